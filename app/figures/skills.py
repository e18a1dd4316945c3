"""Fig. 8: the skills."""

from __future__ import annotations

from typing import Any

from app.figures import sheet as fig
from app.figures.skill import portrait
from app.figures.subject import Subject, runs
from app.figures.views import seen_flat


def draw(subjects: tuple[Subject, ...]) -> Any:
    """Draw each skill: demonstrations, tube, directrix, what stands around, and two runs from new starts.

    (a) *Needle*: wide, narrow, wide. (b) *Curved reach and place*. (c) *Around an obstacle* that nobody
    told the robot of. (d) *Pick and place*: exact at both ends, free in between. Of a file: its skill.
    """
    columns = min(len(subjects), 2)
    figure = fig.sheet(3.8 * columns if columns > 1 else 5.4, 2.7 * ((len(subjects) + 1) // 2) + 0.3)
    grid = figure.add_gridspec((len(subjects) + 1) // 2, columns)
    for number, (cell, subject) in enumerate(zip(grid, subjects, strict=False)):
        tube = subject.cylinder
        where = fig.space(figure, cell, seen_flat(tube))
        paths = [run.positions for run in runs(tube, subject.starts)]
        portrait(where, tube, subject.paths, paths, subject.document.things)
        letter = f"({'abcdefgh'[number]}) " if len(subjects) > 1 else ""
        where.title(letter + subject.document.title)
        fig.scale_bar(where, fig.bar_for(tube))
    fig.legend(figure)
    return figure
