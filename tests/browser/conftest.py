"""One server with the real arm for all stories, and people who come to it."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from app.server import Options, Server, first_document
from tests.browser.person import FIRST_SCREEN, SIZE, Person
from tests.support.chromium import ViserPage

_numbers = itertools.count()

Visit = Callable[..., Person]
"""``visit(code="", server=None, fine=False)``: open the app, on a session or on one of its own, and wait
for the first screen. Its pictures are coarse, and quickly drawn, unless asked to be fine."""
COARSE_PICTURES = 0.5
"""Pixels drawn for one of the page, to either side."""


@contextlib.contextmanager
def serving(library: Path) -> Iterator[Server]:
    """A server on a free port of this machine."""
    server = Server(Options("127.0.0.1", 0, f"sqlite:///{library}"), first_document(()))
    try:
        yield server
    finally:
        server.close()


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    with serving(tmp_path_factory.mktemp("stories") / "library.db") as made:
        yield made


@pytest.fixture
def code() -> str:
    """A session that no other story has seen."""
    return f"browser-story-{next(_numbers):04d}"


@pytest.fixture
def visit(request: pytest.FixtureRequest, open_page: Callable[..., ViserPage]) -> Iterator[Visit]:
    people: list[Person] = []

    def open_app(code: str = "", server: Server | None = None, *, fine: bool = False) -> Person:
        at = server or request.getfixturevalue("server")
        own = code or f"browser-story-{next(_numbers):04d}"
        address = f"http://127.0.0.1:{at.port}/s/{own}"
        person = Person(open_page(address if fine else f"{address}?fixedDpr={COARSE_PICTURES}", *SIZE))
        people.append(person)
        person.tab.wait_drawn(*FIRST_SCREEN)
        return person

    yield open_app
    assert [person.tab.faults for person in people] == [[] for _ in people]
