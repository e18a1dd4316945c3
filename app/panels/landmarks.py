"""Move: what the motion is tied to, where it is now, and how the tube follows."""

from collections.abc import Callable
from functools import partial
from typing import Final

import numpy as np
import viser

from app import bending, edits
from app.actions import Actions
from app.anchors import Anchor
from app.binding import QUIET, Binding, Changed, Rows, assign, name_field, on_choice, on_press, place_of
from app.document import Document, FloatArray, Place
from app.panels import words
from app.panels.position_field import PositionField
from app.store import State

STILL: Final = (
    "Pull the goal, or anything yellow: the tube follows (generalization). Nothing is taught again."
)
NOT_TURNED: Final = np.zeros(3)


class LandmarksPanel:
    """How the tube follows in a sentence, and one folder a landmark."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._how = gui.add_html("")
        self._all_back = gui.add_button("Put all back", icon=viser.Icon.ARROW_BACK_UP, color=QUIET)
        on_press(self._all_back, lambda: actions.edit(edits.put_landmarks_back, "put all landmarks back"))
        self._rows = Rows(gui.add_folder(None), partial(LandmarkRow, gui, actions))
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Follow the landmarks."""
        model = state.model
        for row in self._rows.fit(len(state.document.landmarks)):
            row.draw(state)
        if self._changed(model.anchors, model.registration):
            moved = any(anchor.moved for anchor in model.anchors)
            said = f"{bending.how(model)} Nothing was taught again." if model.registration else STILL
            assign(self._how, content=words.note(words.escape(said)))
            assign(self._all_back, visible=moved)


class LandmarkRow:
    """One landmark: its name, where it is, how it is turned, put it back, remove it."""

    def __init__(self, gui: viser.GuiApi, actions: Actions, index: int) -> None:
        self._actions, self._index = actions, index
        self._place: Place | None = None
        self._anchor: Anchor | None = None
        self._folder = gui.add_folder(f"Landmark {index + 1}", expand_by_default=False)
        with self._folder:
            self._name = self._add_name(gui)
            self._position = PositionField(
                gui, "Place [cm]", read=self._now, write=self._move, hint="x, y, z of where it is now."
            )
            self._turn = PositionField(
                gui,
                "Turned [°]",
                read=self._turned,
                write=self._turn_to,
                turn=True,
                hint="About x, then y, then z (roll, pitch, yaw), since the skill was taught.",
            )
            self._group = gui.add_button_group(" ", ("Remove",))
            on_choice(self._group, self._press)

    def show(self, visible: bool) -> None:
        """Show or hide it."""
        assign(self._folder, visible=visible)

    def draw(self, state: State) -> None:
        """Show the landmark at this place of the list."""
        place = state.document.landmarks[self._index]
        anchor = next((one for one in state.model.anchors if one.name == place.name), None)
        if place is not self._place or anchor is not self._anchor:
            self._place, self._anchor = place, anchor
            self._say(place, anchor)
        self._name.draw(state)
        self._position.draw(state)
        self._turn.draw(state)

    def _say(self, place: Place, anchor: Anchor | None) -> None:
        name = place.name
        where = "at the end of the motion, once it is taught" if anchor is None else bending.moved(anchor)
        title = name[:1].upper() + name[1:]
        assign(self._folder, label=f"{title} · {where}" if where else title)
        assign(self._position.handle, label=f"{title} [cm]")
        assign(self._turn.handle, label=f"{title} turned [°]", visible=place.kind == "object")
        moved = anchor is not None and anchor.moved
        assign(self._group, options=(f"Put {name} back", f"Remove {name}") if moved else (f"Remove {name}",))

    def _add_name(self, gui: viser.GuiApi) -> Binding[str]:
        def write(name: str) -> None:
            if (place := self._place) is not None:
                change = partial(_renamed, place, self._index, name)
                self._actions.edit(change, "rename a landmark", f"rename landmark {self._index}")

        return name_field(gui, "Called", lambda state: state.document.landmarks[self._index].name, write)

    def _now(self, _: State) -> FloatArray | None:
        return None if self._anchor is None else self._anchor.now

    def _turned(self, _: State) -> FloatArray | None:
        turn = None if self._anchor is None else self._anchor.turn
        return NOT_TURNED if turn is None else turn

    def _move(self, position: FloatArray) -> None:
        self._edit(edits.move_landmark, "move", position=position)

    def _turn_to(self, turn: FloatArray) -> None:
        self._edit(edits.turn_landmark, "turn", turn=turn)

    def _edit(self, change: Callable[..., Document], verb: str, **how: FloatArray) -> None:
        """Post an edit that a series of typed digits makes only once."""
        if self._place is not None:
            name = self._place.name
            self._actions.edit(partial(change, name=name, **how), f"{verb} {name}", f"{verb} landmark {name}")

    def _press(self, option: int) -> None:
        if self._place is None:
            return
        name = self._place.name
        if option == 0 and self._anchor is not None and self._anchor.moved:
            self._actions.edit(partial(edits.put_landmark_back, name=name), f"put {name} back")
        else:
            self._actions.edit(partial(edits.remove_landmark, name=name), f"remove {name}")


def _renamed(place: Place, index: int, name: str, document: Document) -> Document:
    """Rename the landmark that was shown, wherever it is in the list by now."""
    at = place_of(place, index, document.landmarks, _same)
    return document if at is None else edits.rename_landmark(document, at, name)


def _same(one: Place, other: Place) -> bool:
    places = one.taught is other.taught and one.now is other.now and one.turn is other.turn
    return one.kind == other.kind and places
