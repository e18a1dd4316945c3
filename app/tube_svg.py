"""A tube as a small drawing: shaded skin, what was shown, middle line, opening; and its widest slice.

Orthographic, seen from the side of the default camera, across the motion and a little into the
opening. Tubes that are to be compared share one `Projection` and slices one `Cut`, so that sizes
can be compared too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.document import FloatArray
from app.palette import BLUE, EDGE, RED
from gc_core import GeneralizedCylinder
from gc_core.arrays import evenly

WIDTH: Final = 1000.0
HEIGHT: Final = 760.0
SLICE_HEIGHT: Final = 620.0
"""Of the drawings, in units fine enough that places are whole numbers, which makes the text short."""
MARGIN: Final = 40.0
RINGS: Final = 26
SIDES: Final = 24
POINTS: Final = 40
"""Of the skin, and of each line."""
ELEVATION: Final = np.radians(20.0)
"""How far from above one looks."""
TURN: Final = np.radians(20.0)
"""How far one looks into the opening instead of straight across the motion."""
CAMERA_SIDE: Final = np.array([0.85, -1.09])
"""Horizontal direction towards the default camera; see `app.scene.view`."""
LIGHT: Final = np.array([-0.35, 0.75, 0.55])
"""To the right, up and towards the eye; made a direction below."""
DARKEST: Final = np.array([112.0, 121.0, 140.0])
LIGHTEST: Final = np.array([218.0, 223.0, 231.0])
SHADES: Final = 7
INSIDE: Final = "#9aa3b4"


@dataclass(frozen=True, eq=False)
class Projection:
    """From places in the room to places on the drawing of a tube."""

    axes: FloatArray
    """(3, 3) rows: to the right, up, towards the eye [-]."""
    middle: FloatArray
    """(2,) what lies in the middle of the drawing, to the right and up [m]."""
    scale: float
    """Units of the drawing per metre."""

    def on_paper(self, points: FloatArray) -> FloatArray:
        """Places (..., 3) [m] on the drawing, (..., 2) from the top left."""
        flat = (points @ self.axes[:2].T - self.middle) * self.scale
        return flat * [1.0, -1.0] + [0.5 * WIDTH, 0.5 * HEIGHT]


@dataclass(frozen=True, eq=False)
class Cut:
    """Which slice of several tubes is drawn, and how large."""

    station: int
    scale: float
    """Units of the drawing per metre."""


def projection_of(cylinders: Sequence[GeneralizedCylinder]) -> Projection:
    """Find the view in which all of these tubes fit; all are about the same motion, at least one.

    Returns
    -------
    Projection
        Up stays up, and left stays left as in the default view of the scene.
    """
    axes = _axes(cylinders[0])
    flat = np.concatenate([c.surface().reshape(-1, 3) for c in cylinders]) @ axes[:2].T
    low, high = flat.min(axis=0), flat.max(axis=0)
    room = np.array([WIDTH, HEIGHT]) - 2.0 * MARGIN
    scale = float((room / np.maximum(high - low, 1e-3)).min())
    return Projection(axes, 0.5 * (low + high), scale)


def cut_of(cylinders: Sequence[GeneralizedCylinder]) -> Cut:
    """Find the slice at which tubes of the same motion, at least one, are widest on average."""
    widths = np.mean([c.radii.mean(axis=1) for c in cylinders], axis=0)
    station = int(np.argmax(widths))
    half = max(float(c.radii[station].max()) for c in cylinders)
    return Cut(station, (0.5 * min(WIDTH, SLICE_HEIGHT) - MARGIN) / max(half, 1e-4))


def tube_svg(cylinder: GeneralizedCylinder, projection: Projection) -> str:
    """Draw one tube.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
        The tube, with what was shown inside.
    projection : Projection
        One of `projection_of`.

    Returns
    -------
    str
        An ``<svg>`` element.
    """
    stations = evenly(len(cylinder.directrix), POINTS)
    lines = projection.on_paper(cylinder.effective_points[stations])
    shown = "".join(path_of(lines[:, j]) for j in range(lines.shape[1]))
    middle = path_of(projection.on_paper(cylinder.directrix[stations]))
    first, last = (path_of(projection.on_paper(cylinder.surface()[end])) + "z" for end in (0, -1))
    return (
        f"{_open(HEIGHT)}"
        f'<g opacity="0.85"><path d="{first}{last}" fill="{INSIDE}"/>{_skin(cylinder, projection)}</g>'
        f'<path d="{last}" style="stroke:{EDGE}" stroke-width="7" opacity="0.7"/>'
        f'<path d="{shown}" style="stroke:{RED}" stroke-width="9"/>'
        f'<path d="{middle}" style="stroke:{BLUE}" stroke-width="20"/>'
        f'<path d="{first}" style="stroke:{EDGE}" stroke-width="13"/></svg>'
    )


def slice_svg(cylinder: GeneralizedCylinder, cut: Cut) -> str:
    """Draw one slice, seen along the motion with up as nearly upwards as can be; as `tube_svg`."""
    forward = cylinder.frames[cut.station, :, 0]
    upward = np.eye(3)[2] - forward[2] * forward
    if np.linalg.norm(upward) < 1e-3:
        upward = cylinder.frames[cut.station, :, 1]
    upward /= np.linalg.norm(upward)
    axes = np.stack([np.cross(forward, upward), -upward], axis=1)

    def on_paper(points: FloatArray) -> FloatArray:
        flat = (points - cylinder.directrix[cut.station]) @ axes
        return flat * cut.scale + [0.5 * WIDTH, 0.5 * SLICE_HEIGHT]

    rim = path_of(on_paper(cylinder.surface()[cut.station])) + "z"
    dots = on_paper(cylinder.effective_points[cut.station])
    return (
        f"{_open(SLICE_HEIGHT)}"
        f'<path d="{rim}" fill="#8a8f98" fill-opacity="0.25" style="stroke:{EDGE}" stroke-width="13"/>'
        + "".join(f'<circle cx="{x:.0f}" cy="{y:.0f}" r="28" style="fill:{RED}"/>' for x, y in dots.tolist())
        + f'<circle cx="{0.5 * WIDTH:.0f}" cy="{0.5 * SLICE_HEIGHT:.0f}" r="34" style="fill:{BLUE}"/></svg>'
    )


def _axes(cylinder: GeneralizedCylinder) -> FloatArray:
    flat = cylinder.directrix[:, :2] - cylinder.directrix[:, :2].mean(axis=0)
    spread, directions = np.linalg.eigh(flat.T @ flat)
    across = np.array([-directions[1, 1], directions[0, 1]])
    if spread[1] < 1e-6 * len(flat):  # straight up or down: no side is better than another
        across = CAMERA_SIDE / np.linalg.norm(CAMERA_SIDE)
    if across @ CAMERA_SIDE < 0.0:
        across = -across
    back = -cylinder.frames[0, :2, 0]  # out of the opening
    turn = TURN if across[0] * back[1] - across[1] * back[0] >= 0.0 else -TURN
    x, y = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]) @ across
    towards = np.array([np.cos(ELEVATION) * x, np.cos(ELEVATION) * y, np.sin(ELEVATION)])
    right = np.array([-y, x, 0.0])
    return np.stack([right, np.cross(towards, right), towards])


def _skin(cylinder: GeneralizedCylinder, projection: Projection) -> str:
    """Those quads of the surface that face the eye; the ones of a shade are one path."""
    stations = evenly(len(cylinder.directrix), RINGS)
    rings = cylinder.surface()[np.ix_(stations, evenly(cylinder.radii.shape[1] + 1, SIDES + 1)[:-1])]
    beside = np.roll(rings, -1, axis=1)
    corners = np.stack([rings[:-1], beside[:-1], beside[1:], rings[1:]], axis=2)
    outward = np.cross(corners[:, :, 2] - corners[:, :, 0], corners[:, :, 3] - corners[:, :, 1])
    centre = cylinder.directrix[stations]
    away = corners.mean(axis=2) - 0.5 * (centre[:-1] + centre[1:])[:, None]
    outward *= np.where(np.einsum("nmi,nmi->nm", outward, away) < 0.0, -1.0, 1.0)[..., None]
    outward /= np.maximum(np.linalg.norm(outward, axis=2, keepdims=True), 1e-12)
    light = LIGHT / np.linalg.norm(LIGHT) @ projection.axes
    bright = np.clip(0.5 + 0.5 * outward @ light, 0.0, 1.0)
    shade = np.where(outward @ projection.axes[2] > 0.0, np.rint(bright * (SHADES - 1)), -1.0)
    paper = projection.on_paper(corners)
    return "".join(_patch(paper[shade == level], level / (SHADES - 1)) for level in range(SHADES))


def _patch(quads: FloatArray, bright: float) -> str:
    """Quads (k, 4, 2); the thin line closes the seams between them."""
    if not len(quads):
        return ""
    r, g, b = np.rint(DARKEST + bright * (LIGHTEST - DARKEST)).astype(int).tolist()
    path = "".join(path_of(quad) + "z" for quad in quads)
    colour = f"#{r:02x}{g:02x}{b:02x}"
    return f'<path d="{path}" fill="{colour}" stroke="{colour}" stroke-width="4"/>'


def _open(height: float) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:.0f} {height:.0f}" width="100%" '
        'fill="none" stroke-linejoin="round" aria-hidden="true" style="display:block">'
    )


def path_of(points: FloatArray) -> str:
    """Points (k, 2) as a path: the first place, then steps, in whole numbers."""
    whole = np.rint(points).astype(int)
    x, y = whole[0].tolist()
    return f"M{x} {y}l" + " ".join(f"{dx} {dy}" for dx, dy in np.diff(whole, axis=0).tolist())
