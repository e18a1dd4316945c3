"""Fig. 5: how a new run is made, by the ratio rule."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from app.figures import sheet as fig
from app.figures.subject import Subject
from app.figures.views import seen_across
from gc_core import GeneralizedCylinder, Reproduction, reproduce

LATER: Final = 0.45
"""Which slice is compared with the first, by station [-]."""
RATIO: Final = 0.7
"""Of the run [-]."""


def draw(subjects: tuple[Subject, ...]) -> Any:
    """Draw a start in the first cross-section, its ratio to the boundary, and the same in a later one.

    The ray from the centre through the start p meets the boundary in g; the run keeps the direction of
    the ray in the moving frame, and the ratio eta of both distances.
    """
    cylinder = subjects[0].cylinder
    corner = len(cylinder.angles) // 8
    start = cylinder.directrix[0] + RATIO * (cylinder.surface()[0, corner] - cylinder.directrix[0])
    run = reproduce(cylinder, start, at=0)
    later = int(LATER * len(cylinder.directrix))
    figure = fig.sheet(7.6, 4.0)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.5, 1))
    where = fig.space(figure, grid[:, 0], seen_across(cylinder))
    fig.tube(where, cylinder)
    where.plot(run.positions, color=fig.REPRODUCTION, linewidth=1.8, label="reproduction", zorder=2.3)
    rings = fig.closed(cylinder.surface())
    fig.lines(where, [rings[0], rings[later]], "sections (b), (c)", color=fig.INK, linewidth=1.2)
    where.plot(run.positions[[0, later]], "o", color=fig.REPRODUCTION, markersize=4, zorder=3)
    where.title("(a) A new run")
    fig.scale_bar(where, fig.bar_for(cylinder))
    reach = 108.0 * max(cylinder.radii[0].max(), cylinder.radii[later].max())
    for row, (name, station) in enumerate((("(b) First section", 0), ("(c) Later section", later))):
        axes = figure.add_subplot(grid[row, 1], xlim=(-reach, reach), ylim=(-reach, reach))
        _rule(axes, cylinder, run, station)
        axes.set_title(f"{name}: η = {run.ratios[station]:.2f}")
    fig.legend(figure)
    return figure


def _rule(axes: Any, cylinder: GeneralizedCylinder, run: Reproduction, station: int) -> None:
    """Draw one section with the ray from its centre through the run to the boundary [cm]."""
    fig.slice_of(axes, cylinder, station)
    place = (run.positions[station] - cylinder.directrix[station]) @ cylinder.frames[station, :, 1:]
    inside, rim = 100.0 * place, 100.0 * place / run.ratios[station]
    axes.plot(*np.stack([np.zeros(2), rim]).T, color=fig.INK, linewidth=0.8, linestyle="--")
    axes.plot(*np.stack([np.zeros(2), inside]).T, color=fig.REPRODUCTION, linewidth=1.6)
    axes.plot(*inside, "o", color=fig.REPRODUCTION, markersize=5)
    axes.plot(*rim, "o", markerfacecolor="white", markeredgecolor=fig.INK, markersize=4)
    across = 9.0 * np.array([rim[1], -rim[0]]) / np.linalg.norm(rim)
    along = 9.0 * rim / np.linalg.norm(rim)
    for point, name, away in ((inside, "p", across), (rim, "g", along), (np.zeros(2), "c", across)):
        axes.annotate(name, point, away, textcoords="offset points", ha="center", va="center", fontsize=8)
