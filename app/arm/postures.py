"""Other postures of the Jaco that bring the tool to the same place, and ways to them.

A hand that is pulled goes downhill only, so it can be stuck beside a place that
other postures reach. They are found from seeds: fixed ones, so that the same
question always gets the same answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from app.arm.conditions import FREE, Conditions
from app.arm.programs import SAFE_DISTANCE
from app.arm.protocol import HERE, FloatArray
from app.arm.solver import Solver

HIGH = (-1.571, 2.6, 1.3, 3.142, 2.2, 0.0)
"""Folded up with the tool down, half a metre high and near the base: from here the arm may turn [rad]."""

OWN_BODY = "its own arm is in the way"
"""Every posture that reaches a place folds the arm into itself."""

_N_SEEDS = 24
_SEED_LOW = np.array([-3.1, 1.2, 0.7, -3.1, 0.9, -3.1])
_SEED_HIGH = np.array([3.1, 5.1, 5.5, 3.1, 5.3, 3.1])
_CLEAR = 0.5 * SAFE_DISTANCE
"""Bodies farther apart than this do not touch on the way to another posture [m]."""
_CHECKED_EVERY = 0.05
"""[rad]"""
_MOST_WAYS = 6
"""Postures to which a way is looked for, the nearest first."""


def seeds(start: FloatArray | None, home: FloatArray) -> Iterator[FloatArray]:
    """Give joints (6,) to begin from: as the arm stands, at home, and all over [rad]."""
    if start is not None:
        yield start
    yield home
    yield from np.random.default_rng(0).uniform(_SEED_LOW, _SEED_HIGH, (_N_SEEDS, len(home)))


def reaching(
    solver: Solver, target: FloatArray, home: FloatArray, *, clear: bool = True
) -> Iterator[FloatArray]:
    """Give joints (6,) that bring the tool to a target (3,) [rad].

    Parameters
    ----------
    solver : Solver
        Heeds the conditions.
    target : (3,) array
        Where the tool is wanted [m].
    home : (6,) array
        The first of the seeds [rad].
    clear : bool
        Leave out postures in which the arm touches itself or an obstacle.
    """
    for seed in seeds(None, home):
        found = solver.walk(target[None], seed)
        if found.errors[0] <= HERE and (not clear or solver.room(found.joints) >= _CLEAR):
            yield found.joints[0]


def why_not(solver: Solver, target: FloatArray, home: FloatArray, conditions: Conditions) -> str | None:
    """Say what keeps every posture from a target (3,); None when the arm is simply not made for it."""
    if conditions.orientation is not None and any(
        True for _ in reaching(solver.heed(Conditions(conditions.obstacles)), target, home)
    ):
        return "the tool is locked: unlock it"
    touching = list(reaching(solver.heed(FREE), target, home, clear=False))
    if not touching:
        return None
    clear = [joints for joints in touching if solver.room(joints[None]) >= _CLEAR]
    if not clear:
        return OWN_BODY
    found = solver.heed(Conditions(conditions.obstacles)).clearance(np.array(clear))
    return f"{found.names[int(found.obstacles.argmax())] or 'an obstacle'} is in the way"


def way_to(
    solver: Solver, joints: FloatArray, target: FloatArray, home: FloatArray, endless: npt.NDArray[np.bool_]
) -> FloatArray | None:
    """Find joints (W, 6) to pass in straight lines to bring the tool to a target (3,); None: no way found."""

    def near(posture: FloatArray, to: FloatArray) -> FloatArray:
        turns = np.round((to - posture) / (2.0 * np.pi))
        return posture + np.where(endless, 2.0 * np.pi * turns, 0.0)

    ends = [near(posture, joints) for posture in reaching(solver, target, home)]
    ends.sort(key=lambda end: float(np.abs(end - joints).max()))
    for end in ends[:_MOST_WAYS]:
        for way in _ways(joints, end, home, near):
            if _is_clear(solver, way):
                return way
    return None


def _ways(
    begin: FloatArray, end: FloatArray, home: FloatArray, near: Callable[[FloatArray, FloatArray], FloatArray]
) -> Iterator[FloatArray]:
    """Give ways worth trying: straight, then folded up over the base, then as at home."""
    yield np.array([begin, end])
    for posture in (np.array(HIGH), home):
        folded = near(posture, begin)
        folded[0] = begin[0]
        turned = near(folded, end)
        turned[0] = end[0]
        yield np.array([begin, folded, turned, end])


def _is_clear(solver: Solver, way: FloatArray) -> bool:
    """Say whether nothing touches on the straight lines of a way (W, 6); where it begins anything may."""
    n_steps = [int(np.ceil(np.abs(b - a).max() / _CHECKED_EVERY)) + 1 for a, b in pairwise(way)]
    lines = [
        a + np.linspace(0.0, 1.0, n)[:, None] * (b - a)
        for (a, b), n in zip(pairwise(way), n_steps, strict=True)
    ]
    at_first = min(_CLEAR, solver.room(way[:1]))
    for joints in np.concatenate(lines):
        if solver.room(joints[None]) < at_first - 1e-6 or solver.lowest(joints) < 0.0:
            return False
    return True
