"""How near runs come to what stands around: the whole arm, or where none is asked the point it leads."""

from __future__ import annotations

import numpy as np

from app.arm.protocol import Arm
from app.arm.shapes import Shape, pose_of, surface_distance
from app.baselines import Run
from app.document import FloatArray
from gc_core.arrays import evenly

SAMPLES = 40
"""Places of a run at which the arm is asked: within 2 mm of what 200 say on the built-in skills."""


def clearances(runs: tuple[Run, ...], things: tuple[Shape, ...], arm: Arm | None = None) -> FloatArray:
    """Measure how clear of everything each run is.

    Parameters
    ----------
    runs : tuple of S Run
    things : tuple of Shape
        What must not be touched.
    arm : Arm, optional
        Led along the runs; it heeds its conditions. The whole of it is kept off the obstacles among
        those, the point that the hand leads off all other things: a ring is around a hand that goes through.

    Returns
    -------
    (S,) array
        Least distance of each run [m]; negative: so deep inside; inf: nothing is there.
    """
    heeded = () if arm is None else arm.conditions.obstacles
    others = tuple(thing for thing in things if thing not in heeded)
    known: dict[bytes, float] = {}  # mixtures give one run, whatever the start
    for run in runs:
        key = run.positions.tobytes()
        if key not in known:
            by_arm = np.inf if arm is None or not heeded else _of_arm(run.positions, arm)
            known[key] = min(_of_point(run.positions, others), by_arm)
    return np.array([known[run.positions.tobytes()] for run in runs])


def _of_arm(path: FloatArray, arm: Arm) -> float:
    some = evenly(len(path), SAMPLES)
    return float(arm.clearance(arm.follow(path[some]).joints).obstacles.min())


def _of_point(path: FloatArray, things: tuple[Shape, ...]) -> float:
    distances = (surface_distance(thing, pose_of(thing), place) for thing in things for place in path)
    return min(distances, default=np.inf)
