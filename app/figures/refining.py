"""Fig. 10: a demonstration is corrected and the skill learned again."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from app.document import FloatArray
from app.figures import sheet as fig
from app.figures.skill import portrait
from app.figures.subject import Subject, pulled, runs
from app.figures.views import seen_across
from app.model import encode_as
from gc_core import GeneralizedCylinder, refined

PULL: Final = 0.11
"""How far the first demonstration is pulled down, by its length [-]."""


def draw(subjects: tuple[Subject, ...]) -> Any:
    """Draw a skill before and after its first demonstration was pulled down in its middle.

    The correction (green) takes the place of its original (dashed); of n demonstrations the mean takes
    over an n-th of it, and the same start gives a run that sinks with it.
    """
    subject = subjects[0]
    before, original = subject.cylinder, subject.paths[0]
    corrected = pulled(original, PULL)
    demonstrations = refined(subject.demonstrations, 0, corrected)
    after = encode_as(demonstrations, subject.document.settings)
    start = before.directrix[:1]
    room = [before.surface(), after.surface(), original, corrected]
    view = seen_across(before)
    wide, high = np.ptp(before.surface().reshape(-1, 3) @ view[:2].T, axis=0)
    rows, columns = (2, 1) if wide > 2.0 * high else (1, 2)
    figure = fig.sheet(7.6, 3.9)
    grid = figure.add_gridspec(rows, columns)
    sunk = 100.0 * float((before.directrix - after.directrix)[:, 2].max())
    titles = ("(a) As shown", f"(b) Demonstration 1 corrected, learned again:\ndirectrix {sunk:.1f} cm lower")
    cells = [fig.space(figure, cell, view, room) for cell in grid]
    shown = (subject.paths, [each.positions for each in demonstrations[1:]])
    for where, title, tube, paths in zip(cells, titles, (before, after), shown, strict=True):
        portrait(where, tube, paths, [run.positions for run in runs(tube, start + _beside(before))])
        where.title(title)
    cells[1].plot(original, color=fig.INK, linewidth=0.9, linestyle="--", label="before its correction")
    cells[1].plot(corrected, color=fig.REFINED, linewidth=2.0, label="corrected", zorder=2.4)
    fig.scale_bar(cells[1], fig.bar_for(before))
    fig.legend(figure)
    return figure


def _beside(tube: GeneralizedCylinder) -> FloatArray:
    """From the centre of the first slice half way to where its boundary is level with it [m]."""
    away = tube.surface()[0] - tube.directrix[0]
    return 0.5 * away[np.abs(away[:, 2]).argmin()]
