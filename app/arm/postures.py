"""Other postures of the Jaco that bring the tool to the same place, and ways to them.

A hand that is pulled goes downhill only, so it can be stuck beside a place that
other postures reach. They are found from seeds: fixed ones, so that the same
question always gets the same answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from app.arm.physics_words import thing_in_words
from app.arm.programs import SAFE_DISTANCE, Wrist
from app.arm.protocol import HERE, FloatArray
from app.arm.solver import Solver

HIGH = (-1.571, 2.6, 1.3, 3.142, 2.2, 0.0)
"""Folded up with the tool down, half a metre high and near the base: from here the arm may turn [rad]."""
HIGHER = (-1.571, 3.0, 2.4, 3.142, 2.2, 0.0)
"""The same, stretched upwards [rad]."""
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


def reaching(solver: Solver, target: FloatArray, home: FloatArray) -> Iterator[tuple[FloatArray, str]]:
    """Give joints (6,) that bring the tool to a target, and what they touch.

    Parameters
    ----------
    solver : Solver
        Heeds the conditions.
    target : (3,) array
        Where the tool is wanted [m].
    home : (6,) array
        The first of the seeds [rad].

    Yields
    ------
    joints : (6,) array
        Found from one seed, with the tool rather down, then with the tool as it likes [rad].
    touched : str
        `OWN_BODY`, the name of an obstacle, or empty when nothing is touched.
    """
    wrists: tuple[Wrist, ...] = ("down", "free")
    for wrist in wrists:
        for seed in seeds(None, home):
            found = solver.walk(target[None], seed, wrist=wrist)
            if found.errors[0] <= HERE:
                clearance = solver.clearance(found.joints)
                own = OWN_BODY if clearance.itself[0] < _CLEAR else ""
                yield found.joints[0], own or (clearance.names[0] if clearance.obstacles[0] < _CLEAR else "")


def search(solver: Solver, target: FloatArray, home: FloatArray) -> tuple[bool, str]:
    """Say whether some posture brings the tool to a target (3,), and if none does, why.

    Returns
    -------
    found : bool
        One does, clear of the arm itself and of obstacles.
    reason : str
        Otherwise what all of them touch; empty when none comes there at all.
    """
    inside = solver.inside(target)
    if inside:
        return False, f"{thing_in_words(inside)} is in the way"
    touched: list[str] = []
    for _, name in reaching(solver, target, home):
        if not name:
            return True, ""
        touched.append(name)
    others = [name for name in touched if name != OWN_BODY]
    return False, f"{thing_in_words(others[0])} is in the way" if others else OWN_BODY if touched else ""


def way_to(
    solver: Solver, joints: FloatArray, target: FloatArray, home: FloatArray, endless: npt.NDArray[np.bool_]
) -> FloatArray | None:
    """Find joints (W, 6) to pass in straight lines to bring the tool to a target (3,); None: no way found."""
    near = partial(_near, endless)
    ends = [near(posture, joints) for posture, touched in reaching(solver, target, home) if not touched]
    ends.sort(key=lambda end: float(np.abs(end - joints).max()))
    under_the_table: FloatArray | None = None
    for end in ends[:_MOST_WAYS]:
        for way in _ways(joints, end, home, near):
            if _is_clear(solver, way):
                if _lowest(solver, way) >= 0.0:
                    return way
                under_the_table = way if under_the_table is None else under_the_table
    # A hand is dragged without regard to where the elbow is, so it may have to come back from down there.
    return under_the_table


def swing(
    solver: Solver, joints: FloatArray, goal: FloatArray, home: FloatArray, endless: npt.NDArray[np.bool_]
) -> FloatArray | None:
    """Find joints (W, 6) to pass in straight lines from one posture to another; None: no way found."""
    ways = _ways(joints, goal, home, partial(_near, endless))
    return next((way for way in ways if _is_above(solver, way) and _is_clear(solver, way)), None)


def _near(endless: npt.NDArray[np.bool_], posture: FloatArray, to: FloatArray) -> FloatArray:
    """Turn the endless joints of a posture round to where they are nearest to another one."""
    turns = np.round((to - posture) / (2.0 * np.pi))
    return posture + np.where(endless, 2.0 * np.pi * turns, 0.0)


def _ways(
    begin: FloatArray, end: FloatArray, home: FloatArray, near: Callable[[FloatArray, FloatArray], FloatArray]
) -> Iterator[FloatArray]:
    """Give ways worth trying: straight, then folded up over the base, then as at home."""
    yield np.array([begin, end])
    for posture in (np.array(HIGH), home, np.array(HIGHER)):
        folded = near(posture, begin)
        folded[0] = begin[0]
        turned = near(folded, end)
        turned[0] = end[0]
        yield np.array([begin, folded, turned, end])


def _is_clear(solver: Solver, way: FloatArray) -> bool:
    """Say whether nothing touches on the straight lines of a way (W, 6); where it begins anything may."""
    at_first = min(_CLEAR, solver.room(way[:1]))
    return all(solver.room(joints[None]) >= at_first - 1e-6 for joints in _lines(way))


def _is_above(solver: Solver, way: FloatArray) -> bool:
    """Say whether a way (W, 6) stays above the table; where it begins and ends the arm may be lower."""
    allowed = min(0.0, *(solver.lowest(joints) for joints in (way[0], way[-1])))
    return all(solver.lowest(joints) >= allowed - 1e-6 for joints in _lines(way))


def _lowest(solver: Solver, way: FloatArray) -> float:
    return min(solver.lowest(joints) for joints in _lines(way))


def _lines(way: FloatArray) -> FloatArray:
    """Give joints (K, 6) along the straight lines of a way (W, 6)."""
    parts: list[FloatArray] = []
    for begin, end in pairwise(way):
        n_steps = int(np.ceil(np.abs(end - begin).max() / _CHECKED_EVERY)) + 1
        parts.append(begin + np.linspace(0.0, 1.0, n_steps)[:, None] * (end - begin))
    return np.concatenate(parts)
