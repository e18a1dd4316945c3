"""Playing a timed joint path under the arm's own limits of torque and speed.

Every joint has a motor that holds its angle (position control), never with
more torque or speed than Kinova allows. The grasp is simple and stated: a
thing that can be carried, whose surface is within `GRASP_REACH` of the point
between the finger tips when the gripper closes, is held as if it were bolted
to the hand until the gripper opens. Fingers do not move and do not squeeze.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.interpolate import (  # pyright: ignore[reportMissingTypeStubs]  # SciPy has none
    PchipInterpolator,
)

from app.arm.errors import ArmError, ArmInputError
from app.arm.physics import World, joint_path_of
from app.arm.physics_report import Carried, Playback, Touch, contacts_of
from app.arm.physics_words import part_in_words
from app.arm.protocol import FloatArray

STEPS_PER_SECOND = 240
GRASP_REACH = 0.02
"""From the point between the finger tips to the surface of what is grasped, at most [m]."""
CLOSED = 0.5
"""A gripper channel of this and more is closed."""
WATCHED = 0.25
"""Between two words about how far a playback is [s]."""
REST = 0.25
"""How long the arm is watched after its path [s]."""

_POSITION_GAIN, _SPEED_GAIN = 0.3, 1.0
_PAUSE = 0.1
"""A contact interrupted for less than this goes on [s]."""
_CLEAR = 1e-3
"""A thing let go is pushed by the hand again when it is this far from it [m]."""
_TOUCHING = 0.002
"""Bodies deeper in each other than this at the start would be thrown apart [m]."""


class StartsInsideError(ArmError):
    """A playback begins with the arm in a thing."""

    def __init__(self, link: str, thing: str, depth: float) -> None:
        super().__init__(
            f"The {part_in_words(link)} is {100.0 * depth:.1f} cm deep in the {thing} where the path begins; "
            f"physics would throw it out. Move the {thing} or begin the path elsewhere."
        )
        self.link, self.object, self.depth = link, thing, depth


def play(
    world: World,
    times: npt.ArrayLike,
    joints: npt.ArrayLike,
    gripper: npt.ArrayLike | None = None,
    *,
    effort: float = 1.0,
    watch: Callable[[float], None] | None = None,
) -> Playback:
    """Let the arm follow a timed joint path as well as its motors can.

    Parameters
    ----------
    world : World
        Entered; things stand where the last playback left them.
    times : (K,) array
        Strictly increasing [s]; K >= 2.
    joints : (K, 6) array
        Wanted at those times; smooth in between [rad].
    gripper : (K,) array, optional
        0 open .. 1 closed; holds from each time to the next.
    effort : float
        Share of the torque limits that the motors may use, above 0.
    watch : callable, optional
        Told each `WATCHED` of the path how much of it is done, 0 .. 1; what it raises ends the playback.

    Returns
    -------
    Playback
        From the first time to `REST` seconds after the last one, at 240 Hz.

    Raises
    ------
    ArmInputError
        If shapes do not fit, numbers are not finite or times do not increase.
    StartsInsideError
        If the arm overlaps a thing at the first configuration.
    """
    clock, path = _timed(times, joints)
    closed = _closed(gripper, clock)
    if not effort > 0.0:
        raise ArmInputError("effort", "a share of the torque limits above 0", effort)
    count = int(np.ceil((clock[-1] - clock[0] + REST) * STEPS_PER_SECOND)) + 1
    steps = clock[0] + np.arange(count) / STEPS_PER_SECOND
    wanted = PchipInterpolator(clock, path)(np.minimum(steps, clock[-1]))
    goals = np.array([_tool_at(world, configuration) for configuration in wanted])
    log = _Log()
    gripped = _Gripper(world)
    rates = np.diff(wanted, axis=0) * STEPS_PER_SECOND
    _begin(world, wanted[0], rates[0])
    for index, time in enumerate(steps.tolist()):
        if watch is not None and index % round(WATCHED * STEPS_PER_SECOND) == 0:
            watch(index / count)
        if index:
            # From where it should be now, at the speed that brings it to where it should be next.
            _drive(world, wanted[index - 1], rates[index - 1], effort)
            world.call("stepSimulation")
        gripped.follow(time, closed=bool(closed[np.searchsorted(clock, time, side="right") - 1]))
        log.note(world, time)
    gripped.end()
    return log.playback(world, steps, goals, tuple(gripped.carried))


@dataclass(eq=False)
class _Log:
    """What happened so far."""

    joints: list[FloatArray] = field(default_factory=list[FloatArray])
    positions: list[FloatArray] = field(default_factory=list[FloatArray])
    speeds: list[FloatArray] = field(default_factory=list[FloatArray])
    torques: list[FloatArray] = field(default_factory=list[FloatArray])
    touches: list[Touch] = field(default_factory=list[Touch])
    poses: dict[str, list[FloatArray]] = field(default_factory=dict[str, list[FloatArray]])

    def note(self, world: World, time: float) -> None:
        """Write down how everything is after a step."""
        states = world.call("getJointStates", world.arm, world.joints)
        self.joints.append(np.array([state[0] for state in states]))
        self.speeds.append(np.array([state[1] for state in states]))
        self.torques.append(np.array([state[3] for state in states]))
        self.positions.append(world.tool_position())
        self.touches.extend(_touches(world, time))
        for shape in world.objects:
            if shape.mass > 0.0:
                self.poses.setdefault(shape.name, []).append(world.pose(shape.name))

    def playback(
        self, world: World, times: FloatArray, goals: FloatArray, carried: tuple[Carried, ...]
    ) -> Playback:
        """Make the report."""
        positions = np.array(self.positions)
        return Playback(
            times=times,
            joints=np.array(self.joints),
            positions=positions,
            errors=np.linalg.norm(positions - goals, axis=1),
            torque_shares=np.abs(self.torques).max(axis=0) / world.torque_limits,
            speed_shares=np.abs(self.speeds).max(axis=0) / world.speed_limits,
            contacts=contacts_of(self.touches, _PAUSE),
            carried=carried,
            objects={name: np.array(poses) for name, poses in self.poses.items()},
        )


class _Gripper:
    """Holds one thing at most."""

    def __init__(self, world: World) -> None:
        self.carried: list[Carried] = []
        self._world = world
        self._was_closed = True  # closed from the beginning: nothing was reached for
        self._held: str | None = None
        self._bolt = -1
        self._taken = 0.0
        self._leaving: set[str] = set()

    def follow(self, time: float, *, closed: bool) -> None:
        """Take or let go when the gripper changes."""
        for name in [name for name in self._leaving if self._world.hand_distance(name) > _CLEAR]:
            self._world.let_touch_hand(name, touch=True)
            self._leaving.discard(name)
        if closed and not self._was_closed:
            self._take(time)
        if not closed and self._held is not None:
            self._release(time)
        self._was_closed = closed

    def end(self) -> None:
        """Write down what is still held, and let go of it."""
        if self._held is not None:
            self._release(None)

    def _take(self, time: float) -> None:
        near = self._world.nearest_to_grip()
        if near is None or near[0] > GRASP_REACH:
            return
        self._held, self._taken = near[1], time
        self._leaving.discard(near[1])
        self._world.let_touch_hand(near[1], touch=False)
        self._bolt = self._world.bolt_to_hand(near[1])

    def _release(self, time: float | None) -> None:
        name = self._held or ""
        self._world.call("removeConstraint", self._bolt)
        self.carried.append(Carried(name, self._taken, time))
        self._leaving.add(name)
        self._held = None


def _begin(world: World, joints: FloatArray, rates: FloatArray) -> None:
    world.place(joints, np.clip(rates, -world.speed_limits, world.speed_limits))
    world.call("setTimeStep", 1.0 / STEPS_PER_SECOND)
    for name in world.bodies:
        for distance, link in world.distances_to(name):
            if distance < -_TOUCHING:
                raise StartsInsideError(link, name, -distance)


def _drive(world: World, joints: FloatArray, rates: FloatArray, effort: float) -> None:
    control = world.constant("POSITION_CONTROL")
    numbers = zip(world.joints, joints, rates, effort * world.torque_limits, world.speed_limits, strict=True)
    for index, angle, rate, torque, speed in numbers:
        world.call(
            "setJointMotorControl2",
            world.arm,
            index,
            control,
            targetPosition=float(angle),
            targetVelocity=float(rate),
            positionGain=_POSITION_GAIN,
            velocityGain=_SPEED_GAIN,
            force=float(torque),
            maxVelocity=float(speed),
        )


def _touches(world: World, time: float) -> list[Touch]:
    """Add up the points of contact between each link and each thing."""
    sums: dict[tuple[str, str], tuple[float, float]] = {}
    for point in world.call("getContactPoints", bodyA=world.arm):
        thing, link = world.name_of(point[2]), world.links.get(point[3])
        if thing is None or link is None or point[8] > 0.0:
            continue
        force, depth = sums.get((link, thing), (0.0, 0.0))
        sums[link, thing] = force + point[9], max(depth, -point[8])
    return [Touch(link, thing, time, force, depth) for (link, thing), (force, depth) in sums.items()]


def _tool_at(world: World, joints: FloatArray) -> FloatArray:
    world.place(joints)
    return world.tool_position()


def _timed(times: npt.ArrayLike, joints: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    path, clock = joint_path_of(joints), np.array(times, dtype=np.float64)
    if clock.shape != (len(path),) or len(path) < 2:
        raise ArmInputError(
            "times", f"{len(path)} numbers, one for each configuration, at least 2", clock.shape
        )
    if not (np.isfinite(clock).all() and np.all(np.diff(clock) > 0.0)):
        raise ArmInputError("times", "finite numbers that increase", "some that do not")
    return clock, path


def _closed(gripper: npt.ArrayLike | None, clock: FloatArray) -> npt.NDArray[np.bool_]:
    if gripper is None:
        return np.zeros(len(clock), dtype=np.bool_)
    channel = np.array(gripper, dtype=np.float64)
    if channel.shape != clock.shape or not np.isfinite(channel).all():
        raise ArmInputError("the gripper", f"{len(clock)} finite numbers, one for each time", channel.shape)
    return channel >= CLOSED
