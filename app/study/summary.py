"""A study in numbers that fit on a page: medians and quartiles of each part, and what failed.

What is measured in which experiment, and what each number means, stands here for report and plots.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from app.study.experiments import Done
from app.study.measures import Row
from app.study.parts import Experiment, Part


@dataclass(frozen=True)
class Measure:
    """A number of the table as it is shown."""

    column: str
    title: str
    unit: str
    factor: float
    """From the table's unit to the one shown."""
    meaning: str
    drawn: bool = True
    log: bool = False
    better: Literal["least", "most"] | None = None
    """Which of its values is the best; None: neither is."""


@dataclass(frozen=True)
class Chapter:
    """An experiment as it is shown."""

    experiment: Experiment
    title: str
    what: str
    measures: tuple[Measure, ...]


_JERK: Final = "Time average of the squared third derivative of the place; small is smooth."
_RATIO: Final = Measure(
    "eta_start",
    "Start's ratio",
    "-",
    1.0,
    "Where the start lies in the first slice of the tube that the run was made with, by the ratio rule: "
    "above 1 it is outside of what was shown, and so is the whole run. For the tube only.",
    drawn=False,
)

CHAPTERS: Final = (
    Chapter(
        "starts",
        "Random starts",
        "Each method learns all demonstrations and runs from the same random starts, which are evenly spread "
        "over the first slice of the tightest tube (hull) around them.",
        (
            Measure(
                "spread_kept",
                "Spread kept",
                "%",
                100.0,
                "Distance of a run from the mean of all runs where it passes the middle slice of the "
                "tightest tube, by the distance of its start from the mean of all starts. 0: runs merge; "
                "100: they stay as far apart. The tube keeps it in proportion to its width there.",
            ),
            Measure(
                "end_error_m",
                "End off",
                "cm",
                100.0,
                "Distance of a run's end from the mean end of the demonstrations.",
                better="least",
            ),
            Measure(
                "frechet_m",
                "Frechet",
                "cm",
                100.0,
                "Discrete Frechet distance of a run from the nearest demonstration: the shortest leash for "
                "two walks that never turn back.",
                better="least",
            ),
            Measure(
                "dtw_m",
                "DTW",
                "cm",
                100.0,
                "Dynamic time warping distance of a run from the nearest demonstration, by its samples.",
                drawn=False,
            ),
            Measure("jerk", "Jerk", "m²/s⁶", 1.0, _JERK, log=True, better="least"),
            Measure(
                "contained_shown",
                "Inside what was shown",
                "%",
                100.0,
                "Share of a run's samples in the tightest tube (hull) around the demonstrations.",
                better="most",
            ),
            Measure(
                "contained_own",
                "Inside its tube",
                "%",
                100.0,
                "Share of a run's samples in the tube that it was made with; for the tube only.",
                drawn=False,
            ),
            _RATIO,
        ),
    ),
    Chapter(
        "moves",
        "Moved start and goal",
        "Start and goal are both moved at random; each method runs from the new start to the new goal. The "
        "tube is bent by the paper's thin-plate spline with two landmarks; the others are asked for start "
        "and goal.",
        (
            Measure(
                "start_error_m",
                "Start off",
                "cm",
                100.0,
                "Distance of a run's beginning from the moved start.",
                drawn=False,
            ),
            Measure(
                "end_error_m",
                "End off",
                "cm",
                100.0,
                "Distance of a run's end from the moved goal.",
                better="least",
            ),
            Measure(
                "shape",
                "Change of shape",
                "%",
                100.0,
                "Root mean square distance from the run of the same method that was not moved after the best "
                "similarity (shifted, turned, scaled), by that run's length.",
                better="least",
            ),
            Measure("jerk", "Jerk", "m²/s⁶", 1.0, _JERK, drawn=False, log=True),
            Measure(
                "folded",
                "Folded",
                "stations",
                1.0,
                "Stations of the moved tube at which the map turns space inside out; for the tube only.",
                drawn=False,
            ),
            Measure(
                "crossing",
                "Crossing",
                "stations",
                1.0,
                "Stations of the moved tube whose slice cuts its neighbour's; for the tube only.",
                drawn=False,
            ),
        ),
    ),
    Chapter(
        "left_out",
        "Leave one out",
        "Each method learns all demonstrations but one, runs from the start of the one left out, and is "
        "compared with it.",
        (
            Measure(
                "frechet_m",
                "Frechet",
                "cm",
                100.0,
                "Discrete Frechet distance from the one left out.",
                better="least",
            ),
            Measure(
                "dtw_m",
                "DTW",
                "cm",
                100.0,
                "Dynamic time warping distance from the one left out, by the run's samples.",
                better="least",
            ),
            Measure(
                "end_error_m",
                "End off",
                "cm",
                100.0,
                "Distance of a run's end from the end of the one left out.",
                drawn=False,
            ),
            _RATIO,
            Measure("jerk", "Jerk", "m²/s⁶", 1.0, _JERK, drawn=False, log=True),
        ),
    ),
)


@dataclass(frozen=True)
class Quartiles:
    """Of a number over the runs of a part, in the unit that is shown."""

    low: float
    median: float
    high: float


@dataclass(frozen=True)
class Line:
    """A part in short."""

    part: Part
    runs: int
    failed: int
    found: Mapping[str, Quartiles | None]
    """By column; None where nothing was measured."""
    fit_ms: float | None
    reproduce_ms: float | None

    @property
    def label(self) -> str:
        """The method, and the kind of slices."""
        return f"{self.part.method} {self.part.section}".strip().replace("_", " ")


def lines_of(chapter: Chapter, found: Sequence[tuple[Part, Done]]) -> tuple[Line, ...]:
    """Sum up all parts of an experiment."""
    return tuple(
        Line(
            part,
            len(done.rows),
            sum(row.failed is not None for row in done.rows),
            {each.column: quartiles(each, done.rows) for each in chapter.measures},
            done.timing.fit_ms,
            done.timing.reproduce_ms,
        )
        for part, done in found
        if part.experiment == chapter.experiment
    )


def quartiles(measure: Measure, rows: Sequence[Row]) -> Quartiles | None:
    """Quartiles of a number over the runs that have it."""
    values = [value for row in rows if (value := getattr(row, measure.column)) is not None]
    if not values:
        return None
    low, median, high = measure.factor * np.quantile(values, (0.25, 0.5, 0.75))
    return Quartiles(float(low), float(median), float(high))


@dataclass(frozen=True)
class Failure:
    """Runs that there are not, for one reason."""

    method: str
    data_set: str
    reason: str
    runs: int


def failures(found: Sequence[tuple[Part, Done]]) -> tuple[Failure, ...]:
    """Count what failed, by method, data set and reason."""
    counted = Counter(
        (part.method, part.data_set, row.failed)
        for part, done in found
        for row in done.rows
        if row.failed is not None
    )
    return tuple(Failure(*what, count) for what, count in sorted(counted.items()))
