"""Teach: the one thing that would help most now, with a button where it can be done at once."""

from typing import Final

import viser

from app import advising
from app.actions import Actions
from app.advising import Noted
from app.binding import QUIET, Binding, Changed, anything, assign, on_press
from app.panels import words
from app.store import State
from gc_core import Demonstration

LABEL: Final = "Suggest what to do next"


class SuggestionPanel:
    """One suggestion at a time; it can be switched off, and waits while something is pulled."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._noted: Noted | None = None
        self._redo: Demonstration | None = None
        self._on: Binding[bool] = Binding(
            gui.add_checkbox(LABEL, True, hint="A disc in the scene shows where one more would help most."),
            read=lambda state: state.view.suggest,
            write=lambda on: actions.look(suggest=on),
            accept=anything,
        )
        self._said = gui.add_html("")
        self._fix = gui.add_button("", color=QUIET, visible=False)
        on_press(self._fix, self._press)
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Say what would help, once nothing is pulled."""
        self._on.draw(state)
        view = state.view
        if state.dragging is not None or not self._changed(
            state.model, state.postures, view.suggest, view.redo
        ):
            return
        self._redo = view.redo
        found = advising.advice(state.model, state.postures) if view.suggest else advising.Advice()
        self._noted = found.notes[0] if found.notes else None
        said = "" if found.suggestion is None else found.suggestion.sentence
        if self._noted is not None:
            said, label = advising.said(self._noted, view.redo)
            assign(self._fix, label=label)
        assign(self._said, content=words.note(words.escape(said)) if said else "")
        assign(self._fix, visible=self._noted is not None)

    def _press(self) -> None:
        if self._noted is not None:
            advising.press(self._actions, self._noted, self._redo)
