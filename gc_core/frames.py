"""Directions and frames along a curve, without twist and without raw differences."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from gc_core.arrays import FloatArray, read_only
from gc_core.errors import DegenerateCurveError

TANGENT_REACH = 0.03
"""A tangent is fitted over this part of the curve to either side [-]."""


NOT_TILTED = 0.98
"""Directions count as tangents where they are this near to the curve's steps (cosine) [-]."""


def smooth(curve: FloatArray, reach: int) -> FloatArray:
    """Average a curve over a moving window; its ends stay where they are.

    Parameters
    ----------
    curve : (n, 3) array
        Points along the curve [m].
    reach : int
        Points to either side that are averaged; cut to (n - 1) // 2.

    Returns
    -------
    (n, 3) array
        Straight, evenly sampled curves come back as they are.
    """
    reach = min(reach, (len(curve) - 1) // 2)
    if reach < 1:
        return curve
    head = 2.0 * curve[0] - curve[reach:0:-1]
    tail = 2.0 * curve[-1] - curve[-2 : -reach - 2 : -1]
    total = np.cumsum(np.concatenate((np.zeros((1, curve.shape[1])), head, curve, tail)), axis=0)
    width = 2 * reach + 1
    return (total[width:] - total[:-width]) / width


def arc_length(curve: FloatArray) -> FloatArray:
    """Length of a polyline up to each of its points.

    Parameters
    ----------
    curve : (n, 3) array
        Points [m].

    Returns
    -------
    (n,) array
        Starting at 0 [m].
    """
    steps = np.diff(curve, axis=0)
    return np.concatenate(([0.0], np.cumsum(np.sqrt(np.einsum("ij,ij->i", steps, steps)))))


def tangents(curve: FloatArray) -> FloatArray:
    """Directions of a curve, from a parabola fitted around every point.

    Parameters
    ----------
    curve : (n, 3) array
        Points along the curve [m]; n >= 2.

    Returns
    -------
    (n, 3) array
        Unit vectors.

    Raises
    ------
    DegenerateCurveError
        If the curve has no direction even at its widest window.

    References
    ----------
    .. [1] A. Savitzky, M. J. E. Golay. Smoothing and differentiation of data by
       simplified least squares procedures. Analytical Chemistry 36(8), 1964.
    """
    reach = min(max(1, round(TANGENT_REACH * len(curve))), (len(curve) - 1) // 2)
    slopes = _slopes(curve, reach) if reach else np.repeat(curve[1:] - curve[:-1], 2, axis=0)
    lengths = np.sqrt(np.einsum("ij,ij->i", slopes, slopes))
    mean_step = float(arc_length(curve)[-1]) / (len(curve) - 1)
    weak = lengths <= 1e-6 * mean_step
    if weak.any():
        slopes = np.where(weak[:, None], _wide_slopes(curve), slopes)
        lengths = np.sqrt(np.einsum("ij,ij->i", slopes, slopes))
        if (lengths <= 1e-9 * mean_step).any() or mean_step == 0.0:
            raise DegenerateCurveError(int(np.argmin(lengths)))
    return slopes / lengths[:, None]


def angles_between(one: FloatArray, other: FloatArray) -> FloatArray:
    """Angles (n,) between unit vectors (n, 3), exact for small ones too [rad]."""
    apart, together = one - other, one + other
    return 2.0 * np.arctan2(np.sqrt(_dot(apart, apart)), np.sqrt(_dot(together, together)))


def rotation_minimizing_frames(curve: FloatArray, normals: FloatArray, first: FloatArray) -> FloatArray:
    """Carry a frame along a curve without twisting it about the direction.

    Parameters
    ----------
    curve : (n, 3) array
        Points along the curve [m].
    normals : (n, 3) array
        Unit directions at the points (the tangents, or section normals).
    first : (3,) array
        Wanted first N [-]. Any length; replaced when parallel to the first direction.

    Returns
    -------
    (n, 3, 3) array
        ``frames[i]`` turns coordinates at ``curve[i]`` into world coordinates. Columns are
        direction, N, B = direction x N.

    References
    ----------
    .. [1] W. Wang, B. Jüttler, D. Zheng, Y. Liu. Computation of rotation minimizing
       frames. ACM Transactions on Graphics 27(1), 2008. doi:10.1145/1330511.1330513
    """
    n, b = _any_perpendicular(normals)
    carried = _double_reflection(curve, normals, n[:-1])
    # Angle by which each frame of the arbitrary field lags behind the carried one; their sum untwists it.
    turns = np.arctan2(_dot(carried, b[1:]), _dot(carried, n[1:]))
    start = np.arctan2(float(first @ b[0]), float(first @ n[0]))
    angle = start + np.concatenate(([0.0], np.cumsum(turns)))
    cos, sin = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return np.stack((normals, cos * n + sin * b, cos * b - sin * n), axis=2)


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.einsum("...i,...i->...", a, b)


def _any_perpendicular(directions: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors perpendicular to each direction; not continuous."""
    axis = np.zeros_like(directions)
    axis[np.arange(len(directions)), np.argmin(np.abs(directions), axis=1)] = 1.0
    n = axis - _dot(axis, directions)[:, None] * directions
    n = n / np.sqrt(_dot(n, n))[:, None]
    return n, np.asarray(np.cross(directions, n), dtype=np.float64)


def _double_reflection(curve: FloatArray, normals: FloatArray, vectors: FloatArray) -> FloatArray:
    """Carry vectors[i] (n-1, 3) from point i to point i + 1 by two reflections.

    The first mirror is perpendicular to the curve's step. Where the directions are tilted away from the curve
    it is perpendicular to their sum: that is the smallest rotation of one into the other.
    """
    step, both = np.diff(curve, axis=0), normals[1:] + normals[:-1]
    along = _dot(step, both)
    tilted = along <= NOT_TILTED * np.sqrt(_dot(step, step) * _dot(both, both))
    step = np.where(tilted[:, None], both, step)
    square = np.maximum(_dot(step, step), 1e-300)[:, None]
    moved = vectors - (2.0 * _dot(step, vectors)[:, None] / square) * step
    left = normals[:-1] - (2.0 * _dot(step, normals[:-1])[:, None] / square) * step
    mirror = normals[1:] - left
    size = np.maximum(_dot(mirror, mirror), 1e-24)[:, None]
    return moved - 2.0 * _dot(mirror, moved)[:, None] / size * mirror


@lru_cache(maxsize=32)
def _slope_weights(reach: int) -> FloatArray:
    """(w, w) array: row k gives the slope of the fitted parabola at the k-th of w = 2 reach + 1 points."""
    at = np.arange(-reach, reach + 1, dtype=np.float64)
    fit = np.linalg.pinv(np.stack((np.ones_like(at), at, at**2), axis=1))
    return read_only(fit[1][None, :] + 2.0 * at[:, None] * fit[2][None, :])


def _slopes(curve: FloatArray, reach: int) -> FloatArray:
    weights = _slope_weights(reach)
    windows = np.lib.stride_tricks.sliding_window_view(curve, 2 * reach + 1, axis=0)
    inner = windows @ weights[reach]
    head = weights[:reach] @ curve[: 2 * reach + 1]
    tail = weights[reach + 1 :] @ curve[-2 * reach - 1 :]
    return np.concatenate((head, inner, tail))


def _wide_slopes(curve: FloatArray) -> FloatArray:
    """Slopes over windows that grow until the curve has moved; for curves that turn back on themselves."""
    slopes = np.zeros_like(curve)
    index = np.arange(len(curve))
    mean_step = float(arc_length(curve)[-1]) / (len(curve) - 1)
    reach = 1
    while reach < 2 * len(curve):
        chord = curve[np.minimum(index + reach, len(curve) - 1)] - curve[np.maximum(index - reach, 0)]
        open_ = _dot(slopes, slopes) <= (1e-6 * mean_step) ** 2
        slopes = np.where(open_[:, None], chord, slopes)
        reach *= 2
    return slopes
