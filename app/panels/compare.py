"""Compare: which methods learn the same demonstrations, from how many starts, and what each of them does."""

from collections.abc import Mapping
from functools import partial
from typing import Final

import viser

from app.actions import Actions
from app.binding import STRONG, Binding, Changed, anything, assign, on_press, one_of
from app.compared import LOOKS, TUBE, Compared
from app.panels import compare_words, words
from app.store import State

ABOUT: Final = (
    "Other ways of learning, given the same demonstrations and begun from the same starts: what becomes of "
    "starts that lie apart, and how well is the motion kept? The tube is always among them."
)
STARTS: Final[Mapping[str, int]] = {
    "3 in the first slice": 3,
    "5 in the first slice": 5,
    "10 in the first slice": 10,
    "20 in the first slice": 20,
    "the starts of Try": 0,
}
AGAIN: Final = "Compare again"
OUTDATED: Final = "This is of the skill as it was: it has changed since. Its runs are not drawn any more."
AS_TAUGHT: Final = (
    "What is compared is the motion as it was taught: before landmarks were moved, and without rules."
)


class ComparePanel:
    """Ticks for methods, the number of starts, a button; then pictures, sentences and a table."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._chosen: tuple[str, ...] = ()
        gui.add_html(words.note(ABOUT))
        self._bindings = (
            *(self._tick(gui, name) for name in LOOKS if name != TUBE),
            _add_starts(gui, actions),
        )
        self._button = gui.add_button("Compare", icon=viser.Icon.CHART_BAR, color=STRONG)
        self._bar = gui.add_progress_bar(0.0, visible=False)
        self._doing = gui.add_html("")
        self._show = Binding(
            gui.add_checkbox("In the scene", True, hint="Draw the runs of the ticked methods."),
            read=lambda state: state.view.show_compared,
            write=lambda value: actions.look(show_compared=value),
            accept=anything,
        )
        self._answer = gui.add_html("")
        on_press(self._button, actions.compare)
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Follow the choice and what the worker finds."""
        self._chosen = state.view.methods
        for binding in (*self._bindings, self._show):
            binding.draw(state)
        known, taught = state.compared, state.model.taught is not None
        assign(self._button, disabled=not taught, label="Compare" if known is None else AGAIN)
        elsewhere = state.model.registration is not None or bool(state.model.constraints)
        if self._changed(known, taught, elsewhere):
            busy = known is not None and bool(known.doing)
            assign(self._bar, visible=busy, value=0.0 if known is None else 100.0 * known.share)
            assign(self._doing, content=words.note(words.escape(said(known, taught, elsewhere))))
            assign(self._answer, content="" if known is None else answer(known))

    def _tick(self, gui: viser.GuiApi, name: str) -> Binding[bool]:
        return Binding(
            gui.add_checkbox(LOOKS[name].label, False, hint=compare_words.HINTS[name]),
            read=lambda state: name in state.view.methods,
            write=partial(self._choose, name),
            accept=anything,
        )

    def _choose(self, name: str, chosen: bool) -> None:
        wanted = {*self._chosen, name} if chosen else {*self._chosen} - {name}
        self._chosen = tuple(each for each in LOOKS if each in wanted)
        self._actions.look(methods=self._chosen)


def said(known: Compared | None, taught: bool, elsewhere: bool) -> str:
    """Say what is going on, or what to do first."""
    if not taught:
        return "Show the motion first: there is nothing to learn from yet."
    if known is not None and known.doing:
        return known.doing
    return AS_TAUGHT if elsewhere else ""


def answer(known: Compared) -> str:
    """Build what is known as HTML: what it says, pictures, numbers, and what they mean."""
    warnings = [OUTDATED] if known.outdated else []
    warnings += [known.problem] if known.problem else []
    parts = [words.note(words.escape(each), color=words.AMBER) for each in warnings]
    if known.found is not None:
        parts += [words.note(words.escape(each)) for each in compare_words.claims_in_words(known.found)]
        paper = f"margin:0 0.75rem 0.5rem;border-radius:6px;padding:4px;{compare_words.PAPER}"
        parts.append(f'<div style="{paper}">{known.picture}</div>')
        parts.append(compare_words.table(known))
        parts.append(words.note(words.escape(compare_words.meaning(known.found))))
    dim = "opacity:0.55" if known.outdated else ""
    return f'<div style="{dim}">{"".join(parts)}</div>'


def _add_starts(gui: viser.GuiApi, actions: Actions) -> Binding[str]:
    shown = {count: text for text, count in STARTS.items()}
    return Binding(
        gui.add_dropdown("Starts", tuple(STARTS), hint="From where all methods begin."),
        read=lambda state: shown.get(state.view.compare_count, next(iter(STARTS))),
        write=lambda text: actions.look(compare_count=STARTS[text]),
        accept=one_of(STARTS),
    )
