"""A person at work, without a browser: pulls, undo, playback, files."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app import edits, gesture
from app.actions import Drag
from app.desk import Desk
from app.document import Document, Place
from app.files import inspect_bytes
from app.player import REST
from gc_core import same_content
from tests.app.makers import FIRST_START, Mouse, desk_of, planned, taught

BY = (0.04, -0.03, 0.05)
THINGS = ("/start/0", "/landmarks/goal", "/landmarks/start", "/demonstrations/1", "/reproductions/0")
RECORDING = b"t,x,y,z\n0,0.3,0.2,0.4\n1,0.4,0.1,0.3\n2,0.5,-0.1,0.2\n"


@pytest.mark.parametrize("node", [*THINGS, "/hand"])
def test_a_pull_is_one_step_and_undo_restores_the_former_document(
    node: str, desk: Desk, mouse: Mouse
) -> None:
    before = desk.store.document

    mouse.pull(node, BY)
    after = desk.store.document
    desk.undo(mouse.now)

    assert not same_content(after, before)
    assert desk.store.document is before
    assert desk.store.undo_name is None


@pytest.mark.parametrize("node", [*THINGS, "/hand"])
def test_redo_brings_the_pulled_document_back(node: str, desk: Desk, mouse: Mouse) -> None:
    mouse.pull(node, BY)
    after = desk.store.document

    desk.undo(mouse.now)
    desk.redo(mouse.now)

    assert desk.store.document is after


@pytest.mark.parametrize("node", [*THINGS, "/hand"])
def test_while_a_pull_lasts_it_is_shown_but_not_stored(node: str, desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document

    mouse.press(node)
    for _ in range(6):
        mouse.move(np.array(BY) / 6)
    state = desk.state()

    assert desk.store.document is before
    assert not same_content(state.document, before)
    assert (state.model.source, state.dragging) == (state.document, node)


@pytest.mark.parametrize("node", THINGS)
def test_what_is_let_go_is_what_was_shown(node: str, desk: Desk, mouse: Mouse) -> None:
    mouse.press(node)
    mouse.move(BY)
    shown = desk.state().document
    mouse.release()
    mouse.wait(0.2)

    assert same_content(desk.state().document, shown)


@pytest.mark.parametrize("node", THINGS)
def test_a_slip_of_the_hand_changes_nothing(node: str, desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document

    mouse.pull(node, (0.0003, 0.0, 0.0), events=1)

    assert desk.store.document is before
    assert desk.state().document is before


@pytest.mark.parametrize("node", THINGS[:3])
def test_a_lost_connection_keeps_what_was_pulled(node: str, desk: Desk, mouse: Mouse) -> None:
    mouse.press(node)
    mouse.move(BY)
    shown = desk.state().document

    desk.let_go(mouse.now)

    assert same_content(desk.store.document, shown)
    assert desk.state().dragging is None


def test_events_of_a_pull_that_was_ended_do_nothing(desk: Desk, mouse: Mouse) -> None:
    mouse.press("/start/0")
    mouse.move(BY)
    desk.let_go(mouse.now)
    kept = desk.store.document

    mouse.move(BY)
    mouse.release()
    mouse.wait(0.3)

    assert desk.store.document is kept


def test_two_parts_within_the_grace_are_one_undo_step(desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document
    mouse.press("/start/0")
    mouse.move((0.04, 0.02, 0.01))
    mouse.release()
    mouse.wait(0.08)
    mouse.press("/start/0", vertical=True)
    mouse.move((0.5, 0.5, 0.03))
    mouse.release()
    mouse.wait(0.2)

    moved = desk.store.document.starts[0] - FIRST_START
    np.testing.assert_allclose(moved, (0.04, 0.02, 0.04), atol=1e-9)
    desk.undo(mouse.now)
    assert desk.store.document is before


def test_two_pulls_further_apart_are_two_undo_steps(desk: Desk, mouse: Mouse) -> None:
    mouse.pull("/start/0", BY)
    between = desk.store.document
    mouse.pull("/start/0", BY)

    desk.undo(mouse.now)

    assert desk.store.document is between


def test_a_late_second_part_is_another_pull_though_nothing_ticked_between(desk: Desk, mouse: Mouse) -> None:
    mouse.press("/start/0")
    mouse.move(BY)
    mouse.release()
    mouse.now += gesture.GRACE + 0.05
    mouse.press("/start/0")

    assert desk.store.undo_name is not None


def test_grabbing_another_thing_within_the_grace_ends_the_first_pull(desk: Desk, mouse: Mouse) -> None:
    mouse.press("/start/0")
    mouse.move(BY)
    mouse.release()
    mouse.press("/landmarks/goal")

    np.testing.assert_allclose(desk.store.document.starts[0] - FIRST_START, BY, atol=1e-9)
    assert desk.state().dragging == "/landmarks/goal"


def test_a_pull_right_after_an_edit_takes_hold_of_what_the_edit_made(desk: Desk, mouse: Mouse) -> None:
    mouse.pull("/demonstrations/1", BY)
    at = mouse.place("/demonstrations/1")
    desk.undo(mouse.now)  # and nothing is drawn before the next grab
    undone = desk.store.document.demonstrations[1].demonstration

    mouse.pull("/demonstrations/1", (0.0, 0.0, 0.02), at=at, events=1)

    after = desk.store.document.demonstrations[1].demonstration
    assert np.max(np.linalg.norm(after.positions - undone.positions, axis=1)) <= 0.02 + 1e-9


def test_what_was_just_demonstrated_can_be_corrected_at_once(desk: Desk, mouse: Mouse) -> None:
    start = mouse.place("/hand")
    mouse.press("/hand")
    for _ in range(6):
        mouse.move((0.0, 0.0, 0.02))
    mouse.release()
    mouse.press("/demonstrations/3", start + np.array([0.0, 0.0, 0.06]))
    kept = desk.store.document.demonstrations[3].demonstration
    mouse.move((0.02, 0.0, 0.0))
    mouse.release()
    mouse.wait(0.2)

    corrected = desk.store.document.demonstrations[3].demonstration
    np.testing.assert_array_equal(corrected.times, kept.times)


def test_a_pull_beyond_all_reach_keeps_the_last_good_place_on_the_screen(desk: Desk, mouse: Mouse) -> None:
    mouse.press("/landmarks/goal")
    mouse.move(BY)
    good = desk.state().document
    mouse.move((50.0, 0.0, 0.0))
    state = desk.state()

    assert state.document is good
    assert state.warning
    assert "between -10 and 10 m" in state.message


def test_a_pull_let_go_beyond_all_reach_changes_nothing_and_says_so(desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document
    mouse.press("/landmarks/goal")
    mouse.move((50.0, 0.0, 0.0))

    desk.let_go(mouse.now)

    state = desk.state()
    assert desk.store.document is before
    assert state.dragging is None
    assert state.warning
    assert "between -10 and 10 m" in state.message


def test_an_event_for_a_thing_that_is_not_there_does_nothing(desk: Desk) -> None:
    before = desk.state()

    for phase in ("start", "update", "end"):
        desk.drag(Drag("/demonstrations/77", phase, FIRST_START, FIRST_START, 1.0))

    assert desk.state().document is before.document
    assert desk.state().dragging is None


def test_an_edit_in_mid_pull_ends_the_pull_first(desk: Desk, mouse: Mouse) -> None:
    mouse.press("/start/0")
    mouse.move(BY)

    desk.edit(lambda d: edits.rename_skill(d, "Pour"), "rename", now=mouse.now)

    assert desk.store.undo_name == "rename"
    desk.undo(mouse.now)
    np.testing.assert_allclose(desk.store.document.starts[0] - FIRST_START, BY, atol=1e-9)


def test_an_echo_is_no_edit(desk: Desk, mouse: Mouse) -> None:
    desk.say("Look here.")

    desk.edit(lambda d: edits.rename_skill(d, d.title), "rename", now=mouse.now)

    assert (desk.store.undo_name, desk.message) == (None, "Look here.")


def test_undo_says_what_was_undone_and_when_there_is_nothing(desk: Desk, mouse: Mouse) -> None:
    mouse.pull("/landmarks/goal", BY)

    desk.undo(mouse.now)
    first = desk.message
    desk.undo(mouse.now)

    assert first == "Undone: move goal."
    assert desk.message == "There is nothing to undo."


# --- playback -----------------------------------------------------------------------


def test_the_first_run_plays_from_the_beginning() -> None:
    playback = desk_of().state().playback

    assert (playback.playing, playback.time, playback.run) == (True, 0.0, 0)
    assert playback.duration > 0.0


def test_nothing_plays_where_nothing_was_taught() -> None:
    desk = desk_of(Document("empty", landmarks=(Place("start"), Place("goal", taught=FIRST_START))))
    mouse = Mouse(desk)

    mouse.wait(0.2)

    assert desk.state().playback.duration == 0.0


def test_while_it_plays_the_arm_follows_the_run(desk: Desk, mouse: Mouse) -> None:
    desk.stage.play(True)
    run = desk.model.runs[0].reproduction
    mouse.wait(1.0)

    state = desk.state()
    here = np.array([np.interp(state.playback.time, run.times, run.positions[:, k]) for k in range(3)])
    assert np.linalg.norm(state.hand.position - here) < 0.03


def test_a_joint_path_leads_the_arm_exactly(desk: Desk, mouse: Mouse) -> None:
    desk.accept_plan(planned(desk))
    desk.stage.seek(1.0)
    mouse.wait(2.0)

    run = desk.model.runs[0].reproduction
    here = np.array([np.interp(1.0, run.times, run.positions[:, k]) for k in range(3)])
    np.testing.assert_allclose(desk.state().hand.position, here, atol=0.002)


def test_a_plan_of_a_former_model_is_not_shown(desk: Desk, mouse: Mouse) -> None:
    desk.accept_plan(planned(desk))
    mouse.pull("/start/0", BY)

    assert desk.state().plan is None


def test_a_run_that_the_arm_cannot_reach_is_said_to_be_out_of_reach() -> None:
    far = replace(taught(), starts=(np.array([2.0, 0.0, 0.5]),))
    desk = desk_of(far)

    desk.accept_plan(planned(desk))

    assert desk.warning
    assert "beyond reach" in desk.message


def test_after_a_start_was_pulled_its_run_plays_from_the_beginning(desk: Desk, mouse: Mouse) -> None:
    desk.edit(lambda d: edits.add_start(d, FIRST_START - 0.03), "add a start", now=mouse.now)
    desk.state()
    mouse.press("/start/1")
    mouse.move(BY)
    pulling = desk.state().playback
    mouse.release()
    mouse.wait(0.16)
    released = desk.state().playback

    assert (pulling.playing, pulling.run, pulling.time) == (False, 1, 0.0)
    assert (released.playing, released.run) == (True, 1)
    assert released.time <= 0.2


def test_playing_to_the_end_with_a_loop_glides_back_to_the_start(desk: Desk, mouse: Mouse) -> None:
    desk.stage.play(True)
    run = desk.model.runs[0].reproduction
    mouse.wait(float(run.times[-1]) + 0.9 * REST)

    at_rest = desk.state()
    assert at_rest.playback.time == at_rest.playback.duration
    assert np.linalg.norm(at_rest.hand.position - run.positions[0]) < 0.02


def test_the_glide_back_never_jumps(desk: Desk, mouse: Mouse) -> None:
    desk.stage.play(True)
    run = desk.model.runs[0].reproduction
    mouse.wait(float(run.times[-1]) - 0.2)
    joints = [desk.state().hand.joints]
    for _ in range(40):
        mouse.wait(0.04)
        joints.append(desk.state().hand.joints)

    assert np.max(np.abs(np.diff(joints, axis=0))) <= 3.0 * 0.04 + 1e-6


def test_without_a_loop_it_stops_at_the_end(desk: Desk, mouse: Mouse) -> None:
    desk.look(loop=False)
    desk.stage.play(True)
    mouse.wait(float(desk.model.runs[0].reproduction.times[-1]) + 0.2)

    state = desk.state()
    assert (state.playback.playing, state.playback.time) == (False, state.playback.duration)


def test_an_arm_at_rest_asks_for_no_more_ticks(desk: Desk, mouse: Mouse) -> None:
    mouse.wait(3.0)

    assert desk.tick(mouse.now + 0.04, 0.04) is False


def test_choosing_another_run_plays_it_from_its_beginning(desk: Desk, mouse: Mouse) -> None:
    desk.edit(lambda d: edits.add_start(d, FIRST_START - 0.03), "add a start", now=mouse.now)
    desk.state()
    desk.stage.seek(1.0)

    desk.choose_run(1, mouse.now)
    desk.choose_run(7, mouse.now)

    assert (desk.stage.playback.run, desk.stage.playback.time) == (1, 0.0)


def test_when_the_played_run_goes_the_playhead_moves_to_one_that_is_left(desk: Desk, mouse: Mouse) -> None:
    desk.edit(lambda d: edits.add_start(d, FIRST_START - 0.03), "add a start", now=mouse.now)
    desk.state()
    desk.choose_run(1, mouse.now)
    desk.undo(mouse.now)

    assert desk.state().playback.run == 0


def test_opening_another_skill_can_be_undone(desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document

    desk.open(taught(2), mouse.now)
    opened = desk.state()
    desk.undo(mouse.now)

    assert len(opened.document.demonstrations) == 2
    assert desk.store.document is before


# --- files --------------------------------------------------------------------------


def test_an_offered_file_changes_nothing_until_it_is_accepted(desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document
    desk.offer_reading(inspect_bytes("mine.csv", RECORDING))
    offered = desk.state()

    assert offered.offer is not None
    assert (offered.offer.name, offered.document) == ("mine.csv", before)
    desk.accept_file("m", offered.offer.frame, mouse.now)
    assert len(desk.store.document.demonstrations) == 4
    assert desk.state().offer is None


def test_a_declined_file_is_forgotten(desk: Desk, mouse: Mouse) -> None:
    desk.offer_reading(inspect_bytes("mine.csv", RECORDING))
    desk.decline_file()
    desk.accept_file("m", "base", mouse.now)

    assert len(desk.store.document.demonstrations) == 3


def test_a_file_next_to_a_built_in_skill_opens_as_a_skill_of_its_own() -> None:
    desk = desk_of(taught(built_in=True))
    desk.offer_reading(inspect_bytes("mine.csv", RECORDING))

    desk.accept_file("m", desk.state().offer.frame, 1.0)

    assert (desk.store.document.title, len(desk.store.document.demonstrations)) == ("mine", 1)


def test_an_accepted_file_can_be_undone(desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document
    desk.offer_reading(inspect_bytes("mine.csv", RECORDING))
    desk.accept_file("m", desk.state().offer.frame, mouse.now)

    desk.undo(mouse.now)

    assert desk.store.document is before


def test_an_accepted_file_is_described_in_the_unit_that_was_chosen(desk: Desk, mouse: Mouse) -> None:
    desk.offer_reading(inspect_bytes("mine.csv", RECORDING))
    assert desk.state().offer.unit == "m"

    desk.accept_file("mm", desk.state().offer.frame, mouse.now)

    assert "read as mm" in desk.state().message
