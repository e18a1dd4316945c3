"""Places and frames that matter, and the points through which they act on a map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import (  # pyright: ignore[reportMissingTypeStubs] - SciPy has none
    Rotation,
)

from gc_core.arrays import FloatArray, finite, read_only
from gc_core.errors import ShapeError, ZeroQuaternionError

FRAME_ARM = 0.1
"""A landmark with an orientation acts through points this far out on its axes [m]."""

ACTING = 7
"""Points through which it acts: its origin and one on each half-axis."""


@dataclass(frozen=True, eq=False)
class Landmark:
    """A place that matters, such as an object or a goal; with an orientation, a frame."""

    position: FloatArray
    """(3,) [m]."""
    orientation: FloatArray | None = None
    """(4,) unit quaternion w, x, y, z; or None."""
    name: str = ""
    """How the person calls it."""

    def __post_init__(self) -> None:
        what = f"Landmark {self.name!r}" if self.name else "A landmark"
        object.__setattr__(self, "position", finite(self.position, f"{what}: position", (3,)))
        if self.orientation is not None:
            quaternion = finite(self.orientation, f"{what}: orientation", (4,))
            length = float(np.linalg.norm(quaternion))
            if length < 1e-9:
                raise ZeroQuaternionError(what, 0)
            object.__setattr__(self, "orientation", read_only(quaternion / length))


def landmarks(given: Sequence[Landmark] | FloatArray) -> list[Landmark]:
    """Take places or landmarks as landmarks.

    Parameters
    ----------
    given : sequence of L Landmark, or (L, 3) array
        [m].

    Returns
    -------
    list of L Landmark
        Places have no orientation.

    Raises
    ------
    ShapeError, NotFiniteError
        If they are not finite places.
    """
    if isinstance(given, np.ndarray) and given.ndim != 2 and given.size:
        raise ShapeError("landmarks", "(any, 3)", given.shape)
    return [item if isinstance(item, Landmark) else Landmark(item) for item in given]


def rotation(landmark: Landmark) -> FloatArray:
    """Tell which way a landmark is turned.

    Parameters
    ----------
    landmark : Landmark

    Returns
    -------
    (3, 3) array
        Its axes in the base frame as columns; those of the base frame when it has no orientation [-].
    """
    if landmark.orientation is None:
        return np.eye(3)
    return np.asarray(
        Rotation.from_quat(landmark.orientation, scalar_first=True).as_matrix(), dtype=np.float64
    )


def acting_points(source: Landmark, target: Landmark) -> tuple[FloatArray, FloatArray]:
    """Find the points through which a landmark acts on a map.

    Parameters
    ----------
    source, target : Landmark
        Before and after it was moved.

    Returns
    -------
    before, after : (1, 3) or (7, 3) arrays
        Its place; and, if it has an orientation before and after, `FRAME_ARM` out on each half-axis [m].
    """
    if source.orientation is None or target.orientation is None:
        return source.position[None], target.position[None]
    arms = FRAME_ARM * np.concatenate((np.zeros((1, 3)), np.eye(3), -np.eye(3)))
    return source.position + arms @ rotation(source).T, target.position + arms @ rotation(target).T
