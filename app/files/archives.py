"""Zip archives from strangers: looked into in memory, never unpacked to a disk."""

from __future__ import annotations

import io
import lzma
import zipfile
import zlib
from collections.abc import Callable
from typing import Final

from app.files.errors import FileError, TooLargeError, UnreadableError

TEXT: Final = "skill.json"
"""What makes an archive a whole skill."""
LARGEST_UNPACKED: Final = 256 * 2**20
"""What an archive may unpack to [bytes]."""


def members(name: str, content: bytes, wanted: Callable[[str], bool], remedy: str) -> dict[str, bytes]:
    """Read the wanted files of an archive.

    Parameters
    ----------
    name : str
        Of the archive, for messages.
    content : bytes
    wanted : callable
        Whether a file of this name is to be read; it may raise a `FileError`.
    remedy : str
        What to do when it is damaged; a sentence.

    Returns
    -------
    dict of str to bytes
        By the names that stand in the archive, which lead nowhere: nothing is written.

    Raises
    ------
    FileError
        If it is damaged, or announces more than `LARGEST_UNPACKED`; what it announces is never exceeded.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            infos = archive.infolist()
            announced = sum(info.file_size for info in infos)
            if announced > LARGEST_UNPACKED:
                raise TooLargeError(name, "unpacks to", announced, LARGEST_UNPACKED, unit="bytes")
            return {info.filename: archive.read(info) for info in infos if wanted(info.filename)}
    except FileError:
        raise
    # What zipfile raises on damaged, encrypted or exotic archives.
    except (
        zipfile.BadZipFile,
        zlib.error,
        lzma.LZMAError,
        EOFError,
        OSError,
        RuntimeError,
        ValueError,
    ) as error:
        raise UnreadableError(name, "it is damaged or no archive of its kind", remedy) from error
