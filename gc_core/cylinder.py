"""The generalized cylinder: a curve with a section at every station, and what is inside.

Everything about inside and outside goes through the polygons of `surface()`; between stations
they are interpolated at equal angle (`gc_core.location`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from gc_core.arrays import BoolArray, FloatArray, finite, read_only, read_only_fields, remembered
from gc_core.diagnostics import Diagnostics
from gc_core.frames import arc_length
from gc_core.location import Sweep, inside, most_central, sweep_of
from gc_core.radius import radius_at, vertex_angles, widened_to_hold
from gc_core.surface import section_surface


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
    def slope(self) -> FloatArray:
        """(N,) fastest change of a radius to a neighbouring station, by the way between them [-].

        Circles below 1 are close to a canal surface, the envelope of spheres of these radii; where the radius
        changes faster than the centre moves there is no such envelope.
        """
        step = np.maximum(np.diff(self.arc_length), np.finfo(float).tiny)
        change = np.abs(np.diff(self.radii, axis=0)).max(axis=1) / step
        return read_only(np.maximum(np.append(change, 0.0), np.append(0.0, change)))

    @cached_property
    def volume(self) -> float:
        """Volume between the sections [m^3]; what is covered twice, or swept backwards, counts as often."""
        # Faces of each slab seen from its first centre add up to its volume (divergence theorem).
        centre = self.directrix[:-1, None]
        here, there = self._surface[:-1] - centre, self._surface[1:] - centre
        here_on, there_on = np.roll(here, -1, axis=1), np.roll(there, -1, axis=1)
        ahead = self.directrix[1:, None] - centre
        sides = _six_volumes(here, here_on, there_on) + _six_volumes(here, there_on, there)
        return float(np.abs(sides + _six_volumes(ahead, there, there_on)).sum()) / 6.0

    @cached_property
    def sweep(self) -> Sweep:
        """The sections, laid out for finding points."""
        return sweep_of(self.directrix, self.frames, self.radii)

    def locate(self, points: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Find the section in which each point lies most centrally.

        Parameters
        ----------
        points : (P, 3) array
            Any points; P may be 0 [m].

        Returns
        -------
        stations : (P,) array
            Fractional stations from 0 to N - 1. For a point beyond an end that no section holds: that end,
            unless a section that passes through the point has its centre nearer, both in half-widths [-].
        angles : (P,) array
            From N to B [rad].
        ratios : (P,) array
            Distance from the directrix by that of the boundary, within the section plane:
            0 on the directrix, 1 on the boundary. Of a point beyond an end: after projection onto
            the end's plane, so that it may be below 1 although `contains` says no [-].

        Raises
        ------
        ShapeError, NotFiniteError
            If the points are not finite places.

        Notes
        -----
        Where the tube passes near itself, a point may lie in several sections: this is the one with the least
        ratio, and `contains` is true if any of them holds the point. Between stations the centre and the
        axes are interpolated linearly and the boundary at equal angle. Memory does not
        grow with P beyond the results.
        """
        return most_central(self.sweep, finite(points, "points", (None, 3)))

    def contains(self, points: ArrayLike) -> BoolArray:
        """Tell which points lie inside.

        Parameters
        ----------
        points : (P, 3) array
            Any points; P may be 0 [m].

        Returns
        -------
        (P,) array of bool
            True on the boundary and in the first and the last plane too; False beyond these.

        Raises
        ------
        ShapeError, NotFiniteError
            If the points are not finite places.
        """
        return inside(self.sweep, finite(points, "points", (None, 3)))


@remembered
def coarser(cylinder: GeneralizedCylinder, angles: int) -> GeneralizedCylinder:
    """Give a tube sections with fewer vertices, for previews.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
    angles : int
        Vertices of each section from now on, at least 3.

    Returns
    -------
    GeneralizedCylinder
        The new vertices lie on the former boundary, or so far outside that the sections still hold the
        effective points. The same object if it has not more vertices than that; the result is remembered as
        long as the cylinder lives.
    """
    if angles >= len(cylinder.angles):
        return cylinder
    fewer = vertex_angles(angles)
    radii = radius_at(cylinder.radii, np.arange(len(cylinder.radii))[:, None], fewer)
    points = (cylinder.effective_points - cylinder.directrix[:, None]) @ cylinder.frames[:, :, 1:]
    return replace(cylinder, angles=fewer, radii=widened_to_hold(radii, points))


def _six_volumes(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """Six times the signed volumes (N,) of all tetrahedra (0, a, b, c) of broadcast corners (N, M, 3)."""
    return np.asarray((a * np.cross(b, c)).sum(axis=(1, 2)), dtype=np.float64)
