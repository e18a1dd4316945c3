"""The bodies that placo keeps apart: the arm's boxes, and obstacles as links of its base."""

from __future__ import annotations

import math
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from app.arm import urdf
from app.arm.protocol import FloatArray
from app.arm.shapes import Primitive, Shape, pose_of, primitives

# As with placo: they live in its prefix.
_coal: Any = import_module("coal")
_pinocchio: Any = import_module("pinocchio")
_FINGERS = 0.04
"""Open fingers stand round what is thinner than twice this, so that the tool may be inside of it [m]."""


@dataclass(frozen=True)
class Nearest:
    """The smallest distances of one configuration."""

    itself: float
    """Between two bodies of the arm [m]."""
    obstacle: float
    """Between the arm and an obstacle [m]; inf without obstacles."""
    link: str
    """The link nearest to an obstacle."""
    name: str
    """The obstacle nearest to the arm."""


class Bodies:
    """The collision bodies of one placo robot; obstacles come and go."""

    def __init__(self, robot: Any, folder: Path) -> None:
        self._robot = robot
        robot.load_collision_pairs(str(folder / urdf.PAIRS_FILE))
        bodies: Any = robot.collision_model.geometryObjects
        self._links: list[str] = [str(body.name).removesuffix("_0") for body in bodies]
        # Without the base: what touches it does so however the arm moves.
        boxes = [urdf.BOXES[link.removeprefix(urdf.PREFIX)] for link in self._links[1:]]
        self._middles = np.array([[*centre, 1.0] for centre, _ in boxes])
        self._radii = np.array([0.5 * float(np.linalg.norm(size)) for _, size in boxes])
        self._obstacles: tuple[Shape, ...] = ()
        self._names: list[str] = []
        self._centres, self._sizes = np.empty((0, 3)), np.empty(0)
        self._watched = np.zeros((len(boxes), 0), dtype=np.bool_)

    def surround(self, obstacles: tuple[Shape, ...]) -> None:
        """Put these obstacles around the robot, instead of those before."""
        if obstacles is self._obstacles or obstacles == self._obstacles:
            return
        model = self._robot.collision_model
        for number in range(len(self._names)):
            model.removeGeometryObject(f"obstacle {number}")
        parts = [
            (shape, part, pose_of(shape) @ part.pose) for shape in obstacles for part in primitives(shape)
        ]
        base = model.geometryObjects[0]
        for number, (_, part, pose) in enumerate(parts):
            placement = _pinocchio.SE3(pose[:3, :3], pose[:3, 3])
            name, joint, frame = f"obstacle {number}", base.parentJoint, base.parentFrame
            model.addGeometryObject(_pinocchio.GeometryObject(name, joint, frame, placement, _geometry(part)))
        self._obstacles, self._names = obstacles, [shape.name for shape, _, _ in parts]
        self._centres = np.array([pose[:3, 3] for _, _, pose in parts]).reshape(-1, 3)
        self._sizes = np.array([_radius(part) for _, part, _ in parts])
        self._watched = np.zeros((len(self._radii), len(parts)), dtype=np.bool_)

    def around(self, position: FloatArray) -> str:
        """Name the obstacle that a position (3,) lies too deep in for open fingers; empty when in none."""
        for shape in self._obstacles:
            if any(_holds(pose_of(shape) @ part.pose, part, position) for part in primitives(shape)):
                return shape.name
        return ""

    def watch(self, within: float | None) -> None:
        """Let the robot, as it is placed, look at obstacles only that can matter: looking costs time.

        Parameters
        ----------
        within : float or None
            Those that may be nearer than this [m]; None: those that may be the nearest.
        """
        if not self._names:
            return
        poses: Any = [self._robot.get_T_world_frame(link) for link in self._links[1:]]
        middles = np.einsum("lij,lj->li", np.array(poses), self._middles)[:, :3]
        apart = np.linalg.norm(middles[:, None] - self._centres, axis=2)
        # Bodies are nowhere farther apart than their middles, and nowhere nearer than the balls around them.
        limit = float(apart.min()) if within is None else within
        wanted = apart - self._radii[:, None] - self._sizes <= limit
        for link, part in np.argwhere(wanted != self._watched).tolist():
            model, first = self._robot.collision_model, len(self._links)
            change = model.addCollisionPair if wanted[link, part] else model.removeCollisionPair
            change(_pinocchio.CollisionPair(link + 1, first + part))
        self._watched = wanted

    def nearest(self) -> Nearest:
        """Measure the robot as it is placed."""
        self.watch(None)
        itself, obstacle, link, name = math.inf, math.inf, "", ""
        for pair in self._robot.distances():
            distance, other = float(pair.min_distance), int(pair.objB) - len(self._links)
            if other < 0:
                itself = min(itself, distance)
            elif distance < obstacle:
                obstacle, link, name = distance, self._links[int(pair.objA)], self._names[other]
        return Nearest(itself, obstacle, link, name)


def _radius(part: Primitive) -> float:
    """Give the radius of the ball around a body [m]."""
    if part.kind == "sphere":
        return part.size[0]
    if part.kind == "box":
        return 0.5 * float(np.linalg.norm(part.size))
    radius, length = part.size
    return float(np.hypot(radius, 0.5 * length)) if part.kind == "cylinder" else radius + 0.5 * length


def _holds(pose: FloatArray, part: Primitive, position: FloatArray) -> bool:
    """Say whether a body holds a position (3,) deeper than `_FINGERS`."""
    x, y, z = (np.abs(pose[:3, :3].T @ (position - pose[:3, 3])) + _FINGERS).tolist()
    if part.kind == "box":
        return all(2.0 * value < size for value, size in zip((x, y, z), part.size, strict=True))
    if part.kind == "cylinder":
        return math.hypot(x, y) < part.size[0] and 2.0 * z < part.size[1]
    return part.kind == "sphere" and math.hypot(x, y, z) < part.size[0]


def _geometry(part: Primitive) -> Any:
    if part.kind == "box":
        return _coal.Box(*part.size)
    if part.kind == "sphere":
        return _coal.Sphere(*part.size)
    make = _coal.Cylinder if part.kind == "cylinder" else _coal.Capsule
    return make(*part.size)
