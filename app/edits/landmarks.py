"""Edits of landmarks: what the motion is tied to, and where that stands now."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from app.document import LANDMARK_KINDS, Document, FloatArray, LandmarkKind, Place
from app.edits.checks import EditError, at, next_number, one_of, point, renamed, without

MOST_LANDMARKS: Final = 12
"""Landmarks of one skill."""
STRONGEST_SMOOTHING: Final = 1.0
KIND_NAMES: Final[Mapping[LandmarkKind, str]] = {
    "start": "start",
    "goal": "goal",
    "via": "way point",
    "obstacle": "obstacle",
    "object": "object",
}
"""What a landmark of each kind is called; all but the start and the goal are numbered."""


def add_landmark(document: Document, kind: LandmarkKind, place: Place | None = None) -> Document:
    """Tie the motion to one more thing.

    Parameters
    ----------
    document : Document
    kind : {"start", "goal", "via", "obstacle", "object"}
        A skill has one start and one goal at most.
    place : Place, optional
        Where it is, from `app.placing`; a start and a goal without one stand at the ends of the tube. Its
        name and kind are not used.

    Returns
    -------
    Document

    Raises
    ------
    EditError
        If there is one already, if there are `MOST_LANDMARKS` landmarks, or if it has no place.
    """
    one_of("kind of landmark", kind, LANDMARK_KINDS)
    same = [other.name for other in document.landmarks if other.kind == kind]
    if kind in ("start", "goal"):
        if same:
            raise EditError(f"There is a {kind} already: {same[0]}. Move that one.")
        name = kind
    else:
        name = f"{KIND_NAMES[kind]} {next_number(KIND_NAMES[kind], same)}"
        if place is None or place.taught is None:
            raise EditError("A landmark needs a place. Click where it stands.")
    if len(document.landmarks) >= MOST_LANDMARKS:
        raise EditError("There are twelve landmarks already. Remove one before you add another.")
    taken = {other.name for other in document.landmarks}
    while name in taken:  # somebody renamed another one to this
        name = f"{name} (new)"
    added = replace(
        place or Place(name),
        name=name,
        kind=kind,
        taught=None if place is None or place.taught is None else point(place.taught),
        now=None if place is None or place.now is None else point(place.now),
    )
    return replace(document, landmarks=(*document.landmarks, added))


def remove_landmark(document: Document, name: str) -> Document:
    """Untie the motion from a landmark: the tube follows those that are left."""
    index, _ = _landmark(document, name)
    return replace(document, landmarks=without(document.landmarks, index))


def rename_landmark(document: Document, index: int, name: str) -> Document:
    """Call a landmark something else; no two have the same name."""
    former = at(document.landmarks, index, "landmark")
    name = renamed("landmark", name, former.name, [other.name for other in document.landmarks])
    if name == former.name:
        return document
    if name in ("start", "goal") and name != former.kind:
        raise EditError(f"Only the {name} of the motion is called {name}. Choose another name.")
    return _with_landmark(document, index, replace(former, name=name))


def move_landmark(document: Document, name: str, position: FloatArray) -> Document:
    """Put a landmark somewhere else: the cylinder bends.

    While nothing has been taught the object itself is placed, so that later
    demonstrations are tied to where it stands.
    """
    index, place = _landmark(document, name)
    moved = point(position)
    if document.demonstrations:
        if place.now is not None and np.array_equal(moved, place.now):
            return document
        return _with_landmark(document, index, replace(place, now=moved))
    if place.taught is not None and np.array_equal(moved, place.taught):
        return document
    return _with_landmark(document, index, replace(place, taught=moved))


def turn_landmark(document: Document, name: str, turn: Sequence[float] | FloatArray) -> Document:
    """Turn an object: the cylinder turns with it where it is near.

    Parameters
    ----------
    document : Document
    name : str
        Of an object.
    turn : (3,) array
        Roll, pitch, yaw since the skill was taught [rad]; any turns, kept between half a turn to either side.
    """
    index, place = _landmark(document, name)
    if place.kind != "object":
        raise EditError(f"The {name} is a point, which cannot be turned. Add an object and turn that.")
    if not document.demonstrations:
        raise EditError("Nothing was taught yet that could turn with it. Show the motion first.")
    angles = np.asarray(turn, dtype=np.float64)
    if angles.shape != (3,) or not np.all(np.abs(angles) <= 100.0):
        raise EditError(f"A turn needs three angles, got {str(turn)[:80]}.")
    angles = np.where(np.abs(angles) <= np.pi, angles, np.pi - (np.pi - angles) % (2.0 * np.pi))
    angles.setflags(write=False)
    former = np.zeros(3) if place.turn is None else place.turn
    if np.array_equal(angles, former):
        return document
    return _with_landmark(document, index, replace(place, turn=angles if np.any(angles) else None))


def put_landmark_back(document: Document, name: str) -> Document:
    """Put a landmark back to where it stood while the skill was taught."""
    index, place = _landmark(document, name)
    back = _back(place)
    return document if back is place else _with_landmark(document, index, back)


def put_landmarks_back(document: Document) -> Document:
    """Put every landmark back: the tube is as it was taught."""
    back = tuple(map(_back, document.landmarks))
    if all(one is other for one, other in zip(back, document.landmarks, strict=True)):
        return document
    return replace(document, landmarks=back)


def set_smoothing(document: Document, smoothing: float) -> Document:
    """Choose how much less space is bent, at the price of missing the landmarks (lambda) [-]."""
    if not 0.0 <= smoothing <= STRONGEST_SMOOTHING:
        raise EditError(f"The smoothing must be between 0 and {STRONGEST_SMOOTHING:g}, got {smoothing}.")
    return document if smoothing == document.smoothing else replace(document, smoothing=float(smoothing))


def _back(place: Place) -> Place:
    return place if place.now is None and place.turn is None else replace(place, now=None, turn=None)


def _with_landmark(document: Document, index: int, place: Place) -> Document:
    before, after = document.landmarks[:index], document.landmarks[index + 1 :]
    return replace(document, landmarks=(*before, place, *after))


def _landmark(document: Document, name: str) -> tuple[int, Place]:
    for index, place in enumerate(document.landmarks):
        if place.name == name:
            return index, place
    names = ", ".join(place.name for place in document.landmarks) or "none"
    raise EditError(f"There is no landmark called {name}; there are: {names}.")
