"""The slice at the playhead as a drawing: boundary, effective points, centre and the run's ray."""

from typing import Final

import numpy as np

from app.document import FloatArray
from app.palette import BLUE, MAGENTA, RED
from gc_core import GeneralizedCylinder, Reproduction

WIDTH: Final = 260.0
HEIGHT: Final = 210.0
"""Of the drawing [px]."""
MARGIN: Final = 16.0
FOOT: Final = 22.0
"""Room below for the scale bar [px]."""
BAR_LENGTHS: Final = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
"""The scale bar has one of these lengths [m]."""
ZOOMS: Final = (1, 2, 4, 8)
"""How often a slice is enlarged; few steps, so that a change of size is seen as such."""
LEVEL: Final = 0.05
"""A slice that leans less than this from the level has no up: sine of the angle [-]."""
UP: Final = (
    '<path d="M12 32V12M8 17L12 11L16 17" fill="none" stroke="currentColor" stroke-width="1.2"/>'
    '<text x="20" y="22" font-size="11" fill="currentColor">up</text>'
)


def section_svg(cylinder: GeneralizedCylinder, station: int, reproduction: Reproduction | None) -> str:
    """Draw one cross-section.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
        The tube.
    station : int
        Which cross-section; clipped to those there are.
    reproduction : Reproduction, optional
        A single run, drawn as the ray from the centre through its point on this station.

    Returns
    -------
    str
        An ``<svg>`` element. Slices of one cylinder have one scale, so that wide and narrow can be told
        apart; one that would be too small to read is enlarged, and says so.
    """
    station = int(np.clip(station, 0, len(cylinder.directrix) - 1))
    zoom = _zoom(cylinder, station)
    scale = zoom * _scale(cylinder)
    turn, leans = upright(cylinder.frames[station])
    boundary = _pixels(_boundary(cylinder, station), scale * turn)
    points = _pixels(_local(cylinder, station, cylinder.effective_points[station]), scale * turn)
    parts = [
        _open(station, len(cylinder.directrix)),
        f'<polygon points="{_joined(boundary)}" fill="#8a8f98" fill-opacity="0.22" stroke="#8a8f98" '
        'stroke-width="1.5"/>',
        *_ray(cylinder, station, reproduction, scale * turn),
        *(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.2" style="fill:{RED}"/>' for x, y in points.tolist()),
        _cross(),
        _bar(scale, zoom),
        UP if leans else "",
        "</svg>",
    ]
    return "".join(parts)


def ratio_at(reproduction: Reproduction, station: int) -> float | None:
    """How far off-centre a run passes a station; None where it does not pass it."""
    index = _index(reproduction, station)
    return (
        None
        if index is None
        else float(np.broadcast_to(reproduction.ratios, reproduction.times.shape)[index])
    )


def size(cylinder: GeneralizedCylinder, station: int) -> tuple[float, float]:
    """Largest and smallest width of a cross-section through its middle [m]."""
    angles = np.linspace(0.0, np.pi, 37)[:-1]
    directions = np.stack([np.cos(angles), np.sin(angles)])
    along = _boundary(cylinder, station) @ directions
    widths = along.max(axis=0) - along.min(axis=0)
    return float(widths.max()), float(widths.min())


def _boundary(cylinder: GeneralizedCylinder, station: int) -> FloatArray:
    radii, angles = cylinder.radii[station], cylinder.angles
    return np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1)


def _local(cylinder: GeneralizedCylinder, station: int, points: FloatArray) -> FloatArray:
    """Coordinates of points (n, 3) along normal and binormal of a station, (n, 2) [m]."""
    return (points - cylinder.directrix[station]) @ cylinder.frames[station][:, 1:]


def _scale(cylinder: GeneralizedCylinder) -> float:
    """Pixels per metre at which the widest cross-section fits."""
    room = 0.5 * min(WIDTH, HEIGHT - FOOT) - MARGIN
    return room / max(float(cylinder.radii.max()), 1e-3)


def _zoom(cylinder: GeneralizedCylinder, station: int) -> int:
    """How often a cross-section is enlarged: the largest of `ZOOMS` at which it fits."""
    share = float(cylinder.radii[station].max() / cylinder.radii.max())
    return max(zoom for zoom in ZOOMS if zoom * share <= 1.0)


def upright(frame: FloatArray) -> tuple[FloatArray, bool]:
    """Turn a slice so that up is up, as one sees it who goes along the motion.

    Parameters
    ----------
    frame : (3, 3) array
        Columns are tangent, normal, binormal.

    Returns
    -------
    tuple of (2, 2) array and bool
        What turns coordinates along normal and binormal to those to the right and upwards; whether any
        direction in the slice leads upwards: in a level one the normal is drawn upwards.
    """
    steep = float(np.hypot(*frame[2, 1:]))
    up = frame[2, 1:] / steep if steep > LEVEL else np.array([1.0, 0.0])
    return np.stack([[-up[1], up[0]], up]), steep > LEVEL


def _pixels(local: FloatArray, turn: FloatArray) -> FloatArray:
    return local @ turn.T * [1.0, -1.0] + [0.5 * WIDTH, 0.5 * (HEIGHT - FOOT)]


def _index(reproduction: Reproduction, station: int) -> int | None:
    found = np.flatnonzero(np.abs(reproduction.stations - station) <= 0.5)
    return int(found[-1]) if len(found) else None


def _ray(
    cylinder: GeneralizedCylinder, station: int, reproduction: Reproduction | None, turn: FloatArray
) -> list[str]:
    """From the centre through the run's point to the edge."""
    index = None if reproduction is None else _index(reproduction, station)
    if reproduction is None or index is None:
        return []
    point = _local(cylinder, station, reproduction.positions[index][None])
    (px, py), (ex, ey) = _pixels(np.concatenate([point, _edge(cylinder, station, point)]), turn).tolist()
    cx, cy = 0.5 * WIDTH, 0.5 * (HEIGHT - FOOT)
    line = f'<line x1="{cx:.1f}" y1="{cy:.1f}" style="stroke:{MAGENTA}" '
    return [
        f'{line}x2="{ex:.1f}" y2="{ey:.1f}" stroke-width="1.2" stroke-dasharray="3 3"/>',
        f'{line}x2="{px:.1f}" y2="{py:.1f}" stroke-width="2.2"/>',
        f'<circle cx="{px:.1f}" cy="{py:.1f}" r="5" style="fill:{MAGENTA}"/>',
    ]


def _edge(cylinder: GeneralizedCylinder, station: int, point: FloatArray) -> FloatArray:
    """Where the ray through a point (1, 2) meets the boundary, (1, 2) [m]."""
    angle = float(np.arctan2(point[0, 1], point[0, 0])) % (2.0 * np.pi)
    angles = np.append(cylinder.angles, cylinder.angles[0] + 2.0 * np.pi)
    radii = np.append(cylinder.radii[station], cylinder.radii[station, 0])
    radius = np.interp(angle, angles, radii)
    return np.array([[radius * np.cos(angle), radius * np.sin(angle)]])


def _open(station: int, stations: int) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:.0f} {HEIGHT:.0f}" width="100%" '
        f'role="img" aria-label="Slice {station + 1} of {stations}" style="display:block">'
    )


def _cross() -> str:
    x, y = 0.5 * WIDTH, 0.5 * (HEIGHT - FOOT)
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4.2" style="fill:{BLUE}"/>'


def _bar(scale: float, zoom: int) -> str:
    """A scale bar of a round length, about a quarter of the drawing wide."""
    length = max((b for b in BAR_LENGTHS if b * scale <= 0.3 * WIDTH), default=BAR_LENGTHS[0])
    x, y, width = MARGIN, HEIGHT - 8.0, length * scale
    enlarged = f" (enlarged {zoom} times)" if zoom > 1 else ""
    return (
        f'<path d="M{x:.1f} {y - 4:.1f}V{y:.1f}H{x + width:.1f}V{y - 4:.1f}" fill="none" '
        'stroke="currentColor" stroke-width="1.2"/>'
        f'<text x="{x + width + 6:.1f}" y="{y:.1f}" font-size="11" fill="currentColor">'
        f"{100 * length:g} cm{enlarged}</text>"
    )


def _joined(points: FloatArray) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points.tolist())
