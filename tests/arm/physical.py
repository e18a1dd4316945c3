"""For the tests of physics: the kinematic distance, and timed paths of the Jaco."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np

from app.arm import FloatArray, Jaco, urdf
from app.arm.cache import prepared_folder
from app.arm.shapes import Primitive, Shape, pose_of, primitives

_coal: Any = import_module("coal")  # the collision library that placo asks


def kinematic_distances(jaco: Jaco, joints: FloatArray, shape: Shape) -> dict[str, float]:
    """Signed distance of every moving link's box to a shape [m], without any physics."""
    found: dict[str, float] = {}
    for link, pose in jaco.link_poses(joints, 0.0).items():
        box = urdf.BOXES.get(link.removeprefix(urdf.PREFIX))
        if box is None or link == urdf.BASE_LINK:
            continue
        centre, size = box
        body, place = _coal.Box(*size), _placed(pose[:3, :3], pose[:3, 3] + pose[:3, :3] @ centre)
        found[link] = min(_between(body, place, pose_of(shape), part) for part in primitives(shape))
    return found


def swing(n_samples: int = 300, duration: float = 3.0) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Times, places and the middle place of a calm arc in front of the arm [s, m]."""
    share = np.linspace(0.0, 1.0, n_samples)
    eased = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    places = np.stack(
        [0.3 - 0.6 * eased, -0.45 - 0.1 * np.sin(np.pi * eased), 0.25 + 0.15 * np.sin(np.pi * eased)], axis=1
    )
    return duration * share, places, places[n_samples // 2]


@cache
def _boxes() -> dict[str, tuple[FloatArray, FloatArray]]:
    """Centre and size of the box of every link, as the prepared model has them [m]."""
    found: dict[str, tuple[FloatArray, FloatArray]] = {}
    for link in ET.parse(prepared_folder() / urdf.ROBOT_FILE).getroot().findall("link"):
        for origin, box in zip(
            link.iterfind("collision/origin"), link.iterfind("collision/geometry/box"), strict=True
        ):
            numbers = [
                np.array(text.split(), dtype=float) for text in (origin.attrib["xyz"], box.attrib["size"])
            ]
            found[link.attrib["name"]] = (numbers[0], numbers[1])
    return found


def _between(body: Any, place: Any, T_world_shape: FloatArray, part: Primitive) -> float:
    pose = T_world_shape @ part.pose
    kinds = {"box": _coal.Box, "sphere": _coal.Sphere, "cylinder": _coal.Cylinder, "capsule": _coal.Capsule}
    result = _coal.DistanceResult()
    other = kinds[part.kind](*part.size)
    return float(
        _coal.distance(
            body, place, other, _placed(pose[:3, :3], pose[:3, 3]), _coal.DistanceRequest(), result
        )
    )


def _placed(turn: FloatArray, position: FloatArray) -> Any:
    return _coal.Transform3s(turn, position)
