"""Fig. 6: one motion, three kinds of cross-section."""

from __future__ import annotations

from typing import Any, Final

from app.document import SECTION_KINDS
from app.figures import sheet as fig
from app.figures.skill import portrait
from app.figures.subject import Subject, around, runs
from app.figures.views import seen_across

NAMES: Final = {"circle": "Circle", "ellipse": "Ellipse", "closed_spline": "Closed spline"}
RATIO: Final = 0.7
"""At which the runs begin [-]."""


def draw(subjects: tuple[Subject, ...]) -> Any:
    """Draw demonstrations, tube, directrix and runs for circle, ellipse and closed spline.

    Above the tubes with runs from new starts, below the widest section of each: a circle is wide, a
    spline follows the shape of what was shown.
    """
    subject = subjects[0]
    tubes = {kind: subject.in_section(kind) for kind in SECTION_KINDS}
    widest = tubes["circle"]
    station = int(widest.radii.mean(axis=1).argmax())
    reach = 108.0 * widest.radii[station].max()
    figure = fig.sheet(7.6, 4.2)
    grid = figure.add_gridspec(2, 3, height_ratios=(1.5, 1))
    for column, (kind, tube) in enumerate(tubes.items()):
        view = seen_across(widest)
        where = fig.space(figure, grid[0, column], view, [widest.surface(), *subject.paths])
        corners = len(tube.angles)
        starts = around(tube, RATIO, (corners // 8, corners * 5 // 8))
        portrait(where, tube, subject.paths, [run.positions for run in runs(tube, starts)])
        ring = fig.closed(tube.surface()[station : station + 1])[0]
        where.plot(ring, color=fig.INK, linewidth=1.1, label="section below")
        where.title(f"({'abc'[column]}) {NAMES[kind]}: {1000.0 * tube.volume:.1f} dm³")
        if column == len(tubes) - 1:
            fig.scale_bar(where, fig.bar_for(widest))
        axes = figure.add_subplot(grid[1, column], xlim=(-reach, reach), ylim=(-reach, reach))
        fig.slice_of(axes, tube, station)
        if column:
            axes.set_ylabel("")
    fig.legend(figure)
    return figure
