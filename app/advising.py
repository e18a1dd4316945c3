"""What would help most now, and what may be wrong with each demonstration."""

from dataclasses import dataclass
from functools import partial
from typing import Final

from app import edits, quality, suggestions
from app.actions import Actions
from app.document import Document
from app.model import Model
from app.quality import Fault, Fix, Note, Postures
from app.suggestions import Suggestion
from gc_core import Demonstration
from gc_core.arrays import remembered

FIX_WORDS: Final[dict[Fix, str]] = {
    "trim": "Cut the pauses out",
    "smooth": "Smooth it",
    "redo": "Show it again",
}
"""What the button says that does it."""
KEEP: Final = "Keep the old one"
"""What it says while its demonstration waits to be shown again."""
FAULT_WORDS: Final[dict[Fault, str]] = {
    "pause": "stands still",
    "shaky": "trembles",
    "outlier": "goes another way",
    "joint_limit": "near a joint's limit",
}


@dataclass(frozen=True, eq=False)
class Noted:
    """A demonstration and the first thing that may be wrong with it."""

    demonstration: Demonstration
    note: Note


@dataclass(frozen=True, eq=False)
class Advice:
    """What is to be said of a model."""

    notes: tuple[Noted, ...] = ()
    """By demonstration, at most one each."""
    suggestion: Suggestion | None = None
    """Where the next demonstration would help most, where the landmarks stand now."""


@remembered
def advice(model: Model, postures: Postures | None = None) -> Advice:
    """Look for what would help; takes some milliseconds, so not while something is pulled."""
    if model.taught is None or model.cylinder is None:
        return Advice()
    first: dict[int, Note] = {}
    for note in quality.notes(model.demonstrations, model.taught, postures):
        first.setdefault(note.index, note)
    noted = tuple(Noted(model.demonstrations[index], note) for index, note in first.items())
    return Advice(noted, suggestions.suggestion(model.cylinder))


def note_of(found: Advice, demonstration: Demonstration) -> Noted | None:
    """Give what may be wrong with a demonstration."""
    return next((one for one in found.notes if one.demonstration is demonstration), None)


def said(noted: Noted, waits: Demonstration | None) -> tuple[str, str]:
    """Say what may be wrong, and what the button does; or that the next recording takes its place."""
    if waits is noted.demonstration:
        return f"Pull the hand: what you show next takes the place of {noted.demonstration.name}.", KEEP
    return noted.note.sentence, FIX_WORDS[noted.note.fix]


def press(actions: Actions, noted: Noted, waits: Demonstration | None) -> None:
    """Do what the button of a note says."""
    shown, fix = noted.demonstration, noted.note.fix
    if fix == "redo":
        actions.look(redo=None if waits is shown else shown)
    else:
        actions.edit(partial(fixed, demonstration=shown, fix=fix), f"{fix} {shown.name}")


def fixed(document: Document, demonstration: Demonstration, fix: Fix) -> Document:
    """Do what a note proposes, wherever the demonstration is by now."""
    for index, shown in enumerate(document.demonstrations):
        if shown.demonstration is demonstration:
            return edits.replace_demonstration(document, index, quality.mended(demonstration, fix))
    return document
