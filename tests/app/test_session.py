"""Sessions on a real server: what a tab is sent, what its pulls do, and what outlives it."""

from __future__ import annotations

import itertools
import re
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.desk import Desk
from app.edits import EditError
from app.history import History
from app.library import Library, LibraryError
from app.server import Server
from app.viewers import Viewer
from app.web import code_of
from gc_core import same_content
from tests.app.site import (
    changed,
    first_document,
    grip_of,
    library_in,
    picture,
    press,
    pull,
    say,
    serving,
    tab,
)
from tests.support.fake_client import FakeClient

BY = (0.05, -0.04, 0.06)
UPLOAD = "Add a recording…"
GOOD = b"t,x,y,z\n0,0.3,0.2,0.4\n1,0.4,0.1,0.3\n2,0.5,-0.1,0.2\n"
_numbers = itertools.count()


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> str:
    return library_in(tmp_path_factory.mktemp("library"))


@pytest.fixture(scope="module")
def server(library: str) -> Iterator[Server]:
    with pytest.MonkeyPatch.context() as patch, serving(library) as made:
        patch.setattr("app.server.MOST_SESSIONS", 1000)  # one a test, and each is kept for a minute
        yield made


@pytest.fixture
def code() -> str:
    """A session that no other test has seen."""
    return f"session-number-{next(_numbers):04d}"


@pytest.fixture
def client(server: Server, code: str) -> Iterator[FakeClient]:
    with tab(server, code) as made:
        yield made


def saved(library: str, code: str) -> Callable[[object], bool]:
    """Whether the library holds a session's demonstrations, all four of them."""
    shelf = Library(library)

    def holds(_: object) -> bool:
        document = shelf.load(code)
        return document is not None and len(document.demonstrations) == 4

    return holds


def wait_for_change(client: FakeClient, before: dict, *names: str) -> None:
    client.wait(lambda c: set(names) <= changed(before, picture(c)) and not dragging(c))


def dragging(client: FakeClient) -> bool:
    """Whether the tube is still the coarse one of a pull."""
    return client.node("/tube").array("vertices").shape[0] < 60 * 32


def show_one(client: FakeClient) -> None:
    """Demonstrate once more."""
    pull(client, "/hand", (0.10, 0.05, -0.08), events=10)
    client.wait(lambda c: "/demonstrations/3" in c.nodes and not dragging(c))


def test_the_first_screen_shows_the_skill_the_arm_and_a_playing_run(client: FakeClient) -> None:
    before = client.world_position("/hand")

    client.wait(lambda c: np.linalg.norm(c.world_position("/hand") - before) > 0.01)
    assert any(name.startswith("/arm/") for name in client.nodes)
    assert client.value("Skill") == "Reaching"


def test_the_tube_is_never_interactive(client: FakeClient) -> None:
    assert not client.node("/tube").drags
    assert not client.node("/tube").clicks


CHANGES = {
    "/start/0": ({"/start/0", "/reproductions/0"}, {"/start/0", "/reproductions/0"}),
    "/landmarks/goal": (
        {"/landmarks/goal", "/tube", "/directrix", "/reproductions/0"},
        {"/landmarks/goal", "/tube", "/directrix", "/directrix/pick", "/reproductions/0", "/start/0"},
    ),
    "/demonstrations/0": (
        {"/demonstrations/0", "/tube", "/directrix"},
        {
            "/demonstrations/0",
            "/tube",
            "/directrix",
            "/directrix/pick",
            "/reproductions/0",
            "/landmarks/start",
            "/landmarks/goal",
        },
    ),
    "/reproductions/0": ({"/reproductions/0"}, {"/reproductions/0"}),
    "/hand": ({"/demonstrations/3", "/tube", "/directrix"}, set()),
}
"""Of each pull: what must look different afterwards, and all that may (nothing said: anything)."""


@pytest.mark.parametrize("node", CHANGES)
def test_a_pull_changes_what_it_should_and_undo_restores_the_picture(client: FakeClient, node: str) -> None:
    must, may = CHANGES[node]
    before = picture(client)

    far = 2.5 if node == "/hand" else 1.0  # less would be a tug, which is not learned from
    pull(client, node, [far * way for way in BY], events=10)
    wait_for_change(client, before, *must)
    after = changed(before, picture(client))
    press(client, "Undo:")

    assert not may or after <= may
    client.wait(lambda c: picture(c) == before)


def test_what_the_arm_cannot_do_is_hatched_and_told_once_the_worker_has_found_it_and_gone_with_it(
    client: FakeClient,
) -> None:
    hatching = "/reproductions/0/hatching"
    client.wait(lambda c: "The arm can do run 1." in c.text())
    pull(client, "/start/0", (0.9, 0.3, 0.1))
    client.wait(lambda c: hatching in c.nodes and c.node(hatching).visible)
    client.wait(lambda c: "The arm cannot do run 1 as it is" in c.text())
    told = [e.label for e in client.gui if e.kind == "Button" and "beyond reach" in e.label and e.usable]

    press(client, "Undo:")

    assert len(told) == 1
    client.wait(lambda c: not c.node(hatching).visible and "The arm can do run 1." in c.text())


def test_every_run_is_checked_not_only_the_one_that_is_played(client: FakeClient) -> None:
    press(client, "Add another start")
    client.wait(lambda c: "/start/1" in c.nodes)
    pull(client, "/start/1", (0.9, 0.3, 0.1))
    client.wait(lambda c: "/reproductions/1/hatching" in c.nodes)

    client.wait(lambda c: any(e.label == "Run" and e.usable for e in c.gui))
    client.set_gui("Run", "1")

    client.wait(lambda c: "The arm can do run 1." in c.text())
    assert "The arm cannot do run 2 as it is" in client.text()


def test_redo_restores_the_pulled_picture(client: FakeClient) -> None:
    before = picture(client)
    pull(client, "/landmarks/goal", BY)
    wait_for_change(client, before, "/landmarks/goal", "/tube")
    client.wait(lambda c: not dragging(c))
    after = picture(client)
    press(client, "Undo:")
    client.wait(lambda c: picture(c) == before)

    press(client, "Redo:")

    client.wait(lambda c: picture(c) == after)


def test_the_first_change_of_a_built_in_skill_makes_a_copy(client: FakeClient) -> None:
    pull(client, "/start/0", BY)

    client.wait(lambda c: c.value("Skill") == "My reaching")


def test_two_sessions_do_not_see_each_other(server: Server, client: FakeClient) -> None:
    with tab(server, "another-session-0001") as other:
        before = picture(other)
        show_one(client)
        press(other, "Add another start")  # an answer of the other session, made after that change
        other.wait(lambda c: "/start/1" in c.nodes)

        seen = changed(before, picture(other))
        assert seen == {"/start/1", "/reproductions/1"}
        assert "/start/1" not in client.nodes


def test_a_second_tab_watches(server: Server, client: FakeClient, code: str) -> None:
    with tab(server, code) as second:
        assert "open in another tab" in second.text()
        show_one(client)

        second.wait(lambda c: "/demonstrations/3" in c.nodes)


def test_the_pulls_of_a_watching_tab_change_nothing_until_it_takes_over(
    server: Server, client: FakeClient, code: str
) -> None:
    with tab(server, code) as second:
        pull(second, "/landmarks/goal", BY)
        press(second, "Work on it here")
        second.wait(lambda c: any(e.label == "Undo" for e in c.gui) and "/landmarks/goal" in c.nodes)
        unmoved = second.world_position("/landmarks/goal")
        pull(second, "/landmarks/goal", BY)

        second.wait(lambda c: np.allclose(c.world_position("/landmarks/goal"), unmoved + BY, atol=1e-6))
        client.wait(lambda c: "open in another tab" in c.text())


def test_when_the_working_tab_leaves_the_watching_one_works(server: Server, code: str) -> None:
    with tab(server, code) as first, tab(server, code) as second:
        first.close()
        second.wait(lambda c: any(e.label == "Undo" for e in c.gui) and "/landmarks/goal" in c.nodes)
        before = picture(second)
        pull(second, "/landmarks/goal", BY)

        wait_for_change(second, before, "/landmarks/goal")


def test_a_reload_brings_the_work_back(server: Server, code: str) -> None:
    with tab(server, code) as client:
        show_one(client)
        before = picture(client)

    with tab(server, code) as again:
        again.wait(lambda c: picture(c) == before)


def test_undo_survives_a_reload(server: Server, code: str) -> None:
    with tab(server, code) as client:
        before = picture(client)
        show_one(client)

    with tab(server, code) as again:
        press(again, "Undo:")
        again.wait(lambda c: picture(c) == before)


def test_the_work_is_saved_after_the_gesture(client: FakeClient, library: str, code: str) -> None:
    show_one(client)

    client.wait(saved(library, code))


@pytest.mark.parametrize(("part", "name"), [(Viewer, "draw"), (Desk, "state")])
def test_work_that_cannot_be_learned_or_drawn_is_saved_all_the_same(
    client: FakeClient, code: str, monkeypatch: pytest.MonkeyPatch, part: type, name: str
) -> None:
    written, keep = threading.Event(), Library.keep

    def noted(self: Library, under: str, history: History, **more: Any) -> None:
        keep(self, under, history, **more)
        if under == code and len(history.present.document.demonstrations) == 4:
            written.set()

    def broken(*_: object) -> None:
        raise ValueError("a picture that cannot be drawn")

    monkeypatch.setattr(Library, "keep", noted)
    monkeypatch.setattr(part, name, broken)
    pull(client, "/hand", (0.10, 0.05, -0.08), events=10)

    assert written.wait(10.0)


def test_a_last_save_that_fails_is_said_in_the_log(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def full(*_: object, **__: object) -> None:
        raise LibraryError("The disk is full.")

    with serving(library_in(tmp_path)) as server, tab(server, "never-saved-0001") as client:
        monkeypatch.setattr(Library, "keep", full)
        pull(client, "/landmarks/goal", BY, let_go=False)
        client.wait(dragging)

    assert "never-saved-0001 is not saved: The disk is full." in caplog.text


def test_a_tab_that_left_while_it_pulled_too_far_leaves_the_work_to_the_next(
    server: Server, client: FakeClient, code: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def beyond(*_: object) -> None:
        raise EditError("It was pulled too far.")

    with tab(server, code) as second:
        pull(client, "/landmarks/goal", BY, let_go=False)
        client.wait(dragging)
        monkeypatch.setattr("app.edits.move_landmark", beyond)
        client.close()

        second.wait(lambda c: any(e.label == "Undo" for e in c.gui))


def test_a_tab_that_takes_over_and_back_is_followed_by_one_camera(server: Server, code: str) -> None:
    with tab(server, code) as first, tab(server, code) as second:
        for one in (second, first, second):
            press(one, "Work on it here")
            one.wait(lambda c: any(e.label == "Undo" for e in c.gui) and "/landmarks/goal" in c.nodes)

        mine = [c for c in server._viser.get_clients().values() if code_of(c) == code]
        assert [len(c.camera._state.camera_cb) for c in mine] == [1, 1]


def test_looking_alone_saves_nothing(tmp_path: Path) -> None:
    library, code = library_in(tmp_path), "only-looked-0001"
    with serving(library) as server, tab(server, code) as client:
        client.wait(lambda c: any("Pause" in e.props.get("options", ()) for e in c.gui))
        client.press("Pause")
        client.wait(lambda c: any("Play" in e.props.get("options", ()) for e in c.gui))

    assert Library(library).load(code) is None


def test_a_new_server_on_the_same_library_brings_the_work_back(tmp_path: Path) -> None:
    library, code = library_in(tmp_path), "restarted-session"
    with serving(library) as server, tab(server, code) as client:
        show_one(client)
        before = picture(client)

    with serving(library) as server, tab(server, code) as client:
        client.wait(lambda c: picture(c) == before)


def test_what_is_drawn_when_the_server_stops_is_kept(tmp_path: Path) -> None:
    library, code = library_in(tmp_path), "stopped-in-mid-pull"
    with serving(library) as server, tab(server, code) as client:
        pull(client, "/hand", (0.10, 0.05, -0.08), let_go=False)
        client.wait(lambda c: "/demonstrations/3" in c.nodes)

    document = Library(library).load(code)
    assert document is not None
    assert len(document.demonstrations) == 4


def test_a_connection_lost_in_mid_pull_keeps_what_was_drawn(server: Server, library: str, code: str) -> None:
    with tab(server, code) as client:
        pull(client, "/hand", (0.10, 0.05, -0.08), let_go=False)
        client.wait(lambda c: "/demonstrations/3" in c.nodes)
        client.close()

    with tab(server, code) as again:
        again.wait(lambda c: "/demonstrations/3" in c.nodes)
        again.wait(saved(library, code))


def test_a_connection_lost_in_mid_pull_of_a_landmark_keeps_it_where_it_was_pulled(
    server: Server, code: str
) -> None:
    with tab(server, code) as client:
        goal = client.world_position("/landmarks/goal")
        pull(client, "/landmarks/goal", BY, let_go=False)
        client.wait(lambda c: np.allclose(c.world_position("/landmarks/goal"), goal + BY, atol=1e-6))
        client.close()

    with tab(server, code) as again:
        np.testing.assert_allclose(again.world_position("/landmarks/goal"), goal + BY, atol=1e-6)


@pytest.mark.parametrize("node", ["/demonstrations/0", "/reproductions/0"])
def test_a_connection_lost_in_mid_correction_saves_nothing_and_asks_again(
    server: Server, library: str, code: str, node: str
) -> None:
    with tab(server, code) as client:
        before = picture(client)
        pull(client, node, BY, let_go=False)
        client.wait(lambda c: node in changed(before, picture(c)))
        client.close()

    with tab(server, code) as again:
        again.wait(lambda c: any("Discard" in e.props.get("options", ()) and e.usable for e in c.gui))
        kept = Library(library).load(code)
        again.press("Discard")
        again.wait(lambda c: picture(c) == before)

    assert kept is None or same_content(kept, first_document())


@pytest.mark.parametrize("wrong", [np.nan, np.inf, 1e30, -11.0])
def test_a_pointer_that_is_nowhere_is_dropped(client: FakeClient, wrong: float) -> None:
    at = grip_of(client, "/landmarks/goal")
    for phase, pointer in (
        ("start", at),
        ("update", at + np.multiply(BY, 0.5)),
        ("update", np.full(3, wrong)),
        ("end", at + BY),
    ):
        say(client, "/landmarks/goal", phase, at, pointer)

    press(client, "Undo: move goal")
    client.wait(lambda c: np.allclose(c.world_position("/landmarks/goal"), at, atol=1e-6))


def test_a_pull_whose_end_is_nowhere_ends_at_its_last_good_place(client: FakeClient) -> None:
    at = grip_of(client, "/landmarks/goal")
    say(client, "/landmarks/goal", "start", at, at)
    say(client, "/landmarks/goal", "update", at, at + BY)
    say(client, "/landmarks/goal", "end", at, np.full(3, np.nan))

    client.wait(lambda c: any(e.label == "Undo: move goal" and e.usable for e in c.gui))
    np.testing.assert_allclose(client.world_position("/landmarks/goal"), at + BY, atol=1e-6)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("notes.txt", b"hello", ".csv"),
        ("nan.csv", b"t,x,y,z\n0,0,0,0\n1,nan,0,0\n2,1,1,1\n", "not a finite number"),
        ("empty.csv", b"", "it is empty"),
        ("words.csv", b"t,x,y,z\n0,a,b,c\n1,d,e,f\n", "is not a number"),
        ("one.csv", b"t,x,y,z\n0,0,0,0\n", "one sample"),
        ("same.csv", b"t,x,y,z\n0,1,1,1\n1,1,1,1\n", "same place"),
        ("junk.npy", b"\x93NUMPY" + bytes(range(64)), "no NumPy file"),
    ],
)
def test_a_bad_file_is_explained_and_the_work_lives_on(
    client: FakeClient, name: str, content: bytes, words: str
) -> None:
    before = picture(client)
    client.upload(UPLOAD, name, content)
    client.wait(lambda c: name in c.text() and words in c.text())

    assert changed(before, picture(client)) == set()
    pull(client, "/start/0", BY)
    wait_for_change(client, before, "/start/0")


def test_a_file_too_large_is_refused_with_a_sentence(client: FakeClient) -> None:
    client.upload(UPLOAD, "huge.csv", b"", announced=500 << 20)

    client.wait(lambda c: "huge.csv has 500 MB" in c.text())


def test_a_good_file_is_offered_then_added(client: FakeClient) -> None:
    pull(client, "/start/0", BY)  # makes the built-in skill one's own, which the file then joins
    client.wait(lambda c: c.value("Skill") == "My reaching")
    client.upload(UPLOAD, "mine.csv", GOOD)
    client.wait(lambda c: c.element("Recording", "Folder").usable)
    assert "/demonstrations/3" not in client.nodes

    client.press("Add")

    client.wait(lambda c: "/demonstrations/3" in c.nodes)


def test_a_good_file_beside_a_built_in_skill_opens_as_a_skill_of_its_own(client: FakeClient) -> None:
    client.upload(UPLOAD, "mine.csv", GOOD)
    client.wait(lambda c: c.element("Recording", "Folder").usable)

    client.press("Add")

    client.wait(lambda c: c.value("Skill") == "mine" and not c.node("/demonstrations/1").visible)


def test_an_empty_skill_of_ones_own_can_be_opened_and_undone(client: FakeClient) -> None:
    before = picture(client)
    client.set_gui("Open", "Teach your own")
    client.wait(lambda c: not c.node("/tube").visible and not c.node("/demonstrations/0").visible)

    press(client, "Undo: begin My skill")

    client.wait(lambda c: picture(c) == before)


def test_ones_own_work_keeps_an_address_when_another_skill_is_opened(
    server: Server, client: FakeClient
) -> None:
    show_one(client)
    client.set_gui("Open", "Needle")
    kept = re.compile(r"kept at /s/([\w-]+)")
    found = client.wait(lambda c: kept.search(c.text()))

    assert client.value("Skill") == "Needle"
    with tab(server, found[1]) as other:
        assert other.value("Skill") == "My reaching"
        assert other.node("/demonstrations/3").visible

    press(client, "Undo: open Needle")
    client.wait(lambda c: c.value("Skill") == "My reaching")
    client.set_gui("Open", "Needle")
    client.wait(lambda c: c.value("Skill") == "Needle" and kept.search(c.text()))
    assert kept.search(client.text())[1] == found[1]


def test_a_built_in_skill_that_was_only_looked_at_is_not_kept(client: FakeClient) -> None:
    client.set_gui("Open", "Needle")
    client.wait(lambda c: c.value("Skill") == "Needle")

    assert "kept at" not in client.text()


def test_the_skill_is_drawn_in_every_kind_of_slice_and_again_when_it_changes(client: FakeClient) -> None:
    def volumes(c: FakeClient) -> list[str]:
        return re.findall(r"<b>([\d.]+ (?:l|cm³))</b>", c.text())

    client.wait(lambda c: len(volumes(c)) == 3)
    before = volumes(client)
    pull(client, "/landmarks/goal", BY)

    client.wait(lambda c: len(volumes(c)) == 3 and volumes(c) != before)


def test_a_full_server_says_so_and_goes_on_serving(
    server: Server, client: FakeClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.server.MOST_SESSIONS", 1)
    with FakeClient(f"ws://127.0.0.1:{server.port}/s/one-too-many-0001") as late:
        late.wait(lambda c: "people are working here already" in c.text())
    before = picture(client)

    pull(client, "/start/0", BY)

    wait_for_change(client, before, "/start/0")
