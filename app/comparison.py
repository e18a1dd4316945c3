"""Methods side by side: the same demonstrations, the same starts, the same numbers.

The claims of the paper's Fig. 9 are checked, not assumed: each comes with what was measured and
whether it holds on these demonstrations.
"""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from app.arm.protocol import Arm
from app.arm.shapes import Shape
from app.baselines import BaselineError, Method, Run, Taught, Tube, places_at, taught
from app.clocking import REPEATS, timed
from app.document import Document, FloatArray
from app.likeness import nearest_dtw, nearest_frechet
from app.touching import clearances
from gc_core import Demonstration, GeneralizedCylinder, InvalidSettingError, metrics

MOST_STARTS: Final = 1000
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
    """What must not be touched."""
    arm: Arm | None = None
    """Asked how clear it stays of its obstacles, after everything else; see `app.touching`."""
    starts: FloatArray | None = None
    """(S, 3) where all begin [m]; None: see `starts_in`."""


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
    """Least distance from a thing over all runs, of the whole arm where one was asked, else of the point that
    the hand leads; negative inside."""
    contacts: int | None = None
    """Runs that touch a thing, likewise."""


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
    kept: float
    """Which part of the starts' spread is left half way [-]."""
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
    *_, found = comparing(task, methods, count)
    return found


def comparing(
    task: Task, methods: Sequence[Method], count: int = 5, repeats: int = REPEATS
) -> Generator[Comparison]:
    """Compare step by step: as `compare`, for whoever wants to show what is known already.

    Parameters
    ----------
    task : Task
    methods : sequence of Method
    count : int
        Number of starts S, where the task has none of its own.
    repeats : int
        Fits of a method that are timed at most.

    Yields
    ------
    Comparison
        Without rows; with one row more after each method; then, where an arm is asked, as many again, each
        with one more row that says how clear it is.
    """
    cylinder = task.tube.fit(task.demonstrations).cylinder
    starts = starts_in(cylinder, count) if task.starts is None else task.starts
    found = Comparison(starts, cylinder, ())
    yield found
    shown = taught(task.demonstrations, task.tube.align_by)
    for method in methods:
        row, runs = _tried(method, found, task, shown, repeats)
        more = found.runs | ({method.name: runs} if runs else {})
        found = replace(found, rows=(*found.rows, row), runs=more)
        yield found
    for number, row in enumerate(found.rows if task.arm is not None else ()):
        cleared = _cleared(row, found.runs.get(row.method, ()), task)
        found = replace(found, rows=(*found.rows[:number], cleared, *found.rows[number + 1 :]))
        yield found


def task_of(document: Document) -> Task:
    """What a document is compared on: what it learns from, as it was taught, and what stands fixed."""
    settings = document.settings
    return Task(
        tuple(each.demonstration for each in document.demonstrations if not each.muted),
        Tube(settings.section, settings.align_by, settings.stations),
        tuple(thing for thing in document.things if thing.mass == 0.0),
    )


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


def width_half_way(cylinder: GeneralizedCylinder) -> float:
    """How wide a tube is in its middle slice, by its width in the first one [-]."""
    widths = cylinder.radii.mean(axis=1)
    return float(widths[len(widths) // 2] / widths[0])


def kept_of(row: Row) -> float | None:
    """Say which part of the starts' spread is left half way [-]; None without runs, or from one place."""
    if row.spread_mid_m is None or not row.spread_start_m:
        return None
    return row.spread_mid_m / row.spread_start_m


def claims(comparison: Comparison) -> tuple[Claim, ...]:
    """Check Fig. 9: the tube keeps paths distinct, the movement primitives and the mixtures merge them."""
    wide = width_half_way(comparison.cylinder)
    found: list[Claim] = []
    for row in comparison.rows:
        kept = kept_of(row)
        if kept is None:
            continue
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
        found.append(Claim(row.method, holds, kept, sentence))
    return tuple(found)


def _tried(
    method: Method, found: Comparison, task: Task, shown: Taught, repeats: int
) -> tuple[Row, tuple[Run, ...]]:
    """Let one method learn and run; without runs where it fails."""
    try:
        done = timed(method, task.demonstrations, found.starts, repeats)
    except BaselineError as error:
        return Row(method.name, failed=str(error)), ()
    row = Row(
        method.name,
        fit_ms=done.fit_ms,
        reproduce_ms=done.reproduce_ms,
        spread_start_m=spread(found.starts),
    )
    row = _judged(row, done.runs, found.cylinder, shown)
    return row if task.arm is not None else _cleared(row, done.runs, task), done.runs


def _judged(row: Row, runs: tuple[Run, ...], cylinder: GeneralizedCylinder, shown: Taught) -> Row:
    """Add how good the runs are."""
    paths = [run.positions for run in runs]
    return replace(
        row,
        spread_mid_m=spread(np.array([half_way(run, cylinder) for run in runs])),
        end_error_m=_mean([metrics.end_error(path, cylinder.directrix[-1]) for path in paths]),
        frechet_m=_mean([nearest_frechet(path, shown.paths) for path in paths]),
        dtw_m=_mean([nearest_dtw(path, shown.paths) for path in paths]),
        jerk=_mean([metrics.jerk(run.positions, run.times) for run in runs]),
    )


def _cleared(row: Row, runs: tuple[Run, ...], task: Task) -> Row:
    """Add how clear of everything the runs are."""
    if not runs or not (task.things or (task.arm is not None and task.arm.conditions.obstacles)):
        return row
    clear = clearances(runs, task.things, task.arm)
    return replace(row, clearance_m=float(clear.min()), contacts=int((clear <= 0.0).sum()))


def _mean(values: list[float]) -> float:
    return float(np.mean(values))
