"""A correction that waits for an answer: what it is, what can be done with it, and how that would look.

Nothing of it is in the document, and so nothing of it is saved, before a person has
chosen. While it waits, the document is shown as the previewed choice would make it.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Final

from app.document import Document, FloatArray
from app.model import Model
from app.subject import Subject
from gc_core import GcError

DISCARD: Final = "Discard"
"""What every proposal offers last."""
UNDO: Final = "discard the correction"
"""What undo does while the question is open."""
DISCARDED: Final = "Discarded. Everything is as it was."
FIRST_ANSWER: Final = "First say what becomes of the correction, above the tabs; Undo discards it."
CHOOSE_ONE: Final = "Choose what becomes of the correction, above the tabs."
LOST: Final = "What was corrected is not there any more, so the correction was not kept."


@dataclass(frozen=True, eq=False)
class Correction:
    """A line on its way to another shape."""

    before: FloatArray
    """(K, 3) what it was [m]."""
    after: FloatArray
    """(T, 3) what it is now [m]."""
    among: Model
    """What was shown before."""


@dataclass(frozen=True, eq=False)
class Choice:
    """One thing that can be done with a correction."""

    label: str
    """Of its button."""
    seen: str
    """How the skill is shown then, for instance ``with the rule``."""
    sentence: str
    """What it means, in one sentence."""
    name: str
    """Of the undo step."""
    apply: Callable[[Document], Document]
    """The edit; the same document where what was corrected is gone."""
    records: bool = True
    """Whether it makes a demonstration, which only holds what the arm can do."""
    implied: bool = False
    """Whether going on to something else accepts it: there was only one thing to do."""


@dataclass(frozen=True, eq=False)
class Proposal:
    """A correction and what can be done with it; `DISCARD` is always possible."""

    title: str
    """What was corrected."""
    sentence: str
    """What happened."""
    choices: tuple[Choice, ...]
    """At least one; the first is previewed first."""
    among: Model
    """What was shown before."""
    before: FloatArray
    """(K, 3) the path that was corrected [m]."""
    after: FloatArray
    """(T, 3) what it became [m]."""
    previewed: int = 0
    """Which choice is shown."""
    subject: Subject | None = None
    """What was pulled by its line, sample by sample, and can be pulled further; None: replayed."""


@dataclass(eq=False)
class Pending:
    """A proposal on the desk."""

    proposal: Proposal
    _shown: dict[tuple[int, Document], Document] = field(default_factory=dict[tuple[int, Document], Document])

    def preview(self, choice: int) -> None:
        """Show what another choice would do."""
        if 0 <= choice < len(self.proposal.choices) and choice != self.proposal.previewed:
            self.proposal = replace(self.proposal, previewed=choice)

    def shown(self, document: Document) -> Document:
        """Give the document as the previewed choice would make it; the same object while nothing changed."""
        key = self.proposal.previewed, document
        if key not in self._shown:
            self._shown = {kept: made for kept, made in self._shown.items() if kept[1] is document}
            self._shown[key] = _applied(self.proposal.choices[key[0]], document)
        return self._shown[key]


def _applied(choice: Choice, document: Document) -> Document:
    try:
        return choice.apply(document)
    except GcError:  # said when it is chosen
        return document
