"""Whether an arm can do a path, how closely, how fast and how clear: numbers, and sentences for where not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from app.arm.physics_report import Nearest
from app.arm.physics_words import length_in_words, part_in_words, thing_in_words
from app.arm.protocol import STUCK, Arm, Clearance, FloatArray, JointPath
from app.arm.timing import TimedPath, retime

REACHED = 1e-3
"""A sample is reached when the tool comes this near [m]."""
LARGEST_STEP = 0.5
"""A larger step between two samples is another posture, not a motion [rad]."""
_PAUSE = 0.03
"""Two stretches with less than this part of the path between them are told as one."""

Kind = Literal["reach", "leap", "itself", "thing", "speed"]
"""Out of reach; another posture on the way; touching itself; touching a thing; shown too fast."""


@dataclass(frozen=True)
class Problem:
    """A part of a path that the arm cannot do as it is, in words."""

    kind: Kind
    first: int
    """Number of its first sample."""
    last: int
    """Number of its last sample."""
    worst: int
    """Number of the sample where it is worst."""
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
    nearest: Nearest | None
    """Where the whole arm comes nearest to an obstacle; None without any."""
    problems: tuple[Problem, ...]
    """In the order of what matters more: reach, touching, leaping, speed; then in time."""

    @property
    def clearance(self) -> float:
        """Smallest distance of the whole arm from obstacles [m]; inf without any."""
        return np.inf if self.nearest is None else self.nearest.distance


def judge(
    arm: Arm,
    positions: FloatArray,
    times: FloatArray,
    start: FloatArray | None = None,
    orientations: FloatArray | None = None,
) -> Verdict:
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
    orientations : (K, 4) array, optional
        How the tool should be turned, w x y z; instead of a lock.

    Raises
    ------
    ArmInputError
        If an argument has the wrong shape or is not finite.
    """
    path = arm.follow(positions, start, orientations)
    steps = np.abs(np.diff(path.joints, axis=0))
    ratios = (
        (steps / np.diff(times)[:, None] / arm.velocity_limits).max(axis=1) if len(steps) else np.zeros(0)
    )
    clearance = arm.clearance(path.joints)
    timed = retime(path.joints, arm.velocity_limits, arm.acceleration_limits)
    missed = _missed(arm, positions, path)
    leaps = steps.max(axis=1) > LARGEST_STEP if len(steps) else np.zeros(0, dtype=np.bool_)
    problems = [
        *missed,
        *_touching_things(clearance),
        *_touching_itself(clearance),
        *_leaping(np.where(leaps, steps.max(axis=1, initial=0.0), 0.0), missed),
        *_hasty(np.where(leaps, 0.0, ratios), timed.duration),
    ]
    return Verdict(
        path=path,
        timed=timed,
        reached=float(np.mean(path.errors <= REACHED)),
        largest_step=float(steps.max(initial=0.0)),
        speed_ratio=float(ratios.max(initial=0.0)),
        self_distance=float(clearance.itself.min()),
        nearest=_nearest(clearance),
        problems=tuple(problems),
    )


def _nearest(clearance: Clearance) -> Nearest | None:
    index = int(np.argmin(clearance.obstacles))
    distance = float(clearance.obstacles[index])
    if np.isinf(distance):
        return None
    return Nearest(distance, index, clearance.links[index], clearance.names[index])


def _missed(arm: Arm, positions: FloatArray, path: JointPath) -> list[Problem]:
    found: list[Problem] = []
    for first, last in _spans(path.errors > REACHED):
        worst = first + int(np.argmax(path.errors[first : last + 1]))
        off = length_in_words(float(path.errors[worst]))
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
        what = f"the hand stays up to {off} away: {reason}"
        found.append(Problem("reach", first, last, worst, what, remedy))
    return found


def _touching_things(clearance: Clearance) -> list[Problem]:
    found: list[Problem] = []
    inside = clearance.obstacles <= 0.0
    for name in sorted({name for name, there in zip(clearance.names, inside, strict=True) if there}):
        of_this = inside & (np.array(clearance.names) == name)
        for first, last in _spans(of_this):
            depths = np.where(of_this, -clearance.obstacles, 0.0)[first : last + 1]
            worst = first + int(np.argmax(depths))
            part, thing = part_in_words(clearance.links[worst]), thing_in_words(name)
            what = f"the {part} would be up to {length_in_words(float(depths.max()))} deep in {thing}"
            remedy = f"Move {thing}, or lead this part of the motion farther around it."
            found.append(Problem("thing", first, last, worst, what, remedy))
    return sorted(found, key=lambda problem: problem.first)


def _touching_itself(clearance: Clearance) -> list[Problem]:
    found: list[Problem] = []
    for first, last in _spans(clearance.itself <= 0.0):
        worst = first + int(np.argmin(clearance.itself[first : last + 1]))
        depth = length_in_words(-float(clearance.itself[worst]))
        what = f"the arm would be up to {depth} deep in itself"
        remedy = "Lead this part of the motion farther away from the base."
        found.append(Problem("itself", first, last, worst, what, remedy))
    return found


def _leaping(steps: FloatArray, missed: Sequence[Problem]) -> list[Problem]:
    """Say where a joint would leap, unless it is told already that the hand does not get through there."""
    found: list[Problem] = []
    for first, last in _spans(steps > 0.0):
        if any(problem.first <= last + 1 and first <= problem.last for problem in missed):
            continue
        worst = first + int(np.argmax(steps[first : last + 1]))
        what = f"a joint would have to leap by {np.degrees(steps[worst]):.0f} degrees to another posture"
        remedy = "Lead the motion farther away from the base or from the end of the reach."
        found.append(Problem("leap", first, last + 1, worst, what, remedy))
    return found


def _hasty(ratios: FloatArray, duration: float) -> list[Problem]:
    """Say where joints would be too fast; one remedy serves all places."""
    fast = np.flatnonzero(ratios > 1.0)
    if not len(fast):
        return []
    worst = int(np.argmax(ratios))
    what = f"a joint would have to be {ratios[worst]:.1f} times as fast as it can"
    remedy = f"Show it more slowly there; timed anew, the arm does the whole motion in {duration:.1f} s."
    return [Problem("speed", int(fast[0]), int(fast[-1]) + 1, worst, what, remedy)]


def _spans(wrong: npt.NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Give the first and last index of every run of true values; short pauses do not part them."""
    found: list[tuple[int, int]] = []
    for index in np.flatnonzero(wrong).tolist():
        if found and index - found[-1][1] <= 1 + int(_PAUSE * len(wrong)):
            found[-1] = found[-1][0], index
        else:
            found.append((index, index))
    return found
