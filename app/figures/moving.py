"""Fig. 7: new goals and new starts, nothing shown again."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from app.document import FloatArray
from app.figures import sheet as fig
from app.figures.subject import Subject, around, runs
from app.figures.views import seen_flat
from gc_core import GeneralizedCylinder, generalize, register

GOALS, STARTS = 3, 4
RATIO: Final = 0.7
"""At which the runs begin [-]."""


def draw(subjects: tuple[Subject, ...]) -> Any:
    """Draw the tube as taught, bent to three new goals, and another one bent to four new starts.

    The first skill (*Curved reach and place*) has its goal moved, the last one (*Pick and place*) its
    start. Faint is where the tube was taught; hollow is where a landmark stood.
    """
    figure = fig.sheet(7.6, 4.1)
    rows = figure.add_gridspec(2, 4)
    first, last = subjects[0], subjects[-1]
    placed = [np.stack([first.ends[0], goal]) for goal in first.moved("goal", GOALS)]
    _row(figure, rows, 0, first, [first.ends, *placed])
    _row(figure, rows, 1, last, [np.stack([start, last.ends[1]]) for start in last.moved("start", STARTS)])
    fig.legend(figure)
    return figure


def _row(figure: Any, grid: Any, row: int, subject: Subject, placings: list[FloatArray]) -> None:
    taught = subject.cylinder
    tubes = [_bent(subject, after) for after in placings]
    view, room = seen_flat(taught), [tube.surface() for tube in (taught, *tubes)]
    cells = [fig.space(figure, grid[row, column], view, [*room, *placings]) for column in range(len(tubes))]
    for column, (where, tube, after) in enumerate(zip(cells, tubes, placings, strict=True)):
        if tube is not taught:
            fig.former(where, taught)
        fig.tube(where, tube)
        starts = around(tube, RATIO, slice(None, None, len(tube.angles) // 4))
        paths = [run.positions for run in runs(tube, starts)]
        fig.lines(where, paths, "reproductions", color=fig.REPRODUCTION, linewidth=0.9)
        fig.landmarks(where, subject.ends, after)
        where.title(f"({'abcdefgh'[4 * row + column]}) {_words(subject.ends, after)}")
    fig.scale_bar(cells[-1], fig.bar_for(taught), triad=False)


def _bent(subject: Subject, after: FloatArray) -> GeneralizedCylinder:
    if np.array_equal(after, subject.ends):
        return subject.cylinder
    return generalize(subject.cylinder, register(subject.ends, after))


def _words(before: FloatArray, after: FloatArray) -> str:
    start, goal = 100.0 * np.linalg.norm(after - before, axis=1)
    if start + goal == 0.0:
        return "As taught"
    return f"Start moved by {start:.0f} cm" if start else f"Goal moved by {goal:.0f} cm"
