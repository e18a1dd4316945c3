"""The hand without a mouse: where it is, one centimetre this way or that, open or closed."""

from functools import partial
from typing import Final

import numpy as np
import viser

from app.actions import Actions
from app.binding import QUIET, STRONG, Binding, anything, assign, on_choice, on_press
from app.panels.position_field import PositionField
from app.store import State

JOG: Final = 0.01
"""One press of a button [m]."""
UP: Final = ("+ x", "+ y", "+ z")
DOWN: Final = ("− x", "− y", "− z")
RECORD: Final = "Record by these buttons"
STOP: Final = "Stop: that was the motion"
HINT: Final = "Key R. Shows the robot a motion without dragging; waiting between presses is left out."


class HandPanel:
    """Moves the hand, and with it the start of the next demonstration; after *Record* it demonstrates."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._position = PositionField(
            gui,
            "Hand [cm]",
            read=lambda state: state.hand.position if state.hand.aim is None else state.hand.aim,
            write=actions.move_hand,
            hint="x, y, z. Leads the hand there; the next demonstration begins there.",
        )
        for label, names, step in (("by + 1 cm", UP, JOG), ("by − 1 cm", DOWN, -JOG)):
            on_choice(gui.add_button_group(label, names), partial(self._jog, step))
        self._gripper = _gripper(gui, actions)
        self._record = gui.add_button(RECORD, icon=viser.Icon.PLAYER_RECORD, color=QUIET, hint=HINT)
        on_press(self._record, actions.record)

    def draw(self, state: State) -> None:
        """Show where the hand is."""
        self._position.draw(state)
        self._gripper.draw(state)
        records = state.hand.recording is not None and state.hand.aim is not None
        assign(self._record, label=STOP if records else RECORD, color=STRONG if records else QUIET)

    def _jog(self, step: float, axis: int) -> None:
        self._actions.nudge_hand(step * np.eye(3)[axis])


def _gripper(gui: viser.GuiApi, actions: Actions) -> Binding[bool]:
    return Binding(
        gui.add_checkbox("Hand closed", False, hint="Key G. Also works while you pull the hand."),
        read=lambda state: state.view.gripper_closed,
        write=lambda _: actions.toggle_gripper(),  # an accepted event is always a change
        accept=anything,
    )
