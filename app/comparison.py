"""Methods side by side: the same demonstrations, the same starts, the same numbers.

The claims of the paper's Fig. 9 are checked, not assumed: each comes with what was measured and
whether it holds on these demonstrations.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from importlib import import_module
from time import perf_counter
from typing import Any, Final

import numpy as np

from app.arm.shapes import Shape, pose_of, surface_distance
from app.baselines import BaselineError, Method, Run, Skill, Taught, Tube, places_at, taught
from app.document import FloatArray
from gc_core import Demonstration, GeneralizedCylinder, InvalidSettingError, metrics

MOST_STARTS: Final = 1000
REPEATS: Final = 3
"""Fits that are timed at most; the quickest counts."""
ENOUGH: Final = 0.2
"""No fit is repeated once this was spent [s]."""
DISTINCT: Final = 0.8
"""The tube keeps paths distinct when their spread half way is this part of what its width there gives [-]."""
MERGED: Final = 0.25
"""Paths have merged when this part of the starts' spread is left half way, or less [-]."""
GOLDEN_ANGLE: Final = math.pi * (3.0 - math.sqrt(5.0))
"""Between starts that follow each other: no two in one direction, however many there are [rad]."""


@dataclass(frozen=True, eq=False)
class Task:
    """What is compared on."""

    demonstrations: tuple[Demonstration, ...]
    tube: Tube = field(default_factory=Tube)
    things: tuple[Shape, ...] = ()
    """What the hand must not touch."""


@dataclass(frozen=True)
class Row:
    """What one method did; means over all runs. None: it failed, or nothing is in the way."""

    method: str
    spread_mid_m: float | None = None
    """Of the runs where they pass the tube's middle slice: root mean square distance from their mean."""
    end_error_m: float | None = None
    """From the end of the directrix."""
    frechet_m: float | None = None
    """From the nearest demonstration."""
    dtw_m: float | None = None
    """From the nearest demonstration, dynamic time warping by the run's samples."""
    jerk: float | None = None
    """Mean squared [m^2/s^6]."""
    fit_ms: float | None = None
    reproduce_ms: float | None = None
    """One run."""
    failed: str | None = None
    """Why it failed, in a sentence."""
    spread_start_m: float | None = None
    """Of the starts, measured as half way."""
    clearance_m: float | None = None
    """Least distance of the hand's ball point from a thing, over all runs; negative inside."""
    contacts: int | None = None
    """Runs that touch a thing."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """All methods on one task."""

    starts: FloatArray
    """(S, 3) [m]."""
    cylinder: GeneralizedCylinder
    """Says where the starts are, where half way is, and where the end."""
    rows: tuple[Row, ...]
    runs: dict[str, tuple[Run, ...]] = field(default_factory=dict[str, tuple[Run, ...]])
    """By method, one a start; a method that failed is not in it."""


@dataclass(frozen=True)
class Claim:
    """A claim of Fig. 9, and whether it holds here."""

    method: str
    holds: bool
    sentence: str


def starts_in(cylinder: GeneralizedCylinder, count: int) -> FloatArray:
    """Spread starts over the first slice of a tube, always the same ones.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
    count : int
        S, from 1 to `MOST_STARTS`.

    Returns
    -------
    (S, 3) array
        Inside of the slice, each in another direction and at another ratio [m].

    Raises
    ------
    InvalidSettingError
        If there cannot be so many.
    """
    if not 1 <= count <= MOST_STARTS:
        raise InvalidSettingError("The number of starts", count, f"from 1 to {MOST_STARTS}")
    number = np.arange(count)
    ratios, angles = np.sqrt((number + 0.5) / count), (number * GOLDEN_ANGLE) % (2.0 * np.pi)
    around = np.append(cylinder.angles, cylinder.angles[0] + 2.0 * np.pi)
    corners = np.concatenate([cylinder.surface()[0], cylinder.surface()[0, :1]])
    boundary = places_at(cylinder.angles[0] + angles, around, corners)
    return cylinder.directrix[0] + ratios[:, None] * (boundary - cylinder.directrix[0])


def compare(task: Task, methods: Sequence[Method], count: int = 5) -> Comparison:
    """Let methods learn the same demonstrations and run from the same starts.

    Parameters
    ----------
    task : Task
    methods : sequence of Method
    count : int
        Number of starts S, see `starts_in`.

    Returns
    -------
    Comparison
        A method that fails has a row that says why, and stops nothing.

    Raises
    ------
    InvalidSettingError
        If there cannot be so many starts.
    GcError
        If no method could learn from these demonstrations.
    """
    cylinder = task.tube.fit(task.demonstrations).cylinder
    starts = starts_in(cylinder, count)
    shown = taught(task.demonstrations, task.tube.align_by)
    rows: list[Row] = []
    runs: dict[str, tuple[Run, ...]] = {}
    for method in methods:
        try:
            done, fit_ms, reproduce_ms = _timed(method, task.demonstrations, starts)
        except BaselineError as error:
            rows.append(Row(method.name, failed=str(error)))
            continue
        runs[method.name] = done
        row = _judged(Row(method.name, fit_ms=fit_ms, reproduce_ms=reproduce_ms), done, cylinder, shown)
        rows.append(_with_contacts(replace(row, spread_start_m=spread(starts)), done, task.things))
    return Comparison(starts, cylinder, tuple(rows), runs)


def spread(places: FloatArray) -> float:
    """Root mean square distance of places (S, 3) from their mean [m]."""
    return float(np.sqrt(((places - places.mean(axis=0)) ** 2).sum(axis=1).mean()))


def half_way(run: Run, cylinder: GeneralizedCylinder) -> FloatArray:
    """Find where a run passes the middle slice of a tube.

    Parameters
    ----------
    run : Run
    cylinder : GeneralizedCylinder

    Returns
    -------
    (3,) array
        Of all crossings of the slice's plane, the one nearest to the slice's centre; without any, the
        sample nearest to it [m].
    """
    middle = len(cylinder.directrix) // 2
    centre, normal = cylinder.directrix[middle], cylinder.frames[middle, :, 0]
    path = run.positions
    height = (path - centre) @ normal
    crossed = np.flatnonzero(height[:-1] * height[1:] <= 0.0)
    before, after = height[crossed], height[crossed + 1]
    part = before / np.where(before == after, 1.0, before - after)
    places = path[crossed] + part[:, None] * (path[crossed + 1] - path[crossed])
    found = places if len(places) else path
    return found[np.linalg.norm(found - centre, axis=1).argmin()]


def claims(comparison: Comparison) -> tuple[Claim, ...]:
    """Check Fig. 9: the tube keeps paths distinct, the movement primitives and the mixtures merge them."""
    widths = comparison.cylinder.radii.mean(axis=1)
    wide = float(widths[len(widths) // 2] / widths[0])
    found: list[Claim] = []
    for row in comparison.rows:
        if row.spread_mid_m is None or not row.spread_start_m:
            continue
        kept = row.spread_mid_m / row.spread_start_m
        if row.method == "gc":
            holds = kept >= DISTINCT * wide
            verb = "keeps the paths apart" if holds else "does not keep the paths apart here"
            beside = f"; the tube is {100.0 * wide:.0f} % as wide there as at its start"
        elif row.method.startswith(("dmp", "gmr")):
            holds = kept <= MERGED
            verb, beside = "merges them" if holds else "does not merge them here", ""
        else:
            continue
        sentence = (
            f"{row.method} {verb}: half way {100.0 * kept:.0f} % of the starts' spread is left{beside}."
        )
        found.append(Claim(row.method, holds, sentence))
    return tuple(found)


def _timed(
    method: Method, demonstrations: Sequence[Demonstration], starts: FloatArray
) -> tuple[tuple[Run, ...], float, float]:
    """Runs from all starts, and how long the quickest fit and a run took [ms]."""
    method.ready()
    with one_thread():
        return _clocked(method, demonstrations, starts)


def _clocked(
    method: Method, demonstrations: Sequence[Demonstration], starts: FloatArray
) -> tuple[tuple[Run, ...], float, float]:
    skill, quickest = _fitted(method, demonstrations)
    spent = quickest
    for _ in range(REPEATS - 1):
        if spent > ENOUGH:
            break
        skill, seconds = _fitted(method, demonstrations)
        quickest, spent = min(quickest, seconds), spent + seconds
    began = perf_counter()
    runs = tuple(skill.reproduce(start) for start in starts)
    return runs, 1000.0 * quickest, 1000.0 * (perf_counter() - began) / len(starts)


def one_thread() -> AbstractContextManager[object]:
    """Keep linear algebra to one thread: small matrices are shared out at a multiple of their cost."""
    try:
        limit: Any = import_module("threadpoolctl").threadpool_limits
    except ImportError:
        return nullcontext()
    return limit(1)


def _fitted(method: Method, demonstrations: Sequence[Demonstration]) -> tuple[Skill, float]:
    """Fit once, and say how long it took [s]."""
    # Copies, since what was computed of a demonstration before would be remembered with it.
    fresh = [replace(each) for each in demonstrations]
    began = perf_counter()
    skill = method.fit(fresh)
    return skill, perf_counter() - began


def _judged(row: Row, runs: tuple[Run, ...], cylinder: GeneralizedCylinder, shown: Taught) -> Row:
    """Add how good the runs are."""
    paths = [run.positions for run in runs]
    leash = [min(metrics.frechet(path, other) for other in shown.paths) for path in paths]
    warped = [min(metrics.dtw(path, other) for other in shown.paths) / len(path) for path in paths]
    return replace(
        row,
        spread_mid_m=spread(np.array([half_way(run, cylinder) for run in runs])),
        end_error_m=_mean([metrics.end_error(path, cylinder.directrix[-1]) for path in paths]),
        frechet_m=_mean(leash),
        dtw_m=_mean(warped),
        jerk=_mean([metrics.jerk(run.positions, run.times) for run in runs]),
    )


def _with_contacts(row: Row, runs: tuple[Run, ...], things: tuple[Shape, ...]) -> Row:
    if not things:
        return row
    clear = [
        min(surface_distance(thing, pose_of(thing), place) for thing in things for place in run.positions)
        for run in runs
    ]
    return replace(row, clearance_m=min(clear), contacts=sum(each <= 0.0 for each in clear))


def _mean(values: list[float]) -> float:
    return float(np.mean(values))
