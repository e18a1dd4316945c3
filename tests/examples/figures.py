"""Drawing for the examples: tubes, lines and slices in the colours of the app, lengths in metres."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from PIL import Image

from app.arm.shapes import Shape, pose_of
from app.scene.things import body
from gc_core import GeneralizedCylinder
from gc_core.arrays import FloatArray

mpl.use("Agg")
import matplotlib.pyplot as plt

DEMONSTRATION, DIRECTRIX, TUBE, REPRODUCTION, GOAL = "#C4161C", "#1F3FA8", "#8E96A6", "#E04BDC", "#F2BA1A"
REFINED = "#1A9E73"
INK, PALE, THING = "#3A3F49", "#DDE1E6", "#8A7C6B"
OUTLINES = 24
"""Slices whose outline is drawn on a tube, so that its shape can be seen."""

plt.rcParams |= {
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
    "xtick.color": INK,
    "ytick.color": INK,
}


def sheet(width: float, height: float) -> Any:
    """Empty figure [inches] whose parts keep out of each other's way."""
    return plt.figure(figsize=(width, height), layout="constrained")


def space(figure: Any, place: Any, *cylinders: GeneralizedCylinder, zoom: float = 1.0) -> Any:
    """Axes in three dimensions with one scale for all of them and room for all tubes."""
    axes = figure.add_subplot(place, projection="3d", computed_zorder=False)
    axes.view_init(elev=16, azim=-62)
    corners = np.concatenate([cylinder.surface().reshape(-1, 3) for cylinder in cylinders])
    low, high = corners.min(axis=0), corners.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=zoom)
    for name, axis in (("x", axes.xaxis), ("y", axes.yaxis), ("z", axes.zaxis)):
        axis.set_label_text(f"{name} [m]")
        axis.labelpad = -4
        axis.set_tick_params(pad=-3, labelsize=7)
        axis.set_pane_color("white")
        axis.set_major_locator(mpl.ticker.MultipleLocator(0.2))
    return axes


def tube(axes: Any, cylinder: GeneralizedCylinder) -> None:
    """Draw a tube, light and transparent, with its directrix."""
    rings = cylinder.surface()
    rings = np.concatenate((rings, rings[:, :1]), axis=1)
    axes.plot_surface(
        *np.moveaxis(rings, 2, 0), color=TUBE, alpha=0.16, shade=False, linewidth=0, rcount=100, ccount=64
    )
    for ring in rings[np.linspace(0, len(rings) - 1, OUTLINES).astype(int)]:
        axes.plot(*ring.T, color=TUBE, linewidth=0.4, alpha=0.8)
    axes.plot(*cylinder.directrix.T, color=DIRECTRIX, linewidth=2.0, label="directrix")


def former(axes: Any, cylinder: GeneralizedCylinder) -> None:
    """Draw faintly where a tube was taught."""
    rings = cylinder.surface()[np.linspace(0, len(cylinder.directrix) - 1, OUTLINES).astype(int)]
    for ring in rings[:, [*range(rings.shape[1]), 0]]:
        axes.plot(*ring.T, color=TUBE, alpha=0.35, linewidth=0.5)
    axes.plot(*cylinder.directrix.T, color=DIRECTRIX, alpha=0.35, linewidth=1.2, label="directrix as taught")


def landmarks(axes: Any, before: FloatArray, after: FloatArray) -> None:
    """Draw landmarks (L, 3) where they stand, and hollow, with a line from there, where they stood."""
    for old, new in zip(before, after, strict=True):
        axes.plot(*np.stack((old, new)).T, color=GOAL, linewidth=1.0)
    axes.plot(*before.T, "o", markerfacecolor="white", markeredgecolor=GOAL, markersize=6)
    axes.plot(*after.T, "o", color=GOAL, markersize=8, label="landmarks")


def lines(axes: Any, paths: list[FloatArray], label: str, **style: Any) -> None:
    """Draw paths (K, 3) or (K, 2), with one entry in the legend."""
    for j, path in enumerate(paths):
        axes.plot(*path.T, label=label if j == 0 else None, **style)


def thing(axes: Any, shape: Shape) -> None:
    """Draw what stands in the way, as the scene does."""
    vertices, faces = body(shape)
    corners = vertices @ pose_of(shape)[:3, :3].T + pose_of(shape)[:3, 3]
    axes.plot_trisurf(*corners.T, triangles=faces, color=THING, alpha=0.55, shade=True, linewidth=0, zorder=0)


def arrows(axes: Any, places: FloatArray, moves: FloatArray) -> None:
    """Draw moves (K, 3) as arrows from places (K, 3); those too short to be seen are left out."""
    seen = np.linalg.norm(moves, axis=1) > 0.004
    axes.quiver(*places[seen].T, *moves[seen].T, color=REFINED, linewidth=0.9, arrow_length_ratio=0.25)


def let_out(axes: Any) -> None:
    """Let a long, flat tube leave the square in which axes of three dimensions draw."""
    for artist in axes.get_children():
        artist.set_clip_on(False)
        artist.set_in_layout(False)


def scale_bar(axes: Any, length: float, *, part: float = 1.0) -> None:
    """Show a length [m] along x where axes are left out, from one end (0) to the other (1) of the x axis."""
    left, right = axes.get_xlim()
    begin, far, low = left + part * (right - left - length), axes.get_ylim()[1], axes.get_zlim()[0]
    axes.plot([begin, begin + length], [far, far], [low, low], color=INK, linewidth=1.5)
    axes.text(begin + 0.5 * length, far, low, f"\n{100 * length:.0f} cm", ha="center", va="top", color=INK)


def slice_of(axes: Any, cylinder: GeneralizedCylinder, station: int, *, legend: bool = True) -> None:
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
        axis.set_major_locator(mpl.ticker.MultipleLocator(5))
    if legend:
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.28), fontsize=8)


def save(figure: Any, name: str) -> Path:
    """Write a figure into the folder given by ``--out``, or here, and say where it is."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", type=Path, default=Path(), help="folder for the figure")
    folder: Path = parser.parse_args().out
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.png"
    figure.savefig(path, dpi=110)
    with Image.open(path) as picture:
        small = picture.convert("RGB").quantize(192, dither=Image.Dither.NONE)
    small.save(path, optimize=True)
    plt.close(figure)
    print(f"figure: {path}")
    return path
