"""What landmarks and things look like: bodies about the origin, with corners for each flat face."""

from functools import cache
from typing import Final

import numpy as np

from app.document import FloatArray
from app.scene.geometry import Faces, Vertices, circle, disc, together, tube_mesh

_CORNERS: Final = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
_SIDES: Final = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
_BOX_FACES: Final[Faces] = np.concatenate(
    [np.array([[4 * i, 4 * i + 1, 4 * i + 2], [4 * i, 4 * i + 2, 4 * i + 3]]) for i in range(6)]
).astype(np.uint32)


@cache
def ball(radius: float, around: int = 32, rings: int = 17) -> tuple[Vertices, Faces]:
    """A sphere; the same object for the same numbers."""
    tilt = np.linspace(np.pi - 1e-3, 1e-3, rings)
    ring = circle(1.0, around)
    surface = np.sin(tilt)[:, None, None] * ring
    surface[:, :, 2] = np.cos(tilt)[:, None]
    return tube_mesh(radius * surface)


def box(half: float, rotation: FloatArray) -> tuple[Vertices, Faces]:
    """A cube of ``2 * half`` [m], turned by a matrix (3, 3)."""
    return cuboid(np.full(3, 2.0 * half), rotation)


def cuboid(size: FloatArray, rotation: FloatArray) -> tuple[Vertices, Faces]:
    """A box with edges (3,) [m], turned by a matrix (3, 3)."""
    corners = (0.5 * size * _CORNERS) @ rotation.T
    return corners[np.array(_SIDES).ravel()].astype(np.float32), _BOX_FACES


def cuboid_edges(size: FloatArray) -> FloatArray:
    """(12, 2, 3) the edges of a box [m]."""
    corners = 0.5 * size * _CORNERS
    apart = np.count_nonzero(_CORNERS[:, None] != _CORNERS[None], axis=2)
    first, second = np.nonzero(np.triu(apart == 1))
    return np.stack([corners[first], corners[second]], axis=1)


def rod(radius: float, length: float, sides: int = 32) -> tuple[Vertices, Faces]:
    """A solid cylinder along z with two lids [m]."""
    ring, high = circle(radius, sides), np.array([0.0, 0.0, 0.5 * length])
    lid, faces = disc(radius, sides)
    top = (lid + high).astype(np.float32), faces
    bottom = (lid - high).astype(np.float32), faces[:, ::-1]
    return together(tube_mesh(np.stack([ring - high, ring + high])), top, bottom)


def hoop(radius: float, height: float = 0.0, sides: int = 48) -> FloatArray:
    """(sides, 2, 3) a circle about z as segments [m]."""
    ring = circle(radius, sides) + np.array([0.0, 0.0, height])
    return np.stack([ring, np.roll(ring, -1, axis=0)], axis=1)


def post(radius: float, low: float, high: float, sides: int = 32) -> tuple[Vertices, Faces]:
    """A round post between two heights [m], with a lid."""
    ring = circle(radius, sides)
    up = np.array([0.0, 0.0, 1.0])
    side = tube_mesh(np.stack([ring + min(low, high - 1e-3) * up, ring + high * up]))
    vertices, faces = disc(radius, sides)
    return together(side, ((vertices + high * up).astype(np.float32), faces))
