"""Pulling on things: every drag in the scene is one mechanism.

The events of a pull become a displacement (`Track`); what was grabbed decides what the
displacement means (`Pull`: an edit of the document). While the pull lasts the edit is
applied to the document it began with and shown, but never stored; letting go commits
it as one undo step. Pulling the hand is the one pull that takes time: see `app.handpull`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app import edits, measures
from app.actions import Drag
from app.document import Document, FloatArray
from app.measures import TABLE
from app.model import Model

GRACE: Final = 0.15
"""A pull that ends and begins again on the same thing within this time is one [s]."""
MAGNET: Final = 0.08
"""A place attracts the depth of what passes it nearer than this, as seen by the camera [m]."""
SIDEWAYS: Final = 1e-6
"""A pull that lifts less than this is along the table [m]."""
LANDING: Final = 0.01
"""What is lowered to this height above the table is put on it [m]."""
FLATTEST: Final = 0.1
"""A handle that is seen more from its end than this moves with the pointer no more: sine squared [-]."""


@dataclass(frozen=True, eq=False)
class Track:
    """How far a thing was pulled, over all parts of one pull.

    Pressing Shift in mid-drag ends one part and begins the next.
    """

    displacement: FloatArray
    """(3,) so far [m]."""
    base: FloatArray
    """(3,) where this part is measured from [m]."""
    before: FloatArray
    """(3,) displacement by the former parts [m]."""


def begin(drag: Drag) -> Track:
    """Begin a pull at the point that was grabbed."""
    zero = np.zeros(3)
    return follow(Track(zero, drag.grabbed, zero), replace(drag, phase="update"))


def follow(track: Track, drag: Drag) -> Track:
    """Take one more event into account; Shift leaves only the height."""
    if drag.phase == "start":
        return Track(track.displacement, drag.pointer, track.displacement)
    moved = drag.pointer - track.base
    if drag.vertical:
        moved = np.array([0.0, 0.0, moved[2]])
    return replace(track, displacement=track.before + moved)


def drawn_to(places: Sequence[FloatArray], target: FloatArray, eye: FloatArray) -> FloatArray:
    """Draw a pulled point towards a place that it passes in front of or behind.

    A flat pointer says nothing about depth. The point stays under the pointer: it moves only along
    the line of sight, towards the depth of the place that this line comes nearest to.

    Parameters
    ----------
    places : sequence of (3,) arrays
        What attracts [m].
    target, eye : (3,) array
        The pulled point and the camera [m].

    Returns
    -------
    (3,) array
        On the line of sight [m]; the target itself where no place is within `MAGNET` of that line,
        exactly as deep as the place where the line passes within half of it.
    """
    sight = target - eye
    depth = float(np.linalg.norm(sight))
    if depth == 0.0 or not places:
        return target
    sight = sight / depth
    depths = [float((place - eye) @ sight) for place in places]
    gaps = [float(np.linalg.norm(place - eye - d * sight)) for place, d in zip(places, depths, strict=True)]
    nearest = int(np.argmin(gaps))
    pull = float(np.clip(2.0 - 2.0 * gaps[nearest] / MAGNET, 0.0, 1.0))
    return target + pull * pull * (3.0 - 2.0 * pull) * (depths[nearest] - depth) * sight


@dataclass(frozen=True, eq=False)
class Pull:
    """What pulling on one thing means."""

    node: str
    """Scene name of what was grabbed."""
    name: str
    """Of the undo step."""
    apply: Callable[[Document, FloatArray], Document]
    """The edit, given the displacement [m]."""


def pull_on(node: str, grabbed: FloatArray, model: Model, eye: FloatArray | None = None) -> Pull | None:
    """Find out what a pull means from what was grabbed; lines are another matter, see `app.linepull`.

    Parameters
    ----------
    node : str
        Scene name, for instance ``/landmarks/goal``.
    grabbed : (3,) array
        The point that was grabbed [m].
    model : Model
        What is shown.
    eye : (3,) array, optional
        The camera [m], where it is known.

    Returns
    -------
    Pull or None
        None for things that cannot be pulled (any more).
    """
    kind, _, which = node.strip("/").partition("/")
    if kind == "landmarks":
        return _pull_landmark(node, which, model)
    if kind == "turns":
        return _pull_turn(node, which, grabbed, model)
    if kind == "obstacles":
        return _pull_thing(node, which, model)
    if kind == "sizes":
        return _pull_side(node, which, grabbed, model, eye)
    index = int(which) if which.isdecimal() else -1
    if kind == "start" and 0 <= index < len(model.runs):
        return _pull_start(node, index, model)
    return None


def thing_held(node: str) -> str:
    """Name the thing whose body or handle a node is; empty for anything else."""
    kind, _, rest = node.strip("/").partition("/")
    return rest if kind == "obstacles" else rest.rpartition("/")[0] if kind == "sizes" else ""


def _pull_landmark(node: str, name: str, model: Model) -> Pull | None:
    origin = next((anchor.now for anchor in model.anchors if anchor.name == name), None)
    if origin is None:
        return None
    return Pull(node, f"move {name}", lambda d, by: edits.move_landmark(d, name, _above(origin + by)))


def _pull_turn(node: str, name: str, grabbed: FloatArray, model: Model) -> Pull | None:
    """The knob of an object turns it about the vertical: by as much as the pointer goes around it."""
    anchor = next((anchor for anchor in model.anchors if anchor.name == name), None)
    if anchor is None or anchor.kind != "object":
        return None
    turn = np.zeros(3) if anchor.turn is None else anchor.turn
    arm = (grabbed - anchor.now)[:2]

    def apply(document: Document, by: FloatArray) -> Document:
        x, y = arm + by[:2]
        angle = np.arctan2(arm[0] * y - arm[1] * x, arm[0] * x + arm[1] * y)
        return edits.turn_landmark(document, name, turn + np.array([0.0, 0.0, angle]))

    return Pull(node, f"turn {name}", apply)


def _pull_thing(node: str, name: str, model: Model) -> Pull | None:
    thing = next((thing for thing in model.source.things if thing.name == name), None)
    if thing is None:
        return None
    begin, underside = np.asarray(thing.position), measures.underside(thing)

    def apply(document: Document, by: FloatArray) -> Document:
        place = begin + by
        if abs(by[2]) > SIDEWAYS and underside + by[2] < LANDING:
            place[2] = begin[2] - underside
        return edits.move_thing(document, name, place)

    return Pull(node, f"move {name}", apply)


def _pull_side(
    node: str, which: str, grabbed: FloatArray, model: Model, eye: FloatArray | None
) -> Pull | None:
    """A handle slides along its own line, and stays beside the pointer as it is seen."""
    name, _, number = which.rpartition("/")
    thing = next((thing for thing in model.source.things if thing.name == name), None)
    if thing is None or not number.isdecimal() or int(number) >= len(measures.measures(thing)):
        return None
    index = int(number)
    along = measures.handles(thing)[index].along
    seen = along
    if eye is not None:
        sight = (grabbed - eye) / max(float(np.linalg.norm(grabbed - eye)), 1e-9)
        seen = along - (along @ sight) * sight
    rate = seen / max(float(seen @ seen), FLATTEST)

    def apply(document: Document, by: FloatArray) -> Document:
        return edits.pull_thing_side(document, name, index, float(by @ rate))

    return Pull(node, f"size {name}", apply)


def _pull_start(node: str, index: int, model: Model) -> Pull:
    origin = model.runs[index].start

    def apply(document: Document, by: FloatArray) -> Document:
        # A start is kept where it was taught; landmarks may have carried it along since.
        return edits.move_start(document, index, model.start_taken_back(_above(origin + by)))

    return Pull(node, "move start", apply)


def _above(position: FloatArray) -> FloatArray:
    """Keep what stands on the table from being pulled below it, which a flat pointer does easily."""
    return np.maximum(position, [-np.inf, -np.inf, TABLE])
