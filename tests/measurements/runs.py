"""Random starts in a tube, and what becomes of the runs from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.study.measures import on_sections
from gc_core import GeneralizedCylinder, reproduce
from gc_core.arrays import BoolArray, FloatArray
from gc_core.radius import radius_at
from tests.measurements.geometry import HELD, IN_PLANE, steps_by_median

JUMP = 5.0
"""A step above this many times the median of the steps around it is a jump [-]."""


@dataclass(frozen=True)
class Runs:
    """What became of S runs."""

    outside: int
    """Runs that leave the tube."""
    jumping: int
    """Runs with a jump."""
    worst: float
    """Longest step by the median of the steps around it [-]."""


def in_first_section(cylinder: GeneralizedCylinder, count: int, rng: np.random.Generator) -> FloatArray:
    """Starts (count, 3) evenly spread over the section of station 0, as far as its polygon reaches [m]."""
    return on_sections(cylinder, np.zeros(count, dtype=np.intp), rng)


def anywhere(cylinder: GeneralizedCylinder, count: int, rng: np.random.Generator) -> FloatArray:
    """Starts (count, 3) at any place along the tube, between stations too [m]."""
    length = rng.uniform(0.0, cylinder.arc_length[-1], count)
    place = np.interp(length, cylinder.arc_length, np.arange(len(cylinder.directrix)))
    before = np.minimum(place.astype(np.intp), len(cylinder.directrix) - 2)
    here = on_sections(cylinder, before, rng)
    there = _along(cylinder, here, before)
    starts = here + (place - before)[:, None] * (there - here)
    # What lies between two sections is not exactly what is inside of them: near a boundary it may be out.
    return np.where(cylinder.contains(starts)[:, None], starts, here)


def follow(cylinder: GeneralizedCylinder, starts: FloatArray) -> Runs:
    """Run the skill from starts (S, 3) and judge the runs."""
    runs = reproduce(cylinder, starts)
    ratios = steps_by_median(runs.positions)
    return Runs(
        outside=int((~inside(cylinder, runs.positions, runs.stations)).any(axis=1).sum()),
        jumping=int((ratios > JUMP).any(axis=1).sum()),
        worst=float(ratios.max()),
    )


def inside(cylinder: GeneralizedCylinder, positions: FloatArray, stations: FloatArray) -> BoolArray:
    """Which samples (S, K) of paths (S, K, 3) at stations (K,) lie in the tube.

    What lies in its own station's polygon does; `contains` is asked about the rest.
    """
    rows = np.rint(stations).astype(np.intp)
    local = np.einsum("ski,kij->skj", positions - cylinder.directrix[rows], cylinder.frames[rows])
    angles = np.arctan2(local[..., 2], local[..., 1])
    reach = radius_at(cylinder.radii, np.broadcast_to(rows, angles.shape), angles)
    held = (np.abs(local[..., 0]) <= IN_PLANE) & (np.hypot(local[..., 1], local[..., 2]) <= HELD * reach)
    waiting = (positions == positions[:, :1]).all(axis=2)
    waiting[:, 0] = False
    rest = ~held & ~waiting
    held[rest] = cylinder.contains(positions[rest])
    return np.where(waiting, held[:, :1], held)


def _along(cylinder: GeneralizedCylinder, points: FloatArray, stations: np.ndarray) -> FloatArray:
    """Points (S, 3) of the sections `stations` at the same angle and ratio one section on."""
    local = np.einsum("sk,skj->sj", points - cylinder.directrix[stations], cylinder.frames[stations])
    angles = np.arctan2(local[:, 2], local[:, 1])
    growth = radius_at(cylinder.radii, stations + 1, angles) / radius_at(cylinder.radii, stations, angles)
    return cylinder.directrix[stations + 1] + growth[:, None] * np.einsum(
        "sj,skj->sk", local[:, 1:], cylinder.frames[stations + 1, :, 1:]
    )
