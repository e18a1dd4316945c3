"""Where demonstrations cross the section planes: the effective points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gc_core.alignment import Alignment
from gc_core.arrays import BoolArray, FloatArray, IntArray, interpolated
from gc_core.demonstration import Trimmed
from gc_core.frames import arc_length

KNOTS = 150
"""A demonstration is searched at this many of its samples, then refined on its polyline."""

SEARCH = 0.2
"""A crossing further along than this part of the demonstration belongs to another station [-]."""


@dataclass(frozen=True, eq=False)
class _Lines:
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


def effective_points(
    demonstrations: tuple[Trimmed, ...], alignment: Alignment, normals: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Cut every demonstration with every section plane.

    Among the crossings in the direction of travel, the one nearest in arc length to the place that
    corresponds by the alignment is taken. Where a demonstration starts after the plane, or ends before it,
    its end is projected onto the plane and the miss is reported.

    Parameters
    ----------
    demonstrations : tuple of n Trimmed
    alignment : Alignment
        Of these demonstrations at N stations; the planes go through its directrix.
    normals : (N, 3) array
        Unit normals of the planes [-].

    Returns
    -------
    points : (N, n, 3) array
        In the planes [m].
    missed : (N, n) array of bool
        Where a demonstration does not cross the plane near its station.
    """
    offsets = np.einsum("ij,ij->i", alignment.directrix, normals)
    lines = _lines(demonstrations, alignment)
    points = _ends(lines, alignment.aligned, normals, offsets)
    station, knot = _nearest_crossings(lines, normals, offsets)
    whose = lines.owner[knot]
    low, high = lines.knots[knot], lines.knots[knot + 1]
    points[station, whose] = _refined(lines.path, low, high, normals[station], offsets[station])
    missed = np.ones(points.shape[:2], dtype=bool)
    missed[station, whose] = False
    # Interpolation leaves a rounding error, projection none: all points are put exactly into the plane.
    height = (points @ normals[:, :, None])[..., 0] - offsets[:, None]
    return points - height[..., None] * normals[:, None, :], missed


def _lines(demonstrations: tuple[Trimmed, ...], alignment: Alignment) -> _Lines:
    counts = np.array([len(demonstration.positions) for demonstration in demonstrations])
    begins = np.cumsum(counts) - counts
    chosen: list[IntArray] = []
    gone: list[FloatArray] = []
    wanted: list[FloatArray] = []
    for demonstration, moments in zip(demonstrations, alignment.moments, strict=True):
        last = len(demonstration.positions) - 1
        knots: IntArray = np.array([*range(0, last, -(-last // KNOTS)), last], dtype=np.intp)
        chosen.append(knots)
        gone.append(arc_length(demonstration.positions[knots]))
        sample = interpolated(moments, demonstration.times, np.arange(last + 1, dtype=np.float64))
        wanted.append(interpolated(sample, knots.astype(np.float64), gone[-1]))
    owner = np.repeat(np.arange(len(counts)), [len(knots) for knots in chosen])
    return _Lines(
        path=np.concatenate([demonstration.positions for demonstration in demonstrations]),
        ends=np.stack((begins, begins + counts - 1), axis=1),
        knots=np.concatenate(chosen) + begins[owner],
        owner=owner,
        gone=np.concatenate(gone),
        lengths=np.array([length[-1] for length in gone]),
        wanted=np.array(wanted),
    )


def _nearest_crossings(lines: _Lines, normals: FloatArray, offsets: FloatArray) -> tuple[IntArray, IntArray]:
    """Stations (C,) and the knots before a crossing (C,): at most one for each demonstration and station."""
    behind = normals @ lines.path[lines.knots].T <= offsets[:, None]
    forward = behind[:, :-1] > behind[:, 1:]
    forward[:, np.flatnonzero(np.diff(lines.owner))] = False
    station, knot = np.divmod(np.flatnonzero(forward), forward.shape[1])
    whose = lines.owner[knot]
    away = np.abs(0.5 * (lines.gone[knot] + lines.gone[knot + 1]) - lines.wanted[whose, station])
    near = np.flatnonzero(away <= SEARCH * lines.lengths[whose])
    station, knot, away = station[near], knot[near], away[near]
    place = station * len(lines.lengths) + whose[near]
    # Sorted by station and demonstration, then nearest first: the first of each is the one to take.
    order = np.lexsort((away, place))
    taken = order[np.flatnonzero(np.diff(place[order], prepend=-1))]
    return station[taken], knot[taken]


def _refined(
    path: FloatArray, low: IntArray, high: IntArray, normals: FloatArray, offsets: FloatArray
) -> FloatArray:
    """Halve the brackets low..high (K,) of sample numbers to one piece, then interpolate on it."""
    while int((high - low).max(initial=0)) > 1:
        middle = (low + high) // 2
        ahead = np.einsum("ij,ij->i", path[middle], normals) > offsets
        # A bracket of one piece has its middle at its low end, which is not ahead.
        low, high = np.where(ahead, low, middle), np.where(ahead, middle, high)
    before = offsets - np.einsum("ij,ij->i", path[low], normals)
    step = np.einsum("ij,ij->i", path[high] - path[low], normals)
    part = np.clip(before / np.where(step > 0.0, step, 1.0), 0.0, 1.0)[:, None]
    return path[low] * (1.0 - part) + path[high] * part


def _ends(lines: _Lines, aligned: FloatArray, normals: FloatArray, offsets: FloatArray) -> FloatArray:
    """Places (N, n, 3) where a plane is missed: the end that it lies beyond, else the aligned place."""
    places = np.swapaxes(aligned, 0, 1)
    ahead = (places @ normals[:, :, None])[..., 0] > offsets[:, None]
    # Only a motion that returns to one place at every knot has no length.
    part = (lines.wanted / np.maximum(lines.lengths, np.finfo(float).tiny)[:, None]).T
    starts_late = (ahead & (part <= SEARCH))[..., None]
    ends_early = (~ahead & (part >= 1.0 - SEARCH))[..., None]
    first, last = lines.path[lines.ends[:, 0]], lines.path[lines.ends[:, 1]]
    return np.where(starts_late, first, np.where(ends_early, last, places))
