"""Shapes made of numbers: tubes, rings, arrowheads and what the pointer can hit.

Pure functions of arrays, nothing of viser. Lengths are metres. Faces are counter-
clockwise from outside and come from a cache, so that the same counts give the same
object and a drawing part sees that there is nothing to send again.
"""

from functools import cache
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import (  # pyright: ignore[reportMissingTypeStubs] - SciPy has none
    Rotation,
)

from app.document import FloatArray
from app.scene.polyline import along, arc_length

Vertices: TypeAlias = npt.NDArray[np.float32]
Faces: TypeAlias = npt.NDArray[np.uint32]

PICK_POINTS: Final = 48
"""Points of a pick tube; constant, so that its faces are sent once."""
_X: Final = np.array([1.0, 0.0, 0.0])
_Z: Final = np.array([0.0, 0.0, 1.0])
_AROUND: Final = ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0))
_BOX: Final = (
    (0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 6, 5), (2, 3, 6), (3, 7, 6), (3, 0, 7), (0, 4, 7),
    (0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7),
)  # fmt: skip


@cache
def strip_faces(n: int, m: int, closed: bool = False) -> Faces:
    """Triangles between n rings of m points each.

    Returns
    -------
    (2 m (n - 1), 3) array, or (2 m n, 3) when ``closed``
        Read-only indices of ring-major vertices. Outward where the ring runs counter-
        clockwise about the direction to the next ring. ``closed`` joins the last ring to the first.
    """
    ring, angle = np.meshgrid(np.arange(n if closed else n - 1), np.arange(m), indexing="ij")
    following, turned = (ring + 1) % n, (angle + 1) % m
    a, b = ring * m + angle, ring * m + turned
    c, d = following * m + angle, following * m + turned
    faces = np.stack([np.stack([a, b, c], -1), np.stack([b, d, c], -1)], -2).reshape(-1, 3)
    return _frozen(faces.astype(np.uint32))


def tube_mesh(surface: FloatArray, closed: bool = False) -> tuple[Vertices, Faces]:
    """Stretch a skin over rings of points, as in ``GeneralizedCylinder.surface()``.

    Parameters
    ----------
    surface : (n, m, 3) array
        n >= 2 rings of m >= 3 points [m].
    closed : bool
        Whether the last ring is joined to the first.

    Returns
    -------
    vertices : (n m, 3) array
    faces : (f, 3) array
        See `strip_faces`.
    """
    n, m = surface.shape[:2]
    return surface.reshape(-1, 3).astype(np.float32), strip_faces(n, m, closed)


def torus(radius: float, thickness: float, around: int = 40, sides: int = 8) -> tuple[Vertices, Faces]:
    """A ring of ``radius`` [m] that lies in the plane z = 0, ``thickness`` [m] thick."""
    turn = np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)[:, None]
    tilt = np.linspace(0.0, -2.0 * np.pi, sides, endpoint=False)[None, :]
    reach = radius + 0.5 * thickness * np.cos(tilt)
    height = np.broadcast_to(0.5 * thickness * np.sin(tilt), (around, sides))
    surface = np.stack([reach * np.cos(turn), reach * np.sin(turn), height], axis=-1)
    return tube_mesh(surface, closed=True)


def together(*bodies: tuple[Vertices, Faces]) -> tuple[Vertices, Faces]:
    """Several bodies as one; made anew at each call, so keep it."""
    counts = [len(vertices) for vertices, _ in bodies]
    before = np.cumsum([0, *counts[:-1]])
    faces = np.concatenate([f + shift for (_, f), shift in zip(bodies, before, strict=True)])
    return np.concatenate([vertices for vertices, _ in bodies]), _frozen(faces.astype(np.uint32))


def stem(height: float, radius: float, sides: int = 12) -> tuple[Vertices, Faces]:
    """An open vertical tube from the origin down by ``height`` [m]; up where it is negative."""
    height = height if abs(height) >= 1e-3 else 1e-3
    ring = circle(radius, sides)
    low, high = min(-height, 0.0), max(-height, 0.0)
    return tube_mesh(np.stack([ring + np.array([0.0, 0.0, z]) for z in (low, high)]))


def circle(radius: float, sides: int = 48) -> FloatArray:
    """(sides, 3) points of a circle about z, counter-clockwise from above [m]."""
    turn = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), np.zeros(sides)], axis=1)


def disc(radius: float, sides: int = 32) -> tuple[Vertices, Faces]:
    """A flat disc about the origin that is seen from above."""
    vertices = np.concatenate([[[0.0, 0.0, 0.0]], circle(radius, sides)])
    first = np.arange(sides)
    faces = np.stack([np.zeros(sides), 1 + first, 1 + (first + 1) % sides], axis=1)
    return vertices.astype(np.float32), _frozen(faces.astype(np.uint32))


def pick_tube(points: FloatArray, radius: float) -> tuple[Vertices, Faces]:
    """Surround a line with something that the pointer can hit: a closed box for every stretch.

    Boxes need no frame carried along the line, and therefore stand standstills and kinks.

    Parameters
    ----------
    points : (n, 3) array
        Corners of the line [m]; n >= 1.
    radius : float
        Half of the side of a box [m]; positive.

    Returns
    -------
    vertices : (8 (PICK_POINTS - 1), 3) array
    faces : (12 (PICK_POINTS - 1), 3) array
    """
    corners = along(points, float(arc_length(points)[-1]) * np.arange(PICK_POINTS) / (PICK_POINTS - 1))
    ahead, aside, up = across(np.diff(corners, axis=0))
    rim = np.stack([x * aside + y * up for x, y in _AROUND], axis=1)
    back = (corners[:-1] - 0.5 * radius * ahead)[:, None] + radius * rim
    front = (corners[1:] + 0.5 * radius * ahead)[:, None] + radius * rim
    vertices = np.concatenate([back, front], axis=1)
    return vertices.reshape(-1, 3).astype(np.float32), _copies(_BOX, 8, PICK_POINTS - 1)


def arrowheads(
    points: FloatArray, count: int = 4, length: float = 0.032, radius: float = 0.011, sides: int = 10
) -> tuple[Vertices, Faces]:
    """Cones along a line that say which way it runs.

    Parameters
    ----------
    points : (n, 3) array
        Corners of the line [m]; n >= 1.
    count : int
        How many, evenly spaced in arc length.
    length, radius : float
        Of one cone [m].
    sides : int
        Corners of its base.

    Returns
    -------
    vertices : (count (sides + 2), 3) array
    faces : (2 count sides, 3) array
    """
    middle = float(arc_length(points)[-1]) * (np.arange(count) + 0.5) / count
    base, tip = along(points, middle - 0.5 * length), along(points, middle + 0.5 * length)
    ahead, aside, up = across(tip - base)
    turn = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)[None, :, None]
    ring = base[:, None] + radius * (np.cos(turn) * aside[:, None] + np.sin(turn) * up[:, None])
    vertices = np.concatenate([(base + length * ahead)[:, None], base[:, None], ring], axis=1)
    return vertices.reshape(-1, 3).astype(np.float32), _copies(_cone(sides), sides + 2, count)


def across(directions: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Complete directions (k, 3) to right-handed frames; a direction without length counts as +x.

    Returns
    -------
    ahead, aside, up : (k, 3) arrays
        Orthonormal, with ``ahead`` x ``aside`` = ``up``.
    """
    length = np.sqrt(np.einsum("ij,ij->i", directions, directions))[:, None]
    still = length < 1e-9
    ahead = np.where(still, _X, directions / np.where(still, 1.0, length))
    aside = _cross(np.where(np.abs(ahead[:, 2:]) > 0.9, _X, _Z), ahead)
    aside /= np.sqrt(np.einsum("ij,ij->i", aside, aside))[:, None]
    return ahead, aside, _cross(ahead, aside)


def quaternions(rotations: FloatArray) -> FloatArray:
    """(k, 4) wxyz of rotation matrices (k, 3, 3)."""
    return np.asarray(Rotation.from_matrix(rotations).as_quat(scalar_first=True), dtype=np.float64)


def facing(direction: FloatArray) -> FloatArray:
    """(4,) wxyz of a rotation that turns +z into a unit vector (3,)."""
    z, aside, up = across(direction[None])
    return quaternions(np.stack([aside, up, z], axis=-1))[0]


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """np.cross for (k, 3) arrays, without its overhead for short ones."""
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=1)


@cache
def _cone(sides: int) -> tuple[tuple[int, int, int], ...]:
    """Faces of a cone with the tip 0, the middle of the base 1 and the ring after them."""
    ring = [(2 + k, 2 + (k + 1) % sides) for k in range(sides)]
    return tuple((0, a, b) for a, b in ring) + tuple((1, b, a) for a, b in ring)


@cache
def _copies(faces: tuple[tuple[int, int, int], ...], stride: int, count: int) -> Faces:
    """The faces of ``count`` equal bodies of ``stride`` vertices each."""
    shifts = stride * np.arange(count)[:, None, None]
    return _frozen((shifts + np.asarray(faces)).reshape(-1, 3).astype(np.uint32))


def _frozen(faces: Faces) -> Faces:
    faces.setflags(write=False)
    return faces
