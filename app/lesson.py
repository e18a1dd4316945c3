"""The lesson: a few things to try, and how it is seen that they were tried."""

import tomllib
from dataclasses import dataclass
from functools import cache
from typing import Final

from app.document import Document
from app.resources import static_folder
from app.store import State

SHORTEST: Final = 0.05
"""A recording from here on counts as a try [m]."""


@dataclass(frozen=True)
class Lesson:
    """A text and the things to try."""

    title: str
    intro: str
    steps: tuple[tuple[str, str], ...]
    """What is to be tried, and the sentence that says so."""


def tried(before: Document | None, state: State) -> frozenset[str]:
    """Tell what a person is trying, by what is dragged and by what changed.

    Parameters
    ----------
    before : Document, optional
        What was drawn last; None at first.
    state : State
        What is drawn now.

    Returns
    -------
    frozenset of str
        Out of ``start``, ``goal``, ``demonstrate``, ``pull`` and ``undo``.
    """
    found: set[str] = set()
    after, dragging = state.document, state.dragging or ""
    if before is not None and _one_change(before, after):
        if after.starts is not before.starts:
            found.add("start")
        if after.landmarks is not before.landmarks:
            found.add("goal")
        if dragging.startswith(("/demonstrations/", "/reproductions/")):
            found.add("pull")
    recording = state.hand.recording
    if recording is not None and len(recording) > 1 and abs(recording - recording[0]).max() >= SHORTEST:
        found.add("demonstrate")
    if state.redo_name is not None:
        found.add("undo")
    return frozenset(found)


@cache
def first_minute() -> Lesson:
    """Read the lesson that greets everybody."""
    data = tomllib.loads((static_folder() / "lessons" / "first_minute.toml").read_text(encoding="utf-8"))
    return Lesson(data["title"], data["intro"], tuple((s["tried"], s["text"]) for s in data["steps"]))


def _one_change(before: Document, after: Document) -> bool:
    """Whether one thing changed; another skill changes several."""
    parts = ("demonstrations", "landmarks", "starts", "rules")
    return sum(getattr(before, part) is not getattr(after, part) for part in parts) == 1
