"""Move: add a landmark by a click in the scene, or where the playhead is."""

from collections.abc import Mapping
from functools import partial
from typing import Final

import viser

from app import edits, placing
from app.actions import Actions
from app.binding import Changed, assign, on_choice
from app.document import LANDMARK_KINDS, LandmarkKind, View
from app.panels import words
from app.store import State

KINDS: Final[Mapping[LandmarkKind, str]] = {
    "via": "Way point",
    "object": "Object",
    "obstacle": "Obstacle",
    "start": "Start",
    "goal": "Goal",
}
WHAT: Final[Mapping[LandmarkKind, str]] = {
    "via": "A way point is a place that the motion passes.",
    "object": "An object can also be turned; the motion near it turns with it.",
    "obstacle": "An obstacle is something to go around: the tube keeps its distance when it is moved.",
}
FULL: Final = "There are twelve landmarks, which is enough. Remove one before you add another."
WHERE: Final = ("At the playhead", "Not now")


class PlacingPanel:
    """One button a kind; then a click says where."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._state: State | None = None
        self._kinds: tuple[LandmarkKind, ...] = ()
        gui.add_html(words.note("Add a landmark", strong=True))
        self._choice = gui.add_button_group("", ("Way point",))
        self._what = gui.add_html("")
        self._where = gui.add_button_group(" ", WHERE, visible=False)
        on_choice(self._choice, self._choose)
        on_choice(self._where, self._answer)
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Offer what can be added, and ask where."""
        self._state = state
        present = {place.kind for place in state.document.landmarks}
        waiting = waits(state.view)
        if not self._changed(state.document.landmarks, waiting, state.model.cylinder is None):
            return
        self._kinds = tuple(kind for kind in KINDS if kind not in ("start", "goal") or kind not in present)
        full = len(state.document.landmarks) >= edits.MOST_LANDMARKS
        assign(self._choice, options=tuple(KINDS[kind] for kind in self._kinds), visible=not full)
        assign(self._where, visible=waiting is not None)
        assign(self._what, content=words.note(words.escape(FULL if full else asked(waiting))))

    def _choose(self, option: int) -> None:
        kind = self._kinds[option]
        if kind in ("start", "goal"):
            self._add(kind)
        else:
            self._actions.look(placing=kind)

    def _answer(self, option: int) -> None:
        kind = None if self._state is None else waits(self._state.view)
        if option == 0 and kind is not None:
            self._add(kind)
        self._actions.look(placing=None)

    def _add(self, kind: LandmarkKind) -> None:
        if self._state is not None:
            place = placing.beside(self._state.model, self._state.playback, kind)
            change = partial(edits.add_landmark, kind=kind, place=place)
            self._actions.edit(change, f"add a landmark ({KINDS[kind].lower()})")


def waits(view: View) -> LandmarkKind | None:
    """Say what kind of landmark waits for its place."""
    return next((kind for kind in LANDMARK_KINDS if kind == view.placing), None)


def asked(kind: LandmarkKind | None) -> str:
    """Ask where the landmark is, or say what there is to add."""
    if kind is None:
        return "Something else that the motion is tied to. Moving it bends the tube near it."
    return f"{WHAT[kind]} Now click where it is: on the tube or on the table."
