"""Above the tabs, where it is always seen: what happened, what is in the way, or what was learned."""

from typing import Final

import viser

from app.binding import Changed, assign
from app.panels import words
from app.store import State

RED: Final = "light-dark(#C4161C,#FF5A4F)"
RECORDING: Final = "&#9679; Recording. Let go when the motion is done."
BY_BUTTONS: Final = "&#9679; Recording. Move the hand by buttons or numbers, then press Stop (key R)."


class StatusPanel:
    """Why the hand cannot follow, recording, a message, or what was learned."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._line = gui.add_html("")
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Say the most urgent of these things."""
        hand, still = state.hand, state.dragging is None
        recording = hand.recording is not None
        by_buttons = hand.aim is not None
        if self._changed(state.message, state.warning, state.model, recording, by_buttons, still):
            assign(self._line, content=status(state))


def status(state: State) -> str:
    """Build the line as HTML, two lines high so that the tabs stay where they are; text is escaped."""
    if state.hand.recording is not None and state.hand.shortfall is None and not state.hand.unturned:
        said = RECORDING if state.hand.aim is None else BY_BUTTONS
        line = words.note(said, strong=True, color=RED)
    else:
        # The lesson shows what the skill is about; here would be the same sentence again.
        message = "" if state.message == state.document.about else state.message
        if message and not state.warning and state.dragging is None:
            message = f"{message} {words.advice(state.model)}".rstrip()
        color = words.AMBER if state.warning else "inherit"
        line = words.note(words.escape(message or words.taught(state.model)), strong=True, color=color)
    return f'<div role="status" style="min-height:3rem">{line}</div>'
