"""Things around the arm: box, sphere, cylinder and ring, each a handful of numbers.

The arm knows nothing of documents and scenes; whoever owns the things hands
them over as these. Both the kinematic distance and the physics are made from
`primitives`, so that they measure the same bodies.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import Literal

import numpy as np
from scipy.spatial.transform import (  # pyright: ignore[reportMissingTypeStubs] - SciPy has none
    Rotation,
)

from app.arm.errors import ArmInputError
from app.arm.protocol import FloatArray

Triple = tuple[float, float, float]
Quadruple = tuple[float, float, float, float]

UPRIGHT: Quadruple = (1.0, 0.0, 0.0, 0.0)
"""Not turned: w, x, y, z."""
RING_PARTS = 16
"""A ring is this many capsules; its wall is true to 1 % of its radius."""


@dataclass(frozen=True)
class _Thing:
    """What all shapes have."""

    name: str
    position: Triple
    """Centre [m]."""
    wxyz: Quadruple = field(default=UPRIGHT, kw_only=True)
    """Orientation; any length but zero."""
    mass: float = field(default=0.0, kw_only=True)
    """0 stands fixed, an obstacle; anything else can be pushed and carried [kg]."""

    def __post_init__(self) -> None:
        common = {one.name for one in fields(_Thing)}
        sizes = [getattr(self, one.name) for one in fields(self) if one.name not in common]
        _check(self.name, self.position, self.wxyz, np.hstack(sizes).tolist(), self.mass)


@dataclass(frozen=True)
class Box(_Thing):
    """A cuboid about its centre."""

    size: Triple
    """Full lengths of its edges along its own x, y and z [m]."""


@dataclass(frozen=True)
class Sphere(_Thing):
    """A ball about its centre."""

    radius: float
    """[m]."""


@dataclass(frozen=True)
class Cylinder(_Thing):
    """A solid cylinder about its centre, its axis along its own z."""

    radius: float
    """[m]."""
    length: float
    """Along its axis [m]."""


@dataclass(frozen=True)
class Ring(_Thing):
    """A torus about its centre; its opening looks along its own z."""

    radius: float
    """From the centre to the middle of the wall [m]."""
    wall: float
    """Radius of the wall's round cross-section, less than ``radius`` [m]."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.wall >= self.radius:
            raise ArmInputError(
                f"the wall of {self.name!r}", f"less than its radius of {self.radius} m", self.wall
            )


Shape = Box | Sphere | Cylinder | Ring


@dataclass(frozen=True, eq=False)
class Primitive:
    """A convex body that every collision library knows."""

    kind: Literal["box", "sphere", "cylinder", "capsule"]
    size: tuple[float, ...]
    """Box: edges x, y, z. Sphere: radius. Cylinder: radius, length. Capsule: radius, distance of its centres.
    All [m]."""
    pose: FloatArray
    """(4, 4) ``T_shape_primitive``; cylinders and capsules lie along z [m]."""


def pose_of(shape: Shape) -> FloatArray:
    """Give the (4, 4) pose ``T_world_shape`` [m]."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation_of(shape.wxyz), shape.position
    return pose


def rotation_of(wxyz: Quadruple) -> FloatArray:
    """Give the (3, 3) rotation of an orientation of any length but zero."""
    return np.asarray(Rotation.from_quat(wxyz, scalar_first=True).as_matrix(), dtype=np.float64)


def primitives(shape: Shape) -> tuple[Primitive, ...]:
    """Take a shape apart into convex bodies, in the frame of the shape.

    Parameters
    ----------
    shape : Shape
        A box, sphere and cylinder is one body; a ring is `RING_PARTS` capsules.

    Returns
    -------
    tuple of Primitive
        At least one.
    """
    if isinstance(shape, Box):
        return (Primitive("box", shape.size, np.eye(4)),)
    if isinstance(shape, Sphere):
        return (Primitive("sphere", (shape.radius,), np.eye(4)),)
    if isinstance(shape, Cylinder):
        return (Primitive("cylinder", (shape.radius, shape.length), np.eye(4)),)
    return tuple(_ring_part(shape, number) for number in range(RING_PARTS))


def surface_distance(shape: Shape, pose: FloatArray, point: FloatArray) -> float:
    """Measure from a point to the surface of a shape.

    Parameters
    ----------
    shape : Shape
        A ring is taken as the torus it is.
    pose : (4, 4) array
        Where the shape is now: ``T_world_shape`` [m].
    point : (3,) array
        In the world [m].

    Returns
    -------
    float
        Negative inside [m].
    """
    local = pose[:3, :3].T @ (point - pose[:3, 3])
    out, up = math.hypot(local[0], local[1]), abs(float(local[2]))
    if isinstance(shape, Sphere):
        return float(np.linalg.norm(local)) - shape.radius
    if isinstance(shape, Ring):
        return math.hypot(out - shape.radius, up) - shape.wall
    if isinstance(shape, Box):
        beyond = np.abs(local) - 0.5 * np.asarray(shape.size)
    else:
        beyond = np.array([out - shape.radius, up - 0.5 * shape.length])
    return float(np.linalg.norm(np.maximum(beyond, 0.0)) + min(beyond.max(), 0.0))


def _ring_part(ring: Ring, number: int) -> Primitive:
    """Give one straight piece; corners lie as far outside the circle as middles lie inside."""
    half = math.pi / RING_PARTS
    corner = 2.0 * ring.radius / (1.0 + math.cos(half))
    middle, angle = corner * math.cos(half), 2.0 * half * number
    outwards = np.array([math.cos(angle), math.sin(angle), 0.0])
    along = np.array([-math.sin(angle), math.cos(angle), 0.0])
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2] = outwards, np.cross(along, outwards), along
    pose[:3, 3] = middle * outwards
    return Primitive("capsule", (ring.wall, 2.0 * corner * math.sin(half)), pose)


def _check(name: str, position: Triple, wxyz: Quadruple, sizes: list[float], mass: float) -> None:
    if not (len(position) == 3 and np.isfinite(position).all()):
        raise ArmInputError(f"the position of {name!r}", "three finite numbers", position)
    if not (len(wxyz) == 4 and np.isfinite(wxyz).all() and np.linalg.norm(wxyz) > 0.0):
        raise ArmInputError(f"the orientation of {name!r}", "w, x, y and z, not all zero", wxyz)
    if not all(math.isfinite(size) and size > 0.0 for size in sizes):
        raise ArmInputError(f"the size of {name!r}", "positive numbers", sizes)
    if not (math.isfinite(mass) and mass >= 0.0):
        raise ArmInputError(f"the mass of {name!r}", "a number of kilograms, 0 when it is fixed", mass)
