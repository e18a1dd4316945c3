"""Fig. 2: what a generalized cylinder is made of."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from app.document import FloatArray
from app.figures import sheet as fig
from app.figures.subject import Subject
from app.figures.views import seen_across, seen_flat
from gc_core import GeneralizedCylinder
from gc_core.arrays import evenly
from gc_core.frames import angles_between, smooth

AXES: Final = (("T", fig.INK), ("N", fig.REFINED), ("B", "#B8860B"))
SECTIONS: Final = (0.12, 0.4, 0.68, 0.95)
"""Which slices are drawn with their frames, by station [-]."""
LETTERED: Final = 3
"""Which of them has letters at its frame."""
REACH: Final = 8
"""Stations over which the directrix is smoothed before it is differentiated twice."""
WHISKERS: Final = 50
AXIS_LENGTH: Final = 0.12
"""Of a frame's axes, by the size of the motion [-]."""


def draw(subjects: tuple[Subject, ...]) -> Any:
    """Draw a directrix with cross-sections and their frames T, N, B; beside it why the frames are carried.

    Left: the directrix sweeps a changing cross-section along; each stands across T and is described
    in N and B. Right: N along the directrix for the frames of Frenet, which follow the curve's
    acceleration and swing round wherever it bends the other way, and for those that are carried along
    without twisting, which the method uses.
    """
    cylinder = subjects[0].cylinder
    figure = fig.sheet(7.6, 3.6)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.9, 1))
    where = fig.space(figure, grid[:, 0], seen_across(cylinder))
    fig.tube(where, cylinder)
    _frames(where, cylinder)
    where.title("(a) Directrix, cross-sections and their frames")
    fig.scale_bar(where, fig.bar_for(cylinder))
    frenet = _frenet(smooth(cylinder.directrix, REACH))
    twist = f"(b) Frenet: N turns by {_twist(cylinder, frenet):.0f}° about T"
    carried = cylinder.frames[:, :, 1]
    for row, (title, normals) in enumerate(((twist, frenet), ("(c) Carried along: N does not", carried))):
        beside = fig.space(figure, grid[row, 1], seen_flat(cylinder))
        _comb(beside, cylinder, normals)
        beside.title(title)
    fig.legend(figure)
    return figure


def _frames(where: fig.Space, cylinder: GeneralizedCylinder) -> None:
    rings, last = fig.closed(cylinder.surface()), len(cylinder.directrix) - 1
    length = AXIS_LENGTH * float(np.ptp(cylinder.directrix, axis=0).max())
    for count, station in enumerate((np.array(SECTIONS) * last).round().astype(int)):
        label = "cross-section" if count == 0 else None
        where.plot(rings[station], color=fig.INK, linewidth=1.2, label=label, zorder=2.3)
        centre = cylinder.directrix[station]
        for (name, colour), axis in zip(AXES, cylinder.frames[station].T, strict=True):
            fig.arrows(where, centre[None], length * axis[None], color=colour, width=0.004)
            if count == LETTERED:
                beside = {"color": colour, "xytext": (0, 0), "ha": "center", "va": "center"}
                where.text(centre + 1.25 * length * axis, name, **beside)


def _comb(where: fig.Space, cylinder: GeneralizedCylinder, normals: FloatArray) -> None:
    """Draw normals (N, 3) as teeth along the directrix, with a line through their tips."""
    tips = cylinder.directrix + AXIS_LENGTH * float(np.ptp(cylinder.directrix, axis=0).max()) * normals
    some = evenly(len(tips), WHISKERS)
    teeth = list(np.stack((cylinder.directrix[some], tips[some]), axis=1))
    fig.lines(where, teeth, "N", color=fig.REFINED, linewidth=0.7)
    where.plot(tips, color=fig.REFINED, linewidth=0.9)
    where.plot(cylinder.directrix, color=fig.DIRECTRIX, linewidth=1.8)


def _frenet(curve: FloatArray) -> FloatArray:
    """Principal normals (N, 3) of a curve (N, 3): where it accelerates to, across its tangent."""
    speed = np.gradient(curve, axis=0)
    tangents = speed / np.linalg.norm(speed, axis=1, keepdims=True)
    bends = np.gradient(tangents, axis=0)
    bends -= (bends * tangents).sum(axis=1, keepdims=True) * tangents
    return bends / np.maximum(np.linalg.norm(bends, axis=1, keepdims=True), 1e-12)


def _twist(cylinder: GeneralizedCylinder, normals: FloatArray) -> float:
    """How far normals (N, 3) turn in all against those that are carried along [degrees]."""
    inside = np.einsum("nij,ni->nj", cylinder.frames[:, :, 1:], normals)
    length = np.linalg.norm(inside, axis=1)
    inside = inside[length > 0.5] / length[length > 0.5, None]  # where it is straight there is no normal
    return float(np.rad2deg(angles_between(inside[:-1], inside[1:]).sum()))
