"""The generalized cylinder: a curve with a section at every station, and what is inside.

Everything about inside and outside goes through the polygons of `surface()`; between stations
they are interpolated at equal angle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gc_core.arrays import BoolArray, FloatArray, IntArray, finite, read_only, read_only_fields
from gc_core.diagnostics import Diagnostics
from gc_core.frames import arc_length
from gc_core.radius import radius_at

ON_BOUNDARY = 1e-9
"""A ratio up to this much above 1 is still inside: rounding [-]."""

CHUNK = 4096
"""Points that are located at once; bounds the memory of a large query."""


@dataclass(frozen=True, eq=False)
class Crossings:
    """Where the section planes, swept along the curve, pass through some points."""

    rows: IntArray
    """(C,) which point."""
    stations: FloatArray
    """(C,) fractional station [-]."""
    angles: FloatArray
    """(C,) angle in the section from N to B [rad]."""
    ratios: FloatArray
    """(C,) distance from the centre by that of the boundary [-]."""


@dataclass(frozen=True, eq=False)
class GeneralizedCylinder:
    """What was learned: a directrix and, at N stations along it, a star-shaped section."""

    directrix: FloatArray
    """(N, 3) the middle line [m]."""
    frames: FloatArray
    """(N, 3, 3) columns: section normal (the tangent unless tilted), N, B [-]."""
    angles: FloatArray
    """(M,) angles of the sections' vertices, from N to B [rad]."""
    radii: FloatArray
    """(N, M) distances of the vertices from the directrix [m]."""
    effective_points: FloatArray
    """(N, n, 3) where the demonstrations cross the section planes [m]."""
    aligned: FloatArray
    """(n, N, 3) corresponding places on the demonstrations [m]."""
    times: FloatArray
    """(N,) mean time law from 0 [s]."""
    orientations: FloatArray | None
    """(N, 4) mean orientation w, x, y, z; None if not shown."""
    gripper: FloatArray | None
    """(N,) gripper by majority; None if not shown."""
    section: str
    """Kind of the sections."""
    diagnostics: Diagnostics
    """What was trimmed, missed, widened, folded, and which stations cross a neighbour."""

    def __post_init__(self) -> None:
        read_only_fields(self)

    @cached_property
    def arc_length(self) -> FloatArray:
        """(N,) length of the directrix up to each station, from 0 [m]."""
        return read_only(arc_length(self.directrix))

    @cached_property
    def _surface(self) -> FloatArray:
        return read_only(section_surface(self.directrix, self.frames, self.angles, self.radii))

    def surface(self) -> FloatArray:
        """Vertices of the sections.

        Returns
        -------
        (N, M, 3) array
            ``surface()[i]`` is the polygon of station i, in its plane, counterclockwise about its normal [m].
        """
        return self._surface

    @cached_property
    def volume(self) -> float:
        """Volume inside `surface()` with flat ends; what is covered twice counts twice [m^3]."""
        # Faces seen from a point on the directrix add up to the volume (divergence theorem).
        rings = self._surface - self.directrix[0]
        turned = np.roll(rings, -1, axis=1)
        sides = _six_volumes(rings[:-1], turned[:-1], turned[1:]) + _six_volumes(
            rings[:-1], turned[1:], rings[1:]
        )
        first, last = self.directrix[0] - self.directrix[0], self.directrix[-1] - self.directrix[0]
        caps = _six_volumes(last, rings[-1], turned[-1]) - _six_volumes(first, rings[0], turned[0])
        return (sides + caps) / 6.0

    def locate(self, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Find the section in which each point lies most centrally.

        Parameters
        ----------
        points : (P, 3) array
            Any points [m].

        Returns
        -------
        stations : (P,) array
            Fractional stations from 0 to N - 1; an end where a point lies beyond it [-].
        angles : (P,) array
            From N to B [rad].
        ratios : (P,) array
            Distance from the directrix by that of the boundary, within the section plane:
            0 on the directrix, 1 on the boundary [-].

        Raises
        ------
        ShapeError, NotFiniteError
            If the points are not finite places.
        """
        places = finite(points, "points", (None, 3))
        stations, angles, ratios = self._beyond(places)
        for begin in range(0, len(places), CHUNK):
            found = self.crossings(places[begin : begin + CHUNK])
            order = np.lexsort((found.ratios, found.rows))
            rows, first = np.unique(found.rows[order], return_index=True)
            best, rows = order[first], rows + begin
            stations[rows] = found.stations[best]
            angles[rows] = found.angles[best]
            ratios[rows] = found.ratios[best]
        return stations, angles, ratios

    def contains(self, points: FloatArray) -> BoolArray:
        """Tell which points lie inside.

        Parameters
        ----------
        points : (P, 3) array
            Any points [m].

        Returns
        -------
        (P,) array of bool
            True on the boundary too; False beyond the first and the last plane.

        Raises
        ------
        ShapeError, NotFiniteError
            If the points are not finite places.
        """
        places = finite(points, "points", (None, 3))
        inside = np.zeros(len(places), dtype=bool)
        for begin in range(0, len(places), CHUNK):
            found = self.crossings(places[begin : begin + CHUNK])
            inside[begin + found.rows[found.ratios <= 1.0 + ON_BOUNDARY]] = True
        return inside

    def crossings(self, points: FloatArray) -> Crossings:
        """Find every place where a section plane, swept from station to station, passes through a point.

        Parameters
        ----------
        points : (P, 3) array
            Finite places [m].

        Returns
        -------
        Crossings
            Sorted by point; none for points beyond the ends, several where the tube passes near itself.
        """
        normals = self.frames[:, :, 0]
        height = points @ normals.T - np.einsum("ij,ij->i", self.directrix, normals)
        slack = 1e-9 * max(float(self.arc_length[-1]), 1e-12)
        before, after = height[:, :-1], height[:, 1:]
        rows, index = np.nonzero(
            ((before >= -slack) & (after <= slack)) | ((before <= slack) & (after >= -slack))
        )
        drop = before[rows, index] - after[rows, index]
        part = np.clip(before[rows, index] / np.where(drop == 0.0, 1.0, drop), 0.0, 1.0)
        angles, ratios = self._in_section(points[rows], index, part)
        return Crossings(rows, index + part, angles, ratios)

    def _in_section(
        self, points: FloatArray, index: IntArray, part: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Angles and ratios (C,) of points (C, 3) in the sections a part of the way past stations `index`."""
        share = part[:, None]
        centre = self.directrix[index] * (1.0 - share) + self.directrix[index + 1] * share
        axes = self.frames[index] * (1.0 - share[..., None]) + self.frames[index + 1] * share[..., None]
        local = np.einsum("ci,cij->cj", points - centre, axes)
        angles = np.arctan2(local[:, 2], local[:, 1])
        edge = radius_at(self.radii, index, angles) * (1.0 - part)
        edge = edge + radius_at(self.radii, index + 1, angles) * part
        return angles, np.hypot(local[:, 1], local[:, 2]) / edge

    def _beyond(self, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Stations, angles and ratios (P,) in the nearest station, for points no plane passes through."""
        away = np.concatenate(
            [
                np.argmin(np.linalg.norm(part[:, None] - self.directrix, axis=2), axis=1)
                for part in np.array_split(points, -(-len(points) // CHUNK))
            ]
            if len(points)
            else [np.zeros(0, dtype=np.intp)]
        )
        index = np.minimum(away, len(self.directrix) - 2)
        angles, ratios = self._in_section(points, index, (away - index).astype(np.float64))
        return away.astype(np.float64), angles, ratios


def section_surface(
    directrix: FloatArray, frames: FloatArray, angles: FloatArray, radii: FloatArray
) -> FloatArray:
    """Vertices (N, M, 3) of sections given by their radii (N, M) [m]."""
    circle = np.stack((np.cos(angles), np.sin(angles)))
    return directrix[:, None, :] + radii[:, :, None] * np.swapaxes(frames[:, :, 1:] @ circle, 1, 2)


def crossing_stations(surface: FloatArray, normals: FloatArray) -> BoolArray:
    """Stations whose section is cut by the section after or before it.

    Parameters
    ----------
    surface : (N, M, 3) array
        Vertices [m].
    normals : (N, 3) array
        Section normals [-].

    Returns
    -------
    (N,) array of bool
    """
    forward = np.diff(surface, axis=0)
    back = np.einsum("imk,ik->im", forward, normals[:-1]) <= 0.0
    back |= np.einsum("imk,ik->im", forward, normals[1:]) <= 0.0
    pair = back.any(axis=1)
    return np.concatenate((pair, [False])) | np.concatenate(([False], pair))


def _six_volumes(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    """Sum of six times the signed volumes of the tetrahedra (0, a, b, c) of broadcast corners (..., 3)."""
    return float((a * np.cross(b, c)).sum())
