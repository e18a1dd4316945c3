"""Whether an arm can do a path, how closely, how fast and how clear: numbers, and sentences for where not."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from app.arm.protocol import STUCK, Arm, FloatArray, JointPath
from app.arm.timing import TimedPath, retime

REACHED = 1e-3
"""A sample is reached when the tool comes this near [m]."""
LARGEST_STEP = 0.5
"""A larger step between two samples is another posture, not a motion [rad]."""


@dataclass(frozen=True)
class Problem:
    """A part of a path that the arm cannot do as it is, in words."""

    first: int
    """Number of its first sample."""
    last: int
    """Number of its last sample."""
    what: str
    """What is wrong there, and by how much; no full stop."""
    remedy: str
    """What to change; a sentence."""


@dataclass(frozen=True, eq=False)
class Verdict:
    """What an arm makes of a path of K positions."""

    path: JointPath
    timed: TimedPath
    """As fast as the arm may."""
    reached: float
    """Share of the samples within `REACHED`, 0 to 1."""
    largest_step: float
    """Of a joint between two samples [rad]."""
    speed_ratio: float
    """Largest speed of a joint over its limit, at the times of the path."""
    self_distance: float
    """Smallest distance of the arm from itself [m]; inf where it cannot touch itself."""
    clearance: float
    """Smallest distance of the whole arm from obstacles [m]; inf without any."""
    problems: tuple[Problem, ...]


def judge(arm: Arm, positions: FloatArray, times: FloatArray, start: FloatArray | None = None) -> Verdict:
    """Lead an arm along a path and say how it does.

    Parameters
    ----------
    arm : Arm
        Heeds its conditions.
    positions : (K, 3) array
        Wanted tool positions [m]; K >= 1.
    times : (K,) array
        When they are wanted [s]; increasing.
    start : (J,) array, optional
        Joints near which to begin [rad].

    Raises
    ------
    ArmInputError
        If an argument has the wrong shape or is not finite.
    """
    path = arm.follow(positions, start)
    steps = np.abs(np.diff(path.joints, axis=0))
    ratios = (
        (steps / np.diff(times)[:, None] / arm.velocity_limits).max(axis=1) if len(steps) else np.zeros(0)
    )
    clearance = arm.clearance(path.joints)
    timed = retime(path.joints, arm.velocity_limits, arm.acceleration_limits)
    problems = [
        *_missed(arm, positions, path),
        *_jumps(steps.max(axis=1) if len(steps) else np.zeros(0)),
        *_touching(clearance.itself, ["its own arm"] * len(positions), "the arm touches itself"),
        *_touching(clearance.obstacles, clearance.names, "the arm touches"),
        *_hasty(ratios, timed.duration),
    ]
    return Verdict(
        path=path,
        timed=timed,
        reached=float(np.mean(path.errors <= REACHED)),
        largest_step=float(steps.max(initial=0.0)),
        speed_ratio=float(ratios.max(initial=0.0)),
        self_distance=float(clearance.itself.min()),
        clearance=float(clearance.obstacles.min()),
        problems=tuple(problems),
    )


def _missed(arm: Arm, positions: FloatArray, path: JointPath) -> list[Problem]:
    found: list[Problem] = []
    for first, last in _spans(path.errors > REACHED):
        worst = first + int(np.argmax(path.errors[first : last + 1]))
        off = 1000.0 * path.errors[worst]
        short = arm.shortfall(path.joints[worst], positions[worst])
        reason = "not quite within reach" if short is None else short.reason
        remedy = "Move this part of the motion nearer to the arm, or the whole of it."
        if reason in (STUCK, "still on its way"):
            reason = "the arm would have to change its posture on the way"
            remedy = "Lead the motion around the base instead of past it, or divide it into two."
        elif reason == "below the table":
            remedy = "Raise this part of the motion."
        elif "in the way" in reason or "base" in reason:
            remedy = "Lead this part of the motion farther around it."
        found.append(Problem(first, last, f"the tool stays up to {off:.0f} mm away: {reason}", remedy))
    return found


def _jumps(steps: FloatArray) -> list[Problem]:
    return [
        Problem(
            first,
            last + 1,
            f"a joint turns by {steps[first : last + 1].max():.1f} rad from one sample to the next",
            "Lead the motion farther away from the base or from the end of the reach.",
        )
        for first, last in _spans(steps > LARGEST_STEP)
    ]


def _touching(distances: FloatArray, names: list[str] | tuple[str, ...], what: str) -> list[Problem]:
    found: list[Problem] = []
    for first, last in _spans(distances <= 0.0):
        worst = first + int(np.argmin(distances[first : last + 1]))
        whom = "" if what.endswith("itself") else f" {names[worst]}"
        found.append(
            Problem(
                first,
                last,
                f"{what}{whom}, {-1000.0 * distances[worst]:.0f} mm deep",
                "Lead this part of the motion farther around it.",
            )
        )
    return found


def _hasty(ratios: FloatArray, duration: float) -> list[Problem]:
    """Say where joints would be too fast; one remedy serves all places."""
    spans = _spans(ratios > 1.0)
    if not spans:
        return []
    most = float(ratios.max())
    return [
        Problem(
            spans[0][0],
            spans[-1][1] + 1,
            f"a joint would have to be {most:.1f} times as fast as it can",
            f"Show it more slowly there; timed anew, the arm does the whole motion in {duration:.1f} s.",
        )
    ]


def _spans(wrong: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> list[tuple[int, int]]:
    """Give the first and last index of every run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], wrong, [False]]).astype(np.int8)))
    return [(int(a), int(b) - 1) for a, b in list(pairwise(edges))[::2]]
