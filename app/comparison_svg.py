"""Small multiples: for each method the demonstrations, the tube's outline and its runs, all in one drawing.

They are seen as flat as they are: across the direction in which demonstrations and tube are thinnest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from scipy.spatial import ConvexHull, QhullError  # pyright: ignore[reportMissingTypeStubs] - SciPy has none

from app.compared import LOOKS, Look
from app.comparison import Comparison
from app.document import FloatArray
from app.palette import RED
from app.tube_svg import path_of
from gc_core import Demonstration, GeneralizedCylinder
from gc_core.arrays import evenly

COLUMNS: Final = 3
WIDTH: Final = 500.0
TALLEST: Final = 500.0
"""Of one small drawing without its name, in units fine enough that places are whole numbers."""
TITLE: Final = 80.0
"""Room for its name."""
MARGIN: Final = 24.0
RINGS: Final = 24
POINTS: Final = 48
"""Of the outline, and of each line."""
UPRIGHT: Final = 0.5
"""Up stays up when so much of it is seen in the plane of the drawing [-]."""
SKIN: Final = "#8a8f98"


def comparison_svg(found: Comparison, shown: Sequence[Demonstration], names: Sequence[str]) -> str:
    """Draw what is known of each method.

    Parameters
    ----------
    found : Comparison
        With runs of the methods that have run; the others are drawn without.
    shown : sequence of Demonstration
        What all have learned from.
    names : sequence of str
        Methods, in this order; keys of `app.compared.LOOKS`.

    Returns
    -------
    str
        An ``<svg>`` element, one scale for all.
    """
    axes = plane(np.concatenate([found.cylinder.surface().reshape(-1, 3), *(d.positions for d in shown)]))
    paper = _paper_of(found, axes, shown)
    hulls = _hulls(paper.place(_rings(found.cylinder)))
    outline = "".join(path_of(hull) + "z" for hull in hulls)
    lines = "".join(path_of(paper.place(_line(d.positions))) for d in shown)
    drawn = (
        _small(LOOKS[name], [paper.place(_line(run.positions)) for run in found.runs.get(name, ())])
        for name in names
    )
    cells = "".join(
        f'<g transform="translate({WIDTH * (i % COLUMNS):.0f} {paper.height * (i // COLUMNS):.0f})">{one}</g>'
        for i, one in enumerate(drawn)
    )
    height = paper.height * -(-len(names) // COLUMNS)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {COLUMNS * WIDTH:.0f} {height:.0f}" '
        'width="100%" fill="none" stroke-linejoin="round" role="img" aria-label="Runs of each method" '
        'style="display:block"><defs><g id="gc-compared">'
        f'<path d="{outline}" fill="{SKIN}" stroke="{SKIN}" stroke-width="2" opacity="0.35"/>'
        f'<path d="{lines}" style="stroke:{RED}" stroke-width="3" opacity="0.75"/>'
        f"</g></defs>{cells}</svg>"
    )


@dataclass(frozen=True, eq=False)
class _Paper:
    """From places in the room to places on a small drawing."""

    axes: FloatArray
    """(2, 3) to the right and up [-]."""
    low: FloatArray
    """(2,) what lies at the lower left [m]."""
    scale: float
    """Units of the drawing per metre."""
    corner: FloatArray
    """(2,) where that is drawn."""
    height: float
    """Of the drawing with its name."""

    def place(self, points: FloatArray) -> FloatArray:
        """Places (..., 3) [m] on the drawing, (..., 2) from the top left."""
        return (points @ self.axes.T - self.low) * self.scale * [1.0, -1.0] + self.corner


def _paper_of(found: Comparison, axes: FloatArray, shown: Sequence[Demonstration]) -> _Paper:
    """Fit tube, demonstrations and all runs into one drawing, no taller than they are."""
    runs = (run.positions for each in found.runs.values() for run in each)
    places = [found.cylinder.surface().reshape(-1, 3), *(d.positions for d in shown), *runs]
    flat = np.concatenate(places) @ axes.T
    low, size = flat.min(axis=0), np.maximum(np.ptp(flat, axis=0), 1e-3)
    scale = min((WIDTH - 2.0 * MARGIN) / size[0], (TALLEST - 2.0 * MARGIN) / size[1])
    height = TITLE + 2.0 * MARGIN + scale * size[1]
    corner = np.array([0.5 * (WIDTH - scale * size[0]), height - MARGIN])
    return _Paper(axes, low, float(scale), corner, float(height))


def plane(points: FloatArray) -> FloatArray:
    """Find the plane in which points (n, 3) lie best: (2, 3) axes to the right and up, principal ones.

    Where the plane stands upright, the drawing's up is the world's; where it lies, one looks from above.
    """
    _, directions = np.linalg.eigh(np.cov(points.T))
    towards = directions[:, 0]
    up = np.array([0.0, 0.0, 1.0]) - towards[2] * towards
    if np.linalg.norm(up) < UPRIGHT:
        towards = towards * (1.0 if towards[2] >= 0.0 else -1.0)
        up = directions[:, 1] if abs(directions[1, 1]) > abs(directions[1, 2]) else directions[:, 2]
        up = up * (1.0 if up[1] >= 0.0 else -1.0)
    elif towards[1] > 0.0:
        towards = -towards  # from the front, where the camera is
    up = up / np.linalg.norm(up)
    return np.array([np.cross(up, towards), up], dtype=np.float64)


def _small(look: Look, runs: list[FloatArray]) -> str:
    dashes = ' stroke-dasharray="20 12"' if look.dashed else ""
    path = "".join(path_of(run) for run in runs)
    return (
        f'<use href="#gc-compared"/><path d="{path}" stroke="{look.hex}" stroke-width="8"{dashes}/>'
        f'<path d="M24 46h96" stroke="{look.hex}" stroke-width="16"{dashes}/>'
        f'<text x="140" y="66" font-size="58" fill="currentColor">{look.label}</text>'
    )


def _rings(cylinder: GeneralizedCylinder) -> FloatArray:
    """(k, m, 3) some of the slices' rims [m]."""
    return cylinder.surface()[evenly(len(cylinder.directrix), RINGS)]


def _hulls(rings: FloatArray) -> list[FloatArray]:
    """Cover a tube by the hulls of neighbouring rims (k, m, 2) on paper."""
    hulls: list[FloatArray] = []
    for one, other in pairwise(rings):
        corners = np.concatenate([one, other])
        try:
            hulls.append(corners[ConvexHull(corners).vertices])
        except QhullError:  # seen edge on: a line
            hulls.append(corners[[0, -1]])
    return hulls


def _line(points: FloatArray) -> FloatArray:
    return points[evenly(len(points), POINTS)]
