"""What outlives a session: its history, its lesson, and the way to the other skills."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from datetime import datetime
from pathlib import Path

import pytest

from app.actor import Actor
from app.arm import PlanarArm
from app.desk import Desk
from app.edits import delete_demonstration, rename_skill
from app.history import begin
from app.keeping import Keeper
from app.library import Library, LibraryError
from app.seat import go_back
from app.server import Server
from tests.app.makers import taught
from tests.app.site import library_in, picture, press, pull, serving, tab
from tests.support.fake_client import FakeClient

BY = (0.05, -0.04, 0.06)
CODE = "kept-and-kept-again"


@pytest.fixture
def library(tmp_path: Path) -> str:
    return library_in(tmp_path)


@pytest.fixture
def server(library: str) -> Iterator[Server]:
    with serving(library) as made:
        yield made


def move(client: FakeClient, node: str, by: tuple[float, float, float] = BY) -> None:
    """Pull at something and wait until that is a step which is saved."""
    before = versions(client)
    pull(client, node, by)
    client.wait(lambda c: versions(c) > before and ">Saved<" in c.text())


def versions(client: FakeClient) -> int:
    return sum(bool(option) for option in client.element("Version", "Dropdown").props["options"])


def ticks(client: FakeClient) -> int:
    """Things of the lesson that were tried."""
    return client.text().count("&#10003;")


def press_option(client: FakeClient, option: str) -> None:
    client.wait(lambda c: any(option in e.props.get("options", ()) and e.usable for e in c.gui))
    client.press(option)


def test_undo_survives_the_end_of_the_server_and_so_does_the_lesson(library: str) -> None:
    with serving(library) as server, tab(server, CODE) as client:
        first = picture(client)
        move(client, "/start/0")
        between = picture(client)
        move(client, "/landmarks/goal")
        last = picture(client)
        press(client, "Undo: move goal")
        client.wait(lambda c: picture(c) == between and ">Saved<" in c.text() and ticks(c) == 3)

    with serving(library) as server, tab(server, CODE) as client:
        client.wait(lambda c: picture(c) == between and ticks(c) == 3)
        press(client, "Redo: move goal")
        client.wait(lambda c: picture(c) == last)
        press(client, "Undo: move goal")
        press(client, "Undo: move start")
        client.wait(lambda c: picture(c) == first)


def test_an_earlier_version_is_worked_on_again_and_that_is_undone(server: Server) -> None:
    with tab(server, CODE) as client:
        first = picture(client)
        move(client, "/start/0")
        moved = picture(client)

        client.press("Go back to it")
        client.wait(lambda c: picture(c) == first)
        press(client, "Undo: go back to the beginning")
        client.wait(lambda c: picture(c) == moved)


def test_going_back_is_named_after_the_time_of_the_version() -> None:
    desk = Desk(taught(), PlanarArm())
    desk.edit(lambda d: rename_skill(d, "First"), "demonstrate", now=0.0)
    first = desk.store.history.present
    desk.edit(lambda d: rename_skill(d, "Second"), "move goal", now=9.0)

    go_back(desk, first.stamp, 10.0)

    assert desk.store.undo_name == f"go back to {datetime.fromtimestamp(first.made):%H:%M}"


def test_a_copy_of_a_skill_is_listed_with_its_picture_and_lives_on_its_own(
    server: Server, library: str
) -> None:
    with tab(server, CODE) as client:
        move(client, "/start/0")
        press_option(client, "Make a copy")
        client.wait(lambda c: "My reaching (copy)</a>" in c.text() and c.text().count("<svg") >= 2)

    shelf = Library(library)
    titles = {summary.title: summary.code for summary in shelf.recent()}
    shelf.close()
    assert set(titles) == {"My reaching", "My reaching (copy)"}
    with tab(server, titles["My reaching (copy)"]) as copy:
        assert copy.value("Skill") == "My reaching (copy)"


def test_a_deleted_skill_is_asked_for_and_brought_back(server: Server, library: str) -> None:
    shelf = Library(library)
    with tab(server, CODE) as client:
        move(client, "/start/0")
        press_option(client, "Delete…")
        client.wait(lambda c: "can be brought back" in c.text())
        assert [summary.code for summary in shelf.recent()] == [CODE]
        client.press("Delete it")
        client.wait(lambda c: "My reaching is among the recently deleted." in c.text())
        assert [s.code for s in shelf.deleted()] == [CODE]
        press_option(client, "Bring it back")
        client.wait(lambda _: [s.code for s in shelf.recent()] == [CODE])
    shelf.close()


def test_a_deleted_demonstration_is_brought_back_by_a_step(server: Server, library: str) -> None:
    begun = begin(taught(), 1.0)
    shelf = Library(library)
    shelf.keep(CODE, begun.after(delete_demonstration(begun.present.document, 1), "delete Reach 2", 2.0))
    shelf.close()
    with FakeClient(f"ws://127.0.0.1:{server.port}/s/{CODE}") as client:
        press(client, "Bring the demonstration back")
        client.wait_nodes("/demonstrations/2")
        press(client, "Undo: bring back Reach 2")


def test_a_watching_tab_may_go_on_with_a_copy(server: Server, library: str) -> None:
    with tab(server, CODE) as first, tab(server, CODE) as second:
        second.press("Make my own copy")
        second.wait(lambda c: "Your copy is ready" in c.text())
        assert "open in another tab" in second.text()
        assert first.value("Skill") == "Reaching"
    shelf = Library(library)
    assert [summary.title for summary in shelf.recent()] == ["Reaching (copy)"]
    shelf.close()


def test_an_address_with_nothing_behind_it_says_so_and_a_fresh_one_does_not(server: Server) -> None:
    with tab(server, CODE) as client:
        client.wait(lambda c: "Nothing is saved under this address" in c.text())
    with tab(server, server._fresh_code()) as fresh:
        assert "Nothing is saved" not in fresh.text()


def test_work_that_is_not_saved_is_said_not_to_be_until_it_is(
    server: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    full, keep = threading.Event(), Library.keep
    problems = itertools.cycle([LibraryError("The disk is full."), ValueError("a fault of ours")])
    full.set()

    def failing(self: Library, *args: object, **more: object) -> None:
        if full.is_set():
            raise next(problems)
        keep(self, *args, **more)

    monkeypatch.setattr("app.keeping.AGAIN", 0.2)
    monkeypatch.setattr(Library, "keep", failing)
    with tab(server, CODE) as client:
        pull(client, "/start/0", BY)
        client.wait(lambda c: "Not saved yet" in c.text() and "The disk is full." in c.text())
        client.wait(lambda c: "Not saved yet" in c.text() and "Something went wrong in" in c.text())
        full.clear()
        client.wait(lambda c: "Not saved yet" not in c.text() and ">Saved<" in c.text())


class Waiting(Executor):
    """A worker that has not come to it yet."""

    def __init__(self) -> None:
        self.jobs: list[Callable[[], object]] = []

    def submit(self, fn: Callable[..., object], /, *args: object, **more: object) -> Future[None]:
        self.jobs.append(lambda: fn(*args, **more))
        return Future()


def test_a_save_that_waited_until_its_session_was_over_undoes_nothing(library: str) -> None:
    shelf, desk, worker = Library(library), Desk(taught(), PlanarArm()), Waiting()
    actor = Actor(tick=lambda: False, draw=lambda: None, report=lambda _: None, name="over")
    keeper = Keeper(CODE, desk, shelf, (worker, actor), clock=lambda: 0.0, on_saved=lambda: None)
    desk.edit(lambda d: rename_skill(d, "First"), "rename", now=0.0)
    keeper.follow(frozenset())
    keeper.finish(frozenset())
    history = desk.store.history
    shelf.keep(CODE, history.after(rename_skill(history.present.document, "Second"), "rename", 2e9))

    for job in worker.jobs:
        job()

    saved = shelf.load(CODE)
    assert saved is not None
    assert saved.title == "Second"
    actor.close()
    shelf.close()
