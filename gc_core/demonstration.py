"""What was shown: one recorded motion, checked once and never changed.

Trimming makes a `Trimmed` for computing; the demonstration itself stays as it was.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gc_core.arrays import FloatArray, IntArray, finite, read_only, read_only_fields, remembered
from gc_core.errors import (
    NoMotionError,
    ShapeError,
    TimesNotIncreasingError,
    TooFarError,
    TooFewSamplesError,
    TooLateError,
    ZeroQuaternionError,
)

SMALLEST_MOTION = 1e-6
"""Demonstrations that stay within this box diagonal do not move [m]."""

FARTHEST = 1e6
"""Positions beyond this distance from the base are no metres [m]."""

LATEST = 1e11
"""Times beyond this are no seconds: since 1970, 1.8e9 have passed [s]."""

SHORTEST_STEP = 1e-15
"""Times that differ by less are one time [s]."""

STATIONARY_SPEED = 0.02
"""The tool stands still below this part of its own top speed, the 90th percentile while it moves [-]."""

STATIONARY_REACH = 0.01
"""What stands still stays within this part of the motion's extent; slow approaches are no stops [-]."""

MOST_SAMPLES = 10_000
"""A demonstration with more samples is computed with about this many of them."""


@dataclass(frozen=True, eq=False)
class Demonstration:
    """One recorded motion of the tool tip, in the arm's base frame.

    Raises
    ------
    ShapeError, TooFewSamplesError, NotFiniteError
        When the arrays are no recording.
    TimesNotIncreasingError, NoMotionError, TooFarError, TooLateError, ZeroQuaternionError
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
        check_places(what, positions)
        _check_clock(what, times)
        check_times(what, times)
        extent = _extent(positions)
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


@remembered
def trim(demonstration: Demonstration, threshold: float = STATIONARY_SPEED) -> Trimmed:
    """Cut the ends in which the tool stands still.

    The speed at a sample is taken over one hundredth of the samples to either side,
    so that a sensor's noise is not taken for motion. What leaves an end's neighbourhood,
    however slowly, is not cut. The first and the last place are
    kept: they are joined to the motion at the threshold speed. Of more than `MOST_SAMPLES`
    samples, those that carry the shape are taken. The result is remembered as long as the
    demonstration lives: while one is being corrected, the others are trimmed already.

    Parameters
    ----------
    demonstration : Demonstration
    threshold : float
        Part of the demonstration's own top speed (the 90th percentile while it moves) below which it
        stands still [-].

    Returns
    -------
    Trimmed
    """
    times, positions = demonstration.times, demonstration.positions
    reach = max(1, len(times) // 100)
    moved = _change(positions, reach)
    speed = np.sqrt(np.einsum("ij,ij->i", moved, moved)) / _change(times, reach)
    limit = threshold * _top_speed(speed, threshold)
    moving = np.flatnonzero(speed > limit)
    if not moving.size:
        moving = np.array([0, len(times) - 1])
    nearby = STATIONARY_REACH * _extent(positions)
    first = _last_nearby(positions[: int(moving[0]) + 1], nearby)
    last = len(times) - 1 - _last_nearby(positions[int(moving[-1]) :][::-1], nearby)
    if first == last:
        first, last = max(first - 1, 0), min(last + 1, len(times) - 1)
    return _joined(demonstration, first, last, limit)


def _extent(positions: FloatArray) -> float:
    """Diagonal of the box around positions (T, 3) [m]."""
    # Axis by axis: over rows of three, numpy's reduction takes five times as long.
    return float(np.linalg.norm([np.ptp(positions[:, axis]) for axis in range(3)]))


def _change(values: FloatArray, reach: int) -> FloatArray:
    """Change of values (T, ...) between `reach` samples before and after each, or the ends; T >= 2 reach."""
    begin, end = values[reach : 2 * reach] - values[0], values[-1] - values[-2 * reach : -reach]
    return np.concatenate((begin, values[2 * reach :] - values[: -2 * reach], end))


def _last_nearby(positions: FloatArray, nearby: float) -> int:
    """Last of the positions (K, 3) before one is further than nearby [m] from the first of them."""
    away = positions - positions[0]
    far = np.flatnonzero(np.einsum("ij,ij->i", away, away) > nearby**2)
    return int(far[0]) - 1 if far.size else len(positions) - 1


def _top_speed(speed: FloatArray, threshold: float) -> float:
    """90th percentile of the speeds (T,) at samples that move [m/s].

    Those move that exceed the threshold times the speed at which half of the way was gone: however long a
    recording stands still, that adds nothing to its way.
    """
    ranked = np.sort(speed)
    gone = np.cumsum(ranked)
    usual = float(ranked[np.searchsorted(gone, 0.5 * gone[-1])])
    still = int(np.searchsorted(ranked, threshold * usual, side="right"))
    return float(ranked[min(still + int(0.9 * (len(ranked) - 1 - still)), len(ranked) - 1)])


def _joined(demonstration: Demonstration, first: int, last: int, speed: float) -> Trimmed:
    """Samples first..last, with the true ends put back at the given speed [m/s]."""
    times, positions = demonstration.times, demonstration.positions
    steps = positions[first + 1 : last + 1] - positions[first:last]
    lengths = np.sqrt(np.einsum("ij,ij->i", steps, steps))
    kept = _telling_samples(positions, first, last)
    clock = times[kept]
    lead = float(np.linalg.norm(positions[first] - positions[0]))
    tail = float(np.linalg.norm(positions[-1] - positions[last]))
    if lead > 0.0:
        begin = max(times[first] - lead / max(speed, 1e-12), times[0])
        kept, clock = np.concatenate(([0], kept)), np.concatenate(([begin], clock))
    if tail > 0.0:
        end = min(times[last] + tail / max(speed, 1e-12), times[-1])
        kept, clock = np.concatenate((kept, [len(times) - 1])), np.concatenate((clock, [end]))
    return Trimmed(
        times=clock - clock[0],
        positions=positions[kept],
        kept=kept.astype(np.float64),
        cut_start=float(clock[0] - times[0]),
        cut_end=float(times[-1] - clock[-1]),
        length=lead + float(lengths.sum()) + tail,
        duplicates=int(np.count_nonzero(lengths == 0.0)),
    )


def _telling_samples(positions: FloatArray, first: int, last: int) -> IntArray:
    """Samples first..last, or about `MOST_SAMPLES` of them.

    Of each block the first is taken, and the one furthest from the line to the next block, so that no
    excursion is lost.
    """
    if last - first < MOST_SAMPLES:
        return np.arange(first, last + 1)
    size = -(-2 * (last - first) // MOST_SAMPLES)
    begins = np.arange(first, last, size)
    inner = np.minimum(begins[:, None] + np.arange(1, size), last)
    line = (positions[np.minimum(begins + size, last)] - positions[begins])[:, None]
    away = positions[inner] - positions[begins][:, None]
    square = np.einsum("bik,bik->bi", line, line)
    along = np.einsum("bik,bik->bi", away, line) / np.where(square > 0.0, square, 1.0)
    away = away - np.clip(along, 0.0, 1.0)[..., None] * line
    furthest = np.argmax(np.einsum("bik,bik->bi", away, away), axis=1)
    return np.unique(np.concatenate((begins, inner[np.arange(len(begins)), furthest], [last])))


def check_places(what: str, positions: FloatArray) -> None:
    """Refuse positions (T, 3) that cannot be metres by orders of magnitude, naming the sample."""
    if np.abs(positions).max(initial=0.0) > FARTHEST:
        far = np.flatnonzero((np.abs(positions) > FARTHEST).any(axis=1))
        # The largest coordinate instead of the length, whose square may not be a number any more.
        distance = float(np.abs(positions[far[0]]).max())
        raise TooFarError(what, int(far[0]), distance, FARTHEST)


def _check_clock(what: str, times: FloatArray) -> None:
    """Refuse times (T,) that cannot be seconds by orders of magnitude, naming the sample."""
    late = np.flatnonzero(np.abs(times) > LATEST)
    if late.size:
        raise TooLateError(what, int(late[0]), float(times[late[0]]), LATEST)


def check_times(what: str, times: FloatArray) -> None:
    """Refuse times (T,) [s] that do not strictly increase, naming the sample."""
    standing = np.flatnonzero(np.diff(times) < SHORTEST_STEP)
    if standing.size:
        index = int(standing[0])
        raise TimesNotIncreasingError(what, index, float(times[index]), float(times[index + 1]))


def _quaternions(what: str, values: FloatArray, count: int) -> FloatArray:
    """Normalize quaternions (T, 4) and flip signs so that neighbours lie on one side."""
    raw = finite(values, f"{what}: orientations", (count, 4))
    largest = np.abs(raw).max(axis=1, keepdims=True)
    zero = np.flatnonzero(largest < 1e-9)
    if zero.size:
        raise ZeroQuaternionError(what, int(zero[0]))
    # The square of a huge number is none; scaled by powers of two, all digits stay.
    scaled = np.ldexp(raw, -np.frexp(largest)[1])
    return read_only(sign_continuous(scaled / np.linalg.norm(scaled, axis=1, keepdims=True)))


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
