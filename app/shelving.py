"""The other skills of a library, as a session lists them and does something with them.

Whoever sits at the server's own machine sees all skills. Others see those whose codes their
browser has opened, since a code is the only key to a skill.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from concurrent.futures import Executor
from dataclasses import replace
from typing import Final, TypeAlias

from app.actor import Actor, Latest, run
from app.desk import Desk
from app.document import Document
from app.drawing import drawing_of
from app.edits import LONGEST_NAME
from app.history import History
from app.library import Library, LibraryError, Summary
from app.pages import fresh_code
from app.store import Card, Shelf

MOST_CARDS: Final = 12
"""Skills that are listed."""

COPY: Final = " (copy)"

Known: TypeAlias = Collection[str] | None
"""Codes that a person has; None: all."""
Job: TypeAlias = "Callable[[Shelving], str]"
"""Done in a worker; returns what came of it, for the person."""
Prepare: TypeAlias = "Callable[[Desk, float], Job | None]"
"""Looks at the desk, in the mailbox, and says what is to be done."""


class Shelving:
    """Looks the list up in a worker whenever something was saved or done."""

    def __init__(self, code: str, library: Library, executor: Executor, actor: Actor) -> None:
        self._code = code
        self.library: Final = library
        self._jobs = executor, actor
        self._listing = Latest(executor, actor)
        self._drawn: dict[str, tuple[Summary, str]] = {}
        self._made: list[str] = []
        self._known: Known = frozenset()
        self.shelf: Shelf | None = None
        """As it was last looked up."""

    def look_for(self, known: Known) -> None:
        """List what somebody with these codes may open, from now on."""
        self._known = known
        self.look_up()

    def look_up(self) -> None:
        """List anew."""
        among = None if self._known is None else {*self._known, *self._made, self._code}
        self._listing.submit(lambda: self._list(among), self._accept)

    def do(self, job: Job | None, say: Callable[[str], None]) -> None:
        """Let a worker do something, say what came of it if it is worth a word, and list anew."""
        if job is None:
            return

        def done(said: str) -> None:
            if said:
                say(said)
            self.look_up()

        run(*self._jobs, lambda: job(self), done)

    def copy(self, document: Document) -> str:
        """Save a copy under a code of its own, in a worker; returns the code."""
        code = fresh_code()
        title = f"{document.title[: LONGEST_NAME - len(COPY)]}{COPY}"
        self.library.save(code, replace(document, title=title, built_in=False))
        self._made.append(code)
        return code

    def put_away(self, code: str, history: History) -> None:
        """Keep one's own work under a code of its own, in a worker."""
        self.library.keep(code, history)
        self._made.append(code)

    def _list(self, among: Known) -> Shelf:
        found = self.library.recent(MOST_CARDS, among)
        new = [s.code for s in found if self._drawn.get(s.code, (None, ""))[0] != s]
        drawings = self.library.drawings(new)
        for summary in found:
            if summary.code in new:
                drawing = drawings.get(summary.code)
                self._drawn[summary.code] = summary, self._draw(summary.code) if drawing is None else drawing
        cards = tuple(Card(summary, self._drawn[summary.code][1]) for summary in found)
        return Shelf(self._code, cards, tuple(self.library.deleted(MOST_CARDS, among)))

    def _draw(self, code: str) -> str:
        """Draw a skill that came into the library without being worked on."""
        try:
            document = self.library.load(code)
        except LibraryError:  # whoever opens it is told why
            return ""
        drawing = "" if document is None else drawing_of(document)
        self.library.draw(code, drawing)
        return drawing

    def _accept(self, shelf: Shelf) -> None:
        self.shelf = shelf


def copied(shelving: Shelving, document: Document) -> str:
    """Make a copy, in a worker, and say where it is."""
    shelving.copy(document)
    return f"A copy of {document.title} is in My skills."
