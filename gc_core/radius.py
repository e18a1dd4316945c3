"""Closed curves round a centre as a radius function: the one place that knows polar polygons.

`radii[..., m]` is the distance of vertex m, at the angle 2 pi m / M, from the centre. The section
*is* the polygon through these vertices, so that what is inside does not depend on how it is drawn.
"""

from __future__ import annotations

import numpy as np

from gc_core.arrays import FloatArray, IntArray, following

GREATEST_SLOPE = 2.0
"""A section widens or narrows along the curve by at most this much per length [-]."""


FINE = 2.0**32
"""Angles are told apart to this part of the step between vertices."""

FULL_SPILL = 0.1
"""A point this far beyond the boundary, relative to it, raises the next vertices in full proportion [-]."""


def vertex_angles(count: int) -> FloatArray:
    """Angles of the vertices, (count,) array from 0 [rad]."""
    return np.arange(count, dtype=np.float64) * (2.0 * np.pi / count)


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
    x, y = loops[..., 0], loops[..., 1]
    # Angles in steps, on a grid on which sums are exact: a ray through a shared vertex belongs to one edge.
    angle = np.rint(np.arctan2(y, x) * (count / (2.0 * np.pi)) * FINE) / FINE
    turn = following(angle) - angle
    turn -= count * np.round(turn / count)
    first = np.ceil(np.minimum(angle, angle + turn)).astype(np.intp).ravel()
    rays = np.ceil(np.maximum(angle, angle + turn)).astype(np.intp).ravel() - first
    edge = np.repeat(np.arange(rays.size), rays)
    ray = np.take(first - np.cumsum(rays) + rays, edge) + np.arange(edge.size)
    ray = np.where(ray < 0, ray + count, ray)
    along_x, along_y = following(x) - x, following(y) - y
    size = np.abs(along_x) + np.abs(along_y)
    scale = 1.0 / np.maximum(size, 1e-300)
    along_x, along_y = along_x * scale, along_y * scale
    cross = np.take(x * along_y - y * along_x, edge)
    square = x * x + y * y
    far = np.take(np.sqrt(np.maximum(square, following(square))), edge)
    angles = vertex_angles(count)
    slant = np.take(np.cos(angles), ray) * np.take(along_y, edge)
    slant -= np.take(np.sin(angles), ray) * np.take(along_x, edge)
    # An edge that points at the origin is met at its far end.
    parallel = np.abs(slant) <= 1e-12
    reach = np.where(parallel, far, cross / np.where(parallel, 1.0, slant))
    radii = np.zeros(len(loops) * count)
    np.maximum.at(radii, edge // loops.shape[1] * count + ray, np.clip(reach, 0.0, far))
    return radii.reshape(len(loops), count)


def widened_to_hold(radii: FloatArray, points: FloatArray) -> FloatArray:
    """Raise vertices until the polygons hold the points.

    Vertices are raised to shares of the least level at which the edge beside a point passes through it. The
    shares fall with the angle to the point, so that nothing jumps when a point moves past a vertex.

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
    distance = np.sqrt(np.einsum("ijk,ijk->ij", points, points)) * (1.0 + 1e-9)
    index, part = bins(np.arctan2(points[..., 1], points[..., 0]), count)
    rows = np.arange(len(radii))[:, None]
    before, after = radii[rows, index], radii[rows, (index + 1) % count]
    edge = chord_radius(before, after, part, count)
    outside = np.nonzero(distance > edge)
    if not outside[0].size:
        return radii
    row, index, part, distance = outside[0], index[outside], part[outside], distance[outside]
    spill = np.minimum((distance / edge[outside] - 1.0) / FULL_SPILL, 1.0)
    near, far = 1.0 - (1.0 - spill) * part, 1.0 - (1.0 - spill) * (1.0 - part)
    before, after = before[outside] / near, after[outside] / far
    # At a common level the edge has 1 / r = other / level + weight / level.
    step = 2.0 * np.pi / count
    weight, other = (
        np.sin(part * step) / np.sin(step) / far,
        np.sin((1.0 - part) * step) / np.sin(step) / near,
    )
    level = distance * (weight + other)
    # Where one of the two already stands above that level, the other one is raised alone.
    high = np.maximum(before, after)
    kept = np.where(before >= after, other, weight) / high
    alone = (weight + other - kept * high) / np.maximum(1.0 / distance - kept, np.finfo(float).tiny)
    level = np.where(level >= high, level, alone)
    raised = radii.copy()
    for offset, share in ((-1, spill * (1.0 - part)), (0, near), (1, far), (2, spill * part)):
        np.maximum.at(raised, (row, (index + offset) % count), share * level)
    return raised


def slope_limited(radii: FloatArray, steps: FloatArray, slope: float = GREATEST_SLOPE) -> FloatArray:
    """Smallest radius function above the given one that changes slowly along the curve.

    Parameters
    ----------
    radii : (N, M) array
        [m].
    steps : (N - 1, M) or (N - 1, 1) array
        Length gone from one section to the next, not negative [m].
    slope : float
        Greatest change of radius per length [-].

    Returns
    -------
    (N, M) array
        Nowhere less than `radii` [m].
    """
    ramp = slope * np.concatenate((np.zeros((1, steps.shape[1])), np.cumsum(steps, axis=0)))
    rising = np.maximum.accumulate(radii + ramp, axis=0) - ramp
    falling = np.maximum.accumulate((radii - ramp)[::-1], axis=0)[::-1] + ramp
    return np.maximum(radii, np.maximum(rising, falling))
