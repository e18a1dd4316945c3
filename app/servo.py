"""The hand's motion as a pure stepper in exact 10 ms ticks of session time.

Events of a drag arrive about every 50 ms. An arm that runs to each of them and
waits for the next one stops and goes; so the hand follows the straight lines
between events one event late, when both ends of a line are known. A tick uses
what had arrived by its time and nothing else, so the same events give the same
motion however the calls are cut.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from app.arm.errors import ArmInputError
from app.arm.protocol import Arm, FloatArray

TICKS_PER_SECOND = 100
"""Ticks are counted, not added up: tick k is at exactly k / 100 s."""
LONGEST_GAP = 0.1
"""After a longer silence of the events the pointer is taken to have stood still [s]."""
USUAL_GAP = 0.05
"""What it is taken to have moved for when it began again: the browser's usual interval [s]."""
HURRY = 0.1
"""The hand goes this share faster or slower than the pointer to keep its lag."""
SETTLE_TIME = 0.6
"""The longest time a released hand is given to arrive after the last event [s]."""
ARRIVED = 0.001
"""A hand this near to the last target has arrived [m]."""
STOPPED = 2e-5
"""A hand that moves less than this in a tick has stopped [m]."""
FASTEST = 3.0
"""No joint turns faster than this while the arm is repositioned [rad/s]."""

_PEAK = 1.875
"""Largest speed of a motion of minimum jerk over its mean speed."""
_TICK = 1.0 / TICKS_PER_SECOND
_MARGIN = 0.01
"""The hand stays the longest recent interval and this much behind: late events do not stop it [s]."""
_SLACK = 0.02
"""That lag may be exceeded by this before the hand hurries [s]."""
_MEMORY = 1.0
"""Recent is what the hand came past within this time [s]."""


@dataclass(frozen=True, eq=False)
class Motion:
    """What the hand did, tick by tick."""

    times: FloatArray
    """(T,) session time of each tick, exact multiples of 10 ms [s]."""
    joints: FloatArray
    """(T, J) joints after each tick [rad]."""
    positions: FloatArray
    """(T, 3) tool tip after each tick [m]."""


@dataclass(frozen=True, eq=False)
class Servo:
    """A hand being led: where the arm is, and what it still has to do."""

    tick: int
    """Number of the last tick done; its session time is ``tick / 100`` s."""
    joints: FloatArray
    """(J,) joints after that tick [rad]."""
    reference: float
    """The event time that the hand has come to; behind the present by one event [s]."""
    waypoints: FloatArray
    """(W, 4) time [s] and position [m] of the events ahead and of the last second; W >= 1."""
    pending: FloatArray
    """(P, 4) events that have not arrived at the time of the last tick."""

    @property
    def time(self) -> float:
        """Session time of the last tick [s]."""
        return self.tick / TICKS_PER_SECOND

    @property
    def waits(self) -> bool:
        """Whether it has come past every event."""
        return len(self.pending) == 0 and self.reference >= self.waypoints[-1, 0]

    @property
    def aim(self) -> FloatArray:
        """(3,) where the last event wants the hand [m]."""
        return self.waypoints[-1, 1:] if len(self.pending) == 0 else self.pending[-1, 1:]

    @property
    def target(self) -> FloatArray:
        """(3,) where the hand is wanted at the last tick; behind the pointer by one event [m]."""
        return _target(self.reference, self.waypoints)


def begin(arm: Arm, joints: FloatArray, time: float) -> Servo:
    """Take the hand where it is.

    Parameters
    ----------
    arm : Arm
        Says where the tool is.
    joints : (J,) array
        Present joints [rad].
    time : float
        Session time [s]; rounded down to a whole tick.

    Returns
    -------
    Servo
        At rest; the first tick to come is the one after ``time``.
    """
    tick = _tick_at(time)
    now = tick / TICKS_PER_SECOND
    waypoint = np.concatenate([[now], arm.tool_pose(joints)[:3, 3]])
    return Servo(tick, np.array(joints, dtype=np.float64), now, waypoint[None], np.empty((0, 4)))


def advance(servo: Servo, arm: Arm, targets: npt.ArrayLike, until: float) -> tuple[Servo, Motion]:
    """Let the hand follow to a time.

    Parameters
    ----------
    servo : Servo
        As the last call left it.
    arm : Arm
        Moves by `Arm.step`.
    targets : (E, 4) array
        Events since the last call, in order: arrival time [s], position [m].
        One later than ``until`` is kept for later; one earlier than a tick
        already done is used from the next tick on. E may be 0.
    until : float
        Session time to come to [s]; the last tick done is not later.

    Returns
    -------
    servo : Servo
        For the next call.
    motion : Motion
        One row for every tick after ``servo.time`` up to ``until``; maybe none.

    Raises
    ------
    ArmInputError
        If a target is not finite.
    """
    events = np.reshape(np.asarray(targets, dtype=np.float64), (-1, 4))
    if not np.isfinite(events).all():
        raise ArmInputError("targets", "finite times and positions", f"{events[~np.isfinite(events)][0]}")
    servo = replace(servo, pending=np.vstack([servo.pending, events]))
    steps = [servo]
    for _ in range(_tick_at(until) - servo.tick):
        steps.append(_one_tick(steps[-1], arm))
    return steps[-1], _motion(arm, steps[1:], len(servo.joints))


def settle(servo: Servo, arm: Arm, at_most: float = SETTLE_TIME) -> tuple[Servo, Motion]:
    """Let the hand arrive after the last event.

    Parameters
    ----------
    servo : Servo
        As the last call of `advance` left it.
    arm : Arm
        Moves by `Arm.step`.
    at_most : float
        The longest time it is given [s].

    Returns
    -------
    servo : Servo
        At rest.
    motion : Motion
        Until the tool is within `ARRIVED` of the last target or has stopped.
    """
    steps = [servo]
    last = np.vstack([servo.waypoints, servo.pending])[-1]
    before = arm.tool_pose(servo.joints)[:3, 3]
    for _ in range(round(at_most * TICKS_PER_SECOND)):
        there = steps[-1].reference >= last[0] and len(steps[-1].pending) == 0
        if there and math.dist(before, last[1:]) <= ARRIVED:
            break
        steps.append(_one_tick(steps[-1], arm))
        after = arm.tool_pose(steps[-1].joints)[:3, 3]
        if there and math.dist(after, before) <= STOPPED:
            break
        before = after
    return steps[-1], _motion(arm, steps[1:], len(servo.joints))


def return_home(
    arm: Arm, start: FloatArray, goal: FloatArray, *, time: float = 0.0, duration: float = 1.0
) -> Motion:
    """Swing from one posture to another, smoothly and without recording.

    Parameters
    ----------
    arm : Arm
        Says where the tool is.
    start, goal : (J,) array
        Joints at the beginning and at the end [rad].
    time : float
        Session time of the beginning [s]; rounded down to a whole tick.
    duration : float
        Length of the motion [s]; rounded to whole ticks, at least one.

    Returns
    -------
    Motion
        Joints on the straight line, with the minimum-jerk time law; the first
        row is one tick after ``time``, the last one is exactly ``goal``.

    References
    ----------
    .. [1] T. Flash, N. Hogan. The coordination of arm movements: an
       experimentally confirmed mathematical model. Journal of Neuroscience
       5(7), 1985.
    """
    n_ticks = max(1, round(duration * TICKS_PER_SECOND))
    ticks = np.arange(1, n_ticks + 1)
    share = ticks / n_ticks
    eased = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    begin_at, end_at = np.asarray(start, dtype=np.float64), np.asarray(goal, dtype=np.float64)
    joints = (1.0 - eased)[:, None] * begin_at + eased[:, None] * end_at
    return _tool_motion(arm, _tick_at(time) + ticks, joints)


def reposition(arm: Arm, joints: FloatArray, target: FloatArray, *, time: float = 0.0) -> Motion | None:
    """Bring a hand that is stuck to where it is wanted, by another posture of the arm.

    Returns
    -------
    Motion or None
        From one posture of the way that `Arm.reposition` finds to the next, beginning at the last whole tick
        before ``time`` [s]; None when there is no way.
    """
    way = arm.reposition(joints, target)
    return None if way is None else swing(arm, way, time=time)


def swing(arm: Arm, way: FloatArray, *, time: float = 0.0, at_least: float = _TICK) -> Motion:
    """Pass postures (W, J) one after the other, each by `return_home`, no joint faster than `FASTEST`.

    From one to the next it takes ``at_least`` so long [s].
    """
    parts: list[Motion] = []
    for start, goal in pairwise(way):
        duration = max(_PEAK * float(np.abs(goal - start).max()) / FASTEST, at_least)
        # Rounded up to a whole tick: a shorter time would be too fast.
        whole = math.ceil(duration * TICKS_PER_SECOND) / TICKS_PER_SECOND
        begins = float(parts[-1].times[-1]) if parts else time
        parts.append(return_home(arm, start, goal, time=begins, duration=whole))
    return Motion(
        np.concatenate([part.times for part in parts]),
        np.concatenate([part.joints for part in parts]),
        np.concatenate([part.positions for part in parts]),
    )


def _one_tick(servo: Servo, arm: Arm) -> Servo:
    tick = servo.tick + 1
    now = tick / TICKS_PER_SECOND
    arrivals = np.maximum.accumulate(servo.pending[:, 0])
    n_arrived = int(np.searchsorted(arrivals, now, side="right"))
    reference, waypoints = servo.reference, servo.waypoints
    for event in servo.pending[:n_arrived]:
        reference, waypoints = _arrive(reference, waypoints, event)
    reference = _proceed(reference, waypoints, now)
    past = int(np.searchsorted(waypoints[:, 0], reference - _MEMORY, side="right"))
    waypoints = waypoints[max(0, past - 1) :]
    joints = arm.step(servo.joints, _target(reference, waypoints), _TICK)
    return Servo(tick, joints, reference, waypoints, servo.pending[n_arrived:])


def _target(reference: float, waypoints: FloatArray) -> FloatArray:
    return np.array([np.interp(reference, waypoints[:, 0], waypoints[:, axis]) for axis in (1, 2, 3)])


def _arrive(reference: float, waypoints: FloatArray, event: FloatArray) -> tuple[float, FloatArray]:
    """Take one event in: it extends the line, or begins a new motion after a silence."""
    last = waypoints[-1]
    if event[0] - last[0] > LONGEST_GAP:
        # The hand is at the last waypoint by now, so nothing moves when its time jumps.
        rest = np.concatenate([[event[0] - USUAL_GAP], last[1:]])
        return max(reference, float(rest[0])), np.vstack([waypoints, rest, event])
    if event[0] <= last[0]:
        # Two events in one instant: the later one holds.
        return reference, np.vstack([waypoints[:-1], np.concatenate([last[:1], event[1:]])])
    return reference, np.vstack([waypoints, event])


def _proceed(reference: float, waypoints: FloatArray, now: float) -> float:
    """Advance the hand's event time by a tick, but never past the last event."""
    gaps = np.diff(waypoints[:, 0])
    wanted_lag = float(gaps[gaps <= LONGEST_GAP].max(initial=USUAL_GAP)) + _MARGIN
    lag = now - reference - _TICK
    hurry = HURRY * (float(lag > wanted_lag + _SLACK) - float(lag < wanted_lag))
    return min(reference + _TICK * (1.0 + hurry), float(waypoints[-1, 0]))


def _motion(arm: Arm, steps: list[Servo], n_joints: int) -> Motion:
    ticks = np.array([step.tick for step in steps], dtype=np.intp)
    joints = np.array([step.joints for step in steps]).reshape(-1, n_joints)
    return _tool_motion(arm, ticks, joints)


def _tool_motion(arm: Arm, ticks: npt.NDArray[np.intp], joints: FloatArray) -> Motion:
    positions = np.array([arm.tool_pose(configuration)[:3, 3] for configuration in joints])
    return Motion(ticks / TICKS_PER_SECOND, joints, positions.reshape(-1, 3))


def _tick_at(time: float) -> int:
    """Give the last tick that is not later than a time."""
    # Compared, not only multiplied: 0.29 s times 100 is 28.999...
    tick = round(time * TICKS_PER_SECOND)
    return tick if tick / TICKS_PER_SECOND <= time else tick - 1
