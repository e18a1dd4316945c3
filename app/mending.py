"""Mending a demonstration: standing still is cut out of it, a tremble is smoothed."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gc_core import Demonstration
from gc_core.arrays import BoolArray, FloatArray, interpolated, remembered
from gc_core.frames import arc_length, smooth

STILL_REACH: Final = 0.003
"""A hand that stays within this of where it is does not move on, ... [m]"""
SLOW: Final = 0.25
"""... or within this part of the way that it goes in that time elsewhere, where that is less [-]."""
CREEP: Final = 0.02
"""A hand that gets somewhere in the end, at least this part as fast as elsewhere, is slow: no pause [-]."""
STILL: Final = 0.6
"""Standing still for less is no pause, but care [s]."""
CHECKS: Final = 20
"""Moments during that time at which is looked whether the hand is still there."""
TREMBLE: Final = 0.15
"""Over this long to either side a smoothed path is averaged, twice [s]."""


@dataclass(frozen=True)
class Pause:
    """A part of a demonstration in which the hand stands still."""

    first: int
    last: int
    """Samples from where to where."""
    seconds: float
    """How long it lasts [s]."""
    begins: float
    """When, since the demonstration began [s]."""
    where: str
    """``start``, ``middle`` or ``end`` of the motion."""


@remembered
def pauses(demonstration: Demonstration) -> tuple[Pause, ...]:
    """Find where a hand stands still, in the order of time.

    While the gripper opens or closes it has to: that is no pause.
    """
    times = demonstration.times
    begins = np.flatnonzero(_still(demonstration))
    ends = np.searchsorted(times, times[begins] + STILL + 1e-9, side="right") - 1
    apart = np.flatnonzero(begins[1:] > ends[:-1])
    spans = zip(np.append(begins[:1], begins[1:][apart]), np.append(ends[:-1][apart], ends[-1:]), strict=True)
    found = [
        _pause(demonstration, int(first), int(last))
        for first, last in spans
        if not _creeps(demonstration, int(first), int(last))
    ]
    # Where a recording has a gap nobody knows what the hand did.
    return tuple(pause for pause in found if pause.last > pause.first and not _grips(demonstration, pause))


def trimmed(demonstration: Demonstration) -> Demonstration:
    """Cut the pauses out: at the ends and in between the motion goes on at its usual speed.

    Returns
    -------
    Demonstration
        Its places, gripper and orientations are those of the samples that are left, the true ends among them;
        the same object where there is no pause.
    """
    found = pauses(demonstration)
    times, positions = demonstration.times, demonstration.positions
    keep, steps = np.ones(len(times), dtype=bool), np.diff(times)
    inside = np.zeros(len(steps), dtype=bool)
    for pause in found:
        keep[pause.first + 1 : pause.last] = False
        inside[pause.first : pause.last] = True
    if not found or inside.all():
        return demonstration
    way = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    pace = max(float(way[~inside].sum() / steps[~inside].sum()), 1e-9)
    usual = float(np.median(steps))
    gaps = np.diff(times[keep])
    kept = np.flatnonzero(keep)
    for pause in found:
        gap = int(np.searchsorted(kept, pause.first))
        apart = float(np.linalg.norm(positions[pause.last] - positions[pause.first]))
        gaps[gap] = min(gaps[gap], max(usual, apart / pace))
    return Demonstration(
        np.concatenate(([0.0], np.cumsum(gaps))),
        positions[keep],
        None if demonstration.orientations is None else demonstration.orientations[keep],
        None if demonstration.gripper is None else demonstration.gripper[keep],
        demonstration.name,
    )


def smoothed(demonstration: Demonstration) -> Demonstration:
    """Take the tremble out of a path: a moving average over 0.15 s to either side, twice.

    Returns
    -------
    Demonstration
        With the same ends, times, orientations and gripper; the same object where it has too few samples.
    """
    usual = float(np.median(np.diff(demonstration.times)))
    reach = round(TREMBLE / usual)
    path = smooth(smooth(demonstration.positions, reach), reach)
    if np.array_equal(path, demonstration.positions):
        return demonstration
    return replace(demonstration, positions=path)


@remembered
def tremble(demonstration: Demonstration, samples: int = 200) -> float:
    """Say how jerky a motion is, whatever its size and duration.

    Parameters
    ----------
    demonstration : Demonstration
    samples : int
        At how many even times to look, pauses left out.

    Returns
    -------
    float
        Usual (median) jerk, times duration cubed, by length [-]: one abrupt stop is no tremble.

    References
    ----------
    .. [1] N. Hogan, D. Sternad. Sensitivity of smoothness measures to movement duration, amplitude, and
       arrests. Journal of Motor Behavior 41(6), 2009. doi:10.3200/35-09-004-RC
    """
    moving = trimmed(demonstration)
    clock = moving.times - moving.times[0]
    even = np.linspace(0.0, float(clock[-1]), samples)
    columns = [interpolated(even, clock, moving.positions[:, axis]) for axis in range(3)]
    path: FloatArray = np.stack(columns, axis=1)
    length = float(arc_length(moving.positions)[-1])
    jerk = float(samples - 1) ** 3 * (path[3:] - 3.0 * path[2:-1] + 3.0 * path[1:-2] - path[:-3])
    size: FloatArray = np.sqrt((jerk**2).sum(axis=1))
    return float(np.median(size)) / max(length, 1e-9)


def _still(demonstration: Demonstration) -> BoolArray:
    """Samples (T,) after which the hand stays where it is for the time of a pause."""
    times, positions = demonstration.times, demonstration.positions
    still, reach = times + STILL <= times[-1] + 1e-9, min(STILL_REACH, SLOW * _usual_way(demonstration))
    for check in range(1, CHECKS + 1):
        until = times + STILL * check / CHECKS + 1e-9
        then = np.searchsorted(times, until, side="right") - 1
        away = positions[then] - positions
        still &= np.einsum("ij,ij->i", away, away) <= reach**2
    return still


def _usual_way(demonstration: Demonstration) -> float:
    """How far the hand goes, where it moves, in the time of a pause [m]."""
    times, positions = demonstration.times, demonstration.positions
    then = np.minimum(np.searchsorted(times, times + STILL), len(times) - 1)
    ways = np.asarray(np.linalg.norm(positions[then] - positions, axis=1), dtype=np.float64)
    return float(np.median(ways[ways >= SLOW * ways.max()]))


def _creeps(demonstration: Demonstration, first: int, last: int) -> bool:
    """Whether the hand gets somewhere in what seems a pause, slow as it is."""
    times, positions = demonstration.times, demonstration.positions[first : last + 1]
    far = float(np.linalg.norm(positions - positions[0], axis=1).max())
    fast = CREEP * _usual_way(demonstration) / STILL
    return far > 2.0 * STILL_REACH and far > fast * float(times[last] - times[first])


def _pause(demonstration: Demonstration, first: int, last: int) -> Pause:
    times, positions = demonstration.times, demonstration.positions
    # What little is left beside an end belongs to the pause.
    if not _moves(positions[: first + 1]):
        first = 0
    if not _moves(positions[last:]):
        last = len(times) - 1
    where = "start" if first == 0 else "end" if last == len(times) - 1 else "middle"
    return Pause(first, last, float(times[last] - times[first]), float(times[first] - times[0]), where)


def _moves(positions: FloatArray) -> bool:
    """Whether places (K, 3) leave the neighbourhood of the first."""
    return bool(np.linalg.norm(positions - positions[0], axis=1).max() > STILL_REACH)


def _grips(demonstration: Demonstration, pause: Pause) -> bool:
    if demonstration.gripper is None:
        return False
    held = demonstration.gripper[max(pause.first - 1, 0) : pause.last + 2]
    return bool(np.ptp(held) > 0.25 * np.ptp(demonstration.gripper)) and bool(np.ptp(held) > 0.0)
