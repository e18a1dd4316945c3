"""Fig. 9: five starts beside other methods."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

from app.baselines import methods
from app.comparison import Comparison, Row, compare, task_of
from app.figures import sheet as fig
from app.figures.subject import Subject
from app.figures.views import seen_flat

METHODS: Final = {
    "gc": "Generalized cylinder",
    "dmp-5": "DMP, 5 weights",
    "dmp-10": "DMP, 10 weights",
    "gmr-5": "GMM/GMR, 5 Gaussians",
    "gmr-10": "GMM/GMR, 10 Gaussians",
}
STARTS: Final = 5


def draw(subjects: tuple[Subject, ...]) -> Any:
    """Draw the runs of the cylinder, of two DMPs and of two mixtures from the same five starts.

    Each title says how far apart the runs are half way (root mean square from their mean), and how many
    touch what stands in the way; the last panel shows the former beside the starts' own spread.
    """
    subject = subjects[0]
    task = replace(task_of(subject.document), demonstrations=subject.demonstrations)
    found = compare(task, methods(tuple(METHODS), task.tube), STARTS)
    figure = fig.sheet(7.6, 4.4)
    grid = figure.add_gridspec(2, 3)
    view, room = seen_flat(subject.cylinder), [found.cylinder.surface(), *subject.paths]
    bodies = [fig.faces_of(thing) for thing in subject.document.things]
    cells = [fig.space(figure, grid[number], view, [*room, *bodies]) for number in range(len(METHODS))]
    for letter, where, row in zip("abcde", cells, found.rows, strict=True):
        _runs(where, subject, found, row)
        where.title(f"({letter}) {METHODS[row.method]}\n{_words(row)}")
    fig.scale_bar(cells[-1], fig.bar_for(found.cylinder))
    _spreads(figure.add_subplot(grid[5]), found)
    fig.legend(figure)
    return figure


def _runs(where: fig.Space, subject: Subject, found: Comparison, row: Row) -> None:
    if row.method == "gc":
        fig.tube(where, found.cylinder, things=subject.document.things)
    else:
        fig.bodies(where, subject.document.things)
    fig.lines(where, subject.paths, "demonstrations", color=fig.DEMONSTRATION, linewidth=0.6)
    runs = [run.positions for run in found.runs.get(row.method, ())]
    fig.lines(where, runs, "runs from five starts", color=fig.REPRODUCTION, linewidth=1.3, zorder=2.3)
    where.plot(found.starts, "o", color=fig.INK, markersize=3, label="starts", zorder=3)


def _spreads(axes: Any, found: Comparison) -> None:
    """Bars: how far apart the runs of each method are half way [cm]."""
    done = [row for row in found.rows if row.spread_mid_m is not None]
    names = [row.method.upper() for row in done]
    axes.barh(names, [100.0 * (row.spread_mid_m or 0.0) for row in done], color=fig.REPRODUCTION, height=0.6)
    if done:
        start = 100.0 * (done[0].spread_start_m or 0.0)
        axes.axvline(start, color=fig.INK, linewidth=0.9, linestyle="--")
        left = start < 0.5 * axes.get_xlim()[1]
        beside = {"textcoords": "offset points", "ha": "left" if left else "right", "va": "center"}
        axes.annotate("the starts", (start, len(done) - 1), (4 if left else -4, 0), **beside)
    axes.invert_yaxis()
    axes.set(xlabel="apart half way [cm]", title="(f) Spread of the runs")


def _words(row: Row) -> str:
    if row.spread_mid_m is None:
        return "not available here"
    touch = "" if row.contacts is None else f", {row.contacts} of {STARTS} touch"
    return f"half way {100.0 * row.spread_mid_m:.1f} cm apart{touch}"
