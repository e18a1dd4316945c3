"""Fix: how far a pull reaches, and the rules that runs obey."""

from collections.abc import Callable
from functools import partial
from typing import Final

import viser

from app import edits
from app.actions import Actions
from app.binding import Binding, Changed, Rows, assign, on_choice
from app.document import Document, Rule
from app.linepull import NARROWEST, WIDEST
from app.panels import words
from app.store import State

LEAST, MOST = 100.0 * NARROWEST, 100.0 * WIDEST
"""Width of a pull [cm]."""
HOW: Final = (
    "Grab any line and pull. A red line: that demonstration is fixed, and the tube with it (incremental "
    "refinement). A magenta line: the run's correction is kept as a rule (constraint-based refinement)."
)
DELETE: Final = "Delete"
OFF, ON = "Switch off", "Switch on"


class RulesPanel:
    """The width of a pull and the list of rules."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        gui.add_html(words.note(words.escape(HOW)))
        self._width: Binding[float] = Binding(
            gui.add_slider(
                "Pull width [cm]",
                LEAST,
                MOST,
                1.0,
                20.0,
                hint="How far along the line a pull reaches to either side; also by Page up and Page down.",
            ),
            read=lambda state: float(round(100.0 * state.view.pull_width)),
            write=lambda width: actions.look(pull_width=width / 100.0),
            accept=lambda width: LEAST <= width <= MOST,
            typed=True,
        )
        self._none = gui.add_html("")
        self._rows = Rows(gui.add_folder(None), partial(RuleRow, gui, actions))
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Follow the rules."""
        self._width.draw(state)
        rules = state.document.rules
        if self._changed(rules):
            on = sum(rule.enabled for rule in rules)
            said = (
                f"{words.count(len(rules), 'rule')}, {on} switched on." if rules else "There is no rule yet."
            )
            assign(self._none, content=words.note(said, strong=True))
        for row in self._rows.fit(len(rules)):
            row.draw(state)


class RuleRow:
    """One rule: on or off, delete."""

    def __init__(self, gui: viser.GuiApi, actions: Actions, index: int) -> None:
        self._actions = actions
        self._index = index
        self._rule: Rule | None = None
        self._group = gui.add_button_group(f"Rule {index + 1}", (OFF, DELETE))
        on_choice(self._group, self._press)

    def show(self, visible: bool) -> None:
        """Show or hide it."""
        assign(self._group, visible=visible)

    def draw(self, state: State) -> None:
        """Show the rule at this place of the list."""
        rule = state.document.rules[self._index]
        if rule is not self._rule:
            self._rule = rule
            off = "" if rule.enabled else " (off)"
            assign(self._group, label=rule.name + off, options=(OFF if rule.enabled else ON, DELETE))

    def _press(self, place: int) -> None:
        rule = self._rule
        if rule is None:
            return
        if place == 1:
            self._actions.edit(partial(_at, rule, edits.delete_rule), f"delete {rule.name}")
        else:
            enable = partial(edits.enable_rule, enabled=not rule.enabled)
            self._actions.edit(
                partial(_at, rule, enable), f"switch {rule.name} {'off' if rule.enabled else 'on'}"
            )


def _at(rule: Rule, change: Callable[[Document, int], Document], document: Document) -> Document:
    """Change the rule that was shown, wherever it is by now."""
    for index, candidate in enumerate(document.rules):
        if candidate is rule:
            return change(document, index)
    return document
