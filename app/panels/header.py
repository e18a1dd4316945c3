"""Above the tabs: which skill this is, the way to another one, and the way back."""

from collections.abc import Sequence
from functools import partial
from typing import Final

import viser

from app import edits
from app.actions import Actions
from app.binding import QUIET, Binding, assign, on_press, one_of
from app.panels import words
from app.store import State

CHOOSE: Final = "another skill…"
OWN: Final = "Teach your own"
SAVED: Final = {
    "saved": words.note('<span style="opacity:0.7">Saved</span>'),
    "saving": words.note('<span style="opacity:0.7">Saving…</span>'),
    "late": words.note("Not saved yet. It is tried again.", color=words.AMBER),
}
"""What is said under the buttons; a check reads the first."""


class HeaderPanel:
    """Name of the skill, menu of skills, undo and redo, and whether it is saved."""

    def __init__(self, gui: viser.GuiApi, actions: Actions, skills: Sequence[tuple[str, str]]) -> None:
        title = gui.add_text(
            "Skill", "", hint="The name of this skill. The first change of a built-in one makes a copy."
        )
        self._title: Binding[str] = Binding(
            title,
            read=lambda state: state.document.title,
            write=lambda text: actions.edit(
                partial(edits.rename_skill, title=text), "rename the skill", "rename skill"
            ),
            accept=lambda text: bool(text.strip()),
            typed=True,
        )
        names = {OWN: ""} | {shown: name for name, shown in skills}
        menu = gui.add_dropdown("Open", (CHOOSE, *(shown for _, shown in skills), OWN), initial_value=CHOOSE)
        self._menu: Binding[str] = Binding(
            menu,
            read=lambda _: CHOOSE,
            write=lambda shown: actions.open_skill(names[shown]),
            accept=one_of(names),
        )
        self._undo = gui.add_button("Undo", icon=viser.Icon.ARROW_BACK_UP, color=QUIET, disabled=True)
        self._redo = gui.add_button("Redo", icon=viser.Icon.ARROW_FORWARD_UP, color=QUIET, visible=False)
        self._saved = gui.add_html("")
        on_press(self._undo, actions.undo)
        on_press(self._redo, actions.redo)

    def draw(self, state: State) -> None:
        """Show the skill's name and what undo and redo would do."""
        self._title.draw(state)
        self._menu.draw(state)
        undo, redo = words.short(state.undo_name or ""), words.short(state.redo_name or "")
        assign(self._undo, label=f"Undo: {undo}" if undo else "Undo", disabled=not undo)
        assign(self._redo, label=f"Redo: {redo}" if redo else "Redo", visible=bool(redo))
        assign(self._saved, content=SAVED[state.saved])
