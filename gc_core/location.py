"""Where a point lies in a tube: which section planes, swept along the curve, pass through it.

Between two stations everything is interpolated: centre and axes linearly, the boundary's distance at
equal angle. A plane may pass through a point more than once, where the tube comes near itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gc_core.arrays import BoolArray, FloatArray, IntArray
from gc_core.frames import arc_length
from gc_core.radius import bins, vertex_angles

ON_BOUNDARY = 1e-9
"""A ratio up to this much above 1 is still inside: rounding [-]."""

ON_PLANE = 1e-9
"""A point this near to a plane lies in it, relative to the length of the curve [-]."""

CACHED = 2**15
"""Distances of points to planes that are looked at in one go: they stay in the processor's cache."""

BLOCK = 4096
"""Points that are located at once: bounds the memory of a large query."""

FARTHEST = 1e100
"""Coordinates beyond this are cut: their products would not be finite [m]."""


@dataclass(frozen=True, eq=False)
class Sweep:
    """The sections of a tube, laid out so that points are found quickly."""

    planes: FloatArray
    """(4, N) normals of the section planes, and minus their distances from the origin."""
    places: FloatArray
    """(N, 9) centre, first and second axis of each section."""
    narrowness: FloatArray
    """(N, M) one by the distance of each vertex from the centre [1/m]."""
    corners: FloatArray
    """(M, 2) directions of the vertices [-]."""
    slack: float
    """How far from a plane a point still lies in it [m]."""

    @property
    def last(self) -> int:
        """Index of the last station."""
        return len(self.places) - 1


@dataclass(frozen=True, eq=False)
class Passages:
    """Every place where a section plane, swept from station to station, passes through some points."""

    rows: IntArray
    """(C,) which point; not decreasing."""
    stations: FloatArray
    """(C,) fractional station, not decreasing for a point [-]."""
    angles: FloatArray
    """(C,) angle in the section from N to B [rad]."""
    ratios: FloatArray
    """(C,) distance from the centre by that of the boundary [-]."""

    @property
    def inside(self) -> BoolArray:
        """(C,) whether the section holds the point."""
        return self.ratios <= 1.0 + ON_BOUNDARY


def sweep_of(directrix: FloatArray, frames: FloatArray, radii: FloatArray) -> Sweep:
    """Lay out the sections of a tube.

    Parameters
    ----------
    directrix : (N, 3) array
        Centres [m]; N >= 2.
    frames : (N, 3, 3) array
        Columns: section normal, first and second axis [-].
    radii : (N, M) array
        Distances of the vertices from the centres, positive [m].

    Returns
    -------
    Sweep
    """
    normals = frames[:, :, 0]
    angles = vertex_angles(radii.shape[1])
    return Sweep(
        planes=np.vstack((normals.T, -np.einsum("ij,ij->i", directrix, normals))),
        places=np.hstack((directrix, frames[:, :, 1], frames[:, :, 2])),
        narrowness=1.0 / radii,
        corners=np.stack((np.cos(angles), np.sin(angles)), axis=1),
        slack=ON_PLANE * max(float(arc_length(directrix)[-1]), 1e-12),
    )


def passages(sweep: Sweep, points: FloatArray) -> Passages:
    """Find every passage of a section plane through each point.

    Parameters
    ----------
    sweep : Sweep
    points : (P, 3) array
        Finite places [m].

    Returns
    -------
    Passages
        None for points beyond the ends, several where the tube passes near itself or the point lies near
        the centre of a bend.
    """
    points = np.clip(points, -FARTHEST, FARTHEST)
    parts = list(_crossed(sweep, points))
    rows, index, part = (np.concatenate(each) for each in zip(*parts, strict=True))
    angles, ratios = in_section(sweep, points[rows], index, part)
    return Passages(rows, index + part, angles, ratios)


def inside(sweep: Sweep, points: FloatArray) -> BoolArray:
    """Tell which points (P, 3) some section holds on its way, (P,) array."""
    held = np.zeros(len(points), dtype=bool)
    for begin, some in cut(points, BLOCK):
        found = passages(sweep, some)
        held[begin + found.rows[found.inside]] = True
    return held


def most_central(sweep: Sweep, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Choose the passage of the least ratio for each point.

    A point that no section holds may also lie before the first plane or behind the last one; that end is
    chosen when the point is nearer to it, in multiples of the section's mean half-width, than to the centre
    of any section that passes through it.

    Parameters
    ----------
    sweep : Sweep
    points : (P, 3) array
        Finite places [m].

    Returns
    -------
    stations, angles, ratios : (P,) arrays
        [-], [rad], [-].
    """
    best = np.zeros((3, len(points)))
    for begin, block in cut(points, BLOCK):
        some = np.clip(block, -FARTHEST, FARTHEST)
        found = passages(sweep, some)
        held = np.zeros(len(some), dtype=bool)
        held[found.rows[found.inside]] = True
        ends, away = _beyond_ends(sweep, some, np.flatnonzero(~held))
        every = _joined([found, ends])
        order = np.lexsort((np.concatenate((found.ratios, away)), every.rows))
        rows, first = np.unique(every.rows[order], return_index=True)
        chosen = order[first]
        best[:, begin + rows] = every.stations[chosen], every.angles[chosen], every.ratios[chosen]
    return best[0], best[1], best[2]


def cut(points: FloatArray, size: int) -> Iterator[tuple[int, FloatArray]]:
    """Cut points (P, 3) into at least one part: where each begins, and the part itself."""
    for begin in range(0, max(len(points), 1), size):
        yield begin, points[begin : begin + size]


def at_once(sweep: Sweep) -> int:
    """Tell of how many points the distances to all planes stay in the processor's cache."""
    return max(CACHED // len(sweep.places), 1)


def heights(sweep: Sweep, points: FloatArray) -> FloatArray:
    """Signed distances (P, N) of points (P, 3) from the section planes [m]."""
    height = points @ sweep.planes[:3]
    height += sweep.planes[3]
    return height


def in_section(
    sweep: Sweep, points: FloatArray, index: IntArray, part: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Angles and ratios of points in given sections.

    Parameters
    ----------
    sweep : Sweep
    points : (C, 3) array
        Places; what they are off the plane does not count [m].
    index : (C,) integer array
        Stations from 0 to N - 2.
    part : (C,) array
        How far past the station, from 0 to 1 [-].

    Returns
    -------
    angles, ratios : (C,) arrays
        [rad], [-].
    """
    place = between(sweep.places, index, part)
    away = points - place[:, :3]
    x, y = (np.einsum("ij,ij->i", away, axis) for axis in (place[:, 3:6], place[:, 6:]))
    angles = np.arctan2(y, x)
    before = bins(angles, len(sweep.corners))[0]
    here, there = (_ray_ratio(sweep, rows, before, x, y) for rows in (index, index + 1))
    # Distances of the boundary are interpolated; these are one by them, in units of the point's own distance.
    mixed = (1.0 - part) * there + part * here
    return angles, here * there / np.maximum(mixed, 1e-300)


def ratios_in_plane(sweep: Sweep, rows: IntArray, x: FloatArray, y: FloatArray) -> FloatArray:
    """Ratios (C,) of points (x, y) [m] in the sections of stations `rows` (C,)."""
    return _ray_ratio(sweep, rows, bins(np.arctan2(y, x), len(sweep.corners))[0], x, y)


def edge_distance(sweep: Sweep, index: IntArray, part: FloatArray, angles: FloatArray) -> FloatArray:
    """Distances (C,) of the boundary from the centre, in directions (C,), in the sections of `in_section`."""
    x, y = np.cos(angles), np.sin(angles)
    before = bins(angles, len(sweep.corners))[0]
    here, there = (_ray_ratio(sweep, rows, before, x, y) for rows in (index, index + 1))
    return (1.0 - part) / here + part / there


def between(table: FloatArray, index: IntArray, part: FloatArray) -> FloatArray:
    """Rows (C, ...) of a table (N, ...) a part (C,) of the way from rows `index` to the next."""
    share = part.reshape(-1, *[1] * (table.ndim - 1))
    return table[index] * (1.0 - share) + table[index + 1] * share


def _crossed(sweep: Sweep, points: FloatArray) -> Iterator[tuple[IntArray, IntArray, FloatArray]]:
    """Which points planes pass through, after which stations, and which part of the way to the next."""
    for begin, some in cut(points, at_once(sweep)):
        height = heights(sweep, some)
        above, below = height > sweep.slack, height < -sweep.slack
        apart = (above[:, :-1] & above[:, 1:]) | (below[:, :-1] & below[:, 1:])
        rows, index = np.divmod(np.flatnonzero(~apart), sweep.last)
        before, after = height[rows, index], height[rows, index + 1]
        drop = before - after
        part = np.clip(before / np.where(drop == 0.0, 1.0, drop), 0.0, 1.0)
        yield rows + begin, index, part


def _beyond_ends(sweep: Sweep, points: FloatArray, rows: IntArray) -> tuple[Passages, FloatArray]:
    """The ends that rows of points (P, 3) lie beyond, and how far in multiples of the mean half-width."""
    ends: list[Passages] = []
    away: list[FloatArray] = []
    height = heights(sweep, points[rows])
    for beyond, index, part in (
        (-height[:, 0], 0, 0.0),
        (height[:, -1], sweep.last - 1, 1.0),
    ):
        off = np.flatnonzero(beyond > sweep.slack)
        station = np.full(off.size, index, dtype=np.intp)
        angles, ratios = in_section(sweep, points[rows[off]], station, np.full(off.size, part))
        ends.append(Passages(rows[off], np.full(off.size, index + part), angles, ratios))
        away.append(np.hypot(ratios, beyond[off] * sweep.narrowness[index + round(part)].mean()))
    return _joined(ends), np.concatenate(away)


def _ray_ratio(sweep: Sweep, rows: IntArray, before: IntArray, x: FloatArray, y: FloatArray) -> FloatArray:
    """Distances of (x, y) from the centres of sections by those of the edges after vertices `before`."""
    count = len(sweep.corners)
    after = (before + 1) % count
    past, short = edge_weights(sweep.corners, before, x, y)
    return past * sweep.narrowness[rows, after] + short * sweep.narrowness[rows, before]


def edge_weights(
    corners: FloatArray, before: IntArray, x: FloatArray, y: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Weights of the vertices after and before, with which (x, y) by the edge's distance is interpolated."""
    start, end = corners[before], corners[(before + 1) % len(corners)]
    step = np.sin(2.0 * np.pi / len(corners))
    return (start[:, 0] * y - start[:, 1] * x) / step, (x * end[:, 1] - y * end[:, 0]) / step


def _joined(parts: list[Passages]) -> Passages:
    return Passages(
        np.concatenate([part.rows for part in parts]),
        np.concatenate([part.stations for part in parts]),
        np.concatenate([part.angles for part in parts]),
        np.concatenate([part.ratios for part in parts]),
    )
