"""Where a start joins the tube: which station, in which direction, and at which ratio."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gc_core.arrays import BoolArray, FloatArray, IntArray, interpolated
from gc_core.cylinder import GeneralizedCylinder
from gc_core.errors import InvalidSettingError
from gc_core.location import Passages, at_once, cut, in_section, passages

LATER = 0.05
"""A start outside joins a later station only when it lies beyond this part of the directrix [-]."""

CLEARLY_NEARER = 0.7
"""... and is nearer to that station than this part of its distance to station 0 [-]."""

LAST_PART = 1e-3
"""A start in the last plane joins this much before it: a run has two samples at least [stations]."""


TIE = 1e-9
"""A passage so near to where the search ends lies beyond it, lest rounding decide [stations]."""


@dataclass(frozen=True, eq=False)
class Joins:
    """Where S starts join the tube."""

    stations: FloatArray
    """(S,) fractional [-]."""
    angles: FloatArray
    """(S,) from N to B [rad]."""
    ratios: FloatArray
    """(S,) of the start in that section's plane [-]."""
    inside: BoolArray
    """(S,) whether any section holds the start."""
    projected: BoolArray
    """(S,) whether the start lies off that plane."""


def joins_of(cylinder: GeneralizedCylinder, starts: FloatArray, at: float | None) -> Joins:
    """Find where starts join.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
    starts : (S, 3) array
        Finite places [m].
    at : float or None
        A station for all, rounded. None: the first section that holds the start; where none does, the first
        station, or the nearest when that is clearly later and nearer and leaves as much of the way
        as the start is away from it.

    Returns
    -------
    Joins
        A section that passes through the start within one station of the chosen one is joined
        there; without one, the start is projected.

    Raises
    ------
    InvalidSettingError
        If there is no such station.
    """
    last = cylinder.sweep.last
    if at is not None and not 0.0 <= at <= last - 1:
        raise InvalidSettingError("at", at, f"a station from 0 to {last - 1}")
    found = passages(cylinder.sweep, starts)
    holding = np.flatnonzero(found.inside)
    inside = np.zeros(len(starts), dtype=bool)
    inside[found.rows[holding]] = True
    if at is None:
        passage = np.full(len(starts), -1, dtype=np.intp)
        rows, first = np.unique(found.rows[holding], return_index=True)
        passage[rows] = holding[first]
        index = np.zeros(len(starts), dtype=np.intp)
        if not inside.all():
            index[~inside] = entrances(cylinder, starts[~inside])
            passage = np.where(inside, passage, _nearest(found, index, back=1.0))
    else:
        index = np.full(len(starts), round(at), dtype=np.intp)
        passage = _nearest(found, index, back=0.0)
    return _joins(cylinder, starts, found, passage, index=index, inside=inside)


def entrances(cylinder: GeneralizedCylinder, starts: FloatArray) -> IntArray:
    """Stations (P,) at which starts (P, 3) outside of the tube join."""
    middle = cylinder.directrix.mean(axis=0)
    centres, gone = cylinder.directrix - middle, cylinder.arc_length
    index = np.zeros(len(starts), dtype=np.intp)
    for begin, some in cut(starts, at_once(cylinder.sweep)):
        near = some - middle
        square = (near * near).sum(axis=1)[:, None] + (centres * centres).sum(axis=1) - 2.0 * near @ centres.T
        nearest = np.argmin(square, axis=1)
        least = np.sqrt(np.maximum(square[np.arange(len(some)), nearest], 0.0))
        later = gone[nearest] > LATER * gone[-1]
        later &= least < CLEARLY_NEARER * np.sqrt(np.maximum(square[:, 0], 0.0))
        # The last station that leaves as much of the way as the start is away.
        latest = interpolated(gone[-1] - least, gone, np.arange(len(gone), dtype=np.float64)).astype(np.intp)
        station = np.minimum(np.minimum(nearest, latest), len(centres) - 2)
        index[begin : begin + len(some)] = np.where(later, station, 0)
    return index


def _nearest(found: Passages, index: IntArray, back: float) -> IntArray:
    """For each of S starts, its passage nearest to station `index` (S,), less than one after it; or -1."""
    past = found.stations - index[found.rows]
    near = np.flatnonzero((past < 1.0 - TIE) & (past >= (TIE - back if back else -TIE)))
    order = near[np.lexsort((np.abs(past[near]), found.rows[near]))]
    rows, first = np.unique(found.rows[order], return_index=True)
    chosen = np.full(len(index), -1, dtype=np.intp)
    chosen[rows] = order[first]
    return chosen


def _joins(
    cylinder: GeneralizedCylinder,
    starts: FloatArray,
    found: Passages,
    passage: IntArray,
    *,
    index: IntArray,
    inside: BoolArray,
) -> Joins:
    """Join at a passage; where that is -1, after projection onto the plane of station `index`."""
    projected = passage < 0
    stations, angles, ratios = np.zeros((3, len(starts)))
    met, off = passage[~projected], np.flatnonzero(projected)
    stations[~projected] = found.stations[met]
    angles[~projected] = found.angles[met]
    ratios[~projected] = found.ratios[met]
    stations[off] = index[off]
    angles[off], ratios[off] = in_section(cylinder.sweep, starts[off], index[off], np.zeros(off.size))
    whole = np.rint(stations)
    stations = np.where(np.abs(stations - whole) <= TIE, whole, stations)  # else two samples in one place
    latest = cylinder.sweep.last - LAST_PART
    return Joins(np.minimum(stations, latest), angles, ratios, inside, projected)
