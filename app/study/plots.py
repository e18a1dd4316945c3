"""A study's plots: small multiples, one frame a data set, as SVG inside the report.

Lines go from the first to the third quartile, dots are medians; texts stay texts.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from app.study.executors import tool
from app.study.summary import Line, Measure

ACROSS: Final = 4
"""Frames beside each other."""
SIZE: Final = (2.6, 0.17, 0.75)
"""A frame's width, a line's height, and a frame's margins [inch]."""
EDGE: Final = 0.04
"""Room beside what is drawn, by its width [-]."""
TUBE: Final = "#1F3FA8"
OTHER: Final = "#7A2E00"
MARKS: Final = ("o", "s", "^")
"""Of the alignments, in their order."""
STYLE: Final = {
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "font.size": 8.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 9.0,
}


def small_multiples(measure: Measure, lines: Sequence[Line], name: str) -> str:
    """Draw one number of all parts of an experiment.

    Parameters
    ----------
    measure : Measure
    lines : sequence of Line
    name : str
        Of the drawing, so that ids of several on one page differ.

    Returns
    -------
    str
        An ``<svg>`` element.
    """
    sets = sorted({line.part.data_set for line in lines})
    labels = list(dict.fromkeys(line.label for line in lines))
    alignments = sorted({line.part.alignment for line in lines})
    rows = -(-len(sets) // ACROSS)
    across = min(ACROSS, len(sets))
    height = SIZE[1] * len(labels) * (0.6 + 0.4 * len(alignments)) + SIZE[2]
    plain: Any = tool("matplotlib")
    with plain.rc_context(STYLE | {"svg.hashsalt": name}):
        figure = tool("matplotlib.figure").Figure(
            figsize=(SIZE[0] * across + 1.0, height * rows), layout="constrained"
        )
        frames = np.atleast_1d(figure.subplots(rows, across, sharey=True, squeeze=False)).ravel()
        for frame, data_set in zip(frames, sets, strict=False):
            _draw(
                frame, measure, [line for line in lines if line.part.data_set == data_set], labels, alignments
            )
            frame.set_title(data_set, parse_math=False)
        for empty in frames[len(sets) :]:
            empty.set_visible(False)
        file = io.StringIO()
        figure.savefig(file, format="svg", metadata={"Date": None})
    drawing = file.getvalue()
    return drawing[drawing.index("<svg") :]


def _draw(
    frame: Any, measure: Measure, lines: Sequence[Line], labels: Sequence[str], alignments: Sequence[str]
) -> None:
    """Fill one frame: a line for each method, a mark for each alignment."""
    for turn, alignment in enumerate(alignments):
        shift = 0.6 * ((turn + 0.5) / len(alignments) - 0.5)
        for line in lines:
            found = line.found[measure.column]
            if line.part.alignment != alignment or found is None:
                continue
            at, colour = labels.index(line.label) + shift, TUBE if line.part.section else OTHER
            frame.plot([found.low, found.high], [at, at], color=colour, linewidth=1.2, solid_capstyle="butt")
            frame.plot([found.median], [at], MARKS[turn], color=colour, markersize=3.2)
    frame.set_yticks(range(len(labels)), labels)
    frame.set_ylim(len(labels) - 0.5, -0.5)
    frame.set_xlabel(f"{measure.title} [{measure.unit}]")
    frame.grid(axis="x", color="#DDDDDD", linewidth=0.6)
    frame.set_axisbelow(True)
    if measure.log:
        frame.set_xscale("log")
    else:
        low, high = min(0.0, frame.dataLim.x0), max(0.0, frame.dataLim.x1)
        room = EDGE * (high - low or 1.0)  # no dot is cut by the frame
        frame.set_xlim(low - room, high + room)
