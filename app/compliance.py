"""A replay that lets itself be corrected: the arm runs along a route and yields when its hand is pulled.

A pure stepper in exact 10 ms ticks of session time, like `app.servo`. The hand
is held to the route by a spring: pulled, it goes aside as a mass of 2 kg on
that spring would (admittance), and let go it eases back. What is recorded is
where the tool of the arm really was, never a place that the arm cannot take.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from app.arm.errors import ArmInputError
from app.arm.protocol import Arm, FloatArray
from app.route import Route
from app.servo import TICKS_PER_SECOND, USUAL_GAP

SLOWEST, FASTEST = 0.25, 1.0
"""How fast a route may be replayed, as shares of its own speed."""
MASS = 2.0
"""What a pull has to move [kg]."""
DAMPING_RATIO = 0.9
"""Of the springs that are at work: nothing swings on by more than 0.2 %."""
GRIP = 600.0
"""Stiffness of the spring between pointer and hand [N/m]."""
STRONGEST = 40.0
"""A pull is never stronger than this [N]."""
BACK = 1e-4
"""A hand let go that is this near to the route is back on it [m]."""

_TICK = 1.0 / TICKS_PER_SECOND
_SUBSTEPS = 4
_RAMP = round(USUAL_GAP * TICKS_PER_SECOND)
"""A pull comes in steps of a browser's event; the hand feels a ramp of this many ticks."""
_LAG = 1e-3
"""A pulled hand that the arm cannot follow by more than this goes no farther aside [m]."""

_REJOIN = 0.03
"""Planned joints that are this near are taken up again [rad]; in a tick that is the speed of a drag."""


@dataclass(frozen=True)
class Feel:
    """How hard the hand is to pull from its route."""

    name: str
    """For people."""
    stiffness: float
    """Of the spring that holds the hand to the route [N/m]."""

    def deflection(self, pull: float) -> float:
        """Predict how far a steady pull of a length brings the hand aside [m]."""
        together = GRIP / (GRIP + self.stiffness) * pull
        return min(together, STRONGEST / self.stiffness)


SOFT = Feel("soft", 100.0)
MEDIUM = Feel("medium", 400.0)
FIRM = Feel("firm", 1500.0)
FEELS = (SOFT, MEDIUM, FIRM)


@dataclass(frozen=True)
class Pull:
    """The pointer moved, or let the hand go."""

    time: float
    """Session time of its arrival [s]."""
    displacement: tuple[float, float, float] | None
    """From where the hand was grabbed, going along with the route; None: let go [m]."""


@dataclass(frozen=True, eq=False)
class Replay:
    """A replay under way."""

    route: Route
    feel: Feel
    speed: float
    """Share of the route's own speed, `SLOWEST` .. `FASTEST`; may be replaced on the way."""
    tick: int
    """Number of the last tick done; its session time is ``tick / 100`` s."""
    joints: FloatArray
    """(J,) joints after that tick [rad]."""
    along: float
    """Time of the route that the hand has come to [s]."""
    aside: FloatArray
    """(3,) how far the hand is wanted from the route [m]."""
    drift: FloatArray
    """(3,) how fast that changes [m/s]."""
    grip: FloatArray | None
    """(3,) how far aside the hand was when it was grabbed; None while nobody holds it [m]."""
    ramp: FloatArray
    """(R, 3) displacements of the coming ticks, the last one holding on; R >= 1 [m]."""
    pending: tuple[Pull, ...]
    """Events that had not arrived at the last tick."""

    @property
    def time(self) -> float:
        """Session time of the last tick [s]."""
        return self.tick / TICKS_PER_SECOND

    @property
    def done(self) -> bool:
        """Whether the route is at its end and the hand, let go, is back on it."""
        at_end = self.along >= float(self.route.times[-1])
        return at_end and self.grip is None and float(np.linalg.norm(self.aside)) <= BACK


@dataclass(frozen=True, eq=False)
class Replayed:
    """What the hand really did, tick by tick."""

    times: FloatArray
    """(T,) session time, exact multiples of 10 ms [s]."""
    joints: FloatArray
    """(T, J) [rad]."""
    positions: FloatArray
    """(T, 3) tool of the arm with these joints [m]."""
    along: FloatArray
    """(T,) time of the route [s]."""
    route: FloatArray
    """(T, 3) where the hand would have been without a pull [m]."""
    pulled: npt.NDArray[np.bool_]
    """(T,) whether somebody held the hand."""


def begin(
    arm: Arm,
    route: Route,
    time: float,
    *,
    feel: Feel = MEDIUM,
    speed: float = FASTEST,
    joints: FloatArray | None = None,
) -> Replay:
    """Stand at the beginning of a route.

    Parameters
    ----------
    arm : Arm
        Finds the joints where none are given.
    route : Route
        What is replayed.
    time : float
        Session time [s]; rounded to a whole tick.
    feel : Feel
        How hard the hand is to pull aside.
    speed : float
        Share of the route's own speed, `SLOWEST` .. `FASTEST`.
    joints : (J,) array, optional
        With the tool at the beginning of the route; by default as planned or found by `Arm.follow` [rad].

    Returns
    -------
    Replay
        The first tick to come is the one after ``time``. How the arm came
        here is the caller's business and is not recorded.

    Raises
    ------
    ArmInputError
        If the speed is out of its range.
    """
    if not SLOWEST <= speed <= FASTEST:
        raise ArmInputError("the speed of a replay", f"a number from {SLOWEST} to {FASTEST}", speed)
    if joints is None:
        joints = route.planned(float(route.times[0]))
    if joints is None:
        joints = arm.follow(route.positions[:: max(1, len(route.positions) // 40)]).joints[0]
    return Replay(
        route=route,
        feel=feel,
        speed=speed,
        tick=round(time * TICKS_PER_SECOND),
        joints=np.array(joints, dtype=np.float64),
        along=float(route.times[0]),
        aside=np.zeros(3),
        drift=np.zeros(3),
        grip=None,
        ramp=np.zeros((1, 3)),
        pending=(),
    )


def advance(replay: Replay, arm: Arm, pulls: tuple[Pull, ...], until: float) -> tuple[Replay, Replayed]:
    """Replay up to a time.

    Parameters
    ----------
    replay : Replay
        As the last call left it.
    arm : Arm
        Moves by `Arm.step`.
    pulls : tuple of Pull
        Events since the last call, in order. One later than ``until`` is kept
        for later; one earlier than a tick already done counts from the next on.
    until : float
        Session time to come to [s]; the last tick done is not later.

    Returns
    -------
    replay : Replay
        For the next call.
    replayed : Replayed
        One row for every tick; none after the replay is `Replay.done`.

    Raises
    ------
    ArmInputError
        If a pull is not finite.
    """
    for pull in pulls:
        if not np.isfinite([pull.time, *(pull.displacement or ())]).all():
            raise ArmInputError("a pull", "a finite time and displacement", pull)
    replay = replace(replay, pending=replay.pending + pulls)
    steps: list[Replay] = []
    while (replay.tick + 1) / TICKS_PER_SECOND <= until and not (replay.done and not replay.pending):
        replay = _one_tick(replay, arm)
        steps.append(replay)
    return replay, _replayed(arm, steps, len(replay.joints))


def _one_tick(replay: Replay, arm: Arm) -> Replay:
    tick = replay.tick + 1
    while replay.pending and replay.pending[0].time <= tick / TICKS_PER_SECOND:
        replay = _arrive(replay, replay.pending[0])
    along, end = replay.along + replay.speed * _TICK, float(replay.route.times[-1])
    # Sums of hundredths end a hair before the end, which is not worth another tick.
    along = end if along > end - 1e-9 else along
    aside, drift = _yield(replay)
    belongs = replay.route.at(along)
    joints = _planned(replay, along, aside)
    if joints is None:
        joints = arm.step(replay.joints, belongs + aside, _TICK)
    if replay.grip is not None:
        reached = arm.tool_pose(joints)[:3, 3] - belongs
        if math.dist(reached, aside) > _LAG:
            # The arm ends here: pulled farther, the hand would only take longer to come back.
            aside, drift = reached, (reached - replay.aside) / _TICK
    ramp = replay.ramp[1:] if len(replay.ramp) > 1 else replay.ramp
    return replace(replay, tick=tick, joints=joints, along=along, aside=aside, drift=drift, ramp=ramp)


def _planned(replay: Replay, along: float, aside: FloatArray) -> FloatArray | None:
    """Give the planned joints while the hand is on its route and the arm is near them; else None."""
    planned = replay.route.planned(along)
    if planned is None or replay.grip is not None or float(np.linalg.norm(aside)) > BACK:
        return None
    return planned if np.abs(planned - replay.joints).max() <= _REJOIN else None


def _arrive(replay: Replay, pull: Pull) -> Replay:
    """Take one event in: a grab, a move of the pointer, or the hand let go."""
    pending = replay.pending[1:]
    if pull.displacement is None:
        return replace(replay, grip=None, ramp=np.zeros((1, 3)), pending=pending)
    felt = np.zeros(3) if replay.grip is None else replay.ramp[0]
    grip = replay.aside if replay.grip is None else replay.grip
    share = np.arange(1, _RAMP + 1)[:, None] / _RAMP
    ramp = felt + share * (np.asarray(pull.displacement, dtype=np.float64) - felt)
    return replace(replay, grip=grip, ramp=ramp, pending=pending)


def _yield(replay: Replay) -> tuple[FloatArray, FloatArray]:
    """Move the mass on its springs for a tick: how far aside, and how fast."""
    stiffness = replay.feel.stiffness
    at_work = stiffness if replay.grip is None else stiffness + GRIP
    damping = 2.0 * DAMPING_RATIO * math.sqrt(at_work * MASS)
    aside, drift, dt = replay.aside, replay.drift, _TICK / _SUBSTEPS
    for _ in range(_SUBSTEPS):
        force = -stiffness * aside - damping * drift
        if replay.grip is not None:
            force = force + _pulling(replay.grip + replay.ramp[0] - aside)
        drift = drift + force / MASS * dt
        aside = aside + drift * dt
    return aside, drift


def _pulling(stretch: FloatArray) -> FloatArray:
    """Give the force of the pointer's spring, at most `STRONGEST` [N]."""
    force = GRIP * stretch
    return force * min(1.0, STRONGEST / max(float(np.linalg.norm(force)), 1e-9))


def _replayed(arm: Arm, steps: list[Replay], n_joints: int) -> Replayed:
    joints = np.array([step.joints for step in steps]).reshape(-1, n_joints)
    positions = np.array([arm.tool_pose(configuration)[:3, 3] for configuration in joints])
    return Replayed(
        times=np.array([step.tick for step in steps], dtype=np.float64) / TICKS_PER_SECOND,
        joints=joints,
        positions=positions.reshape(-1, 3),
        along=np.array([step.along for step in steps]),
        route=np.array([step.route.at(step.along) for step in steps]).reshape(-1, 3),
        pulled=np.array([step.grip is not None for step in steps], dtype=np.bool_),
    )
