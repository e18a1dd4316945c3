"""Fix: how far a pull reaches, and the rules that runs obey."""

from collections.abc import Callable
from functools import partial
from typing import Final

import viser

from app import biting, edits
from app.actions import Actions
from app.binding import Binding, Changed, Rows, anything, assign, name_field, on_choice
from app.document import Document, Rule
from app.linepull import NARROWEST, WIDEST
from app.panels import words
from app.store import State

LEAST, MOST = 100.0 * NARROWEST, 100.0 * WIDEST
"""Width of a pull [cm]."""
HOW: Final = (
    "Grab any line and pull. A red line: that demonstration is fixed, and the tube with it (incremental "
    "refinement). A magenta line: you are asked whether its correction is a rule for all runs "
    "(constraint-based refinement), or one more demonstration."
)
ARROWS: Final = "Arrows: how far each place of the run was corrected (V)."
DELETE: Final = "Delete"
SHOW, HIDE = "Show its arrows", "Hide its arrows"
AMBER: Final = "light-dark(#b45309,#fbbf24)"


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
        if self._changed(rules, state.model.contradictions):
            assign(self._none, content=overview(state))
        for row in self._rows.fit(len(rules)):
            row.draw(state)


def overview(state: State) -> str:
    """Say how many rules there are, and which of them cannot be obeyed together, as HTML."""
    rules = state.document.rules
    on = sum(rule.enabled for rule in rules)
    said = f"{words.count(len(rules), 'rule')}, {on} switched on." if rules else "There is no rule yet."
    wrong = [
        words.note(words.escape(one.sentence()), strong=True, color=AMBER)
        for one in state.model.contradictions
    ]
    return words.note(said, strong=True) + "".join(wrong) + (words.note(ARROWS) if rules else "")


class RuleRow:
    """One rule: on or off, its name, its arrows, delete."""

    def __init__(self, gui: viser.GuiApi, actions: Actions, index: int) -> None:
        self._actions, self._index = actions, index
        self._rule: Rule | None = None
        self._seen = False
        self._changed = Changed()
        self._folder = gui.add_folder(f"Rule {index + 1}")
        with self._folder:
            self._on = self._add_on(gui)
            self._name = self._add_name(gui)
            self._said = gui.add_html("")
            self._group = gui.add_button_group("", (SHOW, DELETE))
            on_choice(self._group, lambda place: (self._show_arrows, self._delete)[place]())

    def show(self, visible: bool) -> None:
        """Show or hide it."""
        assign(self._folder, visible=visible)

    def draw(self, state: State) -> None:
        """Show the rule at this place of the list, and what it does to the runs."""
        rules = state.document.rules
        rule = self._rule = rules[self._index]
        self._seen = state.view.rule in {self._index, self._index - len(rules)}
        self._on.draw(state)
        self._name.draw(state)
        assign(self._folder, label=words.short(rule.name) + ("" if rule.enabled else " · off"))
        assign(self._group, options=(HIDE if self._seen else SHOW, DELETE))
        if (state.dragging is None or state.correction) and self._changed(rule, state.model.runs):
            bite = biting.bites(state.model)[self._index]
            said = f"{biting.where(rule.constraint)} {biting.words(bite, state.model)}"
            assign(self._said, content=words.note(words.escape(said)))

    def _add_on(self, gui: viser.GuiApi) -> Binding[bool]:
        def write(on: bool) -> None:
            if (rule := self._rule) is not None:
                enable = partial(edits.enable_rule, enabled=on)
                self._actions.edit(partial(_at, rule, enable), f"switch {rule.name} {'on' if on else 'off'}")

        return Binding(
            gui.add_checkbox("On", True),
            read=lambda state: state.document.rules[self._index].enabled,
            write=write,
            accept=anything,
        )

    def _add_name(self, gui: viser.GuiApi) -> Binding[str]:
        def write(name: str) -> None:
            if (rule := self._rule) is not None:
                rename = partial(edits.rename_rule, name=name)
                self._actions.edit(
                    partial(_at, rule, rename), f"rename {rule.name}", f"rename rule {self._index}"
                )

        return name_field(gui, "Rule's name", lambda state: state.document.rules[self._index].name, write)

    def _show_arrows(self) -> None:
        self._actions.look(rule=None if self._seen else self._index)

    def _delete(self) -> None:
        if (rule := self._rule) is not None:
            self._actions.edit(partial(_at, rule, edits.delete_rule), f"delete {rule.name}")


def _at(rule: Rule, change: Callable[[Document, int], Document], document: Document) -> Document:
    """Change the rule that was shown, wherever it is by now and whatever it is called."""
    for index, candidate in enumerate(document.rules):
        if candidate.constraint is rule.constraint:
            return change(document, index)
    return document
