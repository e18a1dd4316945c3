"""Demonstrations -> generalized cylinder."""

from __future__ import annotations

from collections.abc import Sequence
from numbers import Real
from typing import Literal

import numpy as np

from gc_core.alignment import Alignment, align, majority_gripper, mean_orientations
from gc_core.arrays import BoolArray, FloatArray, finite
from gc_core.cylinder import GeneralizedCylinder
from gc_core.demonstration import FARTHEST, Demonstration, Trimmed, check_places, trim
from gc_core.diagnostics import Diagnostics
from gc_core.errors import (
    InvalidSettingError,
    NoDemonstrationsError,
    NotADemonstrationError,
    TooFewSamplesError,
    UnknownOptionError,
)
from gc_core.frames import angles_between
from gc_core.radius import vertex_angles
from gc_core.sections import SECTIONS
from gc_core.slicing import Settings, Slices, slices_of

FEWEST_STATIONS = 8
"""Below this a curve has no usable tangents."""

FEWEST_ANGLES = 8
"""Below this a section has no usable shape."""

ANGLES = 64
"""Vertices of a section, unless stated."""

HULL_ANGLES = 128
"""... of a hull, whose sharp corners need more to be tight."""

HALF_WIDTH = 0.001
"""Least distance of the boundary from the directrix, where demonstrations meet [m]."""

SMALLEST_HALF_WIDTH = 1e-9
"""Below this, squares of half-widths are lost beside those of the sections [m]."""

SINGLE_HALF_WIDTH = 0.02
"""Radius of the tube around a single demonstration [m]."""


def encode(
    demonstrations: Sequence[Demonstration],
    *,
    section: str = "closed_spline",
    stations: int = 200,
    angles: int | None = None,
    align_by: str = "time",
    directrix: Literal["mean"] | FloatArray = "mean",
    minimum_half_width: float = HALF_WIDTH,
    single_half_width: float = SINGLE_HALF_WIDTH,
    repair: bool = True,
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
    angles : int or None
        Number of vertices M of each section, at least 8; None for 64, 128 for the sharp corners of a hull.
    align_by : {"time", "arc_length", "dtw"}
        What corresponds: equal parts of the duration, of the path, or places near each other by dynamic
        time warping.
    directrix : "mean" or (K, 3) array
        The mean of the aligned demonstrations, or a curve evenly sampled in the alignment's parameter [m].
    minimum_half_width : float
        Least distance of the boundary from the directrix; also the least half-thickness of a section [m].
    single_half_width : float
        Radius of the tube around a single demonstration [m].
    repair : bool
        Tilt the section planes where neighbouring sections would cross; else they stay perpendicular to the
        directrix, which is quicker.

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
    NotADemonstrationError
        If something else is among them.
    UnknownOptionError, InvalidSettingError, ShapeError, NotFiniteError, TooFewSamplesError, TooFarError
        If an option is none of those above.

    References
    ----------
    .. [1] S. R. Ahmadzadeh, M. A. Rana, S. Chernova. Generalized Cylinders for Learning, Reproduction,
       Generalization, and Refinement of Robot Skills. RSS 2017. doi:10.15607/RSS.2017.XIII.021
    """
    given = _shown(demonstrations)
    order = _canonical_order(given)
    places = sorted(range(len(order)), key=order.__getitem__)
    shown = tuple(given[j] for j in order)
    assumed = len(shown) == 1
    settings = _checked(
        section,
        stations,
        angles,
        align_by,
        single_half_width if assumed else minimum_half_width,
        repair=repair,
    )
    trimmed = tuple(trim(demonstration) for demonstration in shown)
    alignment = align(trimmed, settings.stations, settings.align_by, _given(directrix))
    return _assemble(
        shown, trimmed, alignment, slices_of(trimmed, alignment, settings), settings, places=places
    )


def _assemble(
    shown: tuple[Demonstration, ...],
    trimmed: tuple[Trimmed, ...],
    alignment: Alignment,
    slices: Slices,
    settings: Settings,
    *,
    places: list[int],
) -> GeneralizedCylinder:
    """Put the parts together.

    `places` says where each demonstration that was given stands among those that are shown here.
    """
    normals = slices.frames[:, :, 0]
    local = (slices.points - alignment.directrix[:, None]) @ slices.frames[:, :, 1:]
    return GeneralizedCylinder(
        directrix=alignment.directrix,
        frames=slices.frames,
        angles=vertex_angles(settings.angles),
        radii=slices.radii,
        effective_points=slices.points[:, places],
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
            missed=slices.missed[:, places],
            smoothed=alignment.smoothed,
            centre_outside=_centre_outside(local),
            minimum_half_width=settings.half_width,
            assumed_width=len(shown) == 1,
            crossing=slices.crossing,
            tilt=angles_between(normals, alignment.along),
            folded=np.zeros(len(normals), dtype=bool),
        ),
    )


def _canonical_order(shown: tuple[Demonstration, ...]) -> list[int]:
    """Order that does not depend on the order given, so that rounding and ties do not either."""
    keys = [
        (*d.positions[[0, -1, len(d.positions) // 2]].ravel().tolist(), float(d.times[-1] - d.times[0]))
        for d in shown
    ]
    return sorted(range(len(shown)), key=keys.__getitem__)


def _shown(demonstrations: Sequence[Demonstration] | Demonstration) -> tuple[Demonstration, ...]:
    shown = (demonstrations,) if isinstance(demonstrations, Demonstration) else tuple(demonstrations)
    if not shown:
        raise NoDemonstrationsError
    for index, demonstration in enumerate(shown):
        if not isinstance(demonstration, Demonstration):  # pyright: ignore[reportUnnecessaryIsInstance] - callers
            raise NotADemonstrationError(index, type(demonstration).__name__)
    return shown


def _checked(
    section: str, stations: object, angles: object, align_by: str, half_width: float, *, repair: bool
) -> Settings:
    if section not in SECTIONS:
        raise UnknownOptionError("section", section, SECTIONS)
    if angles is None:
        angles = HULL_ANGLES if section == "hull" else ANGLES
    if not SMALLEST_HALF_WIDTH <= half_width <= FARTHEST:
        wanted = f"a length from {SMALLEST_HALF_WIDTH:g} m to {FARTHEST:g} m"
        raise InvalidSettingError("The half-width", half_width, wanted)
    return Settings(
        section=section,
        stations=_whole("stations", stations, FEWEST_STATIONS),
        angles=_whole("angles", angles, FEWEST_ANGLES),
        align_by=align_by,
        half_width=float(half_width),
        repair=repair,
    )


def _whole(setting: str, value: object, fewest: int) -> int:
    number = float(value) if isinstance(value, Real) else np.nan
    if not (fewest <= number < np.inf and number == int(number)):
        raise InvalidSettingError(setting, value, f"a whole number of at least {fewest}")
    return int(number)


def _given(directrix: Literal["mean"] | FloatArray) -> FloatArray | None:
    if isinstance(directrix, str):
        if directrix != "mean":
            raise UnknownOptionError("directrix", directrix, ("mean", "an (N, 3) array"))
        return None
    curve = finite(directrix, "directrix", (None, 3))
    if len(curve) < 2:
        raise TooFewSamplesError("The directrix", len(curve))
    check_places("The directrix", curve)
    return curve


def _centre_outside(points: FloatArray) -> BoolArray:
    """Tell where the centre lies outside of the hull of points (N, n, 2), beyond rounding."""
    angles = np.sort(np.arctan2(points[..., 1], points[..., 0]), axis=1)
    gaps = np.diff(np.concatenate((angles, angles[:, :1] + 2.0 * np.pi), axis=1), axis=1)
    size = np.linalg.norm(points, axis=2).max(axis=1)
    return (gaps.max(axis=1) > np.pi + 1e-6) & (size > 1e-9)
