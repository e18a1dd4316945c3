"""The Jaco's description: what example-robot-data ships, made fit for use.

Upstream turns the base by 90 degrees, lets joints turn without end (which
pinocchio stores as cosine and sine, so that angles wrap), and collides with
meshes of 20 ms a query. Here the world is the base frame, every joint is one
plain number, the tool points along its own z axis as in Kinova's description,
and bodies collide as eleven boxes.
"""

from __future__ import annotations

import importlib.metadata
import json
import math
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.arm.errors import ArmModelError
from app.arm.protocol import FloatArray

PACKAGE = "example-robot-data"
ROBOT_FILE, PAIRS_FILE = "robot.urdf", "pairs.json"
PREFIX = "j2s6s200_"
JOINT_NAMES = tuple(f"{PREFIX}joint_{number}" for number in range(1, 7))
TOOL = f"{PREFIX}end_effector"
MOVING_LINKS = tuple(f"{PREFIX}link_{number}" for number in range(1, 7))
BASE_LINK = f"{PREFIX}link_base"
HAND_LINK = MOVING_LINKS[-1]
FINGERS = ("1", "2")

ENDLESS = 174.0
"""Limit of a joint that turns without end [rad]: the 27.7 turns of Kinova's specification."""

_TOOL_RPY = "3.14159265359 0 1.57079632679"
"""Kinova's own end-effector frame; upstream here has the tool along x instead."""

BOXES = {
    "link_base": ((0.0, 0.0, 0.0784), (0.0825, 0.0825, 0.1568)),
    "link_1": ((0.0, 0.0, -0.0799), (0.0825, 0.0825, 0.1599)),
    "link_2": ((0.0, -0.205, -0.0215), (0.0825, 0.4925, 0.043)),
    "link_3": ((0.0, 0.083, -0.0115), (0.0825, 0.2485, 0.063)),
    "link_4": ((0.0, 0.008, -0.0676), (0.063, 0.0791, 0.1351)),
    "link_5": ((0.0, 0.0361, -0.0079), (0.063, 0.1351, 0.0791)),
    "link_6": ((0.0, 0.0, -0.0602), (0.063, 0.1085, 0.1204)),
    "link_finger_1": ((0.0216, -0.008, 0.0), (0.058, 0.0265, 0.0229)),
    "link_finger_2": ((0.0216, -0.008, 0.0), (0.058, 0.0265, 0.0229)),
    "link_finger_tip_1": ((0.0171, -0.0045, 0.0), (0.0532, 0.0201, 0.0225)),
    "link_finger_tip_2": ((0.0171, -0.0045, 0.0), (0.0532, 0.0201, 0.0225)),
}
"""Centre and size of the box around each link's mesh, in the link frame [m]."""

_OUTER = (
    "link_4",
    "link_5",
    "link_6",
    "link_finger_1",
    "link_finger_tip_1",
    "link_finger_2",
    "link_finger_tip_2",
)


@dataclass(frozen=True)
class Visual:
    """A mesh that upstream draws on a link, in the frame of the link."""

    link: str
    mesh: Path


@dataclass(frozen=True, eq=False)
class Kinematics:
    """What the cleaned description says about joints and fingers."""

    lower: FloatArray
    """(6,) lower joint limits [rad]."""
    upper: FloatArray
    """(6,) upper joint limits [rad]."""
    velocity_limits: FloatArray
    """(6,) [rad/s]."""
    mounts: dict[str, FloatArray]
    """(4, 4) pose of each finger part in its parent, fingers open."""


def source() -> Path:
    """Find the description among the installed packages.

    Returns
    -------
    Path
        ``kinova.urdf``; its meshes lie in ``../meshes``.

    Raises
    ------
    ArmModelError
        If the package is missing or lacks the file.
    """
    remedy = f"Install it again: pip install --force-reinstall {PACKAGE}==6.0.0"
    try:
        distribution = importlib.metadata.distribution(PACKAGE)
    except importlib.metadata.PackageNotFoundError as error:
        raise ArmModelError(f"the package {PACKAGE} is not installed", remedy) from error
    for file in distribution.files or []:
        if file.name == "kinova.urdf":
            return Path(str(distribution.locate_file(file))).resolve()
    raise ArmModelError(f"the package {PACKAGE} has no kinova.urdf", remedy)


def self_collision_pairs() -> list[tuple[str, str]]:
    """List the 26 pairs of links that could touch; neighbours are left out."""
    inner = [(near, far) for near in ("link_base", "link_1", "link_2") for far in _OUTER]
    forearm = [("link_3", far) for far in _OUTER[2:]]
    return [(PREFIX + near, PREFIX + far) for near, far in inner + forearm]


def clean(text: str) -> str:
    """Turn the upstream description into ours, without meshes.

    Parameters
    ----------
    text : str
        Contents of the upstream URDF.

    Returns
    -------
    str
        URDF with the world as base frame, six plain revolute joints, boxes to
        collide and nothing to draw.
    """
    root = ET.fromstring(text)
    for transmission in root.findall("transmission"):
        root.remove(transmission)
    for joint in root.findall("joint"):
        _clean_joint(joint)
    for link in root.findall("link"):
        for part in link.findall("visual") + link.findall("collision"):
            link.remove(part)
        box = BOXES.get(link.get("name", "").removeprefix(PREFIX))
        if box is not None:
            _add_box(link, *box)
    return ET.tostring(root, encoding="unicode")


def write(folder: Path) -> None:
    """Write the cleaned description and the pairs of links that could touch."""
    folder.joinpath(ROBOT_FILE).write_text(clean(source().read_text("utf-8")), "utf-8")
    folder.joinpath(PAIRS_FILE).write_text(json.dumps(self_collision_pairs()), "utf-8")
    # placo reads this file by itself and warns about the folded zero pose; so it finds no pairs there.
    folder.joinpath("collisions.json").write_text("[]", "utf-8")


def visuals() -> list[Visual]:
    """List the meshes that upstream draws, link by link."""
    urdf = source()
    found: list[Visual] = []
    for link in ET.fromstring(urdf.read_text("utf-8")).findall("link"):
        for mesh in link.iterfind("visual/geometry/mesh"):
            name = Path(mesh.get("filename", "")).name
            found.append(Visual(link.get("name", ""), urdf.parents[1] / "meshes" / name))
    return found


def kinematics(text: str) -> Kinematics:
    """Read joint limits and finger mounts out of a cleaned description."""
    joints = {joint.get("name", ""): joint for joint in ET.fromstring(text).findall("joint")}

    def limit(key: str) -> FloatArray:
        return np.array([_number(joints[name], "limit", key) for name in JOINT_NAMES])

    parts = [f"finger_{finger}" for finger in FINGERS] + [f"finger_tip_{finger}" for finger in FINGERS]
    return Kinematics(
        lower=limit("lower"),
        upper=limit("upper"),
        velocity_limits=limit("velocity"),
        mounts={part: _origin(joints[f"{PREFIX}joint_{part}"]) for part in parts},
    )


def _clean_joint(joint: ET.Element) -> None:
    name = joint.get("name", "")
    if joint.get("type") == "continuous":
        joint.set("type", "revolute")
        _child(joint, "limit").set("lower", str(-ENDLESS))
        _child(joint, "limit").set("upper", str(ENDLESS))
    if name.startswith("jaco_mounting"):
        _child(joint, "origin").set("rpy", "0 0 0")
    if name == f"{PREFIX}joint_end_effector":
        _child(joint, "origin").set("rpy", _TOOL_RPY)


def _add_box(link: ET.Element, centre: tuple[float, ...], size: tuple[float, ...]) -> None:
    collision = ET.SubElement(link, "collision")
    ET.SubElement(collision, "origin", xyz=" ".join(map(str, centre)), rpy="0 0 0")
    ET.SubElement(ET.SubElement(collision, "geometry"), "box", size=" ".join(map(str, size)))


def _child(element: ET.Element, tag: str) -> ET.Element:
    child = element.find(tag)
    if child is None:
        raise ArmModelError(
            f"{element.get('name')} has no <{tag}>", f"Install {PACKAGE}==6.0.0, which this program knows."
        )
    return child


def _number(element: ET.Element, tag: str, key: str) -> float:
    return float(_child(element, tag).get(key, "nan"))


def _origin(joint: ET.Element) -> FloatArray:
    origin = _child(joint, "origin")
    roll, pitch, yaw = (float(value) for value in origin.get("rpy", "0 0 0").split())
    pose = rotation_about(2, yaw) @ rotation_about(1, pitch) @ rotation_about(0, roll)
    pose[:3, 3] = [float(value) for value in origin.get("xyz", "0 0 0").split()]
    return pose


def rotation_about(axis: int, angle: float) -> FloatArray:
    """Make the (4, 4) pose of a turn about x, y or z (0, 1, 2) by an angle [rad]."""
    pose = np.eye(4)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    pose[first, first] = pose[second, second] = math.cos(angle)
    pose[first, second], pose[second, first] = -math.sin(angle), math.sin(angle)
    return pose
