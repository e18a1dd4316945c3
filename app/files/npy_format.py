"""NumPy files: ``.npy`` with one array, ``.npz`` with named ones. Never a pickle.

An array is (T, 3), (T, 7), (n, T, 3) or (n, T, 7); seven columns are x, y, z and a
quaternion w, x, y, z. The array headers are read here rather than by ``np.load``:
it trusts the size that a file announces.
"""

from __future__ import annotations

import io
import math
from collections.abc import Mapping, Sequence
from tokenize import TokenError
from typing import Any, Final, cast

import numpy as np
from numpy.typing import NDArray

from app.document import FloatArray
from app.files.archives import TEXT, members
from app.files.csv_format import labels, name_of
from app.files.errors import BadValueError, PickledError, UnreadableError
from app.files.recording import Contents, Recording, check_count, check_length
from gc_core import Demonstration

_REMEDY: Final = "Save it again with np.save or np.savez."
_npy: Any = cast("Any", np.lib.format)
_SHAPES: Final = (
    "Save positions as (T, 3) or (n, T, 3); with quaternions w, x, y, z behind them as (T, 7) or (n, T, 7)."
)


def parse_npy(name: str, content: bytes) -> Contents:
    """Read demonstrations from one array.

    Raises
    ------
    FileError
        If the file is damaged, a pickle, too large, or of another shape.
    """
    return Contents(_recordings(name, parse_array(name, content), times=None))


def parse_npz(name: str, content: bytes) -> Contents:
    """Read demonstrations from ``positions`` and, where given, ``times`` and ``lengths``.

    With ``lengths`` (n,) the rows of all demonstrations follow each other, as
    `format_npz` writes them; without, ``positions`` is shaped as in an ``.npy``.

    Raises
    ------
    FileError
        As `parse_npy`, and if there is no array ``positions`` among several.
    """
    arrays = _members(name, content)
    numbers = {key: value for key, value in arrays.items() if value.dtype.kind in "fiu"}
    key = "positions" if "positions" in numbers or len(numbers) != 1 else next(iter(numbers))
    if key not in numbers:
        raise UnreadableError(
            name, f"it holds no array positions, only {_listed(arrays)}", "Name the array positions."
        )
    if "lengths" in numbers:
        return Contents(_joined(name, arrays))
    return Contents(_recordings(name, numbers[key], numbers.get("times")))


def format_npz(demonstrations: Sequence[Demonstration]) -> bytes:
    """Write demonstrations one after the other, with the ``lengths`` that divide them."""
    arrays: dict[str, NDArray[Any]] = {
        "positions": np.concatenate([d.positions for d in demonstrations]),
        "times": np.concatenate([d.times for d in demonstrations]),
        "lengths": np.array([len(d.times) for d in demonstrations]),
        "names": np.array(labels(demonstrations)),
    }
    if any(d.orientations is not None for d in demonstrations):
        arrays["orientations"] = np.concatenate(
            [_or_nan(d.orientations, (len(d.times), 4)) for d in demonstrations]
        )
    if any(d.gripper is not None for d in demonstrations):
        arrays["gripper"] = np.concatenate([_or_nan(d.gripper, (len(d.times),)) for d in demonstrations])
    out = io.BytesIO()
    np.savez_compressed(out, allow_pickle=False, **arrays)
    return out.getvalue()


def _members(name: str, content: bytes) -> dict[str, NDArray[Any]]:
    def wanted(member: str) -> bool:
        if member == TEXT:
            raise UnreadableError(
                name, "it is a whole skill", "Give it the ending .gcteach and open it again."
            )
        return member.endswith(".npy")

    found = members(name, content, wanted, _REMEDY)
    return {member.removesuffix(".npy"): parse_array(name, packed) for member, packed in found.items()}


def parse_array(name: str, content: bytes) -> NDArray[Any]:
    """Parse one array, believing its header only as far as there are bytes for it; as `parse_npy`."""
    if content[:1] == b"\x80":
        raise PickledError(name)
    stream = io.BytesIO(content)
    try:
        version = _npy.read_magic(stream)
        read_header = _npy.read_array_header_1_0 if version == (1, 0) else _npy.read_array_header_2_0
        shape, fortran, dtype = read_header(stream)
    except (
        ValueError,
        TypeError,
        EOFError,
        SyntaxError,
        TokenError,
        MemoryError,
        RecursionError,
    ) as error:
        raise UnreadableError(name, "it is damaged or no NumPy file", _REMEDY) from error
    if dtype.hasobject:
        raise PickledError(name)
    count = math.prod(shape)
    if min(shape, default=0) < 0 or count * dtype.itemsize > len(content) - stream.tell():
        raise UnreadableError(name, f"it ends before the {shape} numbers it announces", _REMEDY)
    flat = np.frombuffer(content, dtype=dtype, count=count, offset=stream.tell())
    return flat.reshape(shape, order="F" if fortran else "C")


def _recordings(name: str, array: NDArray[Any], times: NDArray[Any] | None) -> tuple[Recording, ...]:
    if array.dtype.kind not in "fiu" or array.ndim not in (2, 3) or array.shape[-1] not in (3, 7):
        raise UnreadableError(name, f"it holds {array.dtype} of shape {array.shape}", _SHAPES)
    stacked = array if array.ndim == 3 else array[None]
    n, n_samples = stacked.shape[:2]
    check_count(name, n)
    check_length(name, n_samples)
    if times is not None:
        if times.shape not in ((n_samples,), (n, n_samples)):
            raise UnreadableError(
                name, f"times has shape {times.shape}, which does not fit {n} x {n_samples} samples", _SHAPES
            )
        times = np.broadcast_to(times, (n, n_samples))
    return tuple(
        Recording(
            positions=_floats(stacked[i, :, :3]),
            orientations=_floats(stacked[i, :, 3:]) if stacked.shape[2] == 7 else None,
            times=None if times is None else _floats(times[i]),
        )
        for i in range(n)
    )


def _joined(name: str, arrays: Mapping[str, NDArray[Any]]) -> tuple[Recording, ...]:
    lengths, positions = arrays["lengths"], arrays["positions"]
    counts = lengths.ndim == 1 and lengths.dtype.kind in "iu" and bool((lengths >= 0).all())
    table = positions.ndim == 2 and positions.shape[1] == 3
    if not counts or not table or sum(lengths.tolist()) != len(positions):
        raise UnreadableError(
            name, f"lengths does not divide positions of shape {positions.shape} into demonstrations", _SHAPES
        )
    check_count(name, len(lengths))
    columns = {
        key: _column(name, arrays, key, shape)
        for key, shape in (
            ("times", (len(positions),)),
            ("orientations", (len(positions), 4)),
            ("gripper", (len(positions),)),
        )
    }
    names = arrays.get("names")
    if names is None or names.shape != lengths.shape or names.dtype.kind != "U":
        names = np.full(lengths.shape, "")
    stops: list[int] = np.cumsum(lengths).tolist()
    return tuple(
        Recording(
            positions=_floats(positions[stop - length : stop]),
            times=_part(columns["times"], stop - length, stop),
            orientations=_part(columns["orientations"], stop - length, stop),
            gripper=_part(columns["gripper"], stop - length, stop),
            name=name_of(str(label)),
        )
        for length, stop, label in zip(lengths.tolist(), stops, names.tolist(), strict=True)
    )


def _column(
    name: str, arrays: Mapping[str, NDArray[Any]], key: str, shape: tuple[int, ...]
) -> FloatArray | None:
    array = arrays.get(key)
    if array is None:
        return None
    if array.shape != shape or array.dtype.kind not in "fiu":
        raise BadValueError(name, f"array {key}", f"its shape is {array.shape} instead of {shape}", _REMEDY)
    return _floats(array)


def _part(array: FloatArray | None, first: int, stop: int) -> FloatArray | None:
    """The rows of one demonstration; all NaN means that it has none."""
    if array is None or (stop > first and np.isnan(array[first:stop]).all()):
        return None
    return array[first:stop]


def _or_nan(array: FloatArray | None, shape: tuple[int, ...]) -> FloatArray:
    return np.full(shape, np.nan) if array is None else array


def _listed(arrays: Mapping[str, NDArray[Any]]) -> str:
    names = list(arrays)[:8]
    return ", ".join(names) + (" and more" if len(arrays) > 8 else "") or "nothing"


def _floats(array: NDArray[Any]) -> FloatArray:
    return np.array(array, dtype=np.float64)
