"""A run as ``trajectory_msgs/JointTrajectory`` of ROS 2, for a real Jaco.

The timing is that of `app.arm.timing`: at rest at both ends, no joint faster or harder accelerated than
its limit. The whole is stretched to last as long as it was taught, if that is longer.
"""

from __future__ import annotations

import json
from typing import Any, Final

import numpy as np
import yaml  # pyright: ignore[reportMissingModuleSource] - its types are not installed

from app.arm.protocol import Arm, FloatArray
from app.arm.urdf import BASE_LINK
from app.arm.verdict import LARGEST_STEP
from app.store import Plan
from gc_core import GcError

RATE: Final = 50.0
"""Points a second; controllers join them by cubics, which positions and speeds fix [1/s]."""
DIGITS: Final = 6
"""Behind the point: a millionth of a radian."""
DANGEROUS: Final = ("leap", "itself", "thing")
"""Kinds of problems with which no run is given to a real arm."""


class UnsafeRunError(GcError):
    """A run that would harm a real arm or what is around it."""

    def __init__(self, what: str, remedy: str) -> None:
        super().__init__(f"This run is not for a real arm: {what}. {remedy}")
        self.what = what


def joint_trajectory(arm: Arm, plan: Plan) -> dict[str, Any]:
    """Give a run as the message's fields: plain lists, numbers and text.

    Parameters
    ----------
    arm : Arm
        Whose joints are named.
    plan : Plan
        What it makes of the run.

    Raises
    ------
    UnsafeRunError
        If joints would leap, or the arm touch itself or a thing.
    """
    verdict = plan.verdict
    for problem in verdict.problems:
        if problem.kind in DANGEROUS:
            raise UnsafeRunError(problem.what, problem.remedy)
    if verdict.largest_step > LARGEST_STEP:
        raise UnsafeRunError(
            "a joint would have to leap to another posture", "Move the run nearer to the arm."
        )
    times, positions, velocities, accelerations = _sampled(plan)
    points = [
        {
            "positions": _rounded(positions[i]),
            "velocities": _rounded(velocities[i]),
            "accelerations": _rounded(accelerations[i]),
            "effort": [],
            "time_from_start": _duration(times[i]),
        }
        for i in range(len(times))
    ]
    return {
        "header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": BASE_LINK},
        "joint_names": list(arm.joint_names),
        "points": points,
    }


def as_json(message: dict[str, Any]) -> bytes:
    """Write a message as JSON."""
    return (json.dumps(message, indent=1) + "\n").encode()


def as_yaml(message: dict[str, Any]) -> bytes:
    """Write a message as YAML, as ``ros2 topic pub`` reads it; each list of numbers on one line."""
    dumped: str = yaml.safe_dump(message, sort_keys=False, default_flow_style=None, width=10_000)
    return dumped.encode()


def _sampled(plan: Plan) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Give times (P,) and joints, their speeds and accelerations (P, J) at `RATE`, and at the end."""
    timed = plan.verdict.timed
    stretch = max(1.0, plan.taught / timed.duration)
    duration = stretch * timed.duration
    times = np.append(np.arange(0.0, duration - 0.5 / RATE, 1.0 / RATE), duration)
    # Differences over 2 ms of the smooth path are its derivatives to far below the rounding.
    step = 1e-3
    before, here, after = (timed.at((times + shift) / stretch) for shift in (-step, 0.0, step))
    velocities = (after - before) / (2.0 * step)
    velocities[[0, -1]] = 0.0
    return times, here, velocities, (after - 2.0 * here + before) / step**2


def _rounded(values: FloatArray) -> list[float]:
    return [round(float(value), DIGITS) + 0.0 for value in values]


def _duration(time: float) -> dict[str, int]:
    nanoseconds = round(float(time) * 1e9)
    return {"sec": nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}
