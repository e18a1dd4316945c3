"""How the tool is turned: hold it or let it turn, by angles, ten degrees this way or that, or by rings."""

from functools import partial
from typing import Final

import numpy as np
import viser

from app import turning
from app.actions import Actions
from app.arm.shapes import Quadruple
from app.binding import Binding, anything, on_choice
from app.document import FloatArray
from app.panels.position_field import PositionField
from app.store import State

NUDGE: Final = np.deg2rad(10.0)
"""One press of a button [rad]."""
ON: Final = ("↻ x", "↻ y", "↻ z")
BACK: Final = ("↺ x", "↺ y", "↺ z")
HOLD: Final = "Hold the tool"


class ToolPanel:
    """Turns the tool by the arm, and keeps it so while the hand is moved.

    What is not held points down by itself and gives way only where the hand could not go otherwise. That is
    what a teacher expects of a locked tool; one that never gave way would reach half of a recorded skill.
    """

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._turned: Quadruple = turning.DOWN
        self._angles: FloatArray = np.zeros(3)
        with gui.add_folder("Turn the tool", expand_by_default=False):
            self._held: Binding[bool] = Binding(
                gui.add_checkbox(
                    HOLD,
                    False,
                    hint="As it is turned now. Off: it turns freely, and points down where it can.",
                ),
                read=lambda state: state.view.tool is not None,
                write=actions.hold_tool,
                accept=anything,
            )
            self._field = PositionField(
                gui,
                "Tool turned [°]",
                read=self._read,
                write=lambda angles: actions.turn_tool(turning.from_angles(angles)),
                hint="About x, then y, then z (roll, pitch, yaw), since it pointed straight down.",
                turn=True,
            )
            for label, names, sign in (("by + 10°", ON, 1.0), ("by − 10°", BACK, -1.0)):
                group = gui.add_button_group(label, names)
                group.hint = "About the tool's own axes; it points along its z."
                on_choice(group, partial(_nudge, actions, sign))
            self._rings: Binding[bool] = Binding(
                gui.add_checkbox("Rings", False, hint="Pull one of the rings at the hand to turn the tool."),
                read=lambda state: state.view.rings,
                write=lambda rings: actions.look(rings=bool(rings)),
                accept=anything,
            )

    def draw(self, state: State) -> None:
        """Show how the tool is turned, or shall be."""
        self._held.draw(state)
        self._rings.draw(state)
        self._field.draw(state)

    def _read(self, state: State) -> FloatArray:
        free = state.view.tool is None
        turned = state.hand.turned if state.view.tool is None else state.view.tool
        if turned != self._turned and not (free and state.dragging is not None):
            self._turned, self._angles = turned, turning.angles_of(turned)
        return self._angles


def _nudge(actions: Actions, sign: float, axis: int) -> None:
    actions.nudge_turn(sign * NUDGE * np.eye(3)[axis])
