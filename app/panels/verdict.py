"""Try: whether the arm can do the run, where not and why, how fast, and how clear."""

from typing import Final

import viser

from app import judgement
from app.actions import Actions
from app.binding import Changed, assign, on_choice
from app.document import Pace
from app.panels import words
from app.store import State

PACES: Final[tuple[Pace, ...]] = ("taught", "fastest")
PACE_WORDS: Final = ("As taught", "As fast as it can")
CHECKING: Final = "The arm is being asked …"
NOTHING: Final = "There is no run yet, because there is no tube yet."


class VerdictPanel:
    """A headline, what cannot be done with its remedy, the facts, and the pace of playback."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        gui.add_html(words.note("Can the arm do it?", strong=True))
        self._text = gui.add_html("")
        self._pace = gui.add_button_group(
            "Play it",
            PACE_WORDS,
            hint="As taught: slower only where the arm must be. Or at the arm's limits all the way.",
        )
        on_choice(self._pace, lambda place: actions.look(pace=PACES[place]))
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Say what the worker found; while something is dragged, what it found before stays."""
        chosen = PACES.index(state.view.pace)
        assign(self._pace, options=words.marked(PACE_WORDS, chosen))
        run = state.playback.run
        if state.dragging is None and self._changed(state.plans, run, len(state.model.runs)):
            assign(self._text, content=verdict(state))


def verdict(state: State) -> str:
    """Build the panel's text as HTML."""
    plan = state.plan
    if plan is None:
        return words.note(CHECKING if state.model.runs else NOTHING)
    found = judgement.problems(plan)
    lines = [words.note(judgement.headline(plan), strong=True, color=words.AMBER if found else "inherit")]
    for problem in found:
        what = words.escape(f"{judgement.when(plan, problem)}: {problem.what}.")
        lines.append(
            words.note(f'<span style="color:{words.AMBER}">{what}</span> {words.escape(problem.remedy)}')
        )
    lines += [words.note(words.escape(" ".join(judgement.facts(plan))))]
    lines += [
        words.note(words.escape(said), color=words.AMBER)
        for said in judgement.others(state.plans, state.playback.run)
    ]
    return "".join(lines)
