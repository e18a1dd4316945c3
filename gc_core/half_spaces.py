"""The nearest place that several half-spaces have in common, exactly and for many places at once."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from gc_core.arrays import FloatArray

ALLOWED = 1e-12
"""A place this little behind a plane is on it: rounding [m]."""

TOGETHER = 1e-9
"""Half-spaces that are all obeyed to within this have a place in common [m]."""

NEAR = 1.0
"""Half-spaces with no common place within this distance have none, ... [m]"""

NEAR_FOR_DEEP = 10.0
"""... or within this many times as far as the deepest plane."""

CORNERS = 3
"""In space, the nearest place of an intersection of half-spaces lies on at most this many planes."""

OPPOSED = 0.1
"""Planes whose normals add up, in some proportion, to less than this pull against each other [-]."""

_NONE = 1e6
"""Cost of a step that does not obey all planes, beside the violation [m]."""


def nearest_allowed(places: FloatArray, points: FloatArray, normals: FloatArray) -> FloatArray:
    """Nearest place of an intersection of half-spaces, for many places at once.

    Parameters
    ----------
    places : (P, 3) array
        [m].
    points, normals : (P, C, 3) array
        A point of each plane [m], and its unit normal towards the allowed side; a normal of 0 allows all.

    Returns
    -------
    (P, 3) array
        As `step_to_allowed`.
    """
    behind = np.einsum("pci,pci->pc", points - places[:, None], normals)
    return places + step_to_allowed(behind, normals)


def step_to_allowed(behind: FloatArray, normals: FloatArray) -> FloatArray:
    """Shortest steps that lead to the allowed side of all planes.

    Parameters
    ----------
    behind : (P, C) array
        How far each place lies behind each plane; below 0 on the allowed side [m].
    normals : (P, C, 3) array
        Unit normals towards the allowed side; 0 where there is no plane.

    Returns
    -------
    (P, 3) array
        Exact: the nearest place lies on one plane, or on two or three; all such sets are tried [m].
        Where the half-spaces have nothing in common within 1 m, or within ten times as far as the deepest
        plane, the nearest place that lies as little behind the worst of them as can be: half-way between
        two opposite ones.
    """
    steps, cost = _shortest(behind, normals)
    torn = np.flatnonzero(cost > _NONE + TOGETHER)
    if torn.size:
        level = _least_violation(behind[torn], normals[torn])
        known = np.isfinite(level)
        torn = torn[known]
        steps[torn] = _shortest(behind[torn] - level[known, None], normals[torn])[0]
    return steps


def left_behind(steps: FloatArray, behind: FloatArray, normals: FloatArray) -> FloatArray:
    """Tell how far places still are behind the worst of their planes after steps.

    Parameters
    ----------
    steps : (P, 3) array
        [m].
    behind, normals : (P, C) and (P, C, 3) array
        As `step_to_allowed`; C >= 1.

    Returns
    -------
    (P,) array
        0 where all planes are obeyed [m].
    """
    return np.maximum(behind - np.einsum("pci,pi->pc", normals, steps), 0.0).max(axis=1)


def _shortest(behind: FloatArray, normals: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Shortest steps (P, 3) onto up to three planes that obey all, and their cost (P,)."""
    steps, cost = _onto_one(behind, normals)
    rest = np.flatnonzero(cost >= _NONE)
    for size in range(2, min(CORNERS, normals.shape[1]) + 1):
        for chosen in combinations(range(normals.shape[1]), size):
            if not rest.size:
                break
            inverse = np.linalg.pinv(normals[rest[:, None], chosen])
            tried = np.einsum("pic,pc->pi", inverse, behind[rest[:, None], chosen])
            tried_cost = _cost(tried, behind[rest], normals[rest])
            better = tried_cost < cost[rest]
            steps[rest[better]], cost[rest[better]] = tried[better], tried_cost[better]
            # Where all planes are obeyed, and each of the chosen ones pushes, no step is shorter.
            pushes = np.einsum("pic,pi->pc", inverse, tried)
            rest = rest[(tried_cost >= _NONE) | (pushes < 0.0).any(axis=1)]
    return steps, cost


def _onto_one(behind: FloatArray, normals: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Steps (P, 3) onto one plane, and their cost (P,): where all are obeyed then, none is shorter."""
    best = np.zeros((len(behind), 3))
    cost = _cost(best, behind, normals)
    for plane in range(normals.shape[1]):
        # Stepping back towards a plane that is obeyed is never the shortest way.
        step = np.maximum(behind[:, plane], 0.0)[:, None] * normals[:, plane]
        here = _cost(step, behind, normals)
        better = here < cost
        best[better], cost[better] = step[better], here[better]
    return best, cost


def _cost(steps: FloatArray, behind: FloatArray, normals: FloatArray) -> FloatArray:
    """Length of steps (P, 3); of those that do not obey all planes, or lead too far, their violation."""
    violation, length = left_behind(steps, behind, normals), np.sqrt(np.einsum("pi,pi->p", steps, steps))
    too_far = length > np.maximum(NEAR, NEAR_FOR_DEEP * behind.max(axis=1))
    return np.where(too_far, 2.0 * _NONE, np.where(violation > ALLOWED, _NONE + violation, length))


def _least_violation(behind: FloatArray, normals: FloatArray) -> FloatArray:
    """How far (P,) the worst plane is missed at least, where planes pull against each other; else -inf.

    A mean of the planes whose normals cancel bounds it from below; of all such means over two to four planes
    the greatest is met (duality of linear programs).
    """
    level = np.full(len(behind), -np.inf)
    target = np.array([0.0, 0.0, 0.0, 1.0])
    for size in range(2, min(CORNERS + 1, normals.shape[1]) + 1):
        for chosen in combinations(range(normals.shape[1]), size):
            some = np.swapaxes(normals[:, chosen, :], 1, 2)
            system = np.concatenate((some, np.ones_like(some[:, :1])), axis=1)
            shares = np.linalg.pinv(system) @ target
            opposed = np.linalg.norm(np.einsum("pic,pc->pi", some, shares), axis=1) < OPPOSED
            opposed &= (shares > -TOGETHER).all(axis=1)
            missed = np.einsum("pc,pc->p", shares, behind[:, chosen])
            level = np.where(opposed, np.maximum(level, missed), level)
    return level
