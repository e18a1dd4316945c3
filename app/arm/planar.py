"""A tiny arm for tests: a planar two-link arm on a turntable, solved in closed form.

It needs no model file and no solver, answers in microseconds and its numbers
can be checked by hand; otherwise it keeps the same promises as the Jaco.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from copy import copy

import numpy as np
import numpy.typing as npt

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
from app.arm.protocol import HERE, Clearance, FloatArray, JointPath, LinkMesh, Shortfall
from app.arm.reach import Shell

_HEIGHT, _UPPER, _LOWER = 0.3, 0.5, 0.5
"""Height of the shoulder and lengths of the two links [m]."""
_JAW, _OPENING = 0.05, 0.04
"""Length of a jaw, and how far the jaws are apart when open [m]."""
_DRAG_SPEED = 3.0
"""No joint turns faster than this while the hand is dragged [rad/s]."""
_LIMITS = np.array([[-174.0, -2.2, -3.0], [174.0, 3.1, 0.0]])
_AXLE = 1e-3
"""Nearer to the turntable's axis than this, the turntable stays as it is [m]."""
SHELL = Shell(shoulder=(0.0, 0.0, _HEIGHT), inner=0.15, outer=0.98, table=0.02)


class PlanarArm:
    """Turntable, shoulder and elbow; see `app.arm.protocol.Arm` for what each call promises.

    The links point along x of their frames; at joints 0 the arm is stretched
    out along the world's x axis at the height of the shoulder, and positive
    angles of shoulder and elbow lift it. The elbow is always above the hand. It is
    made of thin lines: nothing touches anything, and it has no wrist to lock.
    """

    name = "Planar arm"
    joint_names = ("turntable", "shoulder", "elbow")

    def __init__(self) -> None:
        self.lower, self.upper = _read_only(_LIMITS[0]), _read_only(_LIMITS[1])
        self.velocity_limits = _read_only(np.full(3, 1.0))
        self.acceleration_limits = _read_only(np.full(3, 2.0))
        self.conditions = FREE
        self.home = _read_only(np.array([-math.pi / 2, 0.9, -1.9]))
        self.link_meshes = _meshes()
        self._closed = False

    def tool_pose(self, joints: npt.ArrayLike) -> FloatArray:
        """Give the (4, 4) pose of the tip; it points along x, outwards from the elbow."""
        return self._chain(joints)[-1]

    def link_poses(self, joints: npt.ArrayLike, gripper: float) -> Mapping[str, FloatArray]:
        """Give the (4, 4) pose of every link; the jaws slide together."""
        half = 0.5 * _OPENING * (1.0 - gripper_of(gripper))
        turntable, upper, lower, tip = self._chain(joints)
        return {
            "turntable": turntable,
            "upper": upper,
            "lower": lower,
            "jaw_left": tip @ _shift(-_JAW, half, 0.0),
            "jaw_right": tip @ _shift(-_JAW, -half, 0.0),
        }

    def step(self, joints: npt.ArrayLike, target: npt.ArrayLike, dt: float = 0.01) -> FloatArray:
        """Turn every joint towards the solution, at most 3 rad/s."""
        before = self._joints(joints)
        wanted = self._solve(SHELL.project(position_of(target)), before)
        bound = _DRAG_SPEED * duration_of(dt)
        return before + np.clip(wanted - before, -bound, bound)

    def follow(
        self,
        positions: npt.ArrayLike,
        start: npt.ArrayLike | None = None,
        orientations: npt.ArrayLike | None = None,
    ) -> JointPath:
        """Solve every position; the turntable counts its turns. Without a wrist no orientation is kept."""
        path = path_of(positions)
        if orientations is not None:
            rotations_of(orientations, len(path))
        last = self.home if start is None else self._joints(start)
        joints = np.empty((len(path), 3))
        for index, position in enumerate(SHELL.project(path, above_table=False)):
            joints[index] = last = self._solve(position, last)
        tips = np.array([self.tool_pose(configuration)[:3, 3] for configuration in joints])
        return JointPath(joints, np.linalg.norm(tips - path, axis=1))

    def shortfall(self, joints: npt.ArrayLike, target: npt.ArrayLike) -> Shortfall | None:
        """Say why the tip is not at the target."""
        wanted, placed = position_of(target), self._joints(joints)
        distance = float(np.linalg.norm(self.tool_pose(placed)[:3, 3] - wanted))
        if distance <= HERE:
            return None
        return Shortfall(distance, SHELL.outside(wanted) or self._obstacle(placed, wanted))

    def unreachable(self, positions: npt.ArrayLike) -> str | None:
        """Say why the worst of some places is out of reach."""
        return SHELL.worst(path_of(positions))

    def under(self, conditions: Conditions) -> PlanarArm:
        """Give an arm that knows the conditions and need not heed them."""
        other = copy(self)
        other.conditions = conditions
        return other

    def reposition(self, joints: npt.ArrayLike, target: npt.ArrayLike) -> FloatArray | None:
        """Go straight to the only posture there is; None where it misses."""
        begin, wanted = self._joints(joints), position_of(target)
        end = self._solve(SHELL.project(wanted), begin)
        missed = np.linalg.norm(self.tool_pose(end)[:3, 3] - wanted) > HERE
        return None if missed else np.array([begin, end])

    def way(self, joints: npt.ArrayLike, goal: npt.ArrayLike) -> FloatArray:
        """Go straight: nothing touches anything."""
        return np.array([self._joints(joints), self._joints(goal)])

    def clearance(self, joints: npt.ArrayLike) -> Clearance:
        """Say that nothing is near."""
        n = len(configurations_of(joints, self.lower, self.upper))
        return Clearance(np.full(n, math.inf), np.full(n, math.inf), ("",) * n, ("",) * n)

    def close(self) -> None:
        """Refuse to be used from now on."""
        self._closed = True

    def _obstacle(self, joints: FloatArray, target: FloatArray) -> str:
        if np.abs(self.step(joints, target) - joints).max() > 1e-6:
            return "still on its way"
        room = np.minimum(joints - self.lower, self.upper - joints)
        return f"joint {int(room.argmin()) + 1} at its limit"

    def _chain(self, joints: npt.ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        turn, shoulder, elbow = self._joints(joints).tolist()
        turntable = _turn_about_z(turn)
        upper = turntable @ _shift(0.0, 0.0, _HEIGHT) @ _lift(shoulder)
        lower = upper @ _shift(_UPPER, 0.0, 0.0) @ _lift(elbow)
        return turntable, upper, lower, lower @ _shift(_LOWER, 0.0, 0.0)

    def _solve(self, position: FloatArray, near: FloatArray) -> FloatArray:
        """Solve for the joints of a position (3,), the turntable near its present angle."""
        x, y, z = position.tolist()
        out, up = math.hypot(x, y), z - _HEIGHT
        turn = float(near[0])
        if out > _AXLE:
            turn += math.remainder(math.atan2(y, x) - turn, 2.0 * math.pi)
        cosine = (out * out + up * up - _UPPER**2 - _LOWER**2) / (2.0 * _UPPER * _LOWER)
        elbow = -math.acos(min(max(cosine, -1.0), 1.0))
        reach = math.atan2(_LOWER * math.sin(elbow), _UPPER + _LOWER * math.cos(elbow))
        return np.clip([turn, math.atan2(up, out) - reach, elbow], self.lower, self.upper)

    def _joints(self, joints: npt.ArrayLike) -> FloatArray:
        if self._closed:
            raise ArmClosedError(self.name)
        return joints_of(joints, self.lower, self.upper)


def _meshes() -> tuple[LinkMesh, ...]:
    grey, light = (70, 70, 70), (150, 150, 150)
    return (
        _box("turntable", (-0.08, -0.08, 0.0), (0.08, 0.08, _HEIGHT), grey),
        _box("upper", (0.0, -0.03, -0.03), (_UPPER, 0.03, 0.03), light),
        _box("lower", (0.0, -0.02, -0.02), (_LOWER - _JAW, 0.02, 0.02), light),
        _box("jaw_left", (0.0, 0.0, -0.01), (_JAW, 0.01, 0.01), grey),
        _box("jaw_right", (0.0, -0.01, -0.01), (_JAW, 0.0, 0.01), grey),
    )


def _box(link: str, low: tuple[float, ...], high: tuple[float, ...], color: tuple[int, int, int]) -> LinkMesh:
    """Make a box from its lowest to its highest corner; corner bits are x, y, z."""
    ends = np.array([low, high], dtype=np.float32)
    bits = (np.arange(8)[:, None] >> np.arange(3)) & 1
    vertices = ends[bits, np.arange(3)]
    sides = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    faces = np.array([face for a, b, c, d in sides for face in ((a, b, c), (a, c, d))], dtype=np.uint32)
    return LinkMesh(link, vertices, faces, color)


def _shift(x: float, y: float, z: float) -> FloatArray:
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def _turn_about_z(angle: float) -> FloatArray:
    cosine, sine = math.cos(angle), math.sin(angle)
    pose = np.eye(4)
    pose[:2, :2] = [[cosine, -sine], [sine, cosine]]
    return pose


def _lift(angle: float) -> FloatArray:
    """Turn x towards z."""
    cosine, sine = math.cos(angle), math.sin(angle)
    pose = np.eye(4)
    pose[0, 0] = pose[2, 2] = cosine
    pose[0, 2], pose[2, 0] = -sine, sine
    return pose


def _read_only(values: FloatArray) -> FloatArray:
    array = values.copy()
    array.setflags(write=False)
    return array
