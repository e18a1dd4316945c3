"""What a map makes of a tube: lines along its boundary and its effective points, to be cut by planes.

Coordinates come first here, (3, N, K): a drag cuts thousands of lines.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gc_core.arrays import FloatArray, IntArray, read_only, remembered
from gc_core.cylinder import GeneralizedCylinder
from gc_core.frames import arc_length, rotation_minimizing_frames
from gc_core.radius import GREATEST_SLOPE, loop_radii, slope_limited, widened_to_hold
from gc_core.registration import ThinPlateSpline, map_columns
from gc_core.surface import boundary_advance, section_surface

ROUNDS = 4
"""Steps along a line towards the plane that should cut it."""

FARTHEST = 20.0
"""Stations that the first step goes at most."""

BEYOND = 1.0
"""Pieces by which a line that does not reach its plane is continued straight, before it is projected."""

GRAZING, STEEP = 0.05, 0.3
"""A line that rises by less than the first, per step of the directrix, is projected onto its plane: where
it would meet it is no question any more. From the second on it is cut; in between gradually [-]."""


@dataclass(frozen=True, eq=False)
class Image:
    """A mapped tube before it is cut."""

    cylinder: GeneralizedCylinder
    """As it was taught."""
    directrix: FloatArray
    """(N, 3) mapped [m]."""
    lines: FloatArray
    """(3, N, M + n) mapped: of the boundary at equal angle, then of the effective points [m]."""
    first: FloatArray
    """(3,) wanted first N [-]."""

    def cut(self, normals: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Cut the lines by planes through the directrix.

        Parameters
        ----------
        normals : (N, 3) array
            Unit normals of the planes [-].

        Returns
        -------
        frames : (N, 3, 3) array
            Columns: normal, N, B [-].
        radii : (N, M) array
            Of the boundary, widened to hold the effective points and to change gently along it [m].
        effective_points : (N, n, 3) array
            [m].
        """
        frames = rotation_minimizing_frames(self.directrix, normals, self.first)
        local = _cut_again(self.lines, self.directrix, frames)
        n_rays = len(self.cylinder.angles)
        radii = np.maximum(
            loop_radii(local[:, :n_rays], n_rays), self.cylinder.diagnostics.minimum_half_width
        )
        points = local[:, n_rays:]
        radii = widened_to_hold(radii, points)
        # A tube that is only moved must not change: what it had is allowed, in proportion to the step.
        had = _taught_slopes(self.cylinder) * np.diff(arc_length(self.directrix))[:, None]
        radii = slope_limited(radii, np.maximum(boundary_advance(self.directrix, frames, radii), had))
        return frames, radii, self.directrix[:, None] + points @ np.swapaxes(frames[:, :, 1:], 1, 2)

    def surface(self, normals: FloatArray) -> FloatArray:
        """Vertices (N, M, 3) of the sections in planes with these normals (N, 3) [m]."""
        frames, radii, _ = self.cut(normals)
        return section_surface(self.directrix, frames, self.cylinder.angles, radii)


def image_of(cylinder: GeneralizedCylinder, registration: ThinPlateSpline, first: FloatArray) -> Image:
    """Map a tube.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
        As it was taught.
    registration : ThinPlateSpline
        The map.
    first : (3,) array
        Wanted first N of the image [-].

    Returns
    -------
    Image
    """
    lines = _lines(cylinder)
    mapped = map_columns(registration, lines.reshape(3, -1)).reshape(lines.shape)
    return Image(cylinder, mapped[:, :, -1].T.copy(), mapped[:, :, :-1], first)


@remembered
def _lines(cylinder: GeneralizedCylinder) -> FloatArray:
    """Lines (3, N, M + n + 1) of the boundary, of the effective points and the directrix [m]."""
    together = (cylinder.surface(), cylinder.effective_points, cylinder.directrix[:, None])
    return read_only(np.moveaxis(np.concatenate(together, axis=1), 2, 0))


@remembered
def _taught_slopes(cylinder: GeneralizedCylinder) -> FloatArray:
    """Changes of radius (N - 1, M) per length, by the greatest that is allowed: 1 at most [-]."""
    slopes = np.abs(np.diff(cylinder.radii, axis=0)) / np.diff(cylinder.arc_length)[:, None]
    return read_only(np.minimum(slopes / GREATEST_SLOPE, 1.0))


def _cut_again(lines: FloatArray, directrix: FloatArray, frames: FloatArray) -> FloatArray:
    """Cut lines (3, N, K), sampled at the stations, with the planes: section coordinates (N, K, 2).

    A line that does not reach its plane is continued straight by at most a piece, then projected.
    """
    _, count, width = lines.shape
    axes = np.moveaxis(frames, 0, 2)[..., None]
    middle = np.einsum("ij,ijk->ki", directrix, frames)[..., None]
    exact = 1e-9 * float(arc_length(directrix)[-1])
    following = np.concatenate((lines[:, 1:], 2.0 * lines[:, -1:] - lines[:, -2:-1]), axis=1)
    height = _products(axes[:, 0], lines) - middle[0]
    rise = _products(axes[:, 0], following) - middle[0] - height
    # The piece to try first is the one in which a straight line would meet the plane.
    begin = _first_pieces(height, rise, exact)
    low, along = _pieces(lines, begin)
    climb = _products(axes[:, 0], along)
    part = _part(_products(axes[:, 0], low) - middle[0], climb, exact)
    along *= np.clip(part, -BEYOND, 1.0 + BEYOND)
    along += low
    off = np.flatnonzero((part < 0.0) | (part > 1.0))
    if off.size:
        planes = np.concatenate((frames[:, :, 0].T, middle[0].T))
        met, climb.ravel()[off] = _met(lines, planes, off, begin.ravel()[off], exact)
        along.reshape(3, -1)[:, off] = met
    step = np.diff(directrix, axis=0, append=2.0 * directrix[-1:] - directrix[-2:-1])
    least = np.minimum(rise, climb) / np.sqrt(np.einsum("ij,ij->i", step, step))[:, None]
    station, line = np.nonzero(least < STEEP)
    if station.size:
        above = frames[station, :, 0].T * height[station, line]
        projected = lines[:, station, line] - above
        weight = np.maximum((least[station, line] - GRAZING) / (STEEP - GRAZING), 0.0)
        along[:, station, line] = projected + weight * (along[:, station, line] - projected)
    local = np.empty((count, width, 2))
    for axis in (1, 2):
        local[:, :, axis - 1] = _products(axes[:, axis], along) - middle[axis]
    return local


def _met(
    lines: FloatArray, planes: FloatArray, off: IntArray, begin: IntArray, exact: float
) -> tuple[FloatArray, FloatArray]:
    """Places (3, E) where lines (3, N, K) from pieces `begin` (E,) on meet planes (4, N) of samples `off`.

    Where a line was left by its piece, the piece that the plane should lie in is tried next. Also returned is
    how much the last pieces rise (E,).
    """
    width = lines.shape[2]
    places, climb = np.empty((3, len(off))), np.empty(len(off))
    rows = np.arange(len(off))
    for _ in range(ROUNDS):
        low, along = _pieces(lines, begin)
        plane = np.take(planes, off // width, axis=1)
        rise = _products(plane, along)
        part = _part(_products(plane, low) - plane[3], rise, exact)
        places[:, rows], climb[rows] = low + along * np.clip(part, -BEYOND, 1.0 + BEYOND), rise
        ahead = np.floor(np.clip(part, -8.0, 8.0)).astype(np.intp)
        following = np.clip(begin // width + ahead, 0, lines.shape[1] - 2) * width + off % width
        fresh = np.flatnonzero(following != begin)
        off, begin, rows = off[fresh], following[fresh], rows[fresh]
        if not off.size:
            break
    return places, climb


def _first_pieces(height: FloatArray, rise: FloatArray, exact: float) -> IntArray:
    """Samples (N, K) that begin the pieces in which lines, straight on, would meet their planes."""
    count, width = height.shape
    ahead = np.clip(_part(height, rise, exact), -FARTHEST, FARTHEST)
    station = np.floor(ahead).astype(np.intp) + np.arange(count, dtype=np.intp)[:, None]
    return np.clip(station, 0, count - 2) * width + np.arange(width, dtype=np.intp)


def _pieces(lines: FloatArray, begin: IntArray) -> tuple[FloatArray, FloatArray]:
    """Beginnings and steps (3, ...) of pieces of lines (3, N, K) from samples `begin` (...)."""
    flat = lines.reshape(3, -1)
    low = np.take(flat, begin, axis=1)
    return low, np.take(flat, begin + lines.shape[2], axis=1) - low


def _part(height: FloatArray, rise: FloatArray, exact: float) -> FloatArray:
    """Part of a piece after which a line of that height that rises by so much is in the plane."""
    return -height / np.where(np.abs(rise) > exact, rise, np.inf)


def _products(a: FloatArray, b: FloatArray) -> FloatArray:
    """Sums of products of three coordinates (3, ...)."""
    total = a[0] * b[0]
    total += a[1] * b[1]
    total += a[2] * b[2]
    return total
