"""The ratio rule for many starts at once: the one place that writes the samples of runs.

Starts are done in parts small enough for the processor's cache, one coordinate after the other.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from gc_core.arrays import FloatArray, IntArray, fading, read_only
from gc_core.cylinder import GeneralizedCylinder
from gc_core.joining import Joins
from gc_core.location import CACHED, Sweep, between, edge_distance, edge_weights, ratios_in_plane
from gc_core.radius import bins

JOIN_LENGTH = 0.1
"""An offset fades out over at least this part of the directrix, if so much is left [-]."""

CALM = 2.0
"""... and over at least this many times its size, if so much is left [-]."""

HURRIED = 0.5
"""... but with less than a tenth of the directrix left never over less than this many times its size [-]."""

ROUNDING = 1e-12
"""Offsets up to this part of the length are none [-]."""


@dataclass(frozen=True, eq=False)
class Way:
    """What S runs have before them."""

    starts: FloatArray
    """(S, 3) [m]."""
    stations: FloatArray
    """(S,) where they join [-]."""
    begin: FloatArray
    """(S,) arc length there [m]."""
    angles: FloatArray
    """(S,) from N to B [rad]."""
    ratios: FloatArray
    """(S,) of the starts [-]."""
    kept: FloatArray
    """(S,) with which the rule begins [-]."""
    final: FloatArray
    """(S,) with which it ends [-]."""
    offsets: FloatArray
    """(S, 3) of the starts from where the rule begins [m]."""
    reach: FloatArray
    """(S,) arc length over which these fade out; 0: there are none [m]."""

    def part(self, some: slice) -> Way:
        """Some of the runs."""
        return Way(*(getattr(self, field.name)[some] for field in fields(self)))


@dataclass(frozen=True, eq=False)
class _Stretch:
    """The part of the tube that is run through, at the stations from the earliest join on."""

    stations: FloatArray
    """(K,) of which only the first may be fractional [-]."""
    gone: FloatArray
    """(K,) arc length [m]."""
    centres: FloatArray
    """(3, K) coordinates of the centres [m]."""
    axes: FloatArray
    """(3, 2, K) coordinates of the first and the second axis [-]."""
    narrowness: FloatArray
    """(M, K) one by the distances of the vertices [1/m]."""


def way_of(
    cylinder: GeneralizedCylinder, starts: FloatArray, joins: Joins, kept: FloatArray, final: FloatArray
) -> Way:
    """Find what starts (S, 3) are off the rule's path where they join, and how slowly that fades out."""
    gone = cylinder.arc_length
    begin = np.interp(joins.stations, np.arange(len(gone)), gone)
    # Where a section passes through the start itself, only rounding is left.
    off = np.flatnonzero(joins.projected | (kept != joins.ratios))
    offsets, reach = np.zeros_like(starts), np.zeros(len(starts))
    if off.size:
        offsets[off] = starts[off] - _rule_begins(cylinder, joins.stations[off], joins.angles[off], kept[off])
        reach[off] = _reach(offsets[off], gone[-1] - begin[off], gone[-1])
    return Way(
        starts, joins.stations, begin, joins.angles, joins.ratios, kept, final, offsets=offsets, reach=reach
    )


def _rule_begins(
    cylinder: GeneralizedCylinder, stations: FloatArray, angles: FloatArray, ratios: FloatArray
) -> FloatArray:
    """Positions (S, 3) of the ratio rule at single stations (S,)."""
    index = np.minimum(stations.astype(np.intp), cylinder.sweep.last - 1)
    part = stations - index
    place = between(cylinder.sweep.places, index, part)
    across = np.cos(angles)[:, None] * place[:, 3:6] + np.sin(angles)[:, None] * place[:, 6:]
    return place[:, :3] + (ratios * edge_distance(cylinder.sweep, index, part, angles))[:, None] * across


def _reach(offsets: FloatArray, left: FloatArray, length: float) -> FloatArray:
    """Arc lengths (S,) over which offsets (S, 3) fade out, with so much left (S,) of the whole."""
    size = np.sqrt(np.einsum("ij,ij->i", offsets, offsets))
    tenth = JOIN_LENGTH * length
    reach = np.minimum(np.maximum(CALM * size, tenth), left)
    reach = np.maximum(reach, np.minimum(HURRIED * size, tenth))
    return np.where(size > ROUNDING * length, reach, 0.0)


def runs(cylinder: GeneralizedCylinder, way: Way, stations: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Follow the ratio rule from the starts.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
    way : Way
        Of S runs.
    stations : (K,) array
        The earliest join, and all whole stations after it [-].

    Returns
    -------
    positions : (S, K, 3) array
        Read-only. A run is at its start up to its join [m].
    ratios : (S, K) array
        Read-only. Of these positions in the planes of the stations; up to the join, that of the start [-].
    """
    sweep, low = cylinder.sweep, int(stations[0])
    gone = np.interp(stations, np.arange(len(cylinder.arc_length)), cylinder.arc_length)
    places = sweep.places[low:].T.copy()
    axes = np.stack((places[3:6], places[6:]), axis=1)
    stretch = _Stretch(stations, gone, places[:3], axes, sweep.narrowness[low:].T.copy())
    shape = (len(way.starts), len(stations))
    positions = np.empty((*shape, 3))
    stay = not way.reach.any() and np.array_equal(way.kept, way.final)
    ratios = np.broadcast_to(read_only(way.kept)[:, None], shape) if stay else np.empty(shape)
    size = max(CACHED // shape[1], 1)
    for begin in range(0, shape[0], size):
        some = slice(begin, begin + size)
        part = _some_runs(sweep, stretch, way.part(some), out=np.moveaxis(positions[some], 2, 0))
        if not stay:
            ratios[some] = part
    positions.setflags(write=False)
    ratios.setflags(write=False)
    return positions, ratios


def _some_runs(sweep: Sweep, stretch: _Stretch, way: Way, *, out: FloatArray) -> FloatArray:
    """Ratios (S, K) or (S, 1); writes the coordinates (3, S, K)."""
    ratios = _ratios(stretch, way)
    _rule(sweep, stretch, way.angles, ratios, out=out)
    waiting = stretch.stations <= way.stations[:, None] + 1e-9
    waiting[:, 0] = True
    off = np.flatnonzero(way.reach)
    if off.size:
        part = (stretch.gone - way.begin[off, None]) / way.reach[off, None]
        left = np.where(waiting[off], 0.0, fading(np.minimum(part, 1.0)))
        coordinates = out[:, off] + left * way.offsets[off].T[:, :, None]
        out[:, off] = coordinates
        rows, columns = np.nonzero(left)
        ratios = np.where(waiting, way.ratios[:, None], ratios)
        ratios[off[rows], columns] = _ratios_of(sweep, stretch, coordinates, rows, columns)
    late = waiting[:, 1:].any()
    for axis in range(3):
        out[axis, :, 0] = way.starts[:, axis]
        if late:
            np.copyto(out[axis], way.starts[:, axis, None], where=waiting)
    return ratios


def _ratios(stretch: _Stretch, way: Way) -> FloatArray:
    """Ratios of the rule: (S, K), or (S, 1) where they stay."""
    if np.array_equal(way.kept, way.final):
        return way.kept[:, None]
    gone, begin = stretch.gone, way.begin[:, None]
    part = np.clip((gone - begin) / np.maximum(gone[-1] - begin, 1e-12), 0.0, 1.0)
    return way.final[:, None] + (way.kept - way.final)[:, None] * fading(part)


def _rule(
    sweep: Sweep, stretch: _Stretch, angles: FloatArray, ratios: FloatArray, *, out: FloatArray
) -> None:
    """Write the coordinates (3, S, K) of the ratio rule."""
    before = bins(angles, len(sweep.corners))[0]
    along = np.stack((np.cos(angles), np.sin(angles)), axis=1)
    past, short = edge_weights(sweep.corners, before, along[:, 0], along[:, 1])
    distance = past[:, None] * stretch.narrowness[(before + 1) % len(sweep.corners)]
    distance += short[:, None] * stretch.narrowness[before]
    np.divide(ratios, distance, out=distance)
    across = np.empty_like(distance)
    for axis in range(3):
        np.matmul(along, stretch.axes[axis], out=across)
        across *= distance
        np.add(across, stretch.centres[axis], out=out[axis])


def _ratios_of(
    sweep: Sweep, stretch: _Stretch, coordinates: FloatArray, rows: IntArray, columns: IntArray
) -> FloatArray:
    """Ratios (E,) of some of the coordinates (3, S, K) in the planes of their stations."""
    away = coordinates - stretch.centres[:, None]
    x, y = (np.einsum("csk,ck->sk", away, stretch.axes[:, axis])[rows, columns] for axis in range(2))
    return ratios_in_plane(sweep, int(stretch.stations[0]) + columns, x, y)
