"""Where demonstrations cross the section planes: the effective points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gc_core.alignment import Alignment
from gc_core.arrays import BoolArray, FloatArray, IntArray, interpolated, read_only, remembered
from gc_core.demonstration import Trimmed
from gc_core.frames import arc_length

KNOTS = 100
"""A demonstration is searched at this many of its samples, then refined on its polyline."""

SEARCH = 0.35
"""A crossing further along than this part of the demonstration belongs to another station [-]."""


ON_PLANE = 1e-9
"""An end this near to a plane lies on it: part of the demonstration's length [-]."""


@dataclass(frozen=True, eq=False)
class Lines:
    """All n demonstrations, one behind the other in one array: one search for all costs least."""

    path: FloatArray
    """(T, 3) places [m]."""
    ends: IntArray
    """(n, 2) first and last sample of each."""
    knots: IntArray
    """(K,) samples at which they are searched."""
    owner: IntArray
    """(K,) demonstration of each knot."""
    gone: FloatArray
    """(K,) length along its demonstration [m]."""
    lengths: FloatArray
    """(n,) of the demonstrations [m]."""
    wanted: FloatArray
    """(n, N) length along a demonstration up to the place that corresponds to a station [m]."""
    directrix: FloatArray
    """(N, 3) the planes go through it [m]."""


def effective_points(lines: Lines, normals: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Cut every demonstration with every section plane.

    Among the crossings in the direction of travel, the one nearest in arc length to the place that
    corresponds by the alignment is taken. A demonstration that begins on the plane or ahead of it crosses it
    at its beginning, one that ends on it or behind it at its end: so that a crossing does not jump when the
    plane passes an end. Where there is nothing near, the nearest approach is taken. All three are projected
    onto the plane, and reported if that moves them.

    Parameters
    ----------
    lines : Lines
        Of n demonstrations, to be cut at N stations.
    normals : (N, 3) array
        Unit normals of the planes [-].

    Returns
    -------
    points : (N, n, 3) array
        In the planes [m].
    missed : (N, n) array of bool
        Where a demonstration does not cross the plane near its station.
    """
    offsets = np.einsum("ij,ij->i", lines.directrix, normals)
    heights = _heights(np.take(lines.path, lines.knots, axis=0), normals, offsets)
    points, away = _ends(lines, heights)
    station, knot = _nearest_crossings(lines, heights <= 0.0, away)
    whose = lines.owner[knot]
    low, high = lines.knots[knot], lines.knots[knot + 1]
    planes = np.take(normals, station, axis=0), np.take(offsets, station)
    points[station, whose] = _refined(lines.path, low, high, *planes)
    missed = np.ones(points.shape[:2], dtype=bool)
    missed[station, whose] = False
    lost = missed & (away > SEARCH * lines.lengths)
    for j in np.flatnonzero(lost.any(axis=0)):
        rows = np.flatnonzero(lost[:, j])
        points[rows, j] = _nearest_approach(lines, int(j), rows, normals, offsets)
    # Interpolation leaves a rounding error, projection none: all points are put exactly into the plane.
    height = (points @ normals[:, :, None])[..., 0] - offsets[:, None]
    missed &= np.abs(height) > ON_PLANE * lines.lengths
    return points - height[..., None] * normals[:, None, :], missed


def lines_of(demonstrations: tuple[Trimmed, ...], alignment: Alignment) -> Lines:
    """Lay out demonstrations for a search of their crossings.

    Parameters
    ----------
    demonstrations : tuple of n Trimmed
    alignment : Alignment
        Of these demonstrations at N stations; the planes will go through its directrix.

    Returns
    -------
    Lines
    """
    counts = np.array([len(demonstration.positions) for demonstration in demonstrations])
    begins = np.cumsum(counts) - counts
    chosen: list[IntArray] = []
    gone: list[FloatArray] = []
    wanted: list[FloatArray] = []
    for demonstration, moments in zip(demonstrations, alignment.moments, strict=True):
        knots, length = _knots(demonstration)
        chosen.append(knots)
        gone.append(length)
        sample = interpolated(moments, demonstration.times, np.arange(knots[-1] + 1, dtype=np.float64))
        wanted.append(interpolated(sample, knots.astype(np.float64), length))
    owner = np.repeat(np.arange(len(counts)), [len(knots) for knots in chosen])
    return Lines(
        path=np.concatenate([demonstration.positions for demonstration in demonstrations]),
        ends=np.stack((begins, begins + counts - 1), axis=1),
        knots=np.concatenate(chosen) + begins[owner],
        owner=owner,
        gone=np.concatenate(gone),
        lengths=np.array([length[-1] for length in gone]),
        wanted=np.array(wanted),
        directrix=alignment.directrix,
    )


def _heights(places: FloatArray, normals: FloatArray, offsets: FloatArray) -> FloatArray:
    """Heights (N, K) of places (K, 3) over planes of normals (N, 3) at offsets (N,) from the origin [m]."""
    # In one product: to subtract afterwards takes three times as long.
    planes = np.concatenate((normals, -offsets[:, None]), axis=1)
    return planes @ np.concatenate((places.T, np.ones((1, len(places)))))


@remembered
def _knots(demonstration: Trimmed) -> tuple[IntArray, FloatArray]:
    """Samples (K,) of a demonstration at which it is searched, and its length up to them (K,) [m]."""
    last = len(demonstration.positions) - 1
    knots: IntArray = np.array([*range(0, last, -(-last // KNOTS)), last], dtype=np.intp)
    return read_only(knots), read_only(arc_length(demonstration.positions[knots]))


def _ends(lines: Lines, heights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """End (N, n, 3) that does not lie beyond a plane, and its distance (N, n) along the demonstration.

    The distance is from the place that corresponds, infinite where both ends lie beyond. `heights` (N, K) are
    those of the knots over the planes. An end on a plane counts: where demonstrations end in one place,
    rounding would else choose between it and a crossing before.
    """
    begins = np.flatnonzero(np.diff(lines.owner, prepend=-1))
    on_plane = ON_PLANE * lines.lengths
    late = heights[:, begins] >= -on_plane
    early = heights[:, np.append(begins[1:], len(lines.owner)) - 1] <= on_plane
    from_first = np.where(late, lines.wanted.T, np.inf)
    from_last = np.where(early, lines.lengths - lines.wanted.T, np.inf)
    first, last = lines.path[lines.ends[:, 0]], lines.path[lines.ends[:, 1]]
    points = np.where((from_first <= from_last)[..., None], first, last)
    return points, np.minimum(from_first, from_last)


def _nearest_crossings(lines: Lines, behind: BoolArray, nearer_than: FloatArray) -> tuple[IntArray, IntArray]:
    """Stations (C,) and the knots before a crossing (C,): at most one for each demonstration and station."""
    forward = behind[:, :-1] > behind[:, 1:]
    forward[:, np.flatnonzero(np.diff(lines.owner))] = False
    station, knot = np.divmod(np.flatnonzero(forward), forward.shape[1])
    whose = lines.owner[knot]
    away = np.abs(0.5 * (lines.gone[knot] + lines.gone[knot + 1]) - lines.wanted[whose, station])
    near = np.flatnonzero(away <= np.minimum(SEARCH * lines.lengths[whose], nearer_than[station, whose]))
    station, knot, away = station[near], knot[near], away[near]
    place = station * len(lines.lengths) + whose[near]
    # Sorted by station and demonstration, then nearest first: the first of each is the one to take.
    order = np.lexsort((away, place))
    taken = order[np.flatnonzero(np.diff(place[order], prepend=-1))]
    return station[taken], knot[taken]


def _nearest_approach(
    lines: Lines, j: int, rows: IntArray, normals: FloatArray, offsets: FloatArray
) -> FloatArray:
    """Knot (K, 3) of demonstration j that comes nearest to the planes `rows` (K,) within the search."""
    mine = lines.owner == j
    path, gone = lines.path[lines.knots[mine]], lines.gone[mine]
    height = np.abs(_heights(path, normals[rows], offsets[rows]))
    far = np.abs(gone - lines.wanted[j, rows, None]) > SEARCH * lines.lengths[j]
    return path[np.argmin(np.where(far, np.inf, height), axis=1)]


def _refined(
    path: FloatArray, low: IntArray, high: IntArray, normals: FloatArray, offsets: FloatArray
) -> FloatArray:
    """Halve the brackets low..high (K,) of sample numbers to one piece, then interpolate on it."""
    while int((high - low).max(initial=0)) > 1:
        middle = (low + high) // 2
        ahead = np.einsum("ij,ij->i", np.take(path, middle, axis=0), normals) > offsets
        # A bracket of one piece has its middle at its low end, which is not ahead.
        low, high = np.where(ahead, low, middle), np.where(ahead, middle, high)
    begin, end = np.take(path, low, axis=0), np.take(path, high, axis=0)
    before = offsets - np.einsum("ij,ij->i", begin, normals)
    step = np.einsum("ij,ij->i", end - begin, normals)
    part = np.clip(before / np.where(step > 0.0, step, 1.0), 0.0, 1.0)[:, None]
    return begin * (1.0 - part) + end * part
