"""What can be wrong with a file; each message says what, where and what to do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from gc_core import GcError


class FileError(GcError):
    """A file cannot be read or written."""

    def __init__(self, name: str, message: str) -> None:
        super().__init__(message)
        self.name = name
        """The file, as the person knows it."""


class NoFileError(FileError):
    """There is no such file, or it is no file."""


class UnknownFormatError(FileError):
    """The suffix is none that can be read here, or written."""

    def __init__(
        self, name: str, suffix: str, known: Sequence[str], done: Literal["read", "written"] = "written"
    ) -> None:
        ending = f"files that end in {suffix}" if suffix else "files without an ending"
        super().__init__(name, f"{name}: {ending} cannot be {done} here. Possible are: {', '.join(known)}.")
        self.suffix = suffix
        self.known = tuple(known)


class TooLargeError(FileError):
    """A file holds, or claims to hold, more than is ever read."""

    def __init__(self, name: str, what: str, found: float, limit: float, unit: str) -> None:
        super().__init__(
            name,
            f"{name} {what} {found:,.0f} {unit}; at most {limit:,.0f} are read. "
            "Keep the part that shows the motion, or record with fewer samples a second.",
        )
        self.found = found
        self.limit = limit


class UnreadableError(FileError):
    """The content is not what the suffix promises."""

    def __init__(self, name: str, problem: str, remedy: str) -> None:
        super().__init__(name, f"{name}: {problem}. {remedy}")
        self.problem = problem


class BadValueError(FileError):
    """One value in a file cannot be used; says which."""

    def __init__(self, name: str, where: str, problem: str, remedy: str) -> None:
        super().__init__(name, f"{name}, {where}: {problem}. {remedy}")
        self.where = where
        """For instance ``line 7, column y`` or ``demonstration 2, sample 31``."""
        self.problem = problem


class PickledError(FileError):
    """A NumPy file holds Python objects, which run code when they are opened."""

    def __init__(self, name: str) -> None:
        super().__init__(
            name,
            f"{name} holds Python objects instead of numbers; such files can run code and are never "
            "opened. Save a plain array of numbers: np.save(file, np.asarray(positions, dtype=float)).",
        )
