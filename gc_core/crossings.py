"""Where demonstrations cross the section planes: the effective points."""

from __future__ import annotations

import numpy as np

from gc_core.alignment import Alignment
from gc_core.arrays import BoolArray, FloatArray, IntArray
from gc_core.demonstration import Trimmed
from gc_core.frames import arc_length

KNOTS = 150
"""A demonstration is searched at this many of its samples, then refined on its polyline."""

SEARCH = 0.2
"""A crossing further along than this part of the demonstration belongs to another station [-]."""


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
    found = [
        _cut(
            demonstration.positions, _samples(demonstration, moments), alignment.aligned[j], normals, offsets
        )
        for j, (demonstration, moments) in enumerate(zip(demonstrations, alignment.moments, strict=True))
    ]
    points = np.stack([points for points, _ in found], axis=1)
    # Interpolation leaves a rounding error, projection none: all points are put exactly into the plane.
    height = np.einsum("ijk,ik->ij", points, normals) - offsets[:, None]
    return points - height[..., None] * normals[:, None, :], np.stack([missed for _, missed in found], axis=1)


def _samples(demonstration: Trimmed, moments: FloatArray) -> FloatArray:
    return np.interp(moments, demonstration.times, np.arange(len(demonstration.times), dtype=np.float64))


def _cut(
    path: FloatArray, samples: FloatArray, aligned: FloatArray, normals: FloatArray, offsets: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Crossings (N, 3) of one polyline (T, 3) with the planes, and which are missed."""
    stride = -(-(len(path) - 1) // KNOTS)
    knots = np.append(np.arange(0, len(path) - 1, stride), len(path) - 1)
    gone = arc_length(path[knots])
    wanted = np.interp(samples, knots, gone)
    ahead = normals @ path[knots].T > offsets[:, None]
    station, knot = np.divmod(np.flatnonzero(ahead[:, 1:] & ~ahead[:, :-1]), len(knots) - 1)
    away = np.abs(0.5 * (gone[knot] + gone[knot + 1]) - wanted[station])
    near = away <= SEARCH * gone[-1]
    knot, station, away = knot[near], station[near], away[near]
    # Sorted by station, then nearest first: the first of each station is the one to take.
    order = np.lexsort((away, station))
    taken, first = np.unique(station[order], return_index=True)
    best = knot[order[first]]
    points = _ends(path, aligned, normals, offsets, part=wanted / gone[-1])
    points[taken] = _refined(path, knots[best], knots[best + 1], normals[taken], offsets[taken])
    missed = np.ones(len(normals), dtype=bool)
    missed[taken] = False
    return points, missed


def _refined(
    path: FloatArray, low: IntArray, high: IntArray, normals: FloatArray, offsets: FloatArray
) -> FloatArray:
    """Halve the brackets low..high (K,) of sample numbers to one piece, then interpolate on it."""
    while int((high - low).max(initial=0)) > 1:
        middle = (low + high) // 2
        ahead = np.einsum("ij,ij->i", path[middle], normals) > offsets
        wide = high - low > 1
        low, high = np.where(wide & ~ahead, middle, low), np.where(wide & ahead, middle, high)
    before = offsets - np.einsum("ij,ij->i", path[low], normals)
    step = np.einsum("ij,ij->i", path[high] - path[low], normals)
    part = np.clip(before / np.where(step > 0.0, step, 1.0), 0.0, 1.0)[:, None]
    return path[low] * (1.0 - part) + path[high] * part


def _ends(
    path: FloatArray, aligned: FloatArray, normals: FloatArray, offsets: FloatArray, *, part: FloatArray
) -> FloatArray:
    """Places (N, 3) to use where a plane is missed: the end that it lies beyond, else the aligned place.

    `part` (N,) says how far along the demonstration the aligned places are, from 0 to 1.
    """
    ahead = np.einsum("ij,ij->i", aligned, normals) > offsets
    starts_late = (ahead & (part <= SEARCH))[:, None]
    ends_early = (~ahead & (part >= 1.0 - SEARCH))[:, None]
    return np.where(starts_late, path[0], np.where(ends_early, path[-1], aligned))
