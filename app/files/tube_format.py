"""A tube (generalized cylinder) as a surface for 3-D programs, and as all its numbers."""

from __future__ import annotations

import io
from dataclasses import fields
from typing import Any, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from app.document import FloatArray
from gc_core import GeneralizedCylinder

Indices: TypeAlias = NDArray[np.int64]


def tube_mesh(cylinder: GeneralizedCylinder) -> tuple[FloatArray, Indices]:
    """Make a closed surface of a tube.

    Returns
    -------
    vertices : (N * M + 2, 3) array
        The sections' corners, then the centres of the two ends [m].
    faces : (2 * N * M, 3) array
        Corners of triangles, counter-clockwise from outside.
    """
    surface = cylinder.surface()
    n, m = surface.shape[:2]
    corner = np.arange(n * m, dtype=np.int64).reshape(n, m)
    beside = np.asarray(np.roll(corner, -1, axis=1), dtype=np.int64)
    a, b, c, d = corner[:-1], beside[:-1], corner[1:], beside[1:]
    start, end = np.full(m, n * m), np.full(m, n * m + 1)
    faces = [
        _triangles(a, b, c),
        _triangles(b, d, c),
        _triangles(start, beside[0], corner[0]),
        _triangles(end, corner[-1], beside[-1]),
    ]
    return np.concatenate([surface.reshape(-1, 3), cylinder.directrix[[0, -1]]]), np.concatenate(faces)


def _triangles(a: Indices, b: Indices, c: Indices) -> Indices:
    return np.stack([a.ravel(), b.ravel(), c.ravel()], axis=1)


def format_glb(cylinder: GeneralizedCylinder) -> bytes:
    """Write the closed surface as binary glTF, z upwards [m]."""
    import trimesh  # noqa: PLC0415 - half a second that only this needs

    vertices, faces = tube_mesh(cylinder)
    tube = cast("Any", trimesh).Trimesh(vertices, faces, process=False)
    return bytes(tube.export(file_type="glb"))


def format_tube(cylinder: GeneralizedCylinder) -> bytes:
    """Write every array of a cylinder, its surface and the kind of its sections as ``.npz``."""
    values: dict[str, Any] = {field.name: getattr(cylinder, field.name) for field in fields(cylinder)}
    arrays: dict[str, Any] = {name: value for name, value in values.items() if isinstance(value, np.ndarray)}
    out = io.BytesIO()
    np.savez_compressed(
        out,
        allow_pickle=False,
        surface=cylinder.surface(),
        arc_length=cylinder.arc_length,
        crossing=cylinder.diagnostics.crossing,
        section=np.array(cylinder.section),
        **arrays,
    )
    return out.getvalue()
