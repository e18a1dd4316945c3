"""One line on top of Teach: what just happened, what was learned, or what is in the way."""

from typing import Final

import viser

from app.binding import Changed, assign
from app.panels import words
from app.store import State

AMBER: Final = "#b45309"
RED: Final = "#C4161C"


class StatusPanel:
    """Recording, a message, or what the model holds."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._line = gui.add_html("")
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Say the most urgent of these things."""
        if self._changed(state.message, state.warning, state.model, state.hand.recording is None):
            assign(self._line, content=status(state))


def status(state: State) -> str:
    """Build the line as HTML; what the person wrote is escaped."""
    if state.hand.recording is not None:
        return words.note("&#9679; Recording. Let go when the motion is done.", strong=True, color=RED)
    message, learned = state.message, words.taught(state.model)
    said = words.note(words.escape(message), strong=True, color=AMBER if state.warning else "inherit")
    if message == learned:
        return said
    return (said if message else "") + words.note(words.escape(learned))
