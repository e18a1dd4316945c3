"""Closed-spline sections the plain way: one station after the other, with what SciPy offers."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial import ConvexHull

from gc_core.arrays import FloatArray

SAMPLES = 48
"""Of one spline."""


def closed_spline(points: FloatArray, count: int) -> FloatArray:
    """Radii (N, count) of the periodic centripetal cubics through the hulls of points (N, n, 2) [m]."""
    return np.array([ray_radii(spline_loop(section), count) for section in points])


def spline_loop(section: FloatArray) -> FloatArray:
    """Vertices (P, 2) of the spline through the hull of points (n, 2)."""
    corners = section[ConvexHull(section).vertices]
    closed = np.vstack((corners, corners[:1]))
    knots = np.concatenate(([0.0], np.cumsum(np.sqrt(np.linalg.norm(np.diff(closed, axis=0), axis=1)))))
    spline = CubicSpline(knots, closed, bc_type="periodic")
    part = np.linspace(0.0, 1.0, SAMPLES // len(corners), endpoint=False)
    at = knots[:-1, None] + part * np.diff(knots)[:, None]
    return np.asarray(spline(at.ravel()), dtype=np.float64)


def ray_radii(loop: FloatArray, count: int) -> FloatArray:
    """Farthest distances (count,) at which rays from the origin meet a closed polygon (P, 2)."""
    angles = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    ray = np.stack((np.cos(angles), np.sin(angles)), axis=1)[:, None]
    along = np.roll(loop, -1, axis=0) - loop
    slant = ray[..., 0] * along[:, 1] - ray[..., 1] * along[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = (loop[:, 0] * along[:, 1] - loop[:, 1] * along[:, 0]) / slant
        part = (loop[:, 0] * ray[..., 1] - loop[:, 1] * ray[..., 0]) / slant
    return np.where((part >= 0.0) & (part <= 1.0) & (reach > 0.0), reach, 0.0).max(axis=1)
