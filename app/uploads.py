"""Which uploads a tab may make: decided at the first message, before any memory is taken.

viser 1.1.1 keeps every part of every upload in memory without asking how much that will be, and takes any
GUI element as the target. `UploadLedger` is the missing book-keeping of one tab; it knows nothing of viser.
"""

from dataclasses import dataclass, replace
from typing import Final

MAX_AT_ONCE: Final = 4
"""Uploads that one tab may have under way."""
MIN_PART: Final = 64 << 10
"""Least mean size of a part [bytes]: a list of tiny ones fills the memory; viser's page sends 512 kB."""


@dataclass(frozen=True)
class Announcement:
    """What a tab says before it sends a file."""

    transfer: str
    name: str
    size: int
    """[bytes]"""
    parts: int
    target_takes_files: bool
    """Whether the element it is meant for is an upload button that can be used."""


@dataclass(frozen=True)
class _Progress:
    announced: int
    received: int = 0


class UploadLedger:
    """The uploads of one tab that are under way."""

    def __init__(self, limit: int) -> None:
        """`limit` [bytes] holds for one file and for all files of the tab together."""
        self._limit = limit
        self._open: dict[str, _Progress] = {}

    @property
    def announced(self) -> int:
        """Bytes that the open uploads may still grow to in memory."""
        return sum(progress.announced for progress in self._open.values())

    def start(self, upload: Announcement) -> bool:
        """Whether this upload may begin; if so it is now open."""
        most = 0 if upload.size == 0 else 1 + upload.size // MIN_PART
        sane = min(upload.size, 1) <= upload.parts <= most
        allowed = (
            upload.target_takes_files
            and sane
            and upload.size >= 0
            and self.announced + upload.size <= self._limit
            and upload.transfer not in self._open
            and len(self._open) < MAX_AT_ONCE
        )
        if allowed and upload.size > 0:
            self._open[upload.transfer] = _Progress(upload.size)
        return allowed

    def take(self, transfer: str, size: int) -> bool:
        """Whether a part of so many bytes belongs to an open upload and keeps to what was announced."""
        progress = self._open.get(transfer)
        if progress is None or size <= 0:
            return False
        if progress.received + size > progress.announced:
            return False
        self._open[transfer] = replace(progress, received=progress.received + size)
        return True

    def finished(self, transfer: str) -> bool:
        """Whether all announced bytes of an open upload have come."""
        progress = self._open.get(transfer)
        return progress is not None and progress.received == progress.announced

    def close(self, transfer: str) -> None:
        """Forget an upload: it is complete, or it broke its word."""
        self._open.pop(transfer, None)
