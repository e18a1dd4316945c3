"""One skill on a sheet: the tube, what was shown, the middle line, runs, and what stands around."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from app.arm.shapes import Shape
from app.document import FloatArray
from app.figures.sheet import (
    DEMONSTRATION,
    REPRODUCTION,
    Space,
    legend,
    lines,
    scale_bar,
    seen_across,
    sheet,
    space,
    tube,
)
from gc_core import GeneralizedCylinder


def draw(
    cylinder: GeneralizedCylinder,
    demonstrations: Sequence[FloatArray],
    runs: Sequence[FloatArray],
    things: Sequence[Shape],
    title: str,
) -> Any:
    """Make the figure of `app.figures.skill_figure`."""
    figure = sheet(5.4, 3.9)
    where = space(figure, figure.add_gridspec(1, 1)[0], seen_across(cylinder))
    portrait(where, cylinder, demonstrations, runs, things)
    where.axes.set_title(title)
    scale_bar(where, bar_for(cylinder))
    legend(figure)
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


def bar_for(cylinder: GeneralizedCylinder) -> float:
    """Choose a scale bar that suits a tube: about a quarter of it, 1, 2 or 5 of some unit [m]."""
    wanted = 0.3 * float(cylinder.arc_length[-1])
    unit = 10.0 ** math.floor(math.log10(wanted))
    return max(part * unit for part in (1.0, 2.0, 5.0) if part * unit <= wanted)
