"""The Kinova Jaco (j2s6s200): six joints, a spherical wrist and two fingers."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

from app.arm import meshes, urdf
from app.arm.cache import prepared_folder
from app.arm.conditions import FREE, Conditions
from app.arm.errors import ArmClosedError
from app.arm.inputs import (
    configurations_of,
    duration_of,
    gripper_of,
    joints_of,
    path_of,
    position_of,
    rotations_of,
)
from app.arm.paths import Course, find_path
from app.arm.physics_words import thing_in_words
from app.arm.postures import OWN_BODY, search, swing, way_to
from app.arm.programs import SAFE_DISTANCE
from app.arm.protocol import HERE, STUCK, Clearance, FloatArray, JointPath, LinkMesh, Shortfall
from app.arm.reach import Shell
from app.arm.solver import Solver, SolverPool

HOME = (-1.571, 3.68, 1.735, 3.142, 1.945, 0.0)
"""Tool straight down at (0.010, -0.500, 0.250) m; within (-pi, pi] where joints are endless [rad]."""
SHELL = Shell(shoulder=(0.0, 0.0, 0.2755), inner=0.05, outer=0.98, table=0.02)
"""Everything outside is out of reach for every posture, but for a rim that is thinner than `HERE`."""
ACCELERATION = 1.5
"""Ours, since Kinova states none: the joints come to their full speed in half a second [rad/s^2]."""

_POOL = SolverPool()
_CLOSED = 1.34
"""The fingers meet when they have turned this far [rad]."""
_NEAR_LIMIT = 0.02
"""A joint this near to its limit is what stops the arm [rad]."""
_NEAR_BODY = 0.004
"""Bodies nearer than the safe distance plus this are what stops the arm [m]."""
_CREEPING = 1e-4
"""A tool that moves less than this in a tick has come to rest [m]."""
_COLUMN_RADIUS, _COLUMN_TOP = 0.2, 0.35
"""Around the base and below the shoulder there is little room for the hand [m]."""


class _Seat:
    """The solver that an arm and its views under other conditions share until they are closed."""

    def __init__(self, folder: Path, home: FloatArray) -> None:
        self.folder = folder
        self.solver: Solver | None = _POOL.acquire(folder, home)
        self.kinematics = self.solver.kinematics
        self.searched: tuple[object, str] | None = None
        """What was asked last about a hand that is not there, and the answer: a held pointer asks again."""

    def use(self, conditions: Conditions | None = None) -> Solver:
        """Give the solver, heeding conditions; None: those of last time, which is enough for poses."""
        if self.solver is None:
            raise ArmClosedError("Jaco")
        return self.solver if conditions is None else self.solver.heed(conditions)

    def close(self) -> None:
        """Give the solver back to the pool."""
        solver, self.solver = self.solver, None
        if solver is not None:
            _POOL.release(self.folder, solver)


class Jaco:
    """A simulated Jaco; see `app.arm.protocol.Arm` for what each call promises.

    Parameters
    ----------
    folder : Path, optional
        A prepared model, by default the one in the cache, prepared now where
        it is missing (some seconds, once on a machine).

    Raises
    ------
    ArmModelError
        If the model cannot be found, prepared or read.
    """

    def __init__(self, folder: Path | None = None) -> None:
        folder = prepared_folder() if folder is None else folder
        self._link_meshes = _read_meshes(folder)
        self._home = _read_only(HOME)
        self._seat = _Seat(folder, self._home)
        self._kinematics = self._seat.kinematics
        self._conditions = FREE

    @property
    def name(self) -> str:
        """What people call it."""
        return "Jaco"

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Joints 1 to 6, from the base outwards."""
        return urdf.JOINT_NAMES

    @property
    def home(self) -> FloatArray:
        """(6,) joints at rest: the tool points down, half a metre in front [rad]."""
        return self._home

    @property
    def lower(self) -> FloatArray:
        """(6,) lower limits; joints 1, 4 and 6 turn 27.7 times either way [rad]."""
        return self._kinematics.lower

    @property
    def upper(self) -> FloatArray:
        """(6,) upper limits [rad]."""
        return self._kinematics.upper

    @property
    def velocity_limits(self) -> FloatArray:
        """(6,) what Kinova allows: 36 and 48 degrees a second [rad/s]."""
        return self._kinematics.velocity_limits

    @property
    def acceleration_limits(self) -> FloatArray:
        """(6,) `ACCELERATION` for every joint [rad/s^2]."""
        return _read_only(np.full(len(self._home), ACCELERATION))

    @property
    def conditions(self) -> Conditions:
        """What this arm heeds."""
        return self._conditions

    def under(self, conditions: Conditions) -> Jaco:
        """Give the same arm, heeding other conditions; both are closed together."""
        other = copy(self)
        other._conditions = conditions
        return other

    @property
    def link_meshes(self) -> tuple[LinkMesh, ...]:
        """About 15 000 triangles in 17 parts."""
        return self._link_meshes

    def tool_pose(self, joints: npt.ArrayLike) -> FloatArray:
        """Give the (4, 4) pose of the grip between the fingers; it points along its z axis."""
        return self._seat.use().frames(self._joints(joints), (urdf.TOOL,))[0]

    def link_poses(self, joints: npt.ArrayLike, gripper: float) -> Mapping[str, FloatArray]:
        """Give the (4, 4) pose of every drawn link; the fingers turn with the gripper."""
        turned = urdf.rotation_about(2, _CLOSED * gripper_of(gripper))
        frames = self._seat.use().frames(self._joints(joints), urdf.MOVING_LINKS)
        poses = {urdf.BASE_LINK: np.eye(4), **dict(zip(urdf.MOVING_LINKS, frames, strict=True))}
        mounts = self._kinematics.mounts
        for finger in urdf.FINGERS:
            proximal = frames[-1] @ mounts[f"finger_{finger}"] @ turned
            poses[f"{urdf.PREFIX}link_finger_{finger}"] = proximal
            poses[f"{urdf.PREFIX}link_finger_tip_{finger}"] = proximal @ mounts[f"finger_tip_{finger}"]
        return poses

    def step(self, joints: npt.ArrayLike, target: npt.ArrayLike, dt: float = 0.01) -> FloatArray:
        """Follow the hand for one tick: at most 3 rad/s, off its own body, above the table."""
        wanted = SHELL.project(position_of(target))
        return self._use().drag(self._joints(joints), wanted, duration_of(dt))

    def follow(
        self,
        positions: npt.ArrayLike,
        start: npt.ArrayLike | None = None,
        orientations: npt.ArrayLike | None = None,
    ) -> JointPath:
        """Lead the tool along a path; other postures are tried where the first one fails."""
        path, solver = path_of(positions), self._use()
        first = None if start is None else self._joints(start)
        wanted = None if orientations is None else rotations_of(orientations, len(path))
        course = Course(SHELL.project(path, above_table=False), wanted)
        found = find_path(solver, course, start=first, home=self._home)
        poses = np.array([solver.frames(joints, (urdf.TOOL,))[0] for joints in found.joints])
        turns = None if wanted is None else angles_between(poses[:, :3, :3], wanted)
        return JointPath(found.joints, np.linalg.norm(poses[:, :3, 3] - path, axis=1), turns)

    def shortfall(self, joints: npt.ArrayLike, target: npt.ArrayLike) -> Shortfall | None:
        """Say why the tool is not at the target: reach, table, own body, a joint's limit."""
        placed, wanted = self._joints(joints), position_of(target)
        distance = float(np.linalg.norm(self._use().tip(placed) - wanted))
        if distance <= HERE:
            return None
        reason = SHELL.outside(wanted) or self._obstacle(placed, wanted)
        return Shortfall(distance, reason, self._cause(placed) if reason == STUCK else "")

    def unreachable(self, positions: npt.ArrayLike) -> str | None:
        """Say why the worst of some places is out of reach."""
        return SHELL.worst(path_of(positions))

    def reposition(self, joints: npt.ArrayLike, target: npt.ArrayLike) -> FloatArray | None:
        """Find a way to another posture, straight, folded up over the base, or by way of home."""
        wanted, solver = position_of(target), self._use()
        if np.linalg.norm(SHELL.project(wanted) - wanted) > HERE:
            return None
        return way_to(solver, self._joints(joints), wanted, self._home, solver.endless)

    def way(self, joints: npt.ArrayLike, goal: npt.ArrayLike) -> FloatArray | None:
        """Find a way from posture to posture, straight, folded up over the base, or by way of home."""
        solver = self._use()
        return swing(solver, self._joints(joints), self._joints(goal), self._home, solver.endless)

    def clearance(self, joints: npt.ArrayLike) -> Clearance:
        """Measure between boxes around the links, 26 pairs of them and every obstacle."""
        return self._use().clearance(configurations_of(joints, self.lower, self.upper))

    def close(self) -> None:
        """Give the solver back to the pool."""
        self._seat.close()

    def _obstacle(self, joints: FloatArray, target: FloatArray) -> str:
        """Say what keeps the tool from a target inside the shell."""
        solver = self._use()
        after = solver.drag(joints, target, 0.01)
        if np.linalg.norm(solver.tip(after) - solver.tip(joints)) > _CREEPING:
            return "still on its way"
        question = (target.tobytes(), self._conditions)
        if self._seat.searched is None or self._seat.searched[0] != question:
            self._seat.searched = question, self._searched(target)
        return self._seat.searched[1] or self._cause(joints) or "no posture of the arm reaches this"

    def _cause(self, joints: FloatArray) -> str:
        """Say what is nearest to stopping the arm where it is; empty when nothing is near."""
        found = self._use().clearance(joints[None])
        if found.obstacles[0] < SAFE_DISTANCE + _NEAR_BODY:
            return f"{thing_in_words(found.names[0])} is in the way"
        room = np.minimum(joints - self.lower, self.upper - joints)
        if room.min() < _NEAR_LIMIT:
            return f"joint {int(room.argmin()) + 1} at its limit"
        return OWN_BODY if found.itself[0] < SAFE_DISTANCE + _NEAR_BODY else ""

    def _searched(self, target: FloatArray) -> str:
        """Say whether another posture reaches a target, and if none does, why; empty: no idea."""
        found, reason = search(self._use(), target, self._home)
        if found:
            return STUCK
        unlocked = Conditions(self._conditions.obstacles)
        if unlocked != self._conditions and search(self._seat.use(unlocked), target, self._home)[0]:
            return "the tool is held: let it turn freely"
        in_the_column = bool(np.linalg.norm(target[:2]) < _COLUMN_RADIUS and target[2] < _COLUMN_TOP)
        return "too close to its own base" if in_the_column and reason in ("", OWN_BODY) else reason

    def _joints(self, joints: npt.ArrayLike) -> FloatArray:
        return joints_of(joints, self._kinematics.lower, self._kinematics.upper)

    def _use(self) -> Solver:
        return self._seat.use(self._conditions)


def angles_between(one: FloatArray, other: FloatArray) -> FloatArray:
    """Give the angles (K,) between rotations (K, 3, 3) [rad]."""
    cosine = 0.5 * (np.einsum("kij,kij->k", one, other) - 1.0)
    return np.arccos(np.clip(cosine, -1.0, 1.0))


@cache
def _read_meshes(folder: Path) -> tuple[LinkMesh, ...]:
    return meshes.read(folder)


def _read_only(values: npt.ArrayLike) -> FloatArray:
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array
