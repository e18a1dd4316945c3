"""The boundary of a tube in space: its vertices, how gently they change, where neighbours cross."""

from __future__ import annotations

import numpy as np

from gc_core.arrays import BoolArray, FloatArray
from gc_core.radius import vertex_angles

SHORTEST_ADVANCE = 0.2
"""On the inside of a bend the boundary counts as advancing at least this part of the directrix's step [-]."""


def section_surface(
    directrix: FloatArray, frames: FloatArray, angles: FloatArray, radii: FloatArray
) -> FloatArray:
    """Vertices (N, M, 3) of sections given by their radii (N, M) [m]."""
    circle = np.stack((np.cos(angles), np.sin(angles)))
    return directrix[:, None, :] + radii[:, :, None] * np.swapaxes(frames[:, :, 1:] @ circle, 1, 2)


def crossing_stations(surface: FloatArray, normals: FloatArray) -> BoolArray:
    """Stations whose section is cut by the section after or before it.

    Parameters
    ----------
    surface : (N, M, 3) array
        Vertices [m].
    normals : (N, 3) array
        Section normals [-].

    Returns
    -------
    (N,) array of bool
    """
    forward = np.diff(surface, axis=0)
    back = np.einsum("imk,ik->im", forward, normals[:-1]) <= 0.0
    back |= np.einsum("imk,ik->im", forward, normals[1:]) <= 0.0
    pair = back.any(axis=1)
    return np.concatenate((pair, [False])) | np.concatenate(([False], pair))


def boundary_advance(directrix: FloatArray, frames: FloatArray, radii: FloatArray) -> FloatArray:
    """How far the boundary gets on from section to section.

    On the inside of bends it gets on less than the directrix, and a run would leap if the radius changed
    as fast as elsewhere.

    Parameters
    ----------
    directrix : (N, 3) array
        Centres [m].
    frames : (N, 3, 3) array
        Columns: section normal, N, B.
    radii : (N, M) array
        [m].

    Returns
    -------
    (N - 1, M) array
        From `SHORTEST_ADVANCE` of the directrix's step to the whole of it [m].
    """
    step = np.diff(directrix, axis=0)
    length = np.sqrt(np.einsum("ij,ij->i", step, step))[:, None]
    angles = vertex_angles(radii.shape[1])
    circle = np.stack((np.cos(angles), np.sin(angles)))
    normals, axes = frames[:, :, 0], frames[:, :, 1:]
    # Height of the next vertices above this plane, and of this plane's vertices below the next one.
    after = np.einsum("ij,ij->i", step, normals[:-1])[:, None]
    after = after + radii[1:] * (np.einsum("ij,ijk->ik", normals[:-1], axes[1:]) @ circle)
    before = np.einsum("ij,ij->i", step, normals[1:])[:, None]
    before = before - radii[:-1] * (np.einsum("ij,ijk->ik", normals[1:], axes[:-1]) @ circle)
    return np.clip(np.minimum(after, before), SHORTEST_ADVANCE * length, length)
