"""The lesson: a few sentences, ticked off as things are tried."""

from typing import Final

import viser

from app.actions import Actions
from app.binding import STRONG, Changed, assign, on_press
from app.lesson import Lesson, first_minute
from app.panels import words
from app.store import State

DONE: Final = '<span style="color:light-dark(#157f5c,#19B98C);font-weight:700">&#10003;</span>'
OPEN: Final = '<span style="opacity:0.55">&#9675;</span>'
OWN: Final = "Teach your own"


class LessonPanel:
    """What this skill is, and what to try with it."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._lesson = first_minute()
        self._text = gui.add_html("")
        self._changed = Changed()
        button = gui.add_button(OWN, icon=viser.Icon.SCHOOL, color=STRONG)
        on_press(button, lambda: actions.open_skill(""))

    def draw(self, state: State) -> None:
        """Tick off what was tried."""
        if self._changed(state.document.about, len(state.tried)):
            assign(self._text, content=page(self._lesson, state.document.about, state.tried))


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
