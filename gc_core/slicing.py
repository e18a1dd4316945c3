"""Aligned demonstrations -> section planes and what they cut: frames, effective points, sections."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gc_core.alignment import Alignment
from gc_core.arrays import BoolArray, FloatArray
from gc_core.crossings import Lines, effective_points, lines_of
from gc_core.demonstration import Trimmed
from gc_core.frames import arc_length, rotation_minimizing_frames
from gc_core.radius import slope_limited, vertex_angles
from gc_core.sections import section_radii
from gc_core.surface import boundary_advance, crossing_stations, section_surface
from gc_core.tilting import tilted_normals

REPAIR_ANGLES = 32
"""Vertices of the sections while planes are being tilted, at most."""


@dataclass(frozen=True)
class Settings:
    """How to encode; see `encode`."""

    section: str
    stations: int
    angles: int
    align_by: str
    half_width: float
    repair: bool


@dataclass(frozen=True, eq=False)
class Slices:
    """The demonstrations cut by the planes of some frames."""

    frames: FloatArray
    """(N, 3, 3)"""
    points: FloatArray
    """(N, n, 3) effective points [m]."""
    missed: BoolArray
    """(N, n) where a demonstration does not cross the plane near its station."""
    radii: FloatArray
    """(N, M) [m]."""
    surface: FloatArray
    """(N, M, 3) [m]."""

    @cached_property
    def crossing(self) -> BoolArray:
        """(N,) stations whose section cuts a neighbour."""
        return crossing_stations(self.surface, self.frames[:, :, 0])


def slices_of(trimmed: tuple[Trimmed, ...], alignment: Alignment, settings: Settings) -> Slices:
    """Cut demonstrations perpendicular to the directrix, or tilted where sections would cross.

    Parameters
    ----------
    trimmed : tuple of Trimmed
    alignment : Alignment
        Of these demonstrations.
    settings : Settings

    Returns
    -------
    Slices
        At the alignment's stations.
    """
    along = alignment.along
    first = _first_normal(alignment, along[0])
    lines = lines_of(trimmed, alignment)
    slices = _cut(lines, along, first, settings)
    if not settings.repair or not slices.crossing.any():
        return slices
    coarse = replace(settings, angles=min(settings.angles, REPAIR_ANGLES))
    normals = tilted_normals(
        alignment.directrix,
        along,
        slices.surface,
        lambda normals: _cut(lines, normals, first, coarse).surface,
    )
    return slices if normals is along else _cut(lines, normals, first, settings)


def _cut(lines: Lines, normals: FloatArray, first: FloatArray, settings: Settings) -> Slices:
    """Cut demonstrations by planes with the given normals (N, 3); the first N axis is near `first`."""
    directrix = lines.directrix
    frames = rotation_minimizing_frames(directrix, normals, first)
    points, missed = effective_points(lines, normals)
    local = (points - directrix[:, None]) @ frames[:, :, 1:]
    radii = section_radii(local, settings.section, settings.angles, settings.half_width)
    radii = slope_limited(radii, boundary_advance(directrix, frames, radii))
    surface = section_surface(directrix, frames, vertex_angles(settings.angles), radii)
    return Slices(frames, points, missed, radii, surface)


def _first_normal(alignment: Alignment, direction: FloatArray) -> FloatArray:
    """Choose the first N (3,) from the shape alone, so that frames turn with the data and ignore its order.

    Towards the middle of the curve; on straight curves, along the widest spread of the demonstrations.
    """
    across = np.eye(3) - np.outer(direction, direction)
    lean = across @ (alignment.directrix.mean(axis=0) - alignment.directrix[0])
    length = float(arc_length(alignment.directrix)[-1])
    if float(np.linalg.norm(lean)) > 1e-3 * length:
        return lean
    spread = (alignment.aligned - alignment.directrix).reshape(-1, 3) @ across
    _, axes = np.linalg.eigh(spread.T @ spread)
    widest = across @ axes[:, -1]
    if float(np.linalg.norm(widest)) < 0.5:
        return across[:, int(np.argmin(np.abs(direction)))]
    cubes = (spread @ widest) ** 3
    skew = float(cubes.sum())
    if abs(skew) <= 1e-9 * float(np.abs(cubes).sum()):
        # Neither side is longer; a side of the room keeps rounding from choosing.
        skew = float(widest[np.argmax(np.abs(widest))])
    return widest if skew >= 0.0 else -widest
