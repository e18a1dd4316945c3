"""The ratio rule: cylinder + start -> a new run.

A run keeps its direction in the moving frame and its ratio to the boundary. It always begins
at the start itself, wherever that is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from gc_core.arrays import BoolArray, FloatArray, IntArray, finite, read_only_fields
from gc_core.cylinder import ON_BOUNDARY, GeneralizedCylinder
from gc_core.demonstration import sign_continuous
from gc_core.errors import InvalidSettingError, UnknownOptionError
from gc_core.radius import bins, chord_radius

LAWS = ("fixed", "convergent")
"""How the ratio goes on: kept, or eased to a final value at the end."""

OUTSIDE = ("keep", "boundary", "directrix")
"""What a start outside of the tube does: keep its ratio, or be led to the boundary or the middle."""

_HIGHEST_RATIO = {"keep": float("inf"), "boundary": 1.0, "directrix": 0.0}

LATER = 0.05
"""A start joins a later station only when it lies beyond this part of the directrix [-]."""

CLEARLY_NEARER = 0.7
"""... and, outside of the tube, is nearer to that station than this part of its distance to station 0 [-]."""

LAST_PART = 1e-3
"""A start in the last plane joins this much before it [stations]."""

JOIN_LENGTH = 0.1
"""A start off its section plane is joined over this part of the directrix, or twice its offset [-]."""


@dataclass(frozen=True, eq=False)
class Reproduction:
    """A new run, or S runs at once."""

    positions: FloatArray
    """(K, 3) or (S, K, 3) tool tip; the first is the start [m]."""
    times: FloatArray
    """(K,) from 0 [s]."""
    stations: FloatArray
    """(K,) stations of the cylinder; the first may be fractional [-]."""
    ratios: FloatArray
    """(K,) or (S, K) ratio eta at each station [-]."""
    orientations: FloatArray | None
    """(K, 4) w, x, y, z, or None."""
    gripper: FloatArray | None
    """(K,) or None."""
    start_inside: bool | BoolArray
    """Whether the start lies in the tube; (S,) for S runs."""
    law: str = "fixed"
    """Law of the ratio."""

    def __post_init__(self) -> None:
        read_only_fields(self)


@dataclass(frozen=True, eq=False)
class _Joins:
    """Where S starts join the tube."""

    stations: FloatArray
    angles: FloatArray
    ratios: FloatArray
    inside: BoolArray


def reproduce(
    cylinder: GeneralizedCylinder,
    start: ArrayLike,
    *,
    law: str = "fixed",
    final_ratio: float = 0.0,
    at: float | None = None,
    outside: str = "keep",
) -> Reproduction:
    """Run the skill from a new start.

    A start inside the tube joins where it lies (first passage). A start outside joins at station 0, or at the
    nearest station when that is clearly later and nearer; what it is off that section's plane fades
    out smoothly.
    Several starts share the stations from the earliest join on; a run that joins later waits at its start.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
    start : (3,) or (S, 3) array
        Where to begin: inside, at the centre, outside or off the planes [m].
    law : {"fixed", "convergent"}
        Keep the ratio, or ease it (C1 in arc length) to `final_ratio` at the end.
    final_ratio : float
        For "convergent": ratio at the end, at least 0; smaller ratios are kept [-].
    at : float or None
        Station at which to join, from 0 to N - 2 and rounded, in place of the choice above.
    outside : {"keep", "boundary", "directrix"}
        What starts outside of the tube do: keep their ratio, which leads far away where the first slice is
        narrow and a later one wide; or be led smoothly to the boundary or to the directrix, over a
        tenth of the length or twice the way that is to be made up.

    Returns
    -------
    Reproduction
        Finite; inside the tube from its first sample on when the start is.

    Raises
    ------
    ShapeError, NotFiniteError
        If the start is no finite place.
    UnknownOptionError, InvalidSettingError
        If the law, the final ratio or the station do not exist.

    Notes
    -----
    p_i = c_i + eta R_i(theta) (cos theta N_i + sin theta B_i), theta fixed in the moving frame [1]_, Eq. 8,
    with the unit direction and the centre that are missing there.

    References
    ----------
    .. [1] S. R. Ahmadzadeh, M. A. Rana, S. Chernova. Generalized Cylinders for Learning, Reproduction,
       Generalization, and Refinement of Robot Skills. RSS 2017. doi:10.15607/RSS.2017.XIII.021
    """
    if law not in LAWS:
        raise UnknownOptionError("law", law, LAWS)
    if outside not in OUTSIDE:
        raise UnknownOptionError("outside", outside, OUTSIDE)
    if not 0.0 <= final_ratio < np.inf:
        raise InvalidSettingError("final_ratio", final_ratio, "a ratio of at least 0")
    single = np.ndim(start) == 1
    starts = finite(start, "start", (3,))[None] if single else finite(start, "start", (None, 3))
    joins = _joined_at(cylinder, starts, at) if at is not None else _joined(cylinder, starts)
    led = ~joins.inside & (joins.ratios > _HIGHEST_RATIO[outside])
    joins = replace(joins, ratios=np.where(led, _HIGHEST_RATIO[outside], joins.ratios))
    first = float(joins.stations.min()) if len(starts) else 0.0
    stations = np.concatenate(([first], np.arange(int(first) + 1.0, len(cylinder.directrix))))
    gone = np.interp(stations, np.arange(len(cylinder.directrix)), cylinder.arc_length)
    begin = np.interp(joins.stations, np.arange(len(cylinder.directrix)), cylinder.arc_length)
    ratios = _ratios(joins.ratios, law, final_ratio, gone, begin)
    runs = _runs(cylinder, stations, joins.angles, ratios)
    positions = _begun_at(
        starts, runs, stations, joins.stations, gone=gone, length=float(cylinder.arc_length[-1])
    )
    if led.any():
        ratios[led] = _ratios_of(cylinder, positions[led], stations)
    return _reproduction(cylinder, stations, positions, ratios, inside=joins.inside, law=law, single=single)


def _reproduction(
    cylinder: GeneralizedCylinder,
    stations: FloatArray,
    positions: FloatArray,
    ratios: FloatArray,
    *,
    inside: BoolArray,
    law: str,
    single: bool,
) -> Reproduction:
    times = np.interp(stations, np.arange(len(cylinder.times)), cylinder.times)
    low = int(stations[0])
    orientations = cylinder.orientations
    if orientations is not None:
        part = stations[0] - low
        begin = orientations[low] * (1.0 - part) + orientations[min(low + 1, len(orientations) - 1)] * part
        orientations = np.concatenate((begin[None] / np.linalg.norm(begin), orientations[low + 1 :]))
        orientations = sign_continuous(orientations)
    return Reproduction(
        positions=positions[0] if single else positions,
        times=times - times[0],
        stations=stations,
        ratios=ratios[0] if single else ratios,
        orientations=orientations,
        gripper=None if cylinder.gripper is None else cylinder.gripper[low:],
        start_inside=bool(inside[0]) if single else inside,
        law=law,
    )


def _joined(cylinder: GeneralizedCylinder, starts: FloatArray) -> _Joins:
    """Where starts (S, 3) inside lie at their first passage, and where those outside are sent."""
    found = cylinder.crossings(starts)
    within = np.flatnonzero(found.ratios <= 1.0 + ON_BOUNDARY)
    within = within[np.lexsort((found.stations[within], found.rows[within]))]
    rows, first = np.unique(found.rows[within], return_index=True)
    best = within[first]
    inside = np.zeros(len(starts), dtype=bool)
    inside[rows] = True
    stations, angles, ratios = np.zeros((3, len(starts)))
    stations[rows], angles[rows], ratios[rows] = found.stations[best], found.angles[best], found.ratios[best]
    outside = np.flatnonzero(~inside)
    if outside.size:
        away = np.linalg.norm(starts[outside, None] - cylinder.directrix, axis=2)
        nearest = np.argmin(away, axis=1)
        later = cylinder.arc_length[nearest] > LATER * cylinder.arc_length[-1]
        later &= away.min(axis=1) < CLEARLY_NEARER * away[:, 0]
        index = np.where(later, np.minimum(nearest, len(cylinder.directrix) - 2), 0)
        stations[outside] = index
        angles[outside], ratios[outside] = _in_plane(cylinder, starts[outside], index)
    # A run has two samples at least, also one that begins in the last plane.
    last = len(cylinder.directrix) - 1.0 - LAST_PART
    return _Joins(np.minimum(stations, last), angles, ratios, inside)


def _joined_at(cylinder: GeneralizedCylinder, starts: FloatArray, at: float) -> _Joins:
    last = len(cylinder.directrix) - 2
    if not 0.0 <= at <= last:
        raise InvalidSettingError("at", at, f"a station from 0 to {last}")
    index = np.full(len(starts), round(at), dtype=np.intp)
    angles, ratios = _in_plane(cylinder, starts, index)
    return _Joins(index.astype(np.float64), angles, ratios, cylinder.contains(starts))


def _in_plane(
    cylinder: GeneralizedCylinder, points: FloatArray, index: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Angles and ratios (S,) of points (S, 3) after projection onto the planes of stations (S,)."""
    local = np.einsum("si,sij->sj", points - cylinder.directrix[index], cylinder.frames[index])
    angles = np.arctan2(local[:, 2], local[:, 1])
    count = len(cylinder.angles)
    before, part = bins(angles, count)
    edge = chord_radius(
        cylinder.radii[index, before], cylinder.radii[index, (before + 1) % count], part, count
    )
    return angles, np.hypot(local[:, 1], local[:, 2]) / edge


def _ratios_of(cylinder: GeneralizedCylinder, positions: FloatArray, stations: FloatArray) -> FloatArray:
    """Ratios (S, K) of positions (S, K, 3) in the planes of the stations (K,)."""
    index = np.tile(np.rint(stations).astype(np.intp), len(positions))
    return _in_plane(cylinder, positions.reshape(-1, 3), index)[1].reshape(positions.shape[:2])


def _ratios(
    ratios: FloatArray, law: str, final_ratio: float, gone: FloatArray, begin: FloatArray
) -> FloatArray:
    """Ratios (S, K) along arc lengths `gone` (K,) for runs that join at arc lengths `begin` (S,)."""
    if law == "fixed":
        return np.repeat(ratios[:, None], len(gone), axis=1)
    final = np.minimum(ratios, final_ratio)[:, None]
    part = np.clip((gone[None] - begin[:, None]) / np.maximum(gone[-1] - begin[:, None], 1e-12), 0.0, 1.0)
    return final + (ratios[:, None] - final) * _fading(part)


def _runs(
    cylinder: GeneralizedCylinder, stations: FloatArray, angles: FloatArray, ratios: FloatArray
) -> FloatArray:
    """Ratio rule (S, K, 3) at the stations (K,), of which only the first may be fractional."""
    low, count = int(stations[0]), len(cylinder.angles)
    part = float(stations[0]) - low
    before, share = bins(angles, count)
    after = (before + 1) % count
    radii = cylinder.radii[low:]
    edge = chord_radius(radii[:, before], radii[:, after], share, count)
    frames, centres = cylinder.frames[low:, :, 1:], cylinder.directrix[low:]
    distance = ratios.T * _first_between(edge, part)
    local = np.stack((distance * np.cos(angles), distance * np.sin(angles)), axis=2)
    offset = local @ np.swapaxes(_first_between(frames, part), 1, 2)
    return np.swapaxes(_first_between(centres, part)[:, None, :] + offset, 0, 1)


def _first_between(rows: FloatArray, part: float) -> FloatArray:
    """Rows with the first replaced by what lies a part of the way to the second."""
    if part == 0.0:
        return rows
    return np.concatenate((rows[:1] * (1.0 - part) + rows[1:2] * part, rows[1:]))


def _begun_at(
    starts: FloatArray,
    runs: FloatArray,
    stations: FloatArray,
    joins: FloatArray,
    *,
    gone: FloatArray,
    length: float,
) -> FloatArray:
    """Make runs (S, K, 3) begin at the starts: wait for the join, then fade out the offset from its plane."""
    index = np.searchsorted(stations, joins - 1e-12)
    who = np.arange(len(starts))
    # Between stations, the plane that passes through the start itself was found: nothing to fade out.
    projected = joins == stations[index]
    residual = np.where((projected & (joins % 1.0 == 0.0))[:, None], starts - runs[who, index], 0.0)
    size = np.sqrt(np.einsum("ij,ij->i", residual, residual))
    reach = np.maximum(2.0 * size, JOIN_LENGTH * length)
    part = np.clip((gone[None, :] - gone[index][:, None]) / np.maximum(reach, 1e-12)[:, None], 0.0, 1.0)
    moved = runs + _fading(part)[..., None] * residual[:, None, :]
    waiting = stations[None, :] <= joins[:, None] + 1e-9
    return np.where(waiting[..., None], starts[:, None, :], moved)


def _fading(part: FloatArray) -> FloatArray:
    """Fall from 1 at part 0 to 0 at part 1, with level ends."""
    return (1.0 - part) ** 2 * (1.0 + 2.0 * part)
