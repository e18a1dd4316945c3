"""One server with the real arm for all stories, and people who come to it."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from app.server import Options, Server, first_document
from tests.browser.person import FIRST_SCREEN, SIZE, Person
from tests.support.chromium import ViserPage

_numbers = itertools.count()

Visit = Callable[..., Person]
"""``visit(code="", server=None)``: open the app, and wait for the first screen."""
DENSITY = 0.7
"""Pixels that are drawn for one of the page, to either side: fewer are drawn sooner."""


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

    def open_app(code: str = "", server: Server | None = None) -> Person:
        at = server or request.getfixturevalue("server")
        people.append(come(open_page(address(at, code), *SIZE)))
        return people[-1]

    yield open_app
    assert [person.tab.faults for person in people] == [[] for _ in people]


@pytest.fixture(scope="module")
def guest(server: Server, chromium: Browser) -> Iterator[Person]:
    """Somebody who stays for all stories of a module: each puts back what it changed."""
    context = chromium.new_context(viewport={"width": SIZE[0], "height": SIZE[1]})
    tab = ViserPage(context.new_page())
    tab.page.goto(address(server))
    yield come(tab)
    context.close()
    assert tab.faults == []


def address(server: Server, code: str = "") -> str:
    """Of a session, or of one that no other story has seen."""
    own = code or f"browser-story-{next(_numbers):04d}"
    return f"http://127.0.0.1:{server.port}/s/{own}?fixedDpr={DENSITY}"


def come(tab: ViserPage) -> Person:
    """Wait for the first screen."""
    tab.wait_drawn(*FIRST_SCREEN)
    return Person(tab)
