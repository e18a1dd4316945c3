"""The bodies that placo keeps apart: the arm's boxes, and obstacles as links of its base."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from math import inf
from pathlib import Path
from typing import Any

from app.arm import urdf
from app.arm.protocol import FloatArray
from app.arm.shapes import Primitive, Shape, pose_of, primitives

# As with placo: they live in its prefix.
_coal: Any = import_module("coal")
_pinocchio: Any = import_module("pinocchio")


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
        self._obstacles: tuple[Shape, ...] = ()
        self._names: list[str] = []

    def surround(self, obstacles: tuple[Shape, ...]) -> None:
        """Put these obstacles around the robot, instead of those before."""
        if obstacles is self._obstacles or obstacles == self._obstacles:
            return
        model = self._robot.collision_model
        for number in range(len(self._names)):
            model.removeGeometryObject(f"obstacle {number}")
        parts = [(shape, part) for shape in obstacles for part in primitives(shape)]
        for number, (shape, part) in enumerate(parts):
            self._add(f"obstacle {number}", pose_of(shape) @ part.pose, part)
        self._obstacles, self._names = obstacles, [shape.name for shape, _ in parts]

    def nearest(self) -> Nearest:
        """Measure the robot as it is placed."""
        itself, obstacle, link, name = inf, inf, "", ""
        for pair in self._robot.distances():
            distance, other = float(pair.min_distance), int(pair.objB) - len(self._links)
            if other < 0:
                itself = min(itself, distance)
            elif distance < obstacle:
                obstacle, link, name = distance, self._links[int(pair.objA)], self._names[other]
        return Nearest(itself, obstacle, link, name)

    def _add(self, name: str, pose: FloatArray, part: Primitive) -> None:
        model = self._robot.collision_model
        base = model.geometryObjects[0]
        placement = _pinocchio.SE3(pose[:3, :3], pose[:3, 3])
        body = _pinocchio.GeometryObject(name, base.parentJoint, base.parentFrame, placement, _geometry(part))
        index = model.addGeometryObject(body)
        # Without the base: what touches it does so however the arm moves.
        for number in range(1, len(self._links)):
            model.addCollisionPair(_pinocchio.CollisionPair(number, index))


def _geometry(part: Primitive) -> Any:
    if part.kind == "box":
        return _coal.Box(*part.size)
    if part.kind == "sphere":
        return _coal.Sphere(*part.size)
    make = _coal.Cylinder if part.kind == "cylinder" else _coal.Capsule
    return make(*part.size)
