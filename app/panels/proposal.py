"""Above the tabs: a correction, what can be done with it, and what each choice would change."""

from typing import Final

import viser

from app import effects
from app.actions import Actions
from app.binding import Changed, assign, on_choice
from app.panels import words
from app.proposal import DISCARD, Proposal
from app.store import State

MOST: Final = 3
"""Choices at most."""
UNCHANGED: Final = "Nothing changes."
SHOWN: Final = "✓ "


class ProposalPanel:
    """The chip that asks *Add a rule / Teach it / Discard*, one sentence each."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._count = 0
        self._box = gui.add_folder("Correction", visible=False)
        with self._box:
            self._said = gui.add_html("")
            self._answers = gui.add_button_group("", (DISCARD,))
            self._looks = gui.add_button_group("Show it", (SHOWN.strip(),), visible=False)
        on_choice(self._answers, self._answer)
        on_choice(self._looks, actions.preview)
        self._changed, self._effect = Changed(), Changed()

    def draw(self, state: State) -> None:
        """Ask, while a correction waits."""
        proposal = state.proposal
        if self._changed(proposal, state.model):
            assign(self._box, visible=proposal is not None)
            if proposal is not None:
                self._ask(proposal, state)

    def _ask(self, proposal: Proposal, state: State) -> None:
        labels = tuple(choice.label for choice in proposal.choices[:MOST])
        self._count = len(labels)
        seen = tuple(choice.seen for choice in proposal.choices[:MOST])
        marked = tuple(SHOWN + one if i == proposal.previewed else one for i, one in enumerate(seen))
        assign(self._box, label=proposal.title)
        assign(self._said, content=words.note(asked(proposal, state)))
        assign(self._answers, options=(*labels, DISCARD))
        assign(self._looks, options=marked, visible=len(labels) > 1)

    def _answer(self, place: int) -> None:
        self._actions.answer(place if place < self._count else None)


def asked(proposal: Proposal, state: State) -> str:
    """Build what the chip says, as HTML: what happened, each choice, and what the shown one does to runs."""
    choices = "".join(
        f"<li><b>{words.escape(choice.label)}:</b> {words.escape(choice.sentence)}</li>"
        for choice in proposal.choices
    )
    discard = f"<li><b>{DISCARD}:</b> {UNCHANGED}</li>"
    listed = f'<ul style="margin:0.25rem 0;padding-left:1.1rem">{choices}{discard}</ul>'
    wrong = "".join(f" {contradiction.sentence()}" for contradiction in state.model.contradictions)
    return f"{words.escape(proposal.sentence)}{listed}{words.escape(effect(proposal, state) + wrong)}"


def effect(proposal: Proposal, state: State) -> str:
    """Say how many of the shown runs the previewed choice changes, and by how much."""
    said = effects.on_runs(proposal.among, state.model)
    return f"As shown now, {said}." if said else ""
