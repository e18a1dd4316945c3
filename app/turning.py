"""How the tool is turned: quaternions w, x, y, z, and the three angles that people type.

The angles are roll, pitch and yaw since the tool pointed straight down, about the base
frame's x, then y, then z: all zero is the tool at home.
"""

from typing import Final

import numpy as np
from scipy.spatial.transform import (  # pyright: ignore[reportMissingTypeStubs] - SciPy has none
    Rotation,
)

from app import anchors
from app.arm.physics_words import thing_in_words
from app.arm.protocol import Arm, FloatArray
from app.arm.shapes import Quadruple
from app.edits import EditError

DOWN: Final[Quadruple] = (0.0, 1.0, 0.0, 0.0)
"""Straight down, the fingers left and right."""
_NEAR_LIMIT: Final = 0.03
"""A joint this near to its limit is what stops the tool [rad]."""
_NEAR_BODY: Final = 0.015
"""Bodies nearer than this are what stops the tool [m]."""


def orientation_of(pose: FloatArray) -> Quadruple:
    """Read the orientation from a pose (4, 4)."""
    return _quadruple(Rotation.from_matrix(pose[:3, :3]))


def checked(wxyz: object) -> Quadruple:
    """Give an orientation of length 1.

    Raises
    ------
    EditError
        If these are not four finite numbers, not all zero.
    """
    try:
        values = np.asarray(wxyz, dtype=np.float64)
    except (TypeError, ValueError):
        values = np.zeros(0)
    if values.shape != (4,) or not np.isfinite(values).all() or not np.linalg.norm(values) > 0.0:
        raise EditError("That is no turn of the tool. Type three angles in degrees.")
    return _quadruple(Rotation.from_quat(values, scalar_first=True))


def turned(wxyz: Quadruple, by: FloatArray) -> Quadruple:
    """Turn an orientation about the tool's own axes, by angles (3,) about x, y and z [rad]."""
    return _quadruple(_rotation(wxyz) * Rotation.from_rotvec(by))


def angles_of(wxyz: Quadruple) -> FloatArray:
    """Give (3,) roll, pitch and yaw since straight down [rad]; roll is 0 where it is the same as yaw."""
    return anchors.turn_of((_rotation(wxyz) * _rotation(DOWN).inv()).as_matrix())


def from_angles(angles: FloatArray) -> Quadruple:
    """Make an orientation of roll, pitch and yaw (3,) since straight down [rad].

    Raises
    ------
    EditError
        If these are not three finite numbers.
    """
    if not np.isfinite(angles).all():
        raise EditError("That is no turn of the tool. Type three angles in degrees.")
    return _quadruple(Rotation.from_euler("xyz", angles) * _rotation(DOWN))


def apart(one: Quadruple, other: Quadruple) -> float:
    """Give the angle between two orientations [rad]."""
    return float((_rotation(one).inv() * _rotation(other)).magnitude())


def towards(now: Quadruple, wanted: Quadruple, most: float) -> Quadruple:
    """Go from one orientation towards another by an angle at most [rad], and not past it."""
    between = (_rotation(now).inv() * _rotation(wanted)).as_rotvec()
    angle = float(np.linalg.norm(between))
    return wanted if angle <= most else turned(now, between * (most / angle))


def stopped_by(arm: Arm, joints: FloatArray) -> str:
    """Say what keeps a tool from being turned any farther; no full stop."""
    room = np.minimum(joints - arm.lower, arm.upper - joints)
    if room.min() < _NEAR_LIMIT:
        return f"joint {int(room.argmin()) + 1} at its limit"
    found = arm.clearance(joints[None])
    if found.obstacles[0] < _NEAR_BODY:
        return f"{thing_in_words(found.names[0])} is in the way"
    if found.itself[0] < _NEAR_BODY:
        return "its own arm is in the way"
    return "the hand would have to leave its place"


def _rotation(wxyz: Quadruple) -> Rotation:
    return Rotation.from_quat(wxyz, scalar_first=True)


def _quadruple(rotation: Rotation) -> Quadruple:
    w, x, y, z = rotation.as_quat(scalar_first=True).tolist()
    return w, x, y, z
