"""What every format reader returns, and the checks that are the same for all of them.

A `Recording` is what stands in the file: its own units, its own clock, nothing
repaired. `checked` turns recordings into demonstrations or says what is wrong.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from app.document import FloatArray, plain
from app.files.errors import BadValueError, FileError, TooLargeError, UnreadableError
from gc_core import Demonstration, GcError

Unit: TypeAlias = Literal["m", "cm", "mm"]

MOST_SAMPLES: Final = 200_000
"""In one demonstration."""
MOST_DEMONSTRATIONS: Final = 200
"""In one file."""
LARGEST_NUMBER: Final = 1e12
"""No position, time or orientation is larger; seconds since 1970 in milliseconds are not by far."""
ASSUMED_RATE: Final = 100.0
"""Samples a second of a file without times [Hz]; what the paper's arm records at."""


@dataclass(frozen=True, eq=False)
class Recording:
    """One motion as it stands in a file."""

    positions: FloatArray
    """(T, 3) in the file's unit."""
    times: FloatArray | None = None
    """(T,) in seconds of any clock; None: the file has none."""
    orientations: FloatArray | None = None
    """(T, 4) wxyz, of any length but zero."""
    gripper: FloatArray | None = None
    """(T,) 0 open .. 1 closed."""
    name: str = ""


@dataclass(frozen=True, eq=False)
class Contents:
    """All that a format reader found in one file."""

    recordings: tuple[Recording, ...]
    unit: Unit | None = None
    """The unit that the format fixes; None: it must be guessed."""


@dataclass(frozen=True, eq=False)
class Checked:
    """Demonstrations in the file's unit, and what had to be done to get them."""

    demonstrations: tuple[Demonstration, ...]
    repeated: int
    """Samples left out because their time was that of the sample before."""


def checked(name: str, recordings: Sequence[Recording]) -> Checked:
    """Turn recordings into demonstrations, still in the file's unit.

    Raises
    ------
    FileError
        If there are none or too many, or one of them is too short, too long,
        stands still, holds a NaN, or has a clock that runs backwards.
    """
    if not recordings:
        raise UnreadableError(name, "it holds no demonstration", "Record one, or choose another file.")
    check_count(name, len(recordings))
    demonstrations: list[Demonstration] = []
    repeated = 0
    for number, recording in enumerate(recordings, start=1):
        _check_shape(name, number, recording)
        _check_finite(name, number, recording)
        times, keep = _clock(name, number, recording)
        repeated += int(np.count_nonzero(~keep))
        demonstrations.append(_demonstration(name, number, recording, times, keep))
    return Checked(tuple(demonstrations), repeated)


def check_count(name: str, n_demonstrations: int) -> None:
    """Refuse a file of too many demonstrations, before they are read where that is possible."""
    if n_demonstrations > MOST_DEMONSTRATIONS:
        raise TooLargeError(name, "holds", n_demonstrations, MOST_DEMONSTRATIONS, unit="demonstrations")


def check_length(name: str, n_samples: int) -> None:
    """Refuse a demonstration of too many samples, before it is read where that is possible."""
    if n_samples > MOST_SAMPLES:
        raise TooLargeError(name, "holds a demonstration of", n_samples, MOST_SAMPLES, unit="samples")


def _check_shape(name: str, number: int, recording: Recording) -> None:
    n = len(recording.positions)
    check_length(name, n)
    if n < 2:
        count = "one sample" if n == 1 else "no sample"
        raise BadValueError(
            name, f"demonstration {number}", f"it has {count}", "A motion needs two or more; record it again."
        )


def _check_finite(name: str, number: int, recording: Recording) -> None:
    for what, values in (
        ("position", recording.positions),
        ("time", recording.times),
        ("orientation", recording.orientations),
        ("gripper", recording.gripper),
    ):
        if values is None:
            continue
        table = values.reshape(len(values), -1)
        for wrong, problem in (
            (~np.isfinite(table).all(axis=1), "is missing or not a finite number (NaN)"),
            ((np.abs(table) > LARGEST_NUMBER).any(axis=1), f"is larger than {LARGEST_NUMBER:g}"),
        ):
            if wrong.any():
                raise BadValueError(
                    name,
                    f"demonstration {number}, sample {int(np.argmax(wrong)) + 1}",
                    f"the {what} {problem}",
                    "Remove that sample or write the number that belongs there.",
                )


def _clock(name: str, number: int, recording: Recording) -> tuple[FloatArray, np.ndarray]:
    """Times from 0, and which samples to keep: a clock may stand still, never run backwards."""
    n = len(recording.positions)
    if recording.times is None:
        return np.arange(n) / ASSUMED_RATE, np.ones(n, dtype=bool)
    steps = np.diff(recording.times)
    if np.any(steps < 0.0):
        sample = int(np.argmax(steps < 0.0)) + 2
        raise BadValueError(
            name,
            f"demonstration {number}, sample {sample}",
            f"the time goes back from {recording.times[sample - 2]:g} s to {recording.times[sample - 1]:g} s",
            "Sort the samples by time, or give each demonstration its own name in a column demo.",
        )
    keep = np.concatenate(([True], steps > 0.0))
    return recording.times - recording.times[0], keep


def _demonstration(
    name: str, number: int, recording: Recording, times: FloatArray, keep: np.ndarray
) -> Demonstration:
    where = f"demonstration {number}"
    if np.ptp(recording.positions, axis=0).max() <= 1e-9:
        raise BadValueError(
            name,
            where,
            f"all {len(recording.positions)} samples are in the same place",
            "Record a motion, or remove this demonstration.",
        )
    if np.count_nonzero(keep) < 2:
        raise BadValueError(
            name, where, "all samples have the same time", "Write the seconds of each sample, or leave t out."
        )
    orientations = recording.orientations
    if orientations is not None:
        orientations = _unit_quaternions(name, where, orientations)[keep]
    try:
        return Demonstration(
            times=times[keep],
            positions=recording.positions[keep],
            orientations=orientations,
            gripper=None if recording.gripper is None else recording.gripper[keep],
            name=plain(recording.name),
        )
    except GcError as error:
        raise FileError(name, f"{name}, {where}: {error}") from error


def _unit_quaternions(name: str, where: str, quaternions: FloatArray) -> FloatArray:
    lengths = np.linalg.norm(quaternions, axis=1, keepdims=True)
    if np.any(lengths < 1e-6):
        raise BadValueError(
            name,
            f"{where}, sample {int(np.argmax(lengths[:, 0] < 1e-6)) + 1}",
            "the orientation is all zeros, which is no quaternion",
            "Write w, x, y, z of the orientation, or leave the four columns out.",
        )
    return quaternions / lengths
