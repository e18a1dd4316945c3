"""Fix: pull on a line without a pointer: which line, where along it, and how far it goes there."""

from functools import partial
from typing import Final

import numpy as np
import viser

from app import linepull
from app.actions import Actions
from app.binding import Binding, Changed, assign, on_choice
from app.document import FloatArray
from app.panels.position_field import PositionField
from app.store import State
from app.subject import subjects

JOG: Final = 0.01
"""One press of a button [m]."""
MORE: Final = ("x + 1", "y + 1", "z + 1")
LESS: Final = ("x − 1", "y − 1", "z − 1")
NONE: Final = "choose a line …"


class LinePanel:
    """The same pull as with the mouse, and the same question after it."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._state: State | None = None
        self._nodes = {NONE: ""}
        self._listed = Changed()
        self._box = gui.add_folder("Pull a line without the mouse", expand_by_default=False)
        with self._box:
            self._which = gui.add_dropdown("Line", (NONE,), hint="A demonstration, or a run (reproduction).")
            self._bindings: tuple[Binding[str], Binding[float]] = (
                Binding(
                    self._which,
                    read=self._chosen,
                    write=lambda label: actions.look(line=self._nodes[label]),
                    accept=lambda label: label in self._nodes,
                ),
                _share(gui, actions),
            )
            self._place = PositionField(
                gui,
                "Place [cm]",
                read=place,
                write=self._put,
                hint="x, y, z of the line there. The line beside it comes along, as far as the pull is wide.",
            )
            self._jogs = [gui.add_button_group("by 1 cm", names) for names in (MORE, LESS)]
        for group, step in zip(self._jogs, (JOG, -JOG), strict=True):
            on_choice(group, partial(self._jog, step))

    def draw(self, state: State) -> None:
        """Follow the lines there are, and where the chosen one is."""
        self._state = state
        if state.dragging is None and self._listed(state.document.demonstrations, len(state.model.runs)):
            self._nodes = {NONE: ""} | subjects(state.model)
            assign(self._which, options=tuple(self._nodes))
        for binding in self._bindings:
            binding.draw(state)
        there = bool(self._nodes[self._chosen(state)])
        for widget in (self._place.handle, *self._jogs):
            assign(widget, visible=there)
        if state.dragging is None:
            self._place.draw(state)

    def _chosen(self, state: State) -> str:
        return next((label for label, node in self._nodes.items() if node == state.view.line), NONE)

    def _put(self, wanted: FloatArray) -> None:
        if self._state is not None and (now := place(self._state)) is not None:
            self._move(wanted - now)

    def _jog(self, step: float, axis: int) -> None:
        self._move(step * np.eye(3)[axis])

    def _move(self, by: FloatArray) -> None:
        if self._state is not None and self._state.view.line:
            view = self._state.view
            self._actions.move_line(view.line, view.line_share, by)


def place(state: State) -> FloatArray | None:
    """(3,) where the chosen line is moved [m]; None where none is chosen."""
    return linepull.place_on(state.view.line, state.view.line_share, state.model, state.proposal)


def _share(gui: viser.GuiApi, actions: Actions) -> Binding[float]:
    slider = gui.add_slider("After [% of it]", 0.0, 100.0, 1.0, 50.0, hint="0: its beginning, 100: its end.")
    return Binding(
        slider,
        read=lambda state: float(round(100.0 * state.view.line_share)),
        write=lambda part: actions.look(line_share=part / 100.0),
        accept=lambda part: 0.0 <= part <= 100.0,
        typed=True,
    )
