"""Every edit that panels and scene can make, undone and redone: nothing can be done that cannot be undone.

What there is to do is found in the code. Whoever adds an action, an edit or something to pull on finds a
failing test here until it is listed.
"""

from __future__ import annotations

import inspect
import itertools
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from app import edits, skills
from app.actions import Actions
from app.desk import Desk
from app.document import Document
from app.files import inspect_bytes
from app.library import Library, encode_document
from app.seat import go_back
from gc_core import same_content
from tests.app.makers import Mouse, desk_of, furnished
from tests.app.site import FIRST_SCREEN, library_in, pull, serving
from tests.app.test_edits import CHANGES
from tests.files.makers import GOOD
from tests.support.fake_client import FakeClient

Deed = Callable[[Mouse], object]
BY = (0.05, -0.04, 0.06)

PULLS = {
    "hand": "/hand",
    "start": "/start/0",
    "demonstrations": "/demonstrations/1",
    "reproductions": "/reproductions/0",
    "landmarks": "/landmarks/goal",
    "turns": "/turns/cup",
    "obstacles": "/obstacles/crate",
    "sizes": "/sizes/crate/0",
}
"""Of each kind of thing in the scene that can be pulled on, one."""

LOOKING = {
    "choose_run", "close_export", "compare", "copy_skill", "copy_version", "decline_file", "delete_skill",
    "forget_skill", "hold_tool", "look", "miss_hand", "move_hand", "nudge_hand", "nudge_turn",
    "offer_file", "play", "play_trial", "prepare_export", "preview", "redo", "reposition", "restore_skill",
    "see_from", "seek", "start_replay", "stop_replay", "take_export", "toggle_gripper", "try_physics",
    "turn_tool", "undo",
}  # fmt: skip
"""Actions that leave the document as it is, or are the way back itself."""


def pulled(node: str) -> Deed:
    """Pull on something; the knob of a dial is pulled around its object."""

    def deed(mouse: Mouse) -> None:
        if node.startswith("/turns"):
            mouse.pull(node, (0.0, 0.08, 0.0), at=np.array([0.60, 0.05, 0.30]))
        else:
            mouse.pull(node, BY)

    return deed


def answered(choice: int) -> Deed:
    """Correct a run and answer with one of the choices."""

    def deed(mouse: Mouse) -> None:
        mouse.pull("/reproductions/0", BY, kept=False)
        mouse.desk.amend(lambda amending: amending.answer(choice, mouse.now))

    return deed


def recorded(mouse: Mouse) -> None:
    desk = mouse.desk
    desk.leading.record(mouse.now)
    desk.leading.move(desk.stage.hand.position + np.array(BY), mouse.now)
    mouse.wait(1.5)
    desk.leading.record(mouse.now)
    mouse.wait(0.3)


def moved_line(mouse: Mouse) -> None:
    mouse.desk.leading.move_line("/reproductions/0", 0.5, np.array(BY), mouse.now)
    mouse.desk.amend(lambda amending: amending.answer(0, mouse.now))


def accepted(mouse: Mouse) -> None:
    mouse.desk.offer_reading(inspect_bytes("a.csv", GOOD["a.csv"]))
    mouse.desk.accept_file("m", "as recorded", mouse.now)


def gone_back(mouse: Mouse) -> None:
    desk = mouse.desk
    desk.edit(partial(edits.set_stations, stations=77), "change the slices", now=mouse.now)
    stamp = desk.store.history.present.stamp
    desk.undo(mouse.now)
    go_back(desk, stamp, mouse.now)


def edited(change: Callable[[Document], Document]) -> Deed:
    return lambda mouse: mouse.desk.edit(change, "edit", now=mouse.now)


DEEDS: dict[str, dict[str, Deed]] = {
    "edit": {name: edited(change) for name, change in CHANGES.items()},
    "drag": {node: pulled(node) for node in PULLS.values()},
    "answer": {f"choice {number}": answered(number) for number in range(2)},
    "record": {"by buttons": recorded},
    "move_line": {"by numbers": moved_line},
    "accept_file": {"a table": accepted},
    "go_back": {"a version that was undone": gone_back},
    "open_skill": {"an empty one": lambda mouse: mouse.desk.open(skills.empty_skill(), mouse.now)},
}
"""Of each action that edits, ways to do it."""

ALL = [(f"{action}: {name}", deed) for action, ways in DEEDS.items() for name, deed in ways.items()]


def test_every_action_is_listed_as_one_that_edits_or_one_that_does_not() -> None:
    there = {name for name, _ in inspect.getmembers(Actions, inspect.isfunction) if not name.startswith("_")}

    assert there == DEEDS.keys() | LOOKING
    assert not DEEDS.keys() & LOOKING


def test_every_answer_to_a_corrected_run_is_listed() -> None:
    mouse = Mouse(desk_of(furnished()))
    mouse.pull("/reproductions/0", BY, kept=False)

    proposal = mouse.desk.state().proposal
    assert proposal is not None
    assert len(proposal.choices) == len(DEEDS["answer"])


@pytest.fixture(scope="module")
def furnished_tab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[FakeClient]:
    folder: Path = tmp_path_factory.mktemp("library")
    Library(library_in(folder)).save("everything-in-it", furnished())
    with (
        serving(library_in(folder)) as server,
        FakeClient(f"ws://127.0.0.1:{server.port}/s/everything-in-it") as made,
    ):
        made.wait_nodes(*FIRST_SCREEN, "/turns/cup", "/obstacles/crate")
        yield made


def test_everything_in_the_scene_that_can_be_pulled_on_is_listed(furnished_tab: FakeClient) -> None:
    pull(furnished_tab, "/obstacles/crate", BY)  # which then has handles to size it by
    furnished_tab.wait_nodes("/sizes/crate/0")
    furnished_tab.wait(lambda c: c.node("/sizes/crate/0").drags)

    kinds = {name.split("/")[1] for name, node in furnished_tab.nodes.items() if node.drags}
    assert kinds == PULLS.keys()


@pytest.mark.parametrize(("name", "deed"), ALL, ids=[name for name, _ in ALL])
def test_what_is_done_is_named_undone_and_redone(name: str, deed: Deed) -> None:
    desk = desk_of(furnished())
    mouse, before = Mouse(desk), desk.store.document

    deed(mouse)
    after, called = desk.store.document, desk.state().undo_name
    desk.undo(mouse.now)
    undone = desk.store.document
    desk.redo(mouse.now)

    assert not same_content(after, before)
    assert called
    assert same_content(undone, before)
    assert same_content(desk.store.document, after)
    assert encode_document(undone).text == encode_document(before).text
    assert encode_document(desk.store.document).text == encode_document(after).text


def test_all_that_can_be_done_one_after_the_other_is_undone_step_by_step_and_redone() -> None:
    desk = desk_of(furnished())
    mouse, history = Mouse(desk), [desk.store.document]
    for deed in itertools.chain(DEEDS["drag"].values(), DEEDS["answer"].values(), [recorded, moved_line]):
        deed(mouse)
        mouse.wait(1.5)
        history.append(desk.store.document)

    for former in reversed(history[:-1]):
        desk.undo(mouse.now)
        assert same_content(desk.store.document, former)
    for later in history[1:]:
        desk.redo(mouse.now)
        assert same_content(desk.store.document, later)


def test_undo_and_redo_have_buttons_in_every_tab_and_keys(furnished_tab: FakeClient) -> None:
    tab, before = furnished_tab, furnished_tab.value("Skill")
    inside = {uuid for e in tab.gui if e.kind == "TabGroup" for uuid in e.props["_tab_container_ids"]}
    (undo,) = [e for e in tab.gui if e.kind == "Button" and e.label.startswith("Undo")]
    assert inside
    assert undo.container not in inside
    tab.set_gui("Skill", "Another name")
    tab.wait(lambda c: any(e.label == "Undo: rename the skill" and e.usable for e in c.gui))

    tab.trigger("Undo")
    tab.wait(lambda c: c.value("Skill") == before)
    tab.trigger("Redo (as Windows has it)")

    tab.wait(lambda c: c.value("Skill") == "Another name")


def test_an_edit_error_leaves_nothing_to_undo() -> None:
    desk: Desk = desk_of(furnished())

    with pytest.raises(edits.EditError):
        desk.edit(lambda d: edits.set_stations(d, 3), "change the slices", now=1.0)

    assert desk.state().undo_name is None
