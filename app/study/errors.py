"""What can be wrong with a study; each message says what, where and what to do."""

from __future__ import annotations

from gc_core import GcError


class StudyError(GcError):
    """A study cannot be run, or not to its end."""


class BadSpecError(StudyError):
    """A study's file asks for something that there is not."""

    def __init__(self, file: str, problem: str) -> None:
        super().__init__(f"{file}: {problem}")
        self.file = file


class MissingToolError(StudyError):
    """A package that only studies need is not installed."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f"A study needs the package {name}, which is missing. "
            "Install it with: pip install gc-teach[study,compare]"
        )
        self.name = name

    def __reduce__(self) -> tuple[type[MissingToolError], tuple[str]]:
        """Come home from another process: made again of what it was made of."""
        return MissingToolError, (self.name,)


class FolderError(StudyError):
    """Results cannot be kept."""

    def __init__(self, folder: str, reason: str) -> None:
        super().__init__(f"{folder} cannot be written: {reason}. Choose another folder with --out.")
        self.folder = folder


class ClusterError(StudyError):
    """There is no cluster at an address."""

    def __init__(self, address: str, reason: str) -> None:
        super().__init__(
            f"The dask scheduler {address} cannot be used: {reason}. Start it with 'dask scheduler' and its "
            "workers with 'dask worker ADDRESS', or leave --scheduler out."
        )
        self.address = address


class WorkerLostError(StudyError):
    """A worker died."""

    def __init__(self, reason: str) -> None:
        super().__init__(
            f"A worker was lost ({reason}). Finished parts are kept: start the study again, with fewer "
            "workers if the memory did not suffice."
        )


class OtherVersionsError(StudyError):
    """A worker has other packages than those that the table is to be made with."""

    def __init__(self, differing: str) -> None:
        super().__init__(
            f"A worker has other versions ({differing}), so its numbers could differ in their last digits. "
            "Install the same packages everywhere."
        )
        self.differing = differing

    def __reduce__(self) -> tuple[type[OtherVersionsError], tuple[str]]:
        """Come home from another process: made again of what it was made of."""
        return OtherVersionsError, (self.differing,)


class StoppedError(StudyError):
    """Somebody pressed Ctrl+C."""

    def __init__(self, kept: int, parts: int) -> None:
        super().__init__(
            f"Stopped: {kept} of {parts} parts are finished and kept. Start the study again to go on."
        )
