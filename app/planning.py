"""What the arm makes of a run: the worker's job, from an arm, a model and conditions to a `Plan`."""

import numpy as np

from app.arm.conditions import Conditions
from app.arm.protocol import Arm, FloatArray
from app.arm.timing import no_faster_than
from app.arm.verdict import LARGEST_STEP, REACHED, Verdict, judge
from app.model import Model
from app.store import Plan
from gc_core import GeneralizedCylinder, Reproduction


def plan_run(arm: Arm, model: Model, run: int, conditions: Conditions, near: FloatArray) -> Plan:
    """Check a run in full: joints, limits, timing, and how clear the arm is of itself and of things.

    Parameters
    ----------
    arm : Arm
        Of the worker; not used by anybody else meanwhile.
    model : Model
        With a cylinder.
    run : int
        Which of its reproductions.
    conditions : Conditions
        What the arm heeds.
    near : (J,) array
        Joints near which the path should begin [rad].

    Returns
    -------
    Plan
        Deterministic: a function of the arguments alone.
    """
    wanted = model.runs[run].reproduction
    arm = arm.under(conditions)
    verdict = judge(arm, wanted.positions, wanted.times, near, wanted.orientations)
    ratios = np.zeros(len(wanted.times))
    if model.cylinder is not None:
        ratios = _ratios(arm, model.cylinder, wanted, verdict)
    return Plan(model, run, conditions, verdict, clock_of(wanted.times, verdict), ratios)


def clock_of(taught: FloatArray, verdict: Verdict) -> FloatArray:
    """Give when the arm passes each sample (K,) [s]; a path with leaps has no honest time but the taught."""
    if verdict.largest_step > LARGEST_STEP:
        return taught - taught[0]
    return no_faster_than(taught, verdict.timed.times)


def _ratios(arm: Arm, cylinder: GeneralizedCylinder, wanted: Reproduction, verdict: Verdict) -> FloatArray:
    """Find where in the tube the hand is, which is not on the run where the arm does not reach it."""
    path = verdict.path
    places = wanted.positions.copy()
    for index in np.flatnonzero(path.errors > REACHED):
        places[index] = arm.tool_pose(path.joints[index])[:3, 3]
    return cylinder.locate(places)[2]
