"""Move: places that a skill proposes to move its landmarks to."""

from functools import partial
from typing import Final

import viser

from app import edits
from app.actions import Actions
from app.binding import Changed, assign, on_choice
from app.document import Document, Place
from app.panels import words
from app.store import State

INVITATION: Final = "Or see how the skill follows to other places:"


class TriesPanel:
    """One button a place; nothing where the skill proposes none."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._places: tuple[Place, ...] = ()
        self._invitation = gui.add_html(words.note(INVITATION), visible=False)
        self._choice = gui.add_button_group(" ", ("Goal 1",), visible=False)
        on_choice(self._choice, self._go)
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Offer what can be tried."""
        if not self._changed(state.document.tries, state.document.landmarks):
            return
        self._places = offered(state.document)
        assign(self._invitation, visible=bool(self._places))
        assign(self._choice, visible=bool(self._places))
        if self._places:
            assign(self._choice, options=labels(self._places))

    def _go(self, option: int) -> None:
        if option < len(self._places):
            place = self._places[option]
            if place.now is not None:
                move = partial(edits.move_landmark, name=place.name, position=place.now)
                self._actions.edit(move, f"move {place.name}")


def offered(document: Document) -> tuple[Place, ...]:
    """Those proposals whose landmark is still there."""
    names = {place.name for place in document.landmarks}
    return tuple(place for place in document.tries if place.name in names)


def labels(places: tuple[Place, ...]) -> tuple[str, ...]:
    """Number the places of each landmark: ``Goal 1``, ``Goal 2``, ``Start 1``."""
    names = [place.name for place in places]
    return tuple(f"{name.capitalize()} {names[: i + 1].count(name)}" for i, name in enumerate(names))
