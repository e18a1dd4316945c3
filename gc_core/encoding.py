"""Demonstrations -> generalized cylinder."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from gc_core.alignment import Alignment, align, majority_gripper, mean_orientations
from gc_core.arrays import BoolArray, FloatArray, finite
from gc_core.crossings import effective_points
from gc_core.cylinder import GeneralizedCylinder, crossing_stations, section_surface
from gc_core.demonstration import Demonstration, Trimmed, trim
from gc_core.diagnostics import Diagnostics
from gc_core.errors import InvalidSettingError, NoDemonstrationsError, TooFewSamplesError, UnknownOptionError
from gc_core.frames import arc_length, rotation_minimizing_frames, tangents
from gc_core.radius import vertex_angles
from gc_core.sections import SECTIONS, section_radii

FEWEST_STATIONS = 8
"""Below this a curve has no usable tangents."""

FEWEST_ANGLES = 8
"""Below this a section has no usable shape."""

HALF_WIDTH = 0.001
"""Least distance of the boundary from the directrix, where demonstrations meet [m]."""

SINGLE_HALF_WIDTH = 0.02
"""Radius of the tube around a single demonstration [m]."""


@dataclass(frozen=True)
class Settings:
    """How to encode; see `encode`."""

    section: str
    stations: int
    angles: int
    align_by: str
    half_width: float


def encode(
    demonstrations: Sequence[Demonstration],
    *,
    section: str = "closed_spline",
    stations: int = 200,
    angles: int = 64,
    align_by: str = "time",
    directrix: Literal["mean"] | FloatArray = "mean",
    minimum_half_width: float = HALF_WIDTH,
    single_half_width: float = SINGLE_HALF_WIDTH,
) -> GeneralizedCylinder:
    """Learn a generalized cylinder from demonstrations.

    Stations are evenly spaced along the directrix; `times` keeps the mean speed. The order of the
    demonstrations does not matter.

    Parameters
    ----------
    demonstrations : sequence of n Demonstration
        n >= 1; one gives a tube of radius `single_half_width`.
    section : {"circle", "ellipse", "closed_spline", "hull"}
        Kind of the cross-sections.
    stations : int
        Number of stations N along the directrix, at least 8.
    angles : int
        Number of vertices M of each section, at least 8.
    align_by : {"time", "arc_length"}
        What corresponds: equal parts of the duration, or of the path.
    directrix : "mean" or (K, 3) array
        The mean of the aligned demonstrations, or a curve evenly sampled in the alignment's parameter [m].
    minimum_half_width : float
        Least distance of the boundary from the directrix; also the least half-thickness of a section [m].
    single_half_width : float
        Radius of the tube around a single demonstration [m].

    Returns
    -------
    GeneralizedCylinder
        Every effective point and the directrix lie inside the polygons of its `surface()`.

    Raises
    ------
    NoDemonstrationsError
        If there is none.
    OpposedDemonstrationsError
        If their mean does not move.
    UnknownOptionError, InvalidSettingError, ShapeError, NotFiniteError, TooFewSamplesError
        If an option is none of those above.

    References
    ----------
    .. [1] S. R. Ahmadzadeh, M. A. Rana, S. Chernova. Generalized Cylinders for Learning, Reproduction,
       Generalization, and Refinement of Robot Skills. RSS 2017. doi:10.15607/RSS.2017.XIII.021
    """
    given = tuple(demonstrations)
    if not given:
        raise NoDemonstrationsError
    order = _canonical_order(given)
    places = sorted(range(len(order)), key=order.__getitem__)
    shown = tuple(given[j] for j in order)
    assumed = len(shown) == 1
    settings = _checked(
        section, stations, angles, align_by, single_half_width if assumed else minimum_half_width
    )
    trimmed = tuple(trim(demonstration) for demonstration in shown)
    alignment = align(trimmed, settings.stations, settings.align_by, _given(directrix))
    normals = tangents(alignment.directrix)
    frames = rotation_minimizing_frames(alignment.directrix, normals, _first_normal(alignment, normals[0]))
    return _assemble(shown, trimmed, alignment, frames, settings, places=places)


def _assemble(
    shown: tuple[Demonstration, ...],
    trimmed: tuple[Trimmed, ...],
    alignment: Alignment,
    frames: FloatArray,
    settings: Settings,
    *,
    places: list[int],
) -> GeneralizedCylinder:
    """Cut the demonstrations with the planes of the frames and build the sections.

    `places` says where each demonstration that was given stands among those that are shown here.
    """
    points, missed = effective_points(trimmed, alignment, frames[:, :, 0])
    local = (points - alignment.directrix[:, None]) @ frames[:, :, 1:]
    gone = arc_length(alignment.directrix)
    radii = section_radii(local, gone, settings.section, settings.angles, settings.half_width)
    rays = vertex_angles(settings.angles)
    surface = section_surface(alignment.directrix, frames, rays, radii)
    return GeneralizedCylinder(
        directrix=alignment.directrix,
        frames=frames,
        angles=rays,
        radii=radii,
        effective_points=points[:, places],
        aligned=alignment.aligned[places],
        times=alignment.times,
        orientations=mean_orientations(shown, trimmed, alignment.moments),
        gripper=majority_gripper(shown, trimmed, alignment.moments),
        section=settings.section,
        diagnostics=Diagnostics(
            names=tuple(shown[place].name or f"Demonstration {j + 1}" for j, place in enumerate(places)),
            align_by=settings.align_by,
            trimmed_start=np.array([trimmed[place].cut_start for place in places]),
            trimmed_end=np.array([trimmed[place].cut_end for place in places]),
            duplicates=np.array([trimmed[place].duplicates for place in places], dtype=np.intp),
            missed=missed[:, places],
            centre_outside=_centre_outside(local),
            minimum_half_width=settings.half_width,
            assumed_width=len(shown) == 1,
            crossing=crossing_stations(surface, frames[:, :, 0]),
            tilt=np.zeros(len(frames)),
            folded=np.zeros(len(frames), dtype=bool),
        ),
    )


def _canonical_order(shown: tuple[Demonstration, ...]) -> list[int]:
    """Order that does not depend on the order given, so that rounding and ties do not either."""
    keys = [
        (*d.positions[[0, -1, len(d.positions) // 2]].ravel().tolist(), float(d.times[-1] - d.times[0]))
        for d in shown
    ]
    return sorted(range(len(shown)), key=keys.__getitem__)


def _checked(section: str, stations: int, angles: int, align_by: str, half_width: float) -> Settings:
    if section not in SECTIONS:
        raise UnknownOptionError("section", section, SECTIONS)
    for setting, value, fewest in (
        ("stations", stations, FEWEST_STATIONS),
        ("angles", angles, FEWEST_ANGLES),
    ):
        if not fewest <= value < np.inf or value != int(value):
            raise InvalidSettingError(setting, value, f"a whole number of at least {fewest}")
    if not 0.0 < half_width < np.inf:
        raise InvalidSettingError("The half-width", half_width, "a length above 0 m")
    return Settings(section, int(stations), int(angles), align_by, float(half_width))


def _given(directrix: Literal["mean"] | FloatArray) -> FloatArray | None:
    if isinstance(directrix, str):
        if directrix != "mean":
            raise UnknownOptionError("directrix", directrix, ("mean", "an (N, 3) array"))
        return None
    curve = finite(directrix, "directrix", (None, 3))
    if len(curve) < 2:
        raise TooFewSamplesError("The directrix", len(curve))
    return curve


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


def _centre_outside(points: FloatArray) -> BoolArray:
    """Tell where the centre lies outside of the hull of points (N, n, 2), beyond rounding."""
    angles = np.sort(np.arctan2(points[..., 1], points[..., 0]), axis=1)
    gaps = np.diff(np.concatenate((angles, angles[:, :1] + 2.0 * np.pi), axis=1), axis=1)
    size = np.linalg.norm(points, axis=2).max(axis=1)
    return (gaps.max(axis=1) > np.pi + 1e-6) & (size > 1e-9)
