"""Closed curves round a centre as a radius function: the one place that knows polar polygons.

`radii[..., m]` is the distance of vertex m, at the angle 2 pi m / M, from the centre. The section
*is* the polygon through these vertices, so that what is inside does not depend on how it is drawn.
"""

from __future__ import annotations

import numpy as np

from gc_core.arrays import FloatArray, IntArray

GREATEST_SLOPE = 2.0
"""A section widens or narrows along the curve by at most this much per length [-]."""


def vertex_angles(count: int) -> FloatArray:
    """Angles of the vertices, (count,) array from 0 [rad]."""
    return 2.0 * np.pi / count * np.arange(count)


def bins(angles: FloatArray, count: int) -> tuple[IntArray, FloatArray]:
    """Vertex before each angle, and how far the angle lies past it.

    Parameters
    ----------
    angles : (...) array
        Any angles [rad].
    count : int
        Number of vertices.

    Returns
    -------
    index : (...) integer array
        From 0 to count - 1.
    part : (...) array
        In [0, 1): part of the way to the next vertex [-].
    """
    turns = np.mod(angles / (2.0 * np.pi), 1.0) * count
    index = np.floor(turns)
    return index.astype(np.intp) % count, turns - index


def chord_radius(before: FloatArray, after: FloatArray, part: FloatArray, count: int) -> FloatArray:
    """Distance from the centre to the edge between two neighbouring vertices.

    Parameters
    ----------
    before, after : (...) array
        Radii of the two vertices, positive [m].
    part : (...) array
        Part of the angle between them, in [0, 1] [-].
    count : int
        Number of vertices of the whole polygon, at least 3.

    Returns
    -------
    (...) array
        Exactly the vertices' radii at part 0 and 1 [m].
    """
    step = 2.0 * np.pi / count
    weight = np.sin(part * step) / np.sin(step)
    other = np.sin((1.0 - part) * step) / np.sin(step)
    return before * after / (before * weight + after * other)


def radius_at(radii: FloatArray, rows: IntArray, angles: FloatArray) -> FloatArray:
    """Distance of the polygons' edges from their centres.

    Parameters
    ----------
    radii : (N, M) array
        Polygons [m].
    rows : (...) integer array
        Which polygon.
    angles : (...) array
        In which direction [rad].

    Returns
    -------
    (...) array
        [m].
    """
    count = radii.shape[1]
    index, part = bins(angles, count)
    return chord_radius(radii[rows, index], radii[rows, (index + 1) % count], part, count)


def loop_radii(loops: FloatArray, count: int) -> FloatArray:
    """Turn closed polygons into radius functions about the origin.

    A ray leaves through the outermost edge it meets; where it meets none (the origin lies
    outside of the loop) the radius is 0.

    Parameters
    ----------
    loops : (N, P, 2) array
        Vertices of closed polygons; repeated vertices do no harm [m].
    count : int
        Number of rays.

    Returns
    -------
    (N, count) array
        [m].
    """
    following = np.concatenate((loops[:, 1:], loops[:, :1]), axis=1)
    angle = np.arctan2(loops[..., 1], loops[..., 0]) * (count / (2.0 * np.pi))
    turn = np.concatenate((angle[:, 1:], angle[:, :1]), axis=1) - angle
    turn = turn - count * np.round(turn / count)
    low = np.minimum(angle, angle + turn)
    # A ray through a shared vertex belongs to both edges, whatever the rounding.
    first = np.ceil(low - 1e-9).astype(np.intp).ravel()
    rays = np.floor(low + np.abs(turn) + 1e-9).astype(np.intp).ravel() - first + 1
    edge = np.repeat(np.arange(rays.size), rays)
    ray = first[edge] + np.arange(edge.size) - np.repeat(np.cumsum(rays) - rays, rays)
    ray = ray % count
    reach = _edge_distance(
        loops.reshape(-1, 2)[edge], following.reshape(-1, 2)[edge], vertex_angles(count)[ray]
    )
    radii = np.zeros(len(loops) * count)
    np.maximum.at(radii, edge // loops.shape[1] * count + ray, reach)
    return radii.reshape(len(loops), count)


def _edge_distance(a: FloatArray, b: FloatArray, angle: FloatArray) -> FloatArray:
    """Distance (K,) at which rays from the origin meet the edges a -> b (K, 2)."""
    along = b - a
    cross = a[:, 0] * along[:, 1] - a[:, 1] * along[:, 0]
    slant = np.cos(angle) * along[:, 1] - np.sin(angle) * along[:, 0]
    far = np.sqrt(np.maximum(np.einsum("ij,ij->i", a, a), np.einsum("ij,ij->i", b, b)))
    flat = np.abs(slant) * far <= 1e-12 * np.einsum("ij,ij->i", along, along)
    distance = np.where(flat, far, cross / np.where(flat, 1.0, slant))
    return np.clip(distance, 0.0, far)


def widened_to_hold(radii: FloatArray, points: FloatArray) -> FloatArray:
    """Raise vertices until the polygons hold the points; continuous in the points.

    The two vertices beside a point are scaled until their edge passes through it, the next
    ones by a part of that, so that nothing jumps when a point moves past a vertex.

    Parameters
    ----------
    radii : (N, M) array
        Positive [m].
    points : (N, n, 2) array
        Points relative to the centres [m].

    Returns
    -------
    (N, M) array
        Nowhere less than `radii` [m].
    """
    count = radii.shape[1]
    distance = np.sqrt(np.einsum("ijk,ijk->ij", points, points))
    index, part = bins(np.arctan2(points[..., 1], points[..., 0]), count)
    rows = np.arange(len(radii))[:, None]
    now = chord_radius(radii[rows, index], radii[rows, (index + 1) % count], part, count)
    lacking = distance * (1.0 + 1e-9) / now - 1.0
    if not (lacking > 0.0).any():
        return radii
    which = np.nonzero(lacking > 0.0)
    row, index, part, lacking = which[0], index[which], part[which], lacking[which]
    factor = np.ones_like(radii)
    for offset, share in ((-1, 1.0 - part), (0, np.ones_like(part)), (1, np.ones_like(part)), (2, part)):
        np.maximum.at(factor, (row, (index + offset) % count), 1.0 + lacking * share)
    return radii * factor


def slope_limited(radii: FloatArray, length: FloatArray, slope: float = GREATEST_SLOPE) -> FloatArray:
    """Smallest radius function above the given one that changes slowly along the curve.

    Parameters
    ----------
    radii : (N, M) array
        [m].
    length : (N,) array
        Arc length at the sections, not decreasing [m].
    slope : float
        Greatest change of radius per arc length [-].

    Returns
    -------
    (N, M) array
        Nowhere less than `radii` [m].
    """
    ramp = slope * length[:, None]
    rising = np.maximum.accumulate(radii + ramp, axis=0) - ramp
    falling = np.maximum.accumulate((radii - ramp)[::-1], axis=0)[::-1] + ramp
    return np.maximum(radii, np.maximum(rising, falling))
