"""Numbers and causes in a teacher's words: centimetres, seconds, percent, whole sentences."""

from collections.abc import Sequence
from html import escape as _escape
from typing import Final

import numpy as np

from app import bending
from app.document import FloatArray
from app.model import Model

THINNEST: Final = 0.03
"""Demonstrations thinner than this, as a part of their breadth, were drawn in one plane."""
FLAT: Final = (
    "The tube is flat, as all were drawn in one plane: turn the view or hold Shift, and show it again."
)


MOST_CUT: Final = 0.02
"""Part of the slices that may cut a neighbour without a word above the tabs [-]."""
CRUMPLED: Final = (
    "Where the motion turns back, the tube is wider than the turn and its slices cut each other: "
    "show the turn wider, or more alike."
)


AMBER: Final = "light-dark(#b45309,#fbbf24)"
"""Of a warning, on a light and on a dark page."""
LONGEST: Final = 30
"""Letters that fit into a title of the panel, which is 20 em wide."""
CHOSEN: Final = "✓ "
"""Before the chosen option: viser shows no chosen button in a row."""


def marked(options: Sequence[str], chosen: int) -> tuple[str, ...]:
    """Put a tick before the chosen option; any other number chooses none."""
    return tuple(CHOSEN + option if i == chosen else option for i, option in enumerate(options))


def short(text: str, most: int = LONGEST) -> str:
    """Shorten a text for a line of its own: its beginning, and an ellipsis."""
    return text if len(text) <= most else f"{text[: most - 1].rstrip()}…"


def escape(text: str) -> str:
    """Make a person's text harmless inside HTML."""
    return _escape(" ".join(text.split()))


def escape_line(line: str) -> str:
    """Make a line of a file harmless inside HTML, with its blanks as they are."""
    return _escape(line)


def link(code: str, html: str) -> str:
    """A link to a skill's own page; beside this one, so that it also holds behind a proxy."""
    return f'<a href="{code}" style="color:inherit">{html}</a>'


def note(text: str, *, strong: bool = False, color: str = "inherit") -> str:
    """One paragraph of small print as HTML; ``text`` is HTML already."""
    weight = "600" if strong else "400"
    return (
        '<div style="padding:0 0.75rem 0.5rem;font-size:0.8rem;line-height:1.4;'
        f'font-weight:{weight};color:{color};overflow-wrap:anywhere">{text}</div>'
    )


def cm(length: float) -> str:
    """A length [m] in centimetres: one decimal below 10 cm."""
    return bending.length(length)


def volume(size: float) -> str:
    """A volume [m^3] in litres, a small one in cubic centimetres."""
    litres = 1e3 * size
    if litres < 0.0995:
        return f"{1e3 * litres:.0f} cm³" if litres >= 0.00995 else f"{1e3 * litres:.1f} cm³"
    return f"{litres:.2f} l" if litres < 0.995 else f"{litres:.1f} l"


def seconds(time: float) -> str:
    """A time [s] with one decimal."""
    return f"{time:.1f} s"


def count(number: int, noun: str) -> str:
    """A number with its noun: 1 demonstration, 2 demonstrations."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def rounded(values: FloatArray) -> tuple[float, float, float]:
    """Three numbers with one decimal, as number fields show them."""
    x, y, z = (round(float(value), 1) + 0.0 for value in values)
    return x, y, z


def ratio(eta: float) -> str:
    """How far off-centre, in words."""
    percent = 100.0 * eta
    if percent < 0.5:
        return "on the middle line"
    if percent <= 100.5:
        return f"{percent:.0f} % of the way from the middle line to the edge"
    return f"outside the tube, at {percent:.0f} % of the way to its edge"


def crumpled(model: Model) -> bool:
    """Whether more slices than one in fifty cut their neighbours: there the tube is not to be trusted."""
    return model.cylinder is not None and bool(model.cylinder.diagnostics.crossing.mean() > MOST_CUT)


def drawn_flat(model: Model) -> bool:
    """Whether several demonstrations lie in one plane, as a mouse draws them unless the view is turned.

    Measured by the standard deviations of their places along the principal axes: the least is below
    `THINNEST` of the second one.
    """
    if len(model.demonstrations) < 2:
        return False
    places = np.concatenate([d.positions for d in model.demonstrations])
    variances = np.linalg.eigvalsh(np.cov(places.T))
    return bool(max(variances[0], 0.0) < THINNEST**2 * variances[1])


def advice(model: Model) -> str:
    """What is to be said of the tube, whatever else is said; empty where it is sound."""
    if len(model.demonstrations) > 1 and crumpled(model):
        return CRUMPLED
    return FLAT if drawn_flat(model) else ""


def taught(model: Model) -> str:
    """Say what was learned, or why nothing was."""
    if model.problem is not None:
        return model.problem
    shown, used = len(model.source.demonstrations), len(model.demonstrations)
    if not shown:
        return "Nothing was shown yet. Hold the hand, pull it along the motion, and let go."
    if not used:
        return "All demonstrations are muted. Learn from at least one of them."
    if used == 1:
        return "Shown once. Show it again a little differently, and the tube learns what may vary."
    from_all = "" if used == shown else f" of {shown}"
    learned = f"Learned from {used}{from_all} demonstrations."
    return f"{learned} {advice(model) or 'Wide: free. Narrow: must be exact.'}"
