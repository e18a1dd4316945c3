"""HDF5 recordings of the canal-surface lab: one group a demonstration.

``<demo>/tf_info/pos_rot_data`` (7, T) holds x, y, z [m] and a quaternion x, y, z, w;
``<demo>/time_info/time_data`` (2, T) holds seconds and nanoseconds. Ours may have
``<demo>/gripper_info/gripper_data`` (1, T) beside it, and attributes ``name`` and ``oriented``.
"""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from typing import Any, Final, cast

import h5py  # pyright: ignore[reportMissingTypeStubs]  # it has none
import numpy as np

from app.document import FloatArray
from app.files.csv_format import labels, name_of
from app.files.errors import FileError, TooLargeError, UnreadableError
from app.files.recording import Contents, Recording, check_count, check_length
from gc_core import Demonstration

POSES: Final = "tf_info/pos_rot_data"
TIMES: Final = "time_info/time_data"
GRIPPER: Final = "gripper_info/gripper_data"
LARGEST_CHUNK: Final = 64 * 2**20
"""What one packed piece of an array may unpack to [bytes]; HDF5 unpacks whole pieces."""
_h5: Any = cast("Any", h5py)
_REMEDY: Final = "Export the recording as CSV: t,x,y,z."


def parse_hdf5(name: str, content: bytes) -> Contents:
    """Read every demonstration of a file.

    Raises
    ------
    FileError
        If the file is damaged, too large, or laid out in another way.
    """
    try:
        with _h5.File(io.BytesIO(content), "r") as file:
            return Contents(_recordings(name, file), unit="m")
    except FileError:
        raise
    # h5py raises these for damaged input; KeyError and RuntimeError for broken links and filters.
    except (OSError, KeyError, RuntimeError, ValueError, TypeError, OverflowError, MemoryError) as error:
        raise UnreadableError(name, "it is damaged or no HDF5 file", _REMEDY) from error


def format_hdf5(demonstrations: Sequence[Demonstration]) -> bytes:
    """Write demonstrations: positions exactly, times to the nanosecond.

    Where no orientation was recorded, that of no turn is written, as the lab's programs expect seven rows;
    the attribute ``oriented`` then says so.
    """
    out = io.BytesIO()
    with _h5.File(out, "w") as file:
        for number, (label, d) in enumerate(
            zip(labels(demonstrations), demonstrations, strict=True), start=1
        ):
            group = file.create_group(f"demo{number:03d}")
            group.attrs["name"] = label
            group.attrs["oriented"] = d.orientations is not None
            turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(d.times), 1))
            turns = turns if d.orientations is None else d.orientations
            group[POSES] = np.vstack([d.positions.T, turns[:, [1, 2, 3, 0]].T])
            seconds = np.floor(d.times)
            group[TIMES] = np.stack([seconds, (d.times - seconds) * 1e9])
            if d.gripper is not None:
                group[GRIPPER] = d.gripper[None]
    return out.getvalue()


def _recordings(name: str, file: Any) -> tuple[Recording, ...]:
    keys: list[str] = list(file)
    groups = [key for key in keys if _within(file, f"{key}/{POSES}")]
    if not groups:
        raise UnreadableError(name, f"no group of it holds {POSES}", _REMEDY)
    check_count(name, len(groups))
    return tuple(_recording(name, key, file[key], single=len(groups) == 1) for key in groups)


def _recording(name: str, key: str, group: Any, *, single: bool) -> Recording:
    n = _columns(name, group, f"{key}/{POSES}", POSES, rows=7)
    poses: FloatArray = np.array(group[POSES], dtype=np.float64).T
    times: FloatArray | None = None
    if _within(group, TIMES):
        if _columns(name, group, f"{key}/{TIMES}", TIMES, rows=2) != n:
            raise UnreadableError(name, f"{key} has not as many times as positions", _REMEDY)
        clock = np.array(group[TIMES], dtype=np.float64)
        # Seconds since 1970 leave no digits for nanoseconds: count from the first.
        times = (clock[0] - clock[0, :1]) + (clock[1] - clock[1, :1]) * 1e-9
    gripper: FloatArray | None = None
    if _within(group, GRIPPER):
        if _columns(name, group, f"{key}/{GRIPPER}", GRIPPER, rows=1) != n:
            raise UnreadableError(name, f"{key} has not as many gripper values as positions", _REMEDY)
        gripper = np.array(group[GRIPPER], dtype=np.float64)[0]
    label: Any = group.attrs.get("name")
    return Recording(
        positions=poses[:, :3],
        times=times,
        orientations=poses[:, [6, 3, 4, 5]] if bool(group.attrs.get("oriented", True)) else None,
        gripper=gripper,
        name=name_of(label) if isinstance(label, str) else "" if single else key,
    )


def _within(group: Any, path: str) -> bool:
    """Whether a path stays in this very file: a link may lead into another one of this machine."""
    for part in path.split("/"):
        if not isinstance(group, _h5.Group) or not isinstance(group.get(part, getlink=True), _h5.HardLink):
            return False
        group = group[part]
    return True


def _columns(name: str, group: Any, path: str, key: str, rows: int) -> int:
    """Check a data set's shape before any of it is read; say how many samples it has."""
    data = group[key]
    table = isinstance(data, _h5.Dataset) and data.ndim == 2 and data.dtype.kind in "fiu"
    if not table or data.shape[0] != rows:
        raise UnreadableError(name, f"{path} is not an array of {rows} rows of numbers", _REMEDY)
    if data.external or data.is_virtual:
        raise UnreadableError(name, f"the numbers of {path} lie in another file", _REMEDY)
    n = int(data.shape[1])
    check_length(name, n)
    unpacked = data.dtype.itemsize * math.prod(data.chunks or ())
    if unpacked > LARGEST_CHUNK:
        raise TooLargeError(name, "unpacks to", unpacked, LARGEST_CHUNK, unit="bytes")
    if n == 0:
        raise UnreadableError(name, f"{path} is empty", _REMEDY)
    return n
