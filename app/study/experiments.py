"""One part of a study, worked out: the three experiments.

`work` is a pure function of the plan, the part and its data, the times it took aside. A method that
fails has its sentence in each row that it should have made, and stops nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from time import perf_counter
from typing import Final

import numpy as np

from app.baselines import Method, Run, Skill, Taught, Tube, methods, taught
from app.baselines.tube import TubeSkill
from app.clocking import fitted
from app.comparison import half_way
from app.document import Alignment, FloatArray
from app.likeness import nearest_dtw, nearest_frechet
from app.study.errors import OtherVersionsError
from app.study.measures import Row, in_ball, on_sections, shape_change
from app.study.parts import Experiment, Part, random_numbers, versions
from app.study.sources import DataSet
from app.study.spec import Plan
from gc_core import GcError, GeneralizedCylinder, encode, generalize, metrics, register, reproduce

TIGHTEST: Final = "hull"
"""Kind of slices of the tube that all methods are measured by."""


@dataclass(frozen=True)
class Job:
    """What a worker is asked to do; the data come beside it."""

    plan: Plan
    part: Part
    versions: Mapping[str, str]


@dataclass(frozen=True)
class Timing:
    """How long a part took; never the same twice, and so in a table of its own."""

    fits: int = 0
    fit_ms: float | None = None
    """One, in the mean."""
    runs: int = 0
    reproduce_ms: float | None = None
    """One, in the mean."""
    seconds: float = 0.0
    """The whole part, with all that was measured."""


@dataclass(frozen=True)
class Done:
    """What a part found."""

    rows: tuple[Row, ...]
    timing: Timing


@dataclass
class _Watch:
    """Adds up what fits and runs take."""

    fits: list[float] = field(default_factory=list[float])
    runs: list[float] = field(default_factory=list[float])

    def fit(self, method: Method, data: DataSet) -> Skill:
        skill, seconds = fitted(method, data.demonstrations)
        self.fits.append(seconds)
        return skill

    def run(self, skill: Skill, start: FloatArray, goal: FloatArray | None = None) -> Run:
        began = perf_counter()
        run = skill.reproduce(start, goal)
        self.runs.append(perf_counter() - began)
        return run

    def timing(self, seconds: float) -> Timing:
        fit, run = (1000.0 * float(np.mean(each)) if each else None for each in (self.fits, self.runs))
        return Timing(len(self.fits), fit, len(self.runs), run, seconds)


def work(job: Job, data: DataSet) -> Done:
    """Work out one part.

    Raises
    ------
    OtherVersionsError
        If this process has other packages than the one that asks.
    """
    mine = versions()
    differing = [
        f"{name} {mine[name]} in place of {asked}"
        for name, asked in job.versions.items()
        if mine[name] != asked
    ]
    if differing:
        raise OtherVersionsError(", ".join(differing))
    began, watch = perf_counter(), _Watch()
    rows = tuple(_EXPERIMENTS[job.part.experiment](job.plan, job.part, data, watch))
    return Done(rows, watch.timing(perf_counter() - began))


@lru_cache(maxsize=8)
def shown_by(data: DataSet, alignment: Alignment) -> tuple[GeneralizedCylinder, Taught]:
    """Give what all methods are measured by: the tightest tube, and the demonstrations in correspondence."""
    tube = encode(data.demonstrations, section=TIGHTEST, align_by=alignment)
    return tube, taught(data.demonstrations, alignment)


def _method(part: Part) -> Method:
    (method,) = methods((part.method,), Tube(part.section or TIGHTEST, part.alignment))
    method.ready()
    return method


def _row(part: Part, run: int) -> Row:
    return Row(part.experiment, part.data_set, part.alignment, part.method, part.section, run)


def _all_failed(part: Part, count: int, error: GcError) -> list[Row]:
    return [replace(_row(part, run), failed=str(error)) for run in range(count)]


def _starts(plan: Plan, part: Part, data: DataSet, watch: _Watch) -> list[Row]:
    """Run from random starts in the first slice."""
    try:
        tube, shown = shown_by(data, part.alignment)
        starts = on_sections(tube, np.zeros(plan.starts, dtype=np.intp), random_numbers(plan, part))
        skill = watch.fit(_method(part), data)
    except GcError as error:
        return _all_failed(part, plan.starts, error)
    own = skill.cylinder if isinstance(skill, TubeSkill) else None
    rows: list[Row] = []
    crossings: dict[int, FloatArray] = {}
    for number, start in enumerate(starts):
        row = _row(part, number)
        try:
            run = watch.run(skill, start)
            path = run.positions
            row = replace(
                row,
                start_error_m=metrics.end_error(path[:1], start),
                end_error_m=metrics.end_error(path, tube.directrix[-1]),
                frechet_m=nearest_frechet(path, shown.paths),
                dtw_m=nearest_dtw(path, shown.paths),
                jerk=metrics.jerk(path, run.times),
                contained_shown=metrics.containment(tube, path),
                contained_own=None if own is None else metrics.containment(own, path),
                eta_start=_ratio(skill, start),
            )
            crossings[number] = half_way(run, tube)
        except GcError as error:
            row = replace(row, failed=str(error))
        rows.append(row)
    return _with_spread(rows, starts, crossings)


def _with_spread(rows: list[Row], starts: FloatArray, crossings: Mapping[int, FloatArray]) -> list[Row]:
    """Add how far apart the runs are half way, of those that did not fail."""
    numbers = list(crossings)
    if not numbers:
        return rows
    halfway = np.array([crossings[number] for number in numbers], dtype=np.float64)
    begins, middles = (
        np.linalg.norm(each - each.mean(axis=0), axis=1) for each in (starts[numbers], halfway)
    )
    found = list(rows)
    for number, begin, middle in zip(numbers, begins, middles, strict=True):
        found[number] = replace(
            rows[number],
            away_start_m=float(begin),
            away_mid_m=float(middle),
            spread_kept=float(middle / begin) if begin > 0.0 else None,
        )
    return found


def _moves(plan: Plan, part: Part, data: DataSet, watch: _Watch) -> list[Row]:
    """Move start and goal at random: the tube by its landmarks, the others by what they are asked for."""
    try:
        tube, _ = shown_by(data, part.alignment)
        ends = tube.directrix[[0, -1]]
        away = in_ball(2 * plan.moves, plan.farthest_m, random_numbers(plan, part)).reshape(-1, 2, 3)
        skill = watch.fit(_method(part), data)
        before = watch.run(skill, ends[0]).positions
    except GcError as error:
        return _all_failed(part, plan.moves, error)
    rows: list[Row] = []
    for number, targets in enumerate(ends + away):
        row = _row(part, number)
        try:
            if isinstance(skill, TubeSkill):
                row, run = _bent(row, skill.cylinder, ends, targets)
            else:
                run = watch.run(skill, targets[0], targets[1])
            count = min(len(before), len(run.positions))
            row = replace(
                row,
                start_error_m=metrics.end_error(run.positions[:1], targets[0]),
                end_error_m=metrics.end_error(run.positions, targets[1]),
                shape=shape_change(run.positions[-count:], before[-count:]),
                jerk=metrics.jerk(run.positions, run.times),
            )
        except GcError as error:
            row = replace(_row(part, number), failed=str(error))
        rows.append(row)
    return rows


def _bent(row: Row, cylinder: GeneralizedCylinder, ends: FloatArray, targets: FloatArray) -> tuple[Row, Run]:
    """Bend a tube so that its `ends` (2, 3) are at `targets` (2, 3) [m], and run through it."""
    moved = generalize(cylinder, register(ends, targets))
    found = reproduce(moved, targets[0])
    told = moved.diagnostics
    row = replace(
        row,
        folded=int(told.folded.sum()),
        crossing=int(told.crossing.sum()),
        contained_own=metrics.containment(moved, found.positions),
    )
    return row, Run(found.times, found.positions)


def _left_out(_: Plan, part: Part, data: DataSet, watch: _Watch) -> Iterator[Row]:
    """Learn without each demonstration in turn, run from its start, and compare with it."""
    for number, truth in enumerate(data.demonstrations):
        row = _row(part, number)
        others = data.demonstrations[:number] + data.demonstrations[number + 1 :]
        try:
            path = taught([truth], part.alignment).paths[0]
            skill = watch.fit(_method(part), replace(data, demonstrations=others))
            run = watch.run(skill, path[0])
            yield replace(
                row,
                eta_start=_ratio(skill, path[0]),
                start_error_m=metrics.end_error(run.positions[:1], path[0]),
                end_error_m=metrics.end_error(run.positions, path[-1]),
                frechet_m=metrics.frechet(run.positions, path),
                dtw_m=metrics.dtw(run.positions, path) / len(run.positions),
                jerk=metrics.jerk(run.positions, run.times),
            )
        except GcError as error:
            yield replace(row, failed=str(error))


def _ratio(skill: Skill, start: FloatArray) -> float | None:
    """Ratio of a start (3,) in the first slice of a tube; None for other methods."""
    return float(reproduce(skill.cylinder, start).ratios[0]) if isinstance(skill, TubeSkill) else None


_EXPERIMENTS: Final[dict[Experiment, Callable[[Plan, Part, DataSet, _Watch], list[Row] | Iterator[Row]]]] = {
    "starts": _starts,
    "moves": _moves,
    "left_out": _left_out,
}
