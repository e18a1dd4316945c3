"""What would help most now, and what may be wrong with each demonstration."""

from dataclasses import dataclass
from functools import partial
from typing import Final

from app import edits, quality, suggestions
from app.document import Document
from app.model import Model
from app.quality import Fault, Fix, Note
from app.suggestions import Suggestion
from gc_core import Demonstration
from gc_core.arrays import remembered

FIX_WORDS: Final[dict[Fix, str]] = {
    "trim": "Cut the pauses out",
    "smooth": "Smooth it",
    "redo": "Mute it and show it again",
}
"""What the button says that does it."""
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
def advice(model: Model) -> Advice:
    """Look for what would help; takes some milliseconds, so not while something is pulled."""
    if model.taught is None or model.cylinder is None:
        return Advice()
    first: dict[int, Note] = {}
    for note in quality.notes(model.demonstrations, model.taught):
        first.setdefault(note.index, note)
    noted = tuple(Noted(model.demonstrations[index], note) for index, note in first.items())
    return Advice(noted, suggestions.suggestion(model.cylinder))


def note_of(found: Advice, demonstration: Demonstration) -> Note | None:
    """Give what may be wrong with a demonstration."""
    return next((one.note for one in found.notes if one.demonstration is demonstration), None)


def fixed(document: Document, demonstration: Demonstration, fix: Fix) -> Document:
    """Do what a note proposes, wherever the demonstration is by now; to show it again, it is muted."""
    for index, shown in enumerate(document.demonstrations):
        if shown.demonstration is demonstration:
            if fix == "redo":
                return edits.mute_demonstration(document, index, True)
            return edits.replace_demonstration(document, index, quality.mended(demonstration, fix))
    return document


def fixing(demonstration: Demonstration, fix: Fix) -> tuple[partial[Document], str]:
    """Give the edit that does what a note proposes, and the name of its undo step."""
    verb = {"trim": "trim", "smooth": "smooth", "redo": "mute"}[fix]
    return partial(fixed, demonstration=demonstration, fix=fix), f"{verb} {demonstration.name}"
