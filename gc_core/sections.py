"""Cross-sections: the points where the demonstrations cross a plane -> a radius function.

Every kind returns a polygon that holds all its points and, with at least the minimum half-width,
its centre. Kinds are functions `(points (N, n, 2), count, half_width) -> radii (N, count)`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from gc_core.arrays import FloatArray, IntArray, following, preceding, read_only
from gc_core.errors import UnknownOptionError
from gc_core.radius import loop_radii, vertex_angles, widened_to_hold

SUPPORT_DIRECTIONS = 32
"""Directions in which the outermost points are looked for."""

TIE = 1e-9
"""Points that are as far in a direction to within this part of their distance are told apart by it [-]."""

CURVE_SAMPLES = 48
"""Samples of a closed spline, shared by its pieces."""

ELLIPSE_ROUNDS = 12
"""Rounds towards the smallest ellipse; the last step scales it so that it holds all points."""


def section_radii(points: FloatArray, kind: str, count: int, half_width: float) -> FloatArray:
    """Build the sections of one tube.

    Parameters
    ----------
    points : (N, n, 2) array
        Effective points relative to the centres, in the sections' axes [m].
    kind : str
        One of `SECTIONS`.
    count : int
        Number of vertices of each section.
    half_width : float
        Least distance of the boundary from the centre, and of a thin section's sides from its axis [m].

    Returns
    -------
    (N, count) array
        Radii; every point lies inside its polygon [m].

    Raises
    ------
    UnknownOptionError
        If there is no such kind.
    """
    build = SECTIONS.get(kind)
    if build is None:
        raise UnknownOptionError("section", kind, SECTIONS)
    radii = np.maximum(build(points, count, half_width), half_width)
    return widened_to_hold(radii, points)


def circle(points: FloatArray, count: int, half_width: float) -> FloatArray:
    """Circle about the centre through the farthest point, circumscribed by the polygon."""
    radius = np.maximum(np.sqrt(np.einsum("ijk,ijk->ij", points, points).max(axis=1)), half_width)
    return np.repeat(radius[:, None] / np.cos(np.pi / count), count, axis=1)


def ellipse(points: FloatArray, count: int, half_width: float) -> FloatArray:
    """Smallest ellipse about the centre that holds all points (to within a few per cent of area).

    References
    ----------
    .. [1] L. G. Khachiyan. Rounding of polytopes in the real number model of computation.
       Mathematics of Operations Research 21(2), 1996.
    """
    weights = np.full(points.shape[:2], 1.0 / points.shape[1])
    inverse = _inverse_moments(points, weights, half_width)
    spread = _quadratic(points, inverse)
    for _ in range(ELLIPSE_ROUNDS):
        weights = weights * np.maximum(spread, 1e-12)
        weights = weights / weights.sum(axis=1, keepdims=True)
        inverse = _inverse_moments(points, weights, half_width)
        spread = _quadratic(points, inverse)
    angles = vertex_angles(count)
    rays = np.stack((np.cos(angles), np.sin(angles)), axis=1)
    scale = np.maximum(spread.max(axis=1), 1.0)[:, None]
    return np.sqrt(scale / _quadratic(rays[None], inverse))


def _inverse_moments(points: FloatArray, weights: FloatArray, half_width: float) -> FloatArray:
    """Inverse second moments (N, 3): xx, xy, yy of weighted points (N, n, 2), none thinner than that."""
    x, y, thin = points[..., 0], points[..., 1], half_width**2
    xx, xy, yy = (weights * x * x).sum(1) + thin, (weights * x * y).sum(1), (weights * y * y).sum(1) + thin
    return np.stack((yy, -xy, xx), axis=1) / (xx * yy - xy * xy)[:, None]


def _quadratic(vectors: FloatArray, form: FloatArray) -> FloatArray:
    """Values (N, K) of quadratic forms (N, 3) at vectors (N or 1, K, 2)."""
    x, y = vectors[..., 0], vectors[..., 1]
    return form[:, :1] * x * x + 2.0 * form[:, 1:2] * x * y + form[:, 2:] * y * y


def hull(points: FloatArray, count: int, half_width: float) -> FloatArray:
    """Convex hull of the points, thickened where it is thinner than twice the half-width."""
    supports = _supports(points)
    corners, _ = _corners(points, supports)
    lacking = _lacking_width(supports, half_width)
    return loop_radii(_thickened(points, corners, lacking), count)


def closed_spline(points: FloatArray, count: int, half_width: float) -> FloatArray:
    """Closed cubic spline through the corners of the hull, with centripetal knots.

    References
    ----------
    .. [1] S. R. Ahmadzadeh, M. A. Rana, S. Chernova. Generalized Cylinders for Learning, Reproduction,
       Generalization, and Refinement of Robot Skills. RSS 2017. (Its "natural" ends would leave a corner.)
    .. [2] E. T. Y. Lee. Choosing nodes in parametric curve interpolation. CAD 21(6), 1989.
    """
    supports = _supports(points)
    corners, n_corners = _corners(points, supports)
    lacking = _lacking_width(supports, half_width)
    # Corners on one line, to within rounding, have no curve round them; there the least thickness rules.
    round_ = (n_corners > 2) & (lacking < (1.0 - 1e-9) * half_width)
    loops = np.zeros((2, len(points), CURVE_SAMPLES))
    for n in np.unique(n_corners[round_]):
        rows = np.flatnonzero(n_corners == n)
        curve = _spline_loops(np.take_along_axis(points[rows], corners[rows, :n, None], axis=1))
        loops[:, rows, : curve.shape[2]] = curve
        loops[:, rows, curve.shape[2] :] = curve[:, :, -1:]
    radii = loop_radii(np.moveaxis(loops, 0, 2), count)
    thin = np.flatnonzero(~round_ | (lacking > 0.0))
    if thin.size:
        rounded = loop_radii(_thickened(points[thin], corners[thin], lacking[thin]), count)
        radii[thin] = np.maximum(radii[thin], rounded)
    return radii


def _supports(points: FloatArray) -> FloatArray:
    """How far (n, N, D) points (N, n, 2) are out in each direction [m]."""
    # Points first: the outermost ones are then found by operations on whole arrays.
    return np.ascontiguousarray(points.transpose(1, 0, 2)) @ _directions().T


def _corners(points: FloatArray, supports: FloatArray) -> tuple[IntArray, IntArray]:
    """Outermost points in order round the hull; see `_supports`.

    Returns
    -------
    corners : (N, D) integer array
        Corner numbers; the first `n_corners` of a row differ, the rest repeat the first.
    n_corners : (N,) integer array
    """
    outermost = _outermost(points, supports)
    fresh = outermost != preceding(outermost)
    n_corners = np.maximum(fresh.sum(axis=1), 1)
    order = np.argsort(~fresh, axis=1, kind="stable")
    corners = np.take_along_axis(outermost, order, axis=1)
    beyond = np.arange(SUPPORT_DIRECTIONS)[None, :] >= n_corners[:, None]
    return np.where(beyond, corners[:, :1], corners), n_corners


def _outermost(points: FloatArray, supports: FloatArray) -> IntArray:
    """Point (N, D) that is farthest in each direction; of equal ones, the one farther from the centre.

    Else a point on the straight edge between two corners would be a corner or not by rounding.
    """
    away = np.sqrt(np.einsum("ijk,ijk->ji", points, points))
    supports = supports + TIE * away[:, :, None]
    farthest, outermost = supports[0], np.zeros(supports.shape[1:], dtype=np.intp)
    for index, support in enumerate(supports[1:], 1):
        np.copyto(outermost, index, where=support > farthest)
        np.maximum(farthest, support, out=farthest)
    return outermost


def _lacking_width(supports: FloatArray, half_width: float) -> FloatArray:
    """How far (N,) the hulls must grow to be twice the half-width thick everywhere; see `_supports`."""
    support = supports.max(axis=0)
    width = support + np.roll(support, SUPPORT_DIRECTIONS // 2, axis=1)
    return np.maximum(half_width - 0.5 * width.min(axis=1), 0.0)


def _thickened(points: FloatArray, corners: IntArray, lacking: FloatArray) -> FloatArray:
    """Hull loops (N, P, 2), grown and rounded by a length each (N,)."""
    if not lacking.any():
        most = int((corners != corners[:, :1]).sum(axis=1).max()) + 1
        return np.take_along_axis(points, corners[:, :most, None], axis=1)
    outermost = _outermost(points, _supports(points))
    loops = np.take_along_axis(points, outermost[:, :, None], axis=1)
    # The polygon of directions lies inside the disc that it stands for.
    grown = lacking / np.cos(np.pi / SUPPORT_DIRECTIONS)
    return loops + grown[:, None, None] * _directions()


@lru_cache(maxsize=1)
def _directions() -> FloatArray:
    """Unit vectors (D, 2) in which the outermost points are looked for."""
    angles = vertex_angles(SUPPORT_DIRECTIONS)
    return read_only(np.stack((np.cos(angles), np.sin(angles)), axis=1))


def _spline_loops(corners: FloatArray) -> FloatArray:
    """Sample the periodic centripetal cubic through corners (K, n, 2): x and y (2, K, P)."""
    after = following(corners)
    chord = after - corners
    step = np.sqrt(np.sqrt(np.einsum("ijk,ijk->ij", chord, chord)))
    step = np.maximum(step, 1e-3 * step.max(axis=1, keepdims=True))
    bend = _periodic_curvatures(chord / step[..., None], step)
    square = (step**2)[..., None]
    pieces = np.stack((corners, after, square * bend, square * following(bend)))
    curve = np.moveaxis(pieces, 0, 3) @ _piece_basis(CURVE_SAMPLES // corners.shape[1])
    return np.moveaxis(curve, 2, 0).reshape(2, len(corners), -1)


@lru_cache(maxsize=32)
def _piece_basis(samples: int) -> FloatArray:
    """Shares (4, samples) of a cubic piece's ends, and of their second derivatives by its step squared."""
    part = np.linspace(0.0, 1.0, samples, endpoint=False)
    rest = 1.0 - part
    return read_only(np.stack((rest, part, (rest**3 - rest) / 6.0, (part**3 - part) / 6.0)))


def _periodic_curvatures(slope: FloatArray, step: FloatArray) -> FloatArray:
    """Second derivatives (K, n, 2) at the knots of periodic cubics with these slopes and steps of pieces."""
    n = step.shape[1]
    here = np.arange(n, dtype=np.intp)
    before = preceding(step)
    matrix = np.zeros((len(step), n, n))
    matrix[:, here, here] = 2.0 * (step + before)
    matrix[:, here, (here + 1) % n] += step
    matrix[:, here, (here - 1) % n] += before
    solved = np.linalg.solve(matrix, 6.0 * (slope - preceding(slope)))
    return np.asarray(solved, dtype=np.float64)


SECTIONS: dict[str, Callable[[FloatArray, int, float], FloatArray]] = {
    "circle": circle,
    "ellipse": ellipse,
    "closed_spline": closed_spline,
    "hull": hull,
}
"""Section kinds by name."""
