"""Move: landmarks, and how the tube follows them."""

from functools import partial

import viser

from app import edits
from app.actions import Actions
from app.binding import Changed, Rows, assign, on_choice
from app.document import FloatArray
from app.model import Anchor
from app.panels import words
from app.panels.position_field import PositionField
from app.store import State


class LandmarksPanel:
    """One row a landmark, and the case in a sentence."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._case = gui.add_html("")
        self._rows = Rows(gui.add_folder(None), partial(LandmarkRow, gui, actions))
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Follow the landmarks."""
        anchors = state.model.anchors
        for row in self._rows.fit(len(anchors)):
            row.draw(state)
        if self._changed(anchors):
            assign(self._case, content=words.note(words.escape(words.bending(state.model))))


class LandmarkRow:
    """One landmark: where it is, how far it was moved, put it back."""

    def __init__(self, gui: viser.GuiApi, actions: Actions, index: int) -> None:
        self._actions, self._index = actions, index
        self._anchor: Anchor | None = None
        self._position = PositionField(
            gui, f"Landmark {index + 1}", read=self._read, write=self._move, hint="x, y, z in cm."
        )
        self._group = gui.add_button_group(" ", ("Put back",), visible=False)
        on_choice(self._group, self._put_back)

    def show(self, visible: bool) -> None:
        """Show or hide it."""
        assign(self._position.handle, visible=visible)
        if not visible:
            assign(self._group, visible=False)

    def draw(self, state: State) -> None:
        """Show where it is."""
        anchor = state.model.anchors[self._index]
        if anchor is not self._anchor:
            self._anchor = anchor
            moved = words.distance(anchor) > 5e-4
            assign(self._position.handle, label=f"{anchor.name.capitalize()} [cm]")
            options = (f"Put {anchor.name} back",)
            assign(self._group, visible=moved, label=words.moved(anchor), options=options)
        self._position.draw(state)

    def _read(self, state: State) -> FloatArray:
        return state.model.anchors[self._index].now

    def _move(self, position: FloatArray) -> None:
        if self._anchor is not None:
            name = self._anchor.name
            change = partial(edits.move_landmark, name=name, position=position)
            self._actions.edit(change, f"move {name}", f"move landmark {name}")

    def _put_back(self, _: int) -> None:
        if self._anchor is not None:
            name = self._anchor.name
            self._actions.edit(partial(edits.put_landmark_back, name=name), f"put {name} back")
