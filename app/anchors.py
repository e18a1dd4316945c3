"""Landmarks as they are: every place known, and how the core takes them."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.spatial.transform import (  # pyright: ignore[reportMissingTypeStubs] - SciPy has none
    Rotation,
)

from app.document import FloatArray, LandmarkKind
from gc_core import Landmark

UPRIGHT: Final = 1e-6
"""With a smaller cosine of the pitch, roll and yaw turn about one axis."""


@dataclass(frozen=True, eq=False)
class Anchor:
    """A landmark as it is: every position known."""

    name: str
    taught: FloatArray
    """(3,) where it stood while the skill was taught [m]."""
    now: FloatArray
    """(3,) where it stands now [m]; the same object as ``taught`` unless it was moved."""
    kind: LandmarkKind = "via"
    turn: FloatArray | None = None
    """(3,) roll, pitch, yaw since it was taught [rad]; None: it was not turned."""

    @property
    def moved(self) -> bool:
        """Whether it stands elsewhere or is turned."""
        return self.turn is not None or not (self.now is self.taught or np.array_equal(self.now, self.taught))


def landmark_of(anchor: Anchor, place: FloatArray, turn: FloatArray | None) -> Landmark:
    """Make a landmark of the core; only objects are frames."""
    orientation = quaternion(np.zeros(3) if turn is None else turn) if anchor.kind == "object" else None
    return Landmark(place, orientation, anchor.name)


def same_anchors(one: tuple[Anchor, ...], other: tuple[Anchor, ...]) -> bool:
    """Whether two lists of anchors make the same map."""
    return len(one) == len(other) and all(
        a.name == b.name
        and a.kind == b.kind
        and a.turn is b.turn
        and np.array_equal(a.taught, b.taught)
        and np.array_equal(a.now, b.now)
        for a, b in zip(one, other, strict=True)
    )


def quaternion(turn: FloatArray) -> FloatArray:
    """Turn roll, pitch, yaw (3,) [rad] about the fixed x, then y, then z axis into a quaternion (4,) wxyz."""
    return np.asarray(Rotation.from_euler("xyz", turn).as_quat(scalar_first=True), dtype=np.float64)


def turn_of(rotation: FloatArray) -> FloatArray:
    """(3,) roll, pitch, yaw of a matrix (3, 3) [rad]; roll is 0 where it is the same as yaw."""
    flat = float(np.hypot(rotation[0, 0], rotation[1, 0]))
    pitch = np.arctan2(-rotation[2, 0], flat)
    if flat < UPRIGHT:
        return np.array([0.0, pitch, np.arctan2(-rotation[0, 1], rotation[1, 1])])
    roll, yaw = np.arctan2(rotation[2, 1], rotation[2, 2]), np.arctan2(rotation[1, 0], rotation[0, 0])
    return np.array([roll, pitch, yaw]) + 0.0  # no -0


def matrix(turn: FloatArray | None) -> FloatArray:
    """(3, 3) matrix of roll, pitch, yaw (3,) [rad]: turns about the fixed x, then y, then z axis."""
    if turn is None:
        return np.eye(3)
    return np.asarray(Rotation.from_euler("xyz", turn).as_matrix(), dtype=np.float64)
