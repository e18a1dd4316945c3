"""The skills that were saved: what they look like, a link to each, and what can be done with one."""

from datetime import UTC, datetime
from functools import partial
from typing import Final

import viser

from app.actions import Actions
from app.binding import Changed, Rows, assign, on_choice
from app.library import Summary
from app.panels import words
from app.panels.menu import Menu, Question
from app.sentences import when
from app.store import Card, Shelf, State

CHOOSE: Final = "choose one…"
NOTHING: Final = "Skills are saved here by themselves, as soon as something is changed."
COPY: Final = "Make a copy"
DELETE: Final = "Delete…"


class SkillsPanel:
    """The list; a click on a name opens it."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._changed = Changed()
        self._empty = gui.add_html(words.note(NOTHING))
        self._rows = Rows(gui.add_folder(None), partial(SkillRow, gui))
        self._opened = Changed()
        self._menu: Menu[Summary] = Menu(
            gui,
            "Choose",
            "What the buttons below are about.",
            key=lambda summary: summary.code,
            nothing=CHOOSE,
            on_chosen=self._show_buttons,
        )
        self._buttons = gui.add_button_group("", (COPY, DELETE), visible=False)
        self._question = Question(gui)
        on_choice(self._buttons, lambda place: (self._copy, self._delete)[place]())

    def draw(self, state: State) -> None:
        """Show the list as it was last looked up."""
        shelf = state.shelf
        if not self._changed(shelf) or shelf is None:
            return
        assign(self._empty, visible=not shelf.cards)
        now = datetime.now(UTC)
        for row, card in zip(self._rows.fit(len(shelf.cards)), shelf.cards, strict=True):
            row.draw(card_html(card, shelf, now))
        titles = [card.summary.title for card in shelf.cards if card.summary.code == shelf.here]
        self._menu.offer(
            [(f"{c.summary.title} · {when(c.summary.updated, now)}", c.summary) for c in shelf.cards],
            shelf.here,
            anew=self._opened(*titles),  # another skill is open, or this one is called otherwise
        )
        self._show_buttons()

    def _show_buttons(self) -> None:
        assign(self._buttons, visible=self._menu.chosen is not None)

    def _copy(self) -> None:
        chosen = self._menu.chosen
        if chosen is not None:
            self._actions.copy_skill(chosen.code)

    def _delete(self) -> None:
        chosen = self._menu.chosen
        if chosen is not None:
            question = f"Delete {self._menu.name}? For 30 days it can be brought back."
            self._question.ask(question, "Delete it", lambda: self._actions.delete_skill(chosen.code))


class SkillRow:
    """One skill of the list."""

    def __init__(self, gui: viser.GuiApi, _: int) -> None:
        self._html = gui.add_html("")

    def show(self, visible: bool) -> None:
        """Show or hide it."""
        assign(self._html, visible=visible)

    def draw(self, content: str) -> None:
        """Show a skill."""
        assign(self._html, content=content)


def card_html(card: Card, shelf: Shelf, now: datetime) -> str:
    """Build one line of the list: the tube, the name as a link, when it was saved."""
    summary = card.summary
    title = words.escape(summary.title)
    here = summary.code == shelf.here
    name = f"<b>{title}</b>" if here else words.link(summary.code, title)
    note = f"saved {when(summary.updated, now)}" + (" · open here" if here else "")
    return (
        '<div style="display:flex;gap:0.6rem;align-items:center;padding:0.15rem 0.75rem;font-size:0.8rem;'
        f'line-height:1.3"><span style="flex:0 0 4rem">{card.drawing}</span>'
        f'<span style="overflow-wrap:anywhere">{name}<br><span style="opacity:0.7">{note}</span></span></div>'
    )
