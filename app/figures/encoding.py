"""Fig. 4: the steps from demonstrations to a generalized cylinder."""

from __future__ import annotations

from typing import Any, Final

from app.figures import sheet as fig
from app.figures.subject import Subject
from app.figures.views import seen_across
from gc_core.arrays import evenly

STATIONS: Final = 9
"""Slices that are drawn while the tube is made."""
LINKS: Final = 16
"""Places at which what corresponds is joined."""


def draw(subjects: tuple[Subject, ...]) -> Any:
    """Draw the steps: as recorded, brought into correspondence, cut by planes, and the boundary around.

    (a) The demonstrations. (b) Aligned: thin lines join what belongs together, the directrix is its
    mean. (c) Planes across the directrix cut the demonstrations in the effective points, and around
    those lies a closed curve. (d) The boundary along the whole directrix.
    """
    subject = subjects[0]
    cylinder = subject.cylinder
    view, room = seen_across(cylinder), [cylinder.surface(), *subject.paths]
    figure = fig.sheet(7.6, 5.0)
    grid = figure.add_gridspec(2, 2)
    titles = ("(a) Demonstrations", "(b) Correspondence and directrix", "(c) Cross-sections", "(d) Cylinder")
    cells = [fig.space(figure, cell, view, room) for cell in grid]
    for where, title in zip(cells, titles, strict=True):
        where.title(title)
    shown = {"color": fig.DEMONSTRATION, "linewidth": 0.9}
    fig.lines(cells[0], subject.paths, "demonstrations", **shown)
    fig.lines(cells[1], list(cylinder.aligned), "demonstrations", **shown)
    some = evenly(len(cylinder.directrix), LINKS)
    links = [cylinder.aligned[:, station] for station in some]
    fig.lines(cells[1], links, "same station", color=fig.TUBE, linewidth=0.6, marker=".", markersize=2)
    spine = {"color": fig.DIRECTRIX, "linewidth": 2.0, "label": "directrix"}
    cells[1].plot(cylinder.directrix, **spine)
    fig.lines(cells[2], subject.paths, "demonstrations", color=fig.DEMONSTRATION, linewidth=0.5, alpha=0.5)
    cells[2].plot(cylinder.directrix, **spine)
    _slices(cells[2], subject)
    fig.tube(cells[3], cylinder)
    fig.lines(cells[3], subject.paths, "demonstrations", **shown)
    fig.scale_bar(cells[3], fig.bar_for(cylinder))
    fig.legend(figure)
    return figure


def _slices(where: fig.Space, subject: Subject) -> None:
    cylinder = subject.cylinder
    some = evenly(len(cylinder.directrix), STATIONS)
    rings = list(fig.closed(cylinder.surface())[some])
    fig.lines(where, rings, "cross-section", color=fig.INK, linewidth=0.9)
    points = cylinder.effective_points[some].reshape(-1, 3)
    look = {"color": fig.DEMONSTRATION, "markersize": 2.6, "zorder": 3}
    where.plot(points, "o", label="effective points", **look)
