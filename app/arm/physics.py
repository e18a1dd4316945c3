"""A physical world with the Jaco in it: opened while it is needed, closed after.

The arm is the cleaned model of `app.arm.urdf`, so it has the same eleven boxes,
limits and frames as the kinematics; things are made from the same bodies as
`app.arm.shapes.primitives` gives. Fingers are rigid and stay open.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import (  # pyright: ignore[reportMissingTypeStubs]  # SciPy has none
    Rotation,
)

from app.arm import urdf
from app.arm.cache import prepared_folder
from app.arm.errors import ArmClosedError, ArmInputError, ArmModelError
from app.arm.physics_engine import engine
from app.arm.physics_report import Distances
from app.arm.protocol import FloatArray
from app.arm.shapes import Primitive, Shape, pose_of, primitives, surface_distance

TABLE = "table"
"""What the table is called in reports."""

_GRAVITY = -9.81
_RANGE = 10.0
"""Bodies farther apart than this are not measured [m]."""
_SLAB = 0.1
"""Thickness of the table [m]."""
_MAX_FORCE, _MAX_SPEED, _LINK_NAME = 10, 11, 12
"""Places in what pybullet tells about a joint."""


class World:
    """The Jaco and the things around it, to be used in a ``with`` statement.

    Parameters
    ----------
    objects : sequence of Shape
        Obstacles, and things that can be carried (their mass is not 0). Names differ.
    table : float, optional
        Height of a table top [m]; without it things fall for ever.
    folder : Path, optional
        A prepared model, by default the one in the cache.

    Raises
    ------
    PhysicsMissingError
        If pybullet cannot be used; on entering.
    ArmModelError
        If the folder has no model; on entering.
    ArmInputError
        If two objects have one name.
    """

    def __init__(
        self, objects: Sequence[Shape] = (), *, table: float | None = None, folder: Path | None = None
    ) -> None:
        names = [shape.name for shape in objects]
        if len(set(names)) < len(names) or TABLE in names:
            raise ArmInputError("objects", f"names that differ from each other and from {TABLE!r}", names)
        self.objects = tuple(objects)
        self._table, self._folder = table, folder
        self._client: int | None = None
        self._engine: Any = None

    def __enter__(self) -> World:
        self.close()
        folder = prepared_folder() if self._folder is None else self._folder
        self._engine = engine()
        self._client = int(self._engine.connect(self._engine.DIRECT))
        try:
            self._fill(folder)
        except BaseException:
            self.close()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Give the memory back (24 MB); closing twice is allowed."""
        client, self._client = self._client, None
        if client is not None:
            self._engine.disconnect(physicsClientId=client)

    def call(self, name: str, *args: Any, **kwargs: Any) -> Any:
        """Call a function of pybullet in this world."""
        if self._client is None:
            raise ArmClosedError("physical world")
        return getattr(self._engine, name)(*args, physicsClientId=self._client, **kwargs)

    def constant(self, name: str) -> int:
        """Give a constant of pybullet."""
        return int(getattr(self._engine, name))

    def place(self, joints: FloatArray, speeds: FloatArray | None = None) -> None:
        """Put the arm at joints (6,) [rad], at rest or moving [rad/s]."""
        rates = np.zeros(len(joints)) if speeds is None else speeds
        for index, angle, rate in zip(self.joints, joints.tolist(), rates.tolist(), strict=True):
            self.call("resetJointState", self.arm, index, angle, rate)

    def tool_position(self) -> FloatArray:
        """Give the (3,) place of the tool as the arm stands [m]."""
        state = self.call("getLinkState", self.arm, self.tool, computeForwardKinematics=1)
        return np.array(state[4], dtype=np.float64)

    def pose(self, name: str) -> FloatArray:
        """Give the (4, 4) pose of a thing as it lies now [m]."""
        position, turn = self.call("getBasePositionAndOrientation", self.bodies[name])
        pose = np.eye(4)
        pose[:3, :3] = Rotation.from_quat(turn).as_matrix()
        pose[:3, 3] = position
        return pose

    def name_of(self, body: int) -> str | None:
        """Say what a body is; None for the arm."""
        return next((name for name, number in self.bodies.items() if number == body), None)

    def nearest_to_grip(self) -> tuple[float, str] | None:
        """Give distance [m] and name of the movable thing nearest to the point between the fingers."""
        tool = self.tool_position()
        movable = [shape for shape in self.objects if shape.mass > 0.0]
        return min(
            ((surface_distance(shape, self.pose(shape.name), tool), shape.name) for shape in movable),
            default=None,
        )

    def distances_to(self, name: str) -> list[tuple[float, str]]:
        """Give distances from a thing to moving links, negative inside [m], and the names of the links."""
        points = self.call("getClosestPoints", self.arm, self.bodies[name], _RANGE)
        # Without the base: what touches it does so however the arm moves.
        links = [(point[8], self.links.get(point[3], urdf.BASE_LINK)) for point in points]
        return [(float(distance), link) for distance, link in links if link != urdf.BASE_LINK]

    def hand_distance(self, name: str) -> float:
        """Give the distance between a thing and the hand with its fingers [m]."""
        points = self.call("getClosestPoints", self.arm, self.bodies[name], _RANGE)
        return min((point[8] for point in points if point[3] >= self.hand), default=np.inf)

    def let_touch_hand(self, name: str, *, touch: bool) -> None:
        """Let a thing and the hand push each other, or pass through each other."""
        for index in self.links:
            if index >= self.hand:
                self.call("setCollisionFilterPair", self.arm, self.bodies[name], index, -1, int(touch))

    def bolt_to_hand(self, name: str) -> int:
        """Fix a thing to the hand as it lies now; give the number of the constraint."""
        state = self.call("getLinkState", self.arm, self.hand, computeForwardKinematics=1)
        away, turned = self.call("getBasePositionAndOrientation", self.bodies[name])
        # pybullet's frame of a link is the one of its inertia: state[0] and [1], not [4] and [5].
        back, turn_back = self._engine.invertTransform(state[0], state[1])
        place, turn = self._engine.multiplyTransforms(back, turn_back, away, turned)
        ends = (place, (0.0, 0.0, 0.0), turn)
        kind, axis = self.constant("JOINT_FIXED"), (0.0, 0.0, 0.0)
        return int(
            self.call("createConstraint", self.arm, self.hand, self.bodies[name], -1, kind, axis, *ends)
        )

    def clearance(self, joints: npt.ArrayLike, names: Sequence[str] | None = None) -> Distances:
        """Measure how far every moving link is from the things around it, along a path.

        Parameters
        ----------
        joints : (K, 6) array
            Configurations of the arm [rad].
        names : sequence of str, optional
            Which things; by default those that stand fixed. Things that can
            be carried are measured where they were put first.

        Returns
        -------
        Distances
            Signed distances: negative where bodies overlap.

        Raises
        ------
        ArmInputError
            If the joints are not finite numbers of that shape.
        """
        path = joint_path_of(joints)
        fixed = [shape.name for shape in self.objects if shape.mass == 0.0]
        wanted = tuple(fixed if names is None else names)
        moving = [name for name in self.links.values() if name != urdf.BASE_LINK]
        rows = {name: row for row, name in enumerate(moving)}
        distances = np.full((len(path), len(moving), len(wanted)), np.inf)
        for at, configuration in enumerate(path):
            self.place(configuration)
            for column, name in enumerate(wanted):
                for distance, link in self.distances_to(name):
                    row = rows[link]
                    distances[at, row, column] = min(distances[at, row, column], distance)
        return Distances(tuple(moving), wanted, distances)

    def _fill(self, folder: Path) -> None:
        self.call("setGravity", 0.0, 0.0, _GRAVITY)
        flags = self.constant("URDF_USE_INERTIA_FROM_FILE")
        file = folder / urdf.ROBOT_FILE
        if not file.is_file():
            raise ArmModelError(
                f"{folder} has no {urdf.ROBOT_FILE}", "Leave the folder out or prepare it again."
            )
        self.arm = int(self.call("loadURDF", str(file), useFixedBase=True, flags=flags))
        count = range(self.call("getNumJoints", self.arm))
        facts = [self.call("getJointInfo", self.arm, index) for index in count]
        named = {fact[1].decode(): index for index, fact in enumerate(facts)}
        carried = {fact[_LINK_NAME].decode(): index for index, fact in enumerate(facts)}
        self.joints = [named[name] for name in urdf.JOINT_NAMES]
        self.tool, self.hand = carried[urdf.TOOL], carried[urdf.HAND_LINK]
        self.links = {
            index: name
            for name, index in carried.items()
            if self.call("getCollisionShapeData", self.arm, index)
        }
        self.torque_limits = np.array([facts[index][_MAX_FORCE] for index in self.joints])
        self.speed_limits = np.array([facts[index][_MAX_SPEED] for index in self.joints])
        for index in count:
            self.call(
                "changeDynamics", self.arm, index, linearDamping=0.0, angularDamping=0.0, jointDamping=0.0
            )
        self.bodies = {
            shape.name: self._add(primitives(shape), pose_of(shape), shape.mass) for shape in self.objects
        }
        if self._table is not None:
            self._add_table(self._table)

    def _add_table(self, height: float) -> None:
        slab = Primitive("box", (4.0, 4.0, _SLAB), np.eye(4))
        pose = np.eye(4)
        pose[2, 3] = height - 0.5 * _SLAB
        body = self._add((slab,), pose, 0.0)
        # The base is bolted to the table: they touch by design.
        for index in list(self.links)[:2]:
            self.call("setCollisionFilterPair", self.arm, body, index, -1, 0)
        self.bodies[TABLE] = body

    def _add(self, parts: Sequence[Primitive], pose: FloatArray, mass: float) -> int:
        position, turn = position_and_turn(pose)
        if len(parts) == 1:
            shape = self.call("createCollisionShape", **_described(self, parts[0]))
        else:
            shape = self._add_compound(parts)
        return int(
            self.call(
                "createMultiBody",
                baseMass=mass,
                baseCollisionShapeIndex=shape,
                basePosition=position,
                baseOrientation=turn,
            )
        )

    def _add_compound(self, parts: Sequence[Primitive]) -> int:
        places = [position_and_turn(part.pose) for part in parts]
        return int(
            self.call(
                "createCollisionShapeArray",
                shapeTypes=[_described(self, part)["shapeType"] for part in parts],
                radii=[part.size[0] for part in parts],
                lengths=[part.size[1] for part in parts],
                collisionFramePositions=[place for place, _ in places],
                collisionFrameOrientations=[turn for _, turn in places],
            )
        )


def joint_path_of(joints: npt.ArrayLike) -> FloatArray:
    """Give configurations as a new (K, 6) array [rad], K >= 1."""
    path = np.array(joints, dtype=np.float64)
    wanted = "(K, 6) finite numbers with K >= 1"
    if path.ndim != 2 or path.shape[1] != len(urdf.JOINT_NAMES) or len(path) == 0:
        raise ArmInputError("a joint path", wanted, f"shape {path.shape}")
    if not np.isfinite(path).all():
        raise ArmInputError("a joint path", wanted, f"{path[~np.isfinite(path)][0]} among them")
    return path


def position_and_turn(pose: FloatArray) -> tuple[list[float], list[float]]:
    """Give the place [m] and the quaternion x, y, z, w of a (4, 4) pose, as pybullet wants them."""
    turn = Rotation.from_matrix(pose[:3, :3]).as_quat()
    return pose[:3, 3].tolist(), turn.tolist()


def _described(world: World, part: Primitive) -> dict[str, Any]:
    """Describe one body as pybullet's createCollisionShape wants it."""
    if part.kind == "box":
        half = [0.5 * edge for edge in part.size]
        return {"shapeType": world.constant("GEOM_BOX"), "halfExtents": half}
    kind = world.constant(f"GEOM_{part.kind.upper()}")
    if part.kind == "sphere":
        return {"shapeType": kind, "radius": part.size[0]}
    return {"shapeType": kind, "radius": part.size[0], "height": part.size[1]}
