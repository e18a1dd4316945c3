"""Edits of things: what stands in the way of the arm, and what it can push and carry.

Nothing lies below the table, and what stands on it goes on standing on it when it is
turned or sized.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from app import measures
from app.anchors import quaternion
from app.document import THING_KINDS, Box, Cylinder, Document, FloatArray, Ring, Shape, Sphere, ThingKind
from app.edits.checks import EditError, at, next_number, one_of, point, renamed, without

MOST_THINGS: Final = 12
"""Things of one skill."""
SMALLEST: Final = 0.005
"""No measure of a thing is less [m]."""
LARGEST: Final = 2.0
"""No measure of a thing is more [m]."""
TAKEN: Final = "table"
"""What all things stand on is called this."""
HEAVIEST: Final = 20.0
"""[kg]."""
STANDS: Final = 1e-3
"""What is this near to the table stands on it [m]."""
_HERE: Final = (0.0, 0.0, 0.0)
_ON_EDGE: Final = (np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0)
NEW: Final[Mapping[ThingKind, Shape]] = {
    "box": Box("", _HERE, (0.12, 0.12, 0.20)),
    "ball": Sphere("", _HERE, 0.06),
    "cylinder": Cylinder("", _HERE, 0.05, 0.25),
    "ring": Ring("", _HERE, 0.10, 0.01, wxyz=_ON_EDGE),
}
"""How a new thing of each kind is; a ring stands on its edge."""


def new_thing_name(document: Document, kind: ThingKind) -> str:
    """Give the name that the next thing of a kind will have: box 1."""
    taken = {thing.name for thing in document.things}
    same = [thing.name for thing in document.things if measures.kind_of(thing) == kind]
    name = f"{kind} {next_number(kind, same)}"
    while name in taken:  # somebody renamed another one to this
        name = f"{name} (new)"
    return name


def add_thing(document: Document, kind: ThingKind, place: Sequence[float] | FloatArray) -> Document:
    """Put one more thing there, as an obstacle.

    Parameters
    ----------
    document : Document
    kind : {"box", "ball", "cylinder", "ring"}
    place : (3,) array
        The middle of what it stands on [m].

    Raises
    ------
    EditError
        If the place makes no sense, or there are `MOST_THINGS` things.
    """
    one_of("kind of thing", kind, THING_KINDS)
    new = NEW[kind]
    if len(document.things) >= MOST_THINGS:
        raise EditError("There are twelve things already. Remove one before you add another.")
    x, y, z = point(place).tolist()
    named = replace(new, name=new_thing_name(document, kind), position=(x, y, z + measures.depth(new)))
    return replace(document, things=(*document.things, _above_table(named)))


def move_thing(document: Document, name: str, position: Sequence[float] | FloatArray) -> Document:
    """Put a thing, by its middle (3,) [m], somewhere else; not below the table."""
    thing = _thing(document, name)
    x, y, z = point(position).tolist()
    return _with_thing(document, thing, _above_table(replace(thing, position=(x, y, z))))


def turn_thing(document: Document, name: str, turn: Sequence[float] | FloatArray) -> Document:
    """Turn a thing: roll, pitch and yaw (3,) about the fixed x, then y, then z axis [rad]."""
    thing = _thing(document, name)
    angles = np.asarray(turn, dtype=np.float64)
    if angles.shape != (3,) or not np.all(np.abs(angles) <= 100.0):
        raise EditError(f"A turn needs three angles, got {str(turn)[:80]}.")
    if np.allclose(angles, measures.turn_of(thing.wxyz), rtol=0.0, atol=1e-12):
        return document
    w, x, y, z = quaternion(angles).tolist()
    return _with_thing(document, thing, _as_before(thing, replace(thing, wxyz=(w, x, y, z))))


def resize_thing(document: Document, name: str, lengths: Sequence[float]) -> Document:
    """Give a thing other measures, those of `app.measures.measures` [m].

    Raises
    ------
    EditError
        If there are not as many as it has, or one is not between `SMALLEST` and `LARGEST`.
    """
    thing = _thing(document, name)
    return _with_thing(document, thing, _as_before(thing, _sized(thing, lengths)))


def pull_thing_side(document: Document, name: str, number: int, by: float) -> Document:
    """Pull the handle of one measure (its number) of a thing outwards by a way [m].

    A measure is never pulled beyond `SMALLEST` and `LARGEST`.
    """
    thing = _thing(document, name)
    former = measures.measures(thing)
    if not 0 <= number < len(former):
        raise EditError(f"{name} has no measure {number + 1}; it has {len(former)}.")
    handle = measures.handles(thing)[number]
    wanted = former[number] + (2.0 if handle.both else 1.0) * by
    length = float(np.clip(wanted, SMALLEST, LARGEST))
    sized = _sized(thing, (*former[:number], length, *former[number + 1 :]))
    shift = 0.0 if handle.both else 0.5 * (length - former[number])
    x, y, z = (np.asarray(thing.position) + shift * handle.along).tolist()
    return _with_thing(document, thing, _as_before(thing, replace(sized, position=(x, y, z))))


def weigh_thing(document: Document, name: str, mass: float) -> Document:
    """Say what a thing weighs [kg]: 0 stands fixed, anything else can be pushed and carried."""
    thing = _thing(document, name)
    if not 0.0 <= mass <= HEAVIEST:
        raise EditError(
            f"A thing weighs between 0 g (it stands fixed) and {1000.0 * HEAVIEST:.0f} g, got "
            f"{1000.0 * mass:g} g."
        )
    return _with_thing(document, thing, replace(thing, mass=float(mass)))


def rename_thing(document: Document, index: int, name: str) -> Document:
    """Call a thing something else; no two have the same name."""
    former = at(document.things, index, "thing")
    name = renamed("thing", name, former.name, (TAKEN, *(other.name for other in document.things)))
    return document if name == former.name else _with_thing(document, former, replace(former, name=name))


def remove_thing(document: Document, name: str) -> Document:
    """Take a thing away."""
    return replace(document, things=without(document.things, document.things.index(_thing(document, name))))


def _sized(thing: Shape, lengths: Sequence[float]) -> Shape:
    wanted, former = tuple(map(float, lengths)), measures.measures(thing)
    if len(wanted) != len(former):
        raise EditError(f"{thing.name} has {len(former)} measures, got {len(wanted)}.")
    if not all(SMALLEST <= length <= LARGEST for length in wanted):
        low, high = 100.0 * SMALLEST, 100.0 * LARGEST
        raise EditError(f"Every measure of {thing.name} must be between {low:g} and {high:g} cm.")
    same = np.allclose(wanted, former, rtol=0.0, atol=1e-12)
    return thing if same else measures.measured(thing, wanted)


def _as_before(former: Shape, thing: Shape) -> Shape:
    """Let a changed thing stand on the table if it did so before."""
    if measures.underside(former) > STANDS:
        return _above_table(thing)
    return _at_height(thing, measures.TABLE + measures.depth(thing))


def _above_table(thing: Shape) -> Shape:
    lowest = measures.TABLE + measures.depth(thing)
    return thing if thing.position[2] >= lowest else _at_height(thing, lowest)


def _at_height(thing: Shape, height: float) -> Shape:
    x, y, _ = thing.position
    return replace(thing, position=(x, y, height))


def _with_thing(document: Document, former: Shape, thing: Shape) -> Document:
    if thing == former:
        return document
    return replace(document, things=tuple(thing if one is former else one for one in document.things))


def _thing(document: Document, name: str) -> Shape:
    for thing in document.things:
        if thing.name == name:
            return thing
    names = ", ".join(thing.name for thing in document.things) or "none"
    raise EditError(f"There is nothing called {name} in the way; there are: {names}.")
