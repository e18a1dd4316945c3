"""One skill on a sheet: the tube, what was shown, the middle line, runs, and what stands around."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from app.arm.shapes import Shape
from app.document import FloatArray
from app.figures.sheet import (
    DEMONSTRATION,
    REPRODUCTION,
    Space,
    bar_for,
    legend,
    lines,
    scale_bar,
    sheet,
    space,
    tube,
)
from app.figures.views import seen_flat
from gc_core import GeneralizedCylinder

WORDS: Final = {
    "tube": "tube (generalized cylinder)",
    "directrix": "middle line",
    "reproductions": "new run",
}
"""Those of the app, for the experts' words."""


def draw(
    cylinder: GeneralizedCylinder,
    demonstrations: Sequence[FloatArray],
    runs: Sequence[FloatArray],
    things: Sequence[Shape],
    title: str,
) -> Any:
    """Make the figure of `app.figures.skill_figure`."""
    figure = sheet(5.4, 3.9)
    where = space(figure, figure.add_gridspec(1, 1)[0], seen_flat(cylinder))
    portrait(where, cylinder, demonstrations, runs, things)
    where.title(title)
    scale_bar(where, bar_for(cylinder))
    legend(figure, words=WORDS)
    return figure


def portrait(
    where: Space,
    cylinder: GeneralizedCylinder,
    demonstrations: Sequence[FloatArray],
    runs: Sequence[FloatArray] = (),
    things: Sequence[Shape] = (),
) -> None:
    """Draw a skill: each path is (K, 3) [m]."""
    tube(where, cylinder, things=things)
    lines(where, demonstrations, "demonstrations", color=DEMONSTRATION, linewidth=0.8)
    lines(where, runs, "reproductions", color=REPRODUCTION, linewidth=1.5, zorder=2.3)
    for run in runs:
        where.plot(run[0], "o", color=REPRODUCTION, markersize=3.5, zorder=2.4)
