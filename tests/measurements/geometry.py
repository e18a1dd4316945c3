"""Facts about one cylinder by plain geometry, apart from what the core says of itself.

Everything is measured on the polygons through `surface()`, in the planes of `frames`.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from gc_core import Demonstration, GeneralizedCylinder
from gc_core.arrays import BoolArray, FloatArray
from gc_core.demonstration import trim
from gc_core.frames import tangents
from gc_core.radius import radius_at

WINDOW = 21
"""Steps whose median a step is measured by; at the ends of a path those of them that exist."""

IN_PLANE = 1e-8
"""A sample this near to a plane lies in it [m]."""

HELD = 1.0 + 1e-9
"""A point is inside of its polygon up to this ratio: rounding [-]."""


def in_planes(cylinder: GeneralizedCylinder, points: FloatArray) -> FloatArray:
    """Points (N, K, 3) in the axes of their station's section: (N, K, 3), height first [m]."""
    return (points - cylinder.directrix[:, None]) @ cylinder.frames


def ratios_to_polygons(cylinder: GeneralizedCylinder) -> FloatArray:
    """Effective points by the polygons of `surface()` (N, n): inside when at most 1 [-]."""
    vertices = in_planes(cylinder, cylinder.surface())[:, None, :, 1:]
    following = np.roll(vertices, -1, axis=2)
    points = in_planes(cylinder, cylinder.effective_points)[:, :, None, 1:]
    edge = following - vertices
    outward = np.stack((edge[..., 1], -edge[..., 0]), axis=-1)
    within = (_turn(vertices, points) >= -1e-15) & (_turn(points, following) >= -1e-15)
    height = (points * outward).sum(-1) / (vertices * outward).sum(-1)
    # A point whose direction belongs to no edge lies in no polygon.
    return np.where(within.any(axis=2), np.where(within, height, 0.0).max(axis=2), np.inf)


def centres_inside(cylinder: GeneralizedCylinder) -> BoolArray:
    """Where (N,) the polygon goes once round its centre, always to the left of it."""
    vertices = in_planes(cylinder, cylinder.surface())[..., 1:]
    turns = _turn(vertices, np.roll(vertices, -1, axis=1))
    return (turns > 0.0).all(axis=1)


def heights(cylinder: GeneralizedCylinder) -> float:
    """Farthest distance of an effective point or a vertex from its section plane [m]."""
    both = np.concatenate((cylinder.effective_points, cylinder.surface()), axis=1)
    return float(np.abs(in_planes(cylinder, both)[..., 0]).max())


def area_ratios(cylinder: GeneralizedCylinder) -> FloatArray:
    """Area of the sections by that of the convex hull of their effective points (K,) [-].

    K <= N: stations whose hull is thinner than twice the stated minimum half-width are left out,
    since that width rules there.
    """
    vertices = in_planes(cylinder, cylinder.surface())[..., 1:]
    area = 0.5 * _turn(vertices, np.roll(vertices, -1, axis=1)).sum(axis=1)
    points = in_planes(cylinder, cylinder.effective_points)[..., 1:]
    hulls = np.array([_hull(section) for section in points])
    thick = hulls[:, 1] >= 2.0 * cylinder.diagnostics.minimum_half_width
    return area[thick] / hulls[thick, 0]


def _hull(points: FloatArray) -> tuple[float, float]:
    """Area and least width of the convex hull of points (n, 2); 0 where they lie on a line."""
    if len(points) < 3:
        return 0.0, 0.0
    try:
        hull = ConvexHull(points)
    except QhullError:
        return 0.0, 0.0
    inward = -(points @ hull.equations[:, :2].T + hull.equations[:, 2])
    return float(hull.volume), float(inward.max(axis=0).min())


def cutting_stations(cylinder: GeneralizedCylinder) -> BoolArray:
    """Stations (N,) whose filled polygon truly meets that of the station before or after."""
    surface, normals = cylinder.surface(), cylinder.frames[:, :, 0]
    over, under = _heights_to_neighbours(cylinder)
    turned_back = (np.diff(cylinder.directrix, axis=0) * normals[:-1]).sum(axis=1) <= 0.0
    pairs = turned_back | (over.max(axis=1) <= 0.0) | (under.min(axis=1) >= 0.0)
    mixed = (over.min(axis=1) < 0.0) & (under.max(axis=1) > 0.0) & ~pairs
    for i in np.flatnonzero(mixed):
        line = np.cross(normals[i], normals[i + 1])
        here = _stretches(surface[i], under[i], line)
        there = _stretches(surface[i + 1], over[i], line)
        begins = np.maximum(here[:, None, 0], there[None, :, 0])
        pairs[i] = bool((begins < np.minimum(here[:, None, 1], there[None, :, 1])).any())
    return _stations_of(pairs)


def overlapping_stations(cylinder: GeneralizedCylinder) -> BoolArray:
    """Stations (N,) with a vertex on the wrong side of a neighbour's plane, right above or below its polygon.

    A stricter test than `cutting_stations`: also true where one section lies as a whole behind the other.
    """
    surface, normals = cylinder.surface(), cylinder.frames[:, :, 0]
    over, under = _heights_to_neighbours(cylinder)
    back = (over <= 0.0) & _above(cylinder, surface[1:] - over[..., None] * normals[:-1, None], 0)
    ahead = (under >= 0.0) & _above(cylinder, surface[:-1] - under[..., None] * normals[1:, None], 1)
    return _stations_of(back.any(axis=1) | ahead.any(axis=1))


def _heights_to_neighbours(cylinder: GeneralizedCylinder) -> tuple[FloatArray, FloatArray]:
    """Heights (N - 1, M) of the vertices of i + 1 over the plane i, and of i over the plane i + 1 [m]."""
    surface, centre, normals = cylinder.surface(), cylinder.directrix, cylinder.frames[:, :, 0]
    over = np.einsum("imk,ik->im", surface[1:] - centre[:-1, None], normals[:-1])
    return over, np.einsum("imk,ik->im", surface[:-1] - centre[1:, None], normals[1:])


def _above(cylinder: GeneralizedCylinder, feet: FloatArray, shift: int) -> BoolArray:
    """Which feet (N - 1, M, 3), in the planes of stations i + shift, lie inside of those polygons."""
    rows = np.arange(len(feet)) + shift
    local = (feet - cylinder.directrix[rows, None]) @ cylinder.frames[rows]
    angles = np.arctan2(local[..., 2], local[..., 1])
    reach = radius_at(cylinder.radii, np.broadcast_to(rows[:, None], angles.shape), angles)
    return np.hypot(local[..., 1], local[..., 2]) <= reach


def _stretches(polygon: FloatArray, height: FloatArray, line: FloatArray) -> FloatArray:
    """Stretches (K, 2) of a line that lie in a polygon (M, 3); `height` (M,) changes sign on the line."""
    after, after_height = np.roll(polygon, -1, axis=0), np.roll(height, -1)
    at = np.flatnonzero((height > 0.0) != (after_height > 0.0))
    part = (height[at] / (height[at] - after_height[at]))[:, None]
    met = polygon[at] * (1.0 - part) + after[at] * part
    return np.sort(met @ line).reshape(-1, 2)


def _stations_of(pairs: BoolArray) -> BoolArray:
    """Both stations (N,) of every pair (N - 1,)."""
    return np.concatenate((pairs, [False])) | np.concatenate(([False], pairs))


def tilts(cylinder: GeneralizedCylinder) -> FloatArray:
    """Angles (N,) between section normals and tangents [rad]."""
    along, normals = tangents(cylinder.directrix), cylinder.frames[:, :, 0]
    return np.arctan2(np.linalg.norm(np.cross(along, normals), axis=1), (along * normals).sum(axis=1))


def slopes(cylinder: GeneralizedCylinder) -> FloatArray:
    """|dR| / ds between neighbouring stations at equal angle (N - 1, M) [-]."""
    return np.abs(np.diff(cylinder.radii, axis=0)) / np.diff(cylinder.arc_length)[:, None]


def off_demonstrations(cylinder: GeneralizedCylinder, shown: list[Demonstration]) -> float:
    """Farthest distance of an effective point that counts as a crossing from any true crossing [m].

    A sample in the plane is a crossing too: an end need not go through it.
    """
    farthest = 0.0
    normals = cylinder.frames[:, :, 0]
    level = (cylinder.directrix * normals).sum(axis=1)
    for j, demonstration in enumerate(shown):
        path = trim(demonstration).positions
        height = path @ normals.T - level
        piece, station = np.nonzero((height[:-1] > 0.0) != (height[1:] > 0.0))
        before, after = height[piece, station], height[piece + 1, station]
        part = (before / (before - after))[:, None]
        met = path[piece] * (1.0 - part) + path[piece + 1] * part
        touching, touched = np.nonzero(np.abs(height) <= IN_PLANE)
        met, station = np.concatenate((met, path[touching])), np.concatenate((station, touched))
        away = np.linalg.norm(met - cylinder.effective_points[station, j], axis=1)
        nearest = np.full(len(normals), np.inf)
        np.minimum.at(nearest, station, away)
        farthest = max(farthest, float(np.where(cylinder.diagnostics.missed[:, j], 0.0, nearest).max()))
    return farthest


def missed_at_ends_and_inside(missed: BoolArray) -> tuple[int, int]:
    """Misses (N, n) in one run from the first or to the last station, and all others."""
    from_first = np.logical_and.accumulate(missed, axis=0)
    to_last = np.logical_and.accumulate(missed[::-1], axis=0)[::-1]
    ends = int((from_first | to_last).sum())
    return ends, int(missed.sum()) - ends


def steps_by_median(positions: FloatArray) -> FloatArray:
    """Steps of paths (S, K, 3) by the median of the 21 steps around them: (S, K - 1) [-].

    A path that waits at its beginning is measured from where it goes on; 0 while it waits.
    """
    step = np.linalg.norm(np.diff(positions, axis=1), axis=2)
    moving = np.logical_or.accumulate(step > 0.0, axis=1)
    reach = WINDOW // 2
    padded = np.pad(np.where(moving, step, np.nan), ((0, 0), (reach, reach)), constant_values=np.nan)
    windows = np.sort(np.lib.stride_tricks.sliding_window_view(padded, WINDOW, axis=1), axis=2)
    count = WINDOW - np.isnan(windows).sum(axis=2)
    low = np.take_along_axis(windows, np.maximum(count - 1, 0)[..., None] // 2, axis=2)[..., 0]
    high = np.take_along_axis(windows, (np.minimum(count, WINDOW - 1) // 2)[..., None], axis=2)[..., 0]
    median = np.where(moving, 0.5 * (low + high), 1.0)
    return np.where(moving, step / np.maximum(median, 1e-15), 0.0)


def _turn(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
