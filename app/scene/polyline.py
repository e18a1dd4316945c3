"""Lines made of numbers: pieces, dashes, points at a distance, and what a ray passes nearest.

Pure functions of arrays, nothing of viser. Lengths are metres.
"""

import math

import numpy as np

from app.document import FloatArray
from gc_core.arrays import evenly


def segments(points: FloatArray) -> FloatArray:
    """Join neighbours by straight lines.

    Parameters
    ----------
    points : (n, 3) array
        Corners of the line [m]; n >= 1.

    Returns
    -------
    (n - 1, 2, 3) array
        Both ends of every segment [m].
    """
    return np.stack([points[:-1], points[1:]], axis=1)


def thin_out(points: FloatArray, most: int) -> FloatArray:
    """Keep at most ``most`` of the points (n, 3), evenly, both ends among them."""
    if len(points) <= most:
        return points
    return points[evenly(len(points), most)]


def arc_length(points: FloatArray) -> FloatArray:
    """(n,) distance along the line (n, 3) from its first point [m]."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def along(points: FloatArray, distances: FloatArray) -> FloatArray:
    """Find points on a line by their distance along it.

    Parameters
    ----------
    points : (n, 3) array
        Corners of the line [m]; n >= 1. Neighbours may coincide.
    distances : (k,) array
        From the first point, along the line [m]; beyond the ends the ends are taken.

    Returns
    -------
    (k, 3) array
        Points on the line [m].
    """
    length = arc_length(points)
    moving = np.concatenate([[True], np.diff(length) > 0.0])
    length, corners = length[moving], points[moving]
    return np.stack([np.interp(distances, length, corners[:, axis]) for axis in range(3)], axis=1)


def dashes(points: FloatArray, dash: float = 0.012, gap: float = 0.009) -> FloatArray:
    """Cut a line into dashes.

    Parameters
    ----------
    points : (n, 3) array
        Corners of the line [m]; n >= 1.
    dash, gap : float
        Length of a dash and of the gap after it [m]; positive.

    Returns
    -------
    (k, 2, 3) array
        Both ends of every dash, on the line [m]; empty when the line has no length.
    """
    total = float(arc_length(points)[-1])
    starts = (dash + gap) * np.arange(math.ceil(total / (dash + gap)), dtype=np.float64)
    ends = np.minimum(starts + dash, total)
    return along(points, np.stack([starts, ends], axis=1).ravel()).reshape(-1, 2, 3)


def nearest_to_ray(points: FloatArray, origin: FloatArray, direction: FloatArray, reach: float) -> int:
    """Find the point that somebody who looks along a ray means.

    Parameters
    ----------
    points : (n, 3) array
        Candidates along a line [m]; n >= 1.
    origin, direction : (3,) array
        Of the ray; the direction is not zero.
    reach : float
        Where several stretches of the line lie within ``reach`` of the ray [m], the one in front is meant.

    Returns
    -------
    int
        Index into ``points``.
    """
    depth = (points - origin) @ (direction / np.linalg.norm(direction))
    foot = origin + depth[:, None] * (direction / np.linalg.norm(direction))
    distance = np.linalg.norm(points - foot, axis=1)
    hit = distance <= max(reach, float(distance.min()))
    front = hit & (depth <= depth[hit].min() + 3.0 * reach)
    return int(np.argmin(np.where(front, distance, np.inf)))
