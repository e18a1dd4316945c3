"""What was shown: one recorded motion, checked once and never changed.

Trimming makes a `Trimmed` for computing; the demonstration itself stays as it was.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from gc_core.arrays import FloatArray, finite, read_only, read_only_fields
from gc_core.errors import (
    NoMotionError,
    ShapeError,
    TimesNotIncreasingError,
    TooFewSamplesError,
    ZeroQuaternionError,
)

SMALLEST_MOTION = 1e-6
"""Demonstrations that stay within this box diagonal do not move [m]."""

STATIONARY_SPEED = 0.02
"""The tool stands still below this part of the 90th percentile of its own speed [-]."""


@dataclass(frozen=True, eq=False)
class Demonstration:
    """One recorded motion of the tool tip, in the arm's base frame.

    Raises
    ------
    ShapeError, TooFewSamplesError, NotFiniteError
        When the arrays are no recording.
    TimesNotIncreasingError, NoMotionError, ZeroQuaternionError
        Naming the demonstration and the sample.
    """

    times: FloatArray
    """(T,) strictly increasing, T >= 2 [s]."""
    positions: FloatArray
    """(T, 3) tool tip [m]."""
    orientations: FloatArray | None = None
    """(T, 4) unit quaternions w, x, y, z, sign-continuous; or None [-]."""
    gripper: FloatArray | None = None
    """(T,) opening or command of the gripper, in any unit; or None."""
    name: str = ""
    """How the person calls it."""

    def __post_init__(self) -> None:
        what = f"Demonstration {self.name!r}" if self.name else "A demonstration"
        times = finite(self.times, f"{what}: times", (None,))
        positions = finite(self.positions, f"{what}: positions", (None, 3))
        if len(times) != len(positions):
            raise ShapeError(f"{what}: times", f"({len(positions)},), one per position,", times.shape)
        if len(times) < 2:
            raise TooFewSamplesError(what, len(times))
        check_times(what, times)
        extent = float(np.linalg.norm(np.ptp(positions, axis=0)))
        if extent < SMALLEST_MOTION:
            raise NoMotionError(what, len(times), extent)
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "positions", positions)
        if self.orientations is not None:
            object.__setattr__(self, "orientations", _quaternions(what, self.orientations, len(times)))
        if self.gripper is not None:
            object.__setattr__(self, "gripper", finite(self.gripper, f"{what}: gripper", (len(times),)))


@dataclass(frozen=True, eq=False)
class Trimmed:
    """The part of a demonstration that moves, with its true first and last place."""

    times: FloatArray
    """(K,) strictly increasing, starting at 0 [s]."""
    positions: FloatArray
    """(K, 3) [m]."""
    kept: FloatArray
    """(K,) sample of the demonstration that each of these is [-]."""
    cut_start: float
    """Time that stood still at the start [s]."""
    cut_end: float
    """Time that stood still at the end [s]."""
    length: float
    """Length of the path that was kept [m]."""
    duplicates: int
    """Samples that repeat the place of the sample before, within what was kept."""

    def __post_init__(self) -> None:
        read_only_fields(self)


@lru_cache(maxsize=256)
def trim(demonstration: Demonstration, threshold: float = STATIONARY_SPEED) -> Trimmed:
    """Cut the ends in which the tool stands still.

    The speed at a sample is taken over one hundredth of the samples to either side,
    so that a sensor's noise is not taken for motion. The first and the last place are
    kept: they are joined to the motion at the threshold speed. The result is remembered:
    while one demonstration is being corrected, the others are trimmed already.

    Parameters
    ----------
    demonstration : Demonstration
    threshold : float
        Part of the demonstration's own 90th percentile of speed below which it stands still [-].

    Returns
    -------
    Trimmed
    """
    times, positions = demonstration.times, demonstration.positions
    reach = max(1, len(times) // 100)
    after = np.minimum(np.arange(len(times)) + reach, len(times) - 1)
    before = np.maximum(np.arange(len(times)) - reach, 0)
    moved = positions[after] - positions[before]
    speed = np.sqrt(np.einsum("ij,ij->i", moved, moved)) / (times[after] - times[before])
    rank = int(0.9 * (len(speed) - 1))
    limit = threshold * float(np.partition(speed, rank)[rank])
    moving = np.flatnonzero(speed > limit)
    if not moving.size:
        moving = np.array([0, len(times) - 1])
    first, last = int(moving[0]), int(moving[-1])
    if first == last:
        first, last = max(first - 1, 0), min(last + 1, len(times) - 1)
    return _joined(demonstration, first, last, limit)


def _joined(demonstration: Demonstration, first: int, last: int, speed: float) -> Trimmed:
    """Samples first..last, with the true ends put back at the given speed [m/s]."""
    times, positions = demonstration.times, demonstration.positions
    kept = np.arange(first, last + 1, dtype=np.float64)
    clock = times[first : last + 1]
    lead = float(np.linalg.norm(positions[first] - positions[0]))
    tail = float(np.linalg.norm(positions[-1] - positions[last]))
    if lead > 0.0:
        begin = max(times[first] - lead / max(speed, 1e-12), times[0])
        kept, clock = np.concatenate(([0.0], kept)), np.concatenate(([begin], clock))
    if tail > 0.0:
        end = min(times[last] + tail / max(speed, 1e-12), times[-1])
        kept, clock = np.concatenate((kept, [len(times) - 1.0])), np.concatenate((clock, [end]))
    path = positions[kept.astype(np.intp)]
    steps = np.diff(path, axis=0)
    return Trimmed(
        times=clock - clock[0],
        positions=path,
        kept=kept,
        cut_start=float(clock[0] - times[0]),
        cut_end=float(times[-1] - clock[-1]),
        length=float(np.sqrt(np.einsum("ij,ij->i", steps, steps)).sum()),
        duplicates=int((steps == 0.0).all(axis=1).sum()),
    )


def check_times(what: str, times: FloatArray) -> None:
    """Refuse times (T,) [s] that do not strictly increase, naming the sample."""
    standing = np.flatnonzero(np.diff(times) <= 0.0)
    if standing.size:
        index = int(standing[0])
        raise TimesNotIncreasingError(what, index, float(times[index]), float(times[index + 1]))


def _quaternions(what: str, values: FloatArray, count: int) -> FloatArray:
    """Normalize quaternions (T, 4) and flip signs so that neighbours lie on one side."""
    raw = finite(values, f"{what}: orientations", (count, 4))
    lengths = np.linalg.norm(raw, axis=1)
    zero = np.flatnonzero(lengths < 1e-9)
    if zero.size:
        raise ZeroQuaternionError(what, int(zero[0]))
    return read_only(sign_continuous(raw / lengths[:, None]))


def sign_continuous(quaternions: FloatArray) -> FloatArray:
    """Flip signs along axis 0 so that every quaternion is on the side of the one before.

    Parameters
    ----------
    quaternions : (T, 4) array

    Returns
    -------
    (T, 4) array
        The same rotations.
    """
    dots = np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1])
    signs = np.concatenate(([1.0], np.cumprod(np.where(dots < 0.0, -1.0, 1.0))))
    return quaternions * signs[:, None]
