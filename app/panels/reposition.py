"""One button, there only while the arm is stuck: another posture brings the hand to where it is wanted."""

import viser

from app.actions import Actions
from app.binding import STRONG, assign, on_press
from app.store import State


class RepositionPanel:
    """Below the status line, where it is seen in every tab."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._button = gui.add_button(
            "Reposition the arm",
            icon=viser.Icon.ROTATE,
            color=STRONG,
            visible=False,
            hint="Key P. The arm swings to another posture, clear of everything, and brings the hand there.",
        )
        on_press(self._button, actions.reposition)

    def draw(self, state: State) -> None:
        """Show it where it helps."""
        assign(self._button, visible=state.stuck)
