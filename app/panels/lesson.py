"""The lesson: a few sentences that tick themselves off as things are tried."""

import tomllib
from dataclasses import dataclass
from functools import cache
from typing import Final

import viser

from app.actions import Actions
from app.binding import STRONG, Changed, assign, on_press
from app.document import Document
from app.panels import words
from app.resources import static_folder
from app.store import State

DONE: Final = '<span style="color:light-dark(#157f5c,#19B98C);font-weight:700">&#10003;</span>'
OPEN: Final = '<span style="opacity:0.55">&#9675;</span>'
SHORTEST: Final = 0.05
"""A recording from here on counts as a try [m]."""
OWN: Final = "Teach your own"


@dataclass(frozen=True)
class Lesson:
    """A text and the things to try."""

    title: str
    intro: str
    steps: tuple[tuple[str, str], ...]
    """What is to be tried, and the sentence that says so."""


class LessonPanel:
    """What this skill is, and what to try with it."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._lesson = first_minute()
        self._text = gui.add_html("")
        self._changed = Changed()
        self._tried: frozenset[str] = frozenset()
        self._document: Document | None = None
        button = gui.add_button(OWN, icon=viser.Icon.SCHOOL, color=STRONG)
        on_press(button, lambda: actions.open_skill(""))

    def draw(self, state: State) -> None:
        """Tick off what was tried since the last time."""
        self._tried = self._tried | tried(self._document, state)
        self._document = state.document
        if self._changed(state.document.about, len(self._tried)):
            assign(self._text, content=page(self._lesson, state.document.about, self._tried))


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


def page(lesson: Lesson, about: str, done: frozenset[str]) -> str:
    """Build the text as HTML; a skill's own sentence is escaped."""
    items = "".join(_item(text, step in done) for step, text in lesson.steps)
    head = words.note(words.escape(about), strong=True) if about.strip() else ""
    return head + words.note(words.escape(lesson.intro)) + items + '<div style="height:0.6rem"></div>'


def _item(text: str, done: bool) -> str:
    """One thing to try; the marks are equally wide, so that a tick moves nothing."""
    return (
        '<div style="display:flex;gap:0.5rem;padding:0.15rem 0.75rem;font-size:0.8rem;line-height:1.4;'
        f'opacity:{0.6 if done else 1}"><span style="flex:0 0 0.8rem">{DONE if done else OPEN}</span>'
        f"<span>{words.escape(text)}</span></div>"
    )


@cache
def first_minute() -> Lesson:
    """Read the lesson that greets everybody."""
    data = tomllib.loads((static_folder() / "lessons" / "first_minute.toml").read_text(encoding="utf-8"))
    return Lesson(data["title"], data["intro"], tuple((s["tried"], s["text"]) for s in data["steps"]))


def _one_change(before: Document, after: Document) -> bool:
    """Whether one thing changed; another skill changes several."""
    parts = ("demonstrations", "landmarks", "starts", "rules")
    return sum(getattr(before, part) is not getattr(after, part) for part in parts) == 1
