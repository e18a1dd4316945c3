"""MATLAB files of the TLGC data set: a cell ``smoothData`` of (T, 3) positions [m].

The authors' hold no times; they recorded at 100 Hz. Ours have the same cell, which their programs
read, and beside it cells ``smoothTimes``, ``smoothOrientations``, ``smoothGripper``, ``smoothNames``.
"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Sequence
from typing import Any, Final, cast

import numpy as np
import scipy.io  # pyright: ignore[reportMissingTypeStubs]  # it has none
from numpy.typing import NDArray

from app.document import FloatArray
from app.files.csv_format import labels, name_of
from app.files.errors import BadValueError, TooLargeError, UnreadableError
from app.files.recording import Contents, Recording, check_count, check_length
from gc_core import Demonstration

VARIABLE: Final = "smoothData"
TIMES: Final = "smoothTimes"
ORIENTATIONS: Final = "smoothOrientations"
GRIPPER: Final = "smoothGripper"
NAMES: Final = "smoothNames"
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
        found: dict[str, Any] = _io.loadmat(
            io.BytesIO(content), variable_names=[VARIABLE, TIMES, ORIENTATIONS, GRIPPER, NAMES]
        )
    # What SciPy's reader raises on damaged input; the bytes are the person's, not ours.
    except (
        _io.matlab.MatReadError, ValueError, TypeError, KeyError, IndexError, OSError, OverflowError,
        AttributeError, EOFError, MemoryError, NotImplementedError, struct.error, zlib.error,
    ) as error:  # fmt: skip
        raise UnreadableError(name, "it is damaged or no MATLAB file", _REMEDY) from error
    items = _cell(found, VARIABLE)
    if items is None:
        raise UnreadableError(name, f"it holds no cell called {VARIABLE}", _REMEDY)
    check_count(name, len(items))
    return Contents(tuple(_recording(name, i, items, found) for i in range(len(items))), unit="m")


def format_mat(demonstrations: Sequence[Demonstration]) -> bytes:
    """Write demonstrations exactly; programs for the TLGC data find the positions in ``smoothData``."""
    cells: dict[str, list[object]] = {
        VARIABLE: [d.positions for d in demonstrations],
        TIMES: [d.times for d in demonstrations],
        ORIENTATIONS: [_or_nothing(d.orientations) for d in demonstrations],
        GRIPPER: [_or_nothing(d.gripper) for d in demonstrations],
        NAMES: list(labels(demonstrations)),
    }
    out = io.BytesIO()
    _io.savemat(out, {key: _as_cell(values) for key, values in cells.items()}, do_compression=True)
    return out.getvalue()


def _as_cell(values: Sequence[object]) -> NDArray[Any]:
    cell = np.empty((1, len(values)), dtype=object)
    for i, value in enumerate(values):
        cell[0, i] = value
    return cell


def _or_nothing(array: FloatArray | None) -> FloatArray:
    return np.zeros((0, 0)) if array is None else array


def _cell(found: dict[str, Any], key: str) -> list[object] | None:
    cell: Any = found.get(key)
    if not isinstance(cell, np.ndarray) or cast("NDArray[Any]", cell).dtype != object:
        return None
    return cast("NDArray[Any]", cell).ravel().tolist()


def _recording(name: str, index: int, items: list[object], found: dict[str, Any]) -> Recording:
    number = index + 1
    table: NDArray[Any] = np.asarray(items[index])
    if table.ndim != 2 or table.shape[1] != 3 or table.dtype.kind not in "fiu":
        raise BadValueError(
            name,
            f"demonstration {number}",
            f"the cell holds {table.dtype} of shape {table.shape} instead of T rows of x, y, z",
            _REMEDY,
        )
    check_length(name, len(table))
    positions: FloatArray = np.array(table, dtype=np.float64)
    n = len(positions)

    def beside(key: str, width: int) -> FloatArray | None:
        values = _cell(found, key)
        return (
            None
            if values is None
            else _column(name, f"{key}, demonstration {number}", values, index, (n, width))
        )

    times, gripper = beside(TIMES, 1), beside(GRIPPER, 1)
    return Recording(
        positions,
        times=None if times is None else times[:, 0],
        orientations=beside(ORIENTATIONS, 4),
        gripper=None if gripper is None else gripper[:, 0],
        name=_label(found, index, len(items)),
    )


def _column(
    name: str, where: str, values: list[object], index: int, shape: tuple[int, int]
) -> FloatArray | None:
    """Give what stands beside the positions; an empty array means nothing does."""
    array: NDArray[Any] = np.asarray(values[index] if index < len(values) else None)
    if array.dtype.kind in "fiu" and array.size == 0:
        return None
    if array.dtype.kind not in "fiu" or array.size != shape[0] * shape[1]:
        raise BadValueError(
            name, where, f"there is {array.dtype} of shape {array.shape} instead of {shape}", _REMEDY
        )
    return np.array(array, dtype=np.float64).reshape(shape)


def _label(found: dict[str, Any], index: int, count: int) -> str:
    values = _cell(found, NAMES)
    if values is None or len(values) != count:
        return ""
    label: NDArray[Any] = np.asarray(values[index])
    return name_of(str(label.ravel()[0])) if label.dtype.kind == "U" and label.size == 1 else ""


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
