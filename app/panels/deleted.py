"""What was deleted lately can be brought back: demonstrations of this skill, and skills."""

from datetime import UTC, datetime
from functools import partial
from typing import Final

import viser

from app import edits
from app.actions import Actions
from app.binding import QUIET, Changed, assign, on_choice, on_press
from app.document import Shown
from app.history import deleted_demonstrations
from app.library import Summary
from app.panels import words
from app.panels.menu import Menu, Question
from app.sentences import when
from app.store import State

NOTHING: Final = (
    "Nothing was deleted. Demonstrations come back as long as this skill is kept, skills for 30 days."
)
BRING_BACK: Final = "Bring it back"
FOR_GOOD: Final = "Delete for good…"


class DeletedPanel:
    """Two menus: demonstrations, and skills."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._changed_here, self._changed = Changed(), Changed()
        self._shown: tuple[Shown, ...] = ()
        self._skills: tuple[Summary, ...] = ()
        with gui.add_folder("Recently deleted", expand_by_default=False):
            self._nothing = gui.add_html(words.note(NOTHING))
            self._demonstration: Menu[Shown] = Menu(gui, "Demonstration", "Of this skill.")
            self._back = gui.add_button("Bring the demonstration back", color=QUIET, visible=False)
            self._skill: Menu[Summary] = Menu(
                gui, "Skill ", "It is deleted for good after 30 days.", key=lambda skill: skill.code
            )
            self._buttons = gui.add_button_group("", (BRING_BACK, FOR_GOOD), visible=False)
            self._question = Question(gui)
        on_press(self._back, self._bring_back)
        on_choice(self._buttons, lambda place: (self._restore, self._forget)[place]())

    def draw(self, state: State) -> None:
        """Follow the history and the list of skills."""
        if self._changed_here(state.history) and state.history is not None:
            self._shown = deleted_demonstrations(state.history)
            self._demonstration.offer([(shown.demonstration.name, shown) for shown in self._shown])
            assign(self._back, visible=bool(self._shown))
        if self._changed(state.shelf) and state.shelf is not None:
            self._skills = state.shelf.deleted
            now = datetime.now(UTC)
            self._skill.offer([(f"{s.title} · {when(s.deleted or s.updated, now)}", s) for s in self._skills])
            assign(self._buttons, visible=bool(self._skills))
            if not self._skills:
                self._question.withdraw()
        assign(self._nothing, visible=not (self._shown or self._skills))

    def _bring_back(self) -> None:
        shown = self._demonstration.chosen
        if shown is not None:
            change = partial(edits.bring_back_demonstration, shown=shown)
            self._actions.edit(change, f"bring back {shown.demonstration.name}")

    def _restore(self) -> None:
        chosen = self._skill.chosen
        if chosen is not None:
            self._actions.restore_skill(chosen.code)

    def _forget(self) -> None:
        chosen = self._skill.chosen
        if chosen is not None:
            question = f"Delete {self._skill.name} for good? It cannot be brought back then."
            self._question.ask(
                question, "Delete it for good", lambda: self._actions.forget_skill(chosen.code)
            )
