"""MATLAB files of the TLGC data set: a cell ``smoothData`` of (T, 3) positions [m].

They hold no times; the authors recorded at 100 Hz.
"""

from __future__ import annotations

import io
import struct
import zlib
from typing import Any, Final, cast

import numpy as np
import scipy.io  # pyright: ignore[reportMissingTypeStubs]  # it has none
from numpy.typing import NDArray

from app.document import FloatArray
from app.files.errors import BadValueError, TooLargeError, UnreadableError
from app.files.recording import Contents, Recording, check_count, check_length

VARIABLE: Final = "smoothData"
LARGEST_UNPACKED: Final = 256 * 2**20
"""What a compressed file may unpack to [bytes]."""
_COMPRESSED: Final = 15
_io: Any = cast("Any", scipy.io)
_REMEDY: Final = "Save it in MATLAB with save('file.mat', 'smoothData', '-v7'), or write a CSV."


def parse_mat(name: str, content: bytes) -> Contents:
    """Read the cell ``smoothData``.

    Raises
    ------
    FileError
        If the file is no MATLAB file up to version 7, unpacks to too much, or
        does not hold a cell of (T, 3) arrays.
    """
    if b"MATLAB 7.3" in content[:128] or content[:8] == b"\x89HDF\r\n\x1a\n":
        raise UnreadableError(name, "it was saved in MATLAB's format 7.3", _REMEDY)
    _check_unpacked(name, content)
    try:
        found: dict[str, Any] = _io.loadmat(io.BytesIO(content), variable_names=[VARIABLE])
    # What SciPy's reader raises on damaged input; the bytes are the person's, not ours.
    except (
        _io.matlab.MatReadError, ValueError, TypeError, KeyError, IndexError, OSError, OverflowError,
        AttributeError, EOFError, MemoryError, NotImplementedError, struct.error, zlib.error,
    ) as error:  # fmt: skip
        raise UnreadableError(name, "it is damaged or no MATLAB file", _REMEDY) from error
    cell: Any = found.get(VARIABLE)
    if not isinstance(cell, np.ndarray) or cast("NDArray[Any]", cell).dtype != object:
        raise UnreadableError(name, f"it holds no cell called {VARIABLE}", _REMEDY)
    items: list[object] = cast("NDArray[Any]", cell).ravel().tolist()
    check_count(name, len(items))
    return Contents(tuple(_recording(name, i, item) for i, item in enumerate(items, start=1)), unit="m")


def _recording(name: str, number: int, item: object) -> Recording:
    table: NDArray[Any] = np.asarray(item)
    if table.ndim != 2 or table.shape[1] != 3 or table.dtype.kind not in "fiu":
        raise BadValueError(
            name,
            f"demonstration {number}",
            f"the cell holds {table.dtype} of shape {table.shape} instead of T rows of x, y, z",
            _REMEDY,
        )
    check_length(name, len(table))
    positions: FloatArray = np.array(table, dtype=np.float64)
    return Recording(positions)


def _check_unpacked(name: str, content: bytes) -> None:
    """Count what the compressed parts unpack to, without keeping it."""
    order = "<" if content[126:128] == b"IM" else ">"
    offset, total = 128, 0
    while offset + 8 <= len(content):
        kind, size = struct.unpack_from(f"{order}II", content, offset)
        if kind == _COMPRESSED:
            total += _unpacked_size(content[offset + 8 : offset + 8 + size], LARGEST_UNPACKED - total)
        if total > LARGEST_UNPACKED:
            raise TooLargeError(name, "unpacks to more than", total - 1, LARGEST_UNPACKED, unit="bytes")
        offset += 8 + size


def _unpacked_size(packed: bytes, limit: int) -> int:
    """How many bytes come out, up to a little more than the limit."""
    machine, size = zlib.decompressobj(), 0
    try:
        while packed and size <= limit and not machine.eof:
            size += len(machine.decompress(packed, 2**20))
            packed = machine.unconsumed_tail
    except zlib.error:
        return size  # damaged: the reader says so
    return size
