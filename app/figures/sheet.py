"""Drawing on paper: tubes, lines, slices and things in the colours of the app, lengths in centimetres.

A `Space` is a view of the room without perspective on plain axes, so that every panel has one scale,
what is nearer covers what is farther, and lines of what is inside a tube are drawn upon its skin.
Figures know nothing of windows: `sheet` makes one, `saved` turns it into the bytes of a file.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from io import BytesIO
from typing import Any, Final, cast

import matplotlib as mpl
import numpy as np
from matplotlib import colors
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from app.arm.shapes import Shape, pose_of
from app.document import FloatArray
from app.figures.catalogue import Form
from app.figures.views import letters_of
from gc_core import GeneralizedCylinder
from gc_core.arrays import evenly

DEMONSTRATION, DIRECTRIX, TUBE, REPRODUCTION, GOAL = "#C4161C", "#1F3FA8", "#8E96A6", "#E04BDC", "#F2BA1A"
REFINED = "#1A9E73"
INK, PALE = "#3A3F49", "#DDE1E6"
SKIN: Final = ("#BFC6D1", "#F3F5F8")
"""Of a tube, where it is darkest and where it is brightest."""
BODY: Final = ("#8F8170", "#DCD4C8")
"""Of a thing, likewise."""
LIGHT: Final = np.array([-0.35, 0.75, 0.55])
"""To the right, up and towards the eye; made a direction below."""
OUTLINES: Final = 24
"""Slices whose outline is drawn on a tube, so that its shape can be seen."""
RINGS: Final = 120
SIDES: Final = 48
"""Of the skin."""
DOTS_PER_INCH: Final = {"png": 300.0, "svg": 200.0}
"""Of an SVG: of the skins, which are pictures there; all else is lines and letters."""
SHORT: Final = 0.3
"""Axes that point at the eye more than this leaves of their length are not shown [-]."""

STYLE: Final[dict[str, Any]] = {
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.6,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": 9,
    "font.size": 8.5,
    "grid.color": PALE,
    "grid.linewidth": 0.5,
    "legend.frameon": False,
    "lines.solid_capstyle": "round",
    "lines.solid_joinstyle": "round",
    "svg.hashsalt": "gc-teach",
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
}


@dataclass(frozen=True, eq=False)
class Space:
    """A part of a sheet in which the room is seen from one side, without perspective."""

    axes: Any
    """Plain axes of matplotlib, in centimetres."""
    basis: FloatArray
    """(3, 3) rows: to the right, up, towards the eye [-]."""

    def on_paper(self, points: FloatArray) -> FloatArray:
        """Find where places (..., 3) [m] are drawn, (..., 2) [cm]."""
        return 100.0 * np.asarray(points) @ self.basis[:2].T

    def plot(self, points: FloatArray, *marks: str, **look: Any) -> None:
        """Draw a line through places (K, 3) or a single place (3,) [m], as matplotlib's ``plot`` does."""
        self.axes.plot(*np.atleast_2d(self.on_paper(points)).T, *marks, **look)

    def title(self, words: str) -> None:
        """Write above what a person may have typed: dollars are dollars, not formulas."""
        self.axes.set_title(words, parse_math=False)

    def text(self, place: FloatArray, words: str, **look: Any) -> None:
        """Write beside a place (3,) [m]."""
        self.axes.annotate(
            words, self.on_paper(place), textcoords="offset points", annotation_clip=False, **look
        )


def styled() -> AbstractContextManager[None]:
    """Put the style of all figures in force, which matplotlib keeps for the whole process."""
    return cast("Any", mpl).rc_context(STYLE)


def sheet(width: float, height: float) -> Any:
    """Empty figure [inches] whose parts keep out of each other's way."""
    figure = Figure(figsize=(width, height), layout="constrained")
    cast("Any", figure.get_layout_engine()).set(h_pad=0.07)
    return figure


def space(figure: Any, place: Any, view: FloatArray, room: Iterable[FloatArray] = ()) -> Space:
    """View of the room as a part of a figure.

    Parameters
    ----------
    figure : Figure
        Of `sheet`.
    place : SubplotSpec
        One or more cells of the figure's grid.
    view : (3, 3) array
        See `app.figures.views` [-].
    room : arrays (..., 3), optional
        What must have room, so that several panels have one scale; otherwise all that is drawn [m].
    """
    axes = figure.add_subplot(place, aspect="equal")
    axes.set_axis_off()
    axes.margins(0.03)
    made = Space(axes, view)
    corners = [made.on_paper(points).reshape(-1, 2) for points in room]
    if corners:
        every = np.concatenate(corners)
        low, high = every.min(axis=0), every.max(axis=0)
        edge = 0.03 * (high - low).max()
        axes.set(xlim=(low[0] - edge, high[0] + edge), ylim=(low[1] - edge, high[1] + edge))
    return made


def tube(where: Space, cylinder: GeneralizedCylinder, *, things: Sequence[Shape] = ()) -> None:
    """Draw a tube with its directrix, and things that may stand before or behind it."""
    rings = closed(cylinder.surface())
    bare = rings[evenly(len(rings), RINGS)][:, evenly(rings.shape[1], SIDES + 1)]
    quads = np.stack([bare[:-1, :-1], bare[:-1, 1:], bare[1:, 1:], bare[1:, :-1]], axis=2).reshape(-1, 4, 3)
    _paint(where, [(quads, SKIN), *((body, BODY) for body in map(faces_of, things))])
    for ring in rings[evenly(len(rings), OUTLINES)]:
        where.plot(ring, color=TUBE, linewidth=0.35, alpha=0.8, zorder=1)
    where.plot(cylinder.directrix, color=DIRECTRIX, linewidth=2.0, label="directrix", zorder=2.2)


def bodies(where: Space, things: Sequence[Shape]) -> None:
    """Draw things where no tube is."""
    if things:
        _paint(where, [(faces_of(thing), BODY) for thing in things])


def former(where: Space, cylinder: GeneralizedCylinder) -> None:
    """Draw faintly where a tube was taught."""
    rings = closed(cylinder.surface())
    for ring in rings[evenly(len(rings), OUTLINES)]:
        where.plot(ring, color=TUBE, alpha=0.35, linewidth=0.5, zorder=-1)
    look = {"color": DIRECTRIX, "alpha": 0.35, "linewidth": 1.2, "zorder": -0.5}
    where.plot(cylinder.directrix, label="directrix as taught", **look)


def landmarks(where: Space, before: FloatArray, after: FloatArray) -> None:
    """Draw landmarks (L, 3) where they stand, and hollow, with a line from there, where they stood."""
    for old, new in zip(before, after, strict=True):
        where.plot(np.stack((old, new)), color=GOAL, linewidth=1.0)
    where.plot(before, "o", markerfacecolor="white", markeredgecolor=GOAL, markersize=4, zorder=3)
    where.plot(after, "o", color=GOAL, markersize=5, label="landmarks", zorder=3)


def lines(where: Any, paths: Iterable[FloatArray], label: str, **look: Any) -> None:
    """Draw paths (K, 3) in a `Space` or (K, 2) on axes, with one entry in the legend."""
    for j, path in enumerate(paths):
        named = {"label": label if j == 0 else None, **look}
        if isinstance(where, Space):
            where.plot(path, **named)
        else:
            where.plot(*path.T, **named)


def arrows(where: Space, places: FloatArray, moves: FloatArray, **look: Any) -> None:
    """Draw moves (K, 3) as arrows from places (K, 3); those too short to be seen are left out."""
    seen = np.linalg.norm(moves, axis=1) > 0.004
    start, step = where.on_paper(places[seen]), where.on_paper(moves[seen])
    shape = {"color": REFINED, "width": 0.003, "headwidth": 4.0, "headlength": 5.0, "zorder": 2.4} | look
    where.axes.update_datalim(start + 1.4 * step)  # with room for a letter
    where.axes.autoscale_view()
    where.axes.quiver(*start.T, *step.T, angles="xy", scale_units="xy", scale=1.0, **shape)


def scale_bar(where: Space, length: float, *, triad: bool = True) -> None:
    """Show below a part, when all else is drawn, a length [m] and where x, y and z point."""
    (left, right), (low, high) = where.axes.get_xlim(), where.axes.get_ylim()
    where.axes.set(xlim=(left, right), ylim=(low, high))  # what follows lies beyond them
    span = max(right - left, high - low)
    ink = {"color": INK, "clip_on": False, "zorder": 4}
    beside = {"annotation_clip": False, "color": INK}
    below = low - 0.03 * span
    where.axes.plot([right - 100.0 * length, right], [below, below], linewidth=1.5, **ink)
    under = beside | {"xytext": (0, -3), "textcoords": "offset points", "ha": "center", "va": "top"}
    words = f"{100 * length:.0f} cm"
    where.axes.annotate(words, (right - 50.0 * length, below), fontsize=8, **under)
    if triad:
        origin = np.array([left + 0.09 * span, below - 0.08 * span])
        axes = where.basis[:2].T
        seen = np.flatnonzero(np.linalg.norm(axes, axis=1) >= SHORT)
        for number, letter in zip(seen, letters_of(axes[seen]), strict=True):
            tip, at = origin + 0.07 * span * axes[number], origin + 0.07 * span * letter
            where.axes.plot(*np.stack([origin, tip]).T, linewidth=0.9, **ink)
            where.axes.annotate("xyz"[number], at, fontsize=7, ha="center", va="center", **beside)


def bar_for(cylinder: GeneralizedCylinder) -> float:
    """Choose a scale bar that suits a tube: about a quarter of it, 1, 2 or 5 of some unit [m]."""
    wanted = 0.3 * float(cylinder.arc_length[-1])
    unit = 10.0 ** math.floor(math.log10(wanted))
    return max(part * unit for part in (1.0, 2.0, 5.0) if part * unit <= wanted)


def slice_of(axes: Any, cylinder: GeneralizedCylinder, station: int) -> None:
    """Draw one section in its plane [cm]: the boundary, the demonstrations' crossings, the centre."""
    angles, radii = cylinder.angles, 100.0 * cylinder.radii[station]
    boundary = np.stack((radii * np.cos(angles), radii * np.sin(angles)))
    away = cylinder.effective_points[station] - cylinder.directrix[station]
    crossings = 100.0 * away @ cylinder.frames[station, :, 1:]
    axes.fill(*boundary, facecolor=TUBE + "30", edgecolor=TUBE, linewidth=1.2, label="boundary")
    axes.plot(*crossings.T, "o", color=DEMONSTRATION, markersize=4, label="demonstrations")
    axes.plot(0, 0, "o", color=DIRECTRIX, markersize=5, label="directrix")
    axes.set(aspect="equal", xlabel="N [cm]", ylabel="B [cm]")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(4, integer=True))


def legend(figure: Any, columns: int = 6, words: Mapping[str, str] | None = None) -> None:
    """Explain below a figure each kind of line once; with ``words`` instead of its own, the tube, too."""
    named: dict[str, Any] = {}
    if words is not None:
        named["tube"] = Patch(facecolor=SKIN[0], edgecolor=TUBE)
    words = words or {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            named.setdefault(label, handle)
    labels = [words.get(label, label) for label in named]
    figure.legend(list(named.values()), labels, loc="outside lower center", ncols=columns)


def saved(figure: Any, form: Form, dots_per_inch: float | None = None) -> bytes:
    """Make a file of a figure: the same bytes whenever it is the same."""
    file = BytesIO()
    metadata = {"Date": None} if form == "svg" else {"Software": None}
    with styled():
        figure.savefig(
            file,
            format=form,
            dpi=dots_per_inch or DOTS_PER_INCH[form],
            bbox_inches="tight",
            pad_inches=0.05,
            metadata=metadata,
        )
    return file.getvalue()


def closed(rings: FloatArray) -> FloatArray:
    """Rings (N, M, 3) that end where they begin, (N, M + 1, 3)."""
    return np.concatenate((rings, rings[:, :1]), axis=1)


def faces_of(thing: Shape) -> FloatArray:
    """(F, 3, 3) corners of a thing's faces where it stands [m]."""
    from app.scene.things import body  # noqa: PLC0415 - a second that only things need

    vertices, faces = body(thing)
    pose = pose_of(thing)
    return (vertices @ pose[:3, :3].T + pose[:3, 3])[faces]


def _paint(where: Space, skins: Sequence[tuple[FloatArray, tuple[str, str]]]) -> None:
    """Paint faces (F, k, 3) with their darkest and brightest colours, what is farthest first."""
    shades = np.concatenate([_shaded(faces, look, where.basis) for faces, look in skins])
    depths = np.concatenate([faces.mean(axis=1) @ where.basis[2] for faces, _ in skins])
    paper = [face for faces, _ in skins for face in where.on_paper(faces)]
    order = np.argsort(depths, kind="stable")
    skin = PolyCollection(
        [paper[i] for i in order],
        facecolors=shades[order],
        edgecolors=shades[order],
        linewidths=0.35,
        zorder=0,
        rasterized=True,
    )
    where.axes.add_collection(skin, autolim=True)
    where.axes.autoscale_view()


def _shaded(faces: FloatArray, look: tuple[str, str], basis: FloatArray) -> FloatArray:
    """Colours (F, 3) of faces (F, k, 3) by the light that falls on them."""
    out = np.cross(faces[:, 1] - faces[:, 0], faces[:, -1] - faces[:, 0]) @ basis.T
    out *= np.where(out[:, 2:] < 0.0, -1.0, 1.0)  # what is seen of a face is turned to the eye
    out /= np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-15)
    bright = np.clip(0.45 + 0.55 * out @ (LIGHT / np.linalg.norm(LIGHT)), 0.0, 1.0)[:, None]
    dark_end, bright_end = (np.array(cast("Any", colors).to_rgb(colour)) for colour in look)
    return (1.0 - bright) * dark_end + bright * bright_end
