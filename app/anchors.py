"""Landmarks as they are: every place known, and how the core takes them."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import (  # pyright: ignore[reportMissingTypeStubs] - SciPy has none
    Rotation,
)

from app.document import FloatArray, LandmarkKind
from gc_core import Landmark


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


def matrix(turn: FloatArray | None) -> FloatArray:
    """(3, 3) matrix of roll, pitch, yaw (3,) [rad]: turns about the fixed x, then y, then z axis."""
    if turn is None:
        return np.eye(3)
    return np.asarray(Rotation.from_euler("xyz", turn).as_matrix(), dtype=np.float64)
