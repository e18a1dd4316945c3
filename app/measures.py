"""Things as a person measures them: full lengths, what they stand on, and where one pulls to size them.

The arm's shapes have radii and centres; people see how wide something is and that it
stands on the table. All lengths are metres.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app import anchors
from app.arm.shapes import Quadruple, Triple, rotation_of
from app.document import Box, Cylinder, FloatArray, Shape, Sphere, ThingKind

TABLE: Final = 0.0
"""Height of the table top [m]."""
NAMES: Final[dict[ThingKind, tuple[str, ...]]] = {
    "box": ("Width", "Depth", "Height"),
    "ball": ("Width",),
    "cylinder": ("Width", "Height"),
    "ring": ("Opening", "Thickness"),
}
"""What the measures of each kind are called, in order."""

_X: Final[Triple] = (1.0, 0.0, 0.0)
_TOWARDS_US: Final[Triple] = (0.0, -1.0, 0.0)
_Z: Final[Triple] = (0.0, 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class Handle:
    """Where one of the measures of a thing is pulled."""

    place: FloatArray
    """(3,) on its surface, in the world [m]."""
    along: FloatArray
    """(3,) direction in which it grows, of length 1."""
    both: bool
    """It grows to all sides; else the opposite side stays where it is."""


def kind_of(thing: Shape) -> ThingKind:
    """Say what a thing is."""
    if isinstance(thing, Box):
        return "box"
    if isinstance(thing, Sphere):
        return "ball"
    return "cylinder" if isinstance(thing, Cylinder) else "ring"


def measures(thing: Shape) -> tuple[float, ...]:
    """Measure a thing: the full lengths that `NAMES` names [m]."""
    if isinstance(thing, Box):
        return thing.size
    if isinstance(thing, Sphere):
        return (2.0 * thing.radius,)
    if isinstance(thing, Cylinder):
        return (2.0 * thing.radius, thing.length)
    return (2.0 * (thing.radius - thing.wall), 2.0 * thing.wall)


def measured(thing: Shape, lengths: tuple[float, ...]) -> Shape:
    """Give a thing other measures about the same middle; as many as it has, positive [m]."""
    if isinstance(thing, Box):
        x, y, z = lengths
        return replace(thing, size=(x, y, z))
    if isinstance(thing, Sphere):
        return replace(thing, radius=0.5 * lengths[0])
    if isinstance(thing, Cylinder):
        return replace(thing, radius=0.5 * lengths[0], length=lengths[1])
    opening, thickness = lengths
    return replace(thing, radius=0.5 * (opening + thickness), wall=0.5 * thickness)


def depth(thing: Shape) -> float:
    """Measure from the middle of a thing straight down to the height of its lowest point [m]."""
    up = rotation_of(thing.wxyz)[2]
    flat = float(np.hypot(up[0], up[1]))
    if isinstance(thing, Box):
        return 0.5 * float(np.abs(up) @ np.asarray(thing.size))
    if isinstance(thing, Sphere):
        return thing.radius
    if isinstance(thing, Cylinder):
        return 0.5 * thing.length * abs(float(up[2])) + thing.radius * flat
    return thing.wall + thing.radius * flat


def underside(thing: Shape) -> float:
    """Height of the lowest point of a thing above the table [m]."""
    return thing.position[2] - depth(thing) - TABLE


def handles(thing: Shape) -> tuple[Handle, ...]:
    """Find where the measures of a thing are pulled, one handle for each; on the sides one mostly sees."""
    turn, middle = rotation_of(thing.wxyz), np.asarray(thing.position)

    def at(place: Triple, along: Triple, *, both: bool) -> Handle:
        return Handle(middle + turn @ place, turn @ along, both)

    if isinstance(thing, Box):
        x, y, z = (0.5 * length for length in thing.size)
        return (
            at((x, 0.0, 0.0), _X, both=False),
            at((0.0, -y, 0.0), _TOWARDS_US, both=False),
            at((0.0, 0.0, z), _Z, both=False),
        )
    if isinstance(thing, Sphere):
        return (at((thing.radius, 0.0, 0.0), _X, both=True),)
    if isinstance(thing, Cylinder):
        top = (0.0, 0.0, 0.5 * thing.length)
        return (at((thing.radius, 0.0, 0.0), _X, both=True), at(top, _Z, both=False))
    rim, crest = (thing.radius + thing.wall, 0.0, 0.0), (thing.radius, 0.0, thing.wall)
    return (at(rim, _X, both=True), at(crest, _Z, both=True))


def turn_of(wxyz: Quadruple) -> FloatArray:
    """(3,) roll, pitch, yaw of an orientation: turns about the fixed x, then y, then z axis [rad]."""
    return anchors.turn_of(rotation_of(wxyz))
