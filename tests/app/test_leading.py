"""The hand led by buttons, numbers and rings: moved, turned, recorded, and freed where it is stuck."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app import turning
from app.arm import HERE, Jaco
from app.arm.shapes import Box
from app.desk import Desk
from app.document import Document, FloatArray
from app.edits import EditError
from app.handpull import LONGEST_REST
from app.inquiry import Inquiry
from app.servo import FASTEST
from tests.app.makers import TICK, Mouse, taught

WAY = np.array([0.10, 0.06, 0.08])
TILTED = np.radians([20.0, -10.0, 30.0])
STUCK_JOINTS = np.array([1.463, 5.463, 0.895, -0.022, 3.363, -0.984])
OPPOSITE = np.array([0.068, -0.91, 0.05])
"""Reached by other postures than the one the arm is stuck in."""


@pytest.fixture(scope="module")
def jaco() -> Iterator[Jaco]:
    arm = Jaco()
    yield arm
    arm.close()


def at_rest(jaco: Jaco, document: Document | None = None) -> tuple[Desk, Mouse]:
    desk = Desk(taught() if document is None else document, jaco)
    desk.stage.pause()
    desk.state()
    return desk, Mouse(desk)


def put(desk: Desk, jaco: Jaco, joints: FloatArray) -> None:
    """Let the arm stand like this."""
    hand = replace(desk.stage.hand, joints=joints, position=jaco.tool_pose(joints)[:3, 3])
    desk.stage.driver.pulled(hand)


def answer(desk: Desk, jaco: Jaco, mouse: Mouse) -> Inquiry | None:
    """Do what the worker does."""
    inquiry = desk.leading.inquiry
    if inquiry is not None:
        desk.leading.answered(inquiry, inquiry.answer(jaco), mouse.now)
    return inquiry


def hold_towards(desk: Desk, jaco: Jaco, mouse: Mouse, target: FloatArray) -> None:
    """Pull the hand to a place and hold it there until the reason is known."""
    begin = mouse.place("/hand")
    mouse.press("/hand")
    for _ in range(20):
        mouse.move((target - begin) / 20)
    for _ in range(40):
        mouse.wait(TICK)
        answer(desk, jaco, mouse)


def off_by(desk: Desk, angles: FloatArray) -> float:
    """How far the tool is from roll, pitch and yaw [rad]."""
    return turning.apart(desk.state().hand.turned, turning.from_angles(angles))


# --- angles --------------------------------------------------------------------------------------


@given(st.tuples(*[st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1)]))
def test_angles_say_how_the_tool_is_turned(angles: tuple[float, float, float]) -> None:
    given_angles = np.array(angles)

    np.testing.assert_allclose(turning.angles_of(turning.from_angles(given_angles)), given_angles, atol=1e-6)


@given(st.floats(-3.1, 3.1), st.floats(-3.1, 3.1))
def test_flat_tools_have_angles_too(roll: float, yaw: float) -> None:
    flat = turning.from_angles(np.array([roll, np.pi / 2, yaw]))

    assert turning.apart(turning.from_angles(turning.angles_of(flat)), flat) < 1e-5


@pytest.mark.parametrize("bad", [(0.0, 0.0, 0.0, 0.0), (1.0, np.nan, 0.0, 0.0), (1.0, 0.0), "up", None])
def test_what_is_no_turn_is_refused_in_words(bad: object) -> None:
    with pytest.raises(EditError, match="no turn"):
        turning.checked(bad)


# --- turning -------------------------------------------------------------------------------------


def test_the_tool_is_turned_by_the_servo_and_the_hand_stays(jaco: Jaco) -> None:
    desk, mouse = at_rest(jaco)
    place, joints = mouse.place("/hand"), [desk.state().hand.joints]
    desk.leading.turn(turning.from_angles(TILTED), mouse.now)
    for _ in range(75):
        mouse.wait(TICK)
        joints.append(desk.state().hand.joints)

    assert np.abs(np.diff(joints, axis=0)).max() <= FASTEST * TICK + 1e-9
    assert off_by(desk, TILTED) < np.radians(1.5)
    assert np.linalg.norm(mouse.place("/hand") - place) < 0.002
    assert desk.tick(mouse.now, TICK) is False


def test_a_turn_that_cannot_be_says_why_and_leaves_the_tool_as_it_came(jaco: Jaco) -> None:
    desk, mouse = at_rest(jaco)
    desk.leading.turn(turning.from_angles(np.array([np.pi, 0.0, 0.0])), mouse.now)
    mouse.wait(8.0)
    state = desk.state()

    assert state.warning
    assert "cannot be turned any farther: " in state.message
    assert state.view.tool is not None
    assert turning.apart(state.view.tool, state.hand.turned) < np.radians(5.0)


def test_presses_turn_the_tool_about_its_own_axes_and_add_up(jaco: Jaco) -> None:
    desk, mouse = at_rest(jaco)
    begin, ten_degrees = desk.state().hand.turned, np.array([0.0, 0.0, np.radians(10.0)])
    desk.leading.nudge_turn(ten_degrees, mouse.now)
    desk.leading.nudge_turn(ten_degrees, mouse.now)
    mouse.wait(2.0)

    assert turning.apart(desk.state().hand.turned, turning.turned(begin, 2.0 * ten_degrees)) < 0.02


def test_a_held_tool_keeps_its_turn_while_the_hand_is_pulled(jaco: Jaco) -> None:
    desk, mouse = at_rest(jaco)
    desk.leading.turn(turning.from_angles(TILTED), mouse.now)
    mouse.wait(3.0)
    mouse.pull("/hand", tuple(WAY), aside=True)

    assert off_by(desk, TILTED) < np.radians(2.0)


def test_only_demonstrations_with_a_held_tool_keep_orientations(jaco: Jaco) -> None:
    desk, mouse = at_rest(jaco)
    mouse.pull("/hand", tuple(1.4 * WAY))
    mouse.wait(2.0)
    desk.leading.hold(True)
    mouse.pull("/hand", tuple(1.4 * WAY))
    free, held = (shown.demonstration for shown in desk.store.document.demonstrations[-2:])

    assert free.orientations is None
    assert held.orientations is not None
    assert held.orientations.shape == (len(held.times), 4)
    assert "The tool was held in 1 of 5" in desk.message


def test_runs_hold_the_tool_once_all_were_shown_so(jaco: Jaco) -> None:
    desk, mouse = at_rest(jaco, Document("empty"))
    desk.leading.hold(True)
    for side in (0.0, 0.01, 0.02):
        mouse.pull("/hand", tuple(np.add(WAY, (side, 0.0, 0.0))))
        mouse.wait(2.0)
    run = desk.state().model.runs[0].reproduction

    assert run.orientations is not None
    path = jaco.follow(run.positions, orientations=run.orientations)
    assert path.turns is not None
    assert path.turns.max() < np.radians(3.0)


def test_a_held_tool_is_played_as_it_was_shown_not_as_it_is_held(jaco: Jaco) -> None:
    desk, _ = at_rest(jaco)
    desk.leading.hold(True)

    assert desk.stage.arm.conditions.orientation is not None
    assert desk.stage.playing_conditions.orientation is None


# --- moving and recording ------------------------------------------------------------------------


def test_presses_move_the_hand_on_from_where_it_is_going(desk: Desk, mouse: Mouse) -> None:
    begin = mouse.place("/hand")
    for _ in range(3):
        desk.leading.nudge(np.array([0.0, 0.0, 0.01]), mouse.now)
    mouse.wait(1.0)

    np.testing.assert_allclose(mouse.place("/hand") - begin, [0.0, 0.0, 0.03], atol=0.002)


def test_the_fields_show_where_the_hand_is_going_until_it_is_there(desk: Desk, mouse: Mouse) -> None:
    there = mouse.place("/hand") + WAY
    desk.leading.move(there, mouse.now)
    mouse.wait(TICK)

    np.testing.assert_allclose(desk.state().hand.aim, there)
    mouse.wait(3.0)
    assert desk.state().hand.aim is None


def test_a_motion_is_shown_by_buttons_without_the_waiting_between_them(desk: Desk, mouse: Mouse) -> None:
    begin = mouse.place("/hand")
    desk.leading.record(mouse.now)
    for _ in range(5):
        desk.leading.nudge(np.array([0.02, 0.0, 0.0]), mouse.now)
        mouse.wait(4.0)
    desk.leading.record(mouse.now)
    kept = desk.store.document.demonstrations[-1].demonstration

    np.testing.assert_allclose(kept.positions[-1] - begin, [0.1, 0.0, 0.0], atol=0.002)
    still = np.linalg.norm(np.diff(kept.positions, axis=0), axis=1) < 1e-5
    longest = max(len(part) for part in "".join("s" if one else " " for one in still).split())
    assert longest <= LONGEST_REST + 1
    np.testing.assert_allclose(kept.times, 0.01 * np.arange(len(kept.times)), atol=1e-9)


def test_waiting_while_recording_by_buttons_draws_nothing_new(desk: Desk, mouse: Mouse) -> None:
    desk.leading.record(mouse.now)
    desk.leading.nudge(np.array([0.05, 0.0, 0.0]), mouse.now)
    mouse.wait(3.0)
    before = desk.state()
    mouse.wait(1.0)

    assert desk.state().hand is before.hand
    assert desk.state().model is before.model


def test_grabbing_the_hand_ends_what_buttons_do(desk: Desk, mouse: Mouse) -> None:
    desk.leading.move(mouse.place("/hand") + WAY, mouse.now)
    mouse.wait(2 * TICK)
    at = mouse.place("/hand")
    mouse.pull("/hand", (0.0, 0.0, 0.1))

    np.testing.assert_array_equal(desk.store.document.demonstrations[-1].demonstration.positions[0], at)


# --- reasons, and another posture ----------------------------------------------------------------


def test_what_stands_in_the_way_is_named_while_the_hand_is_pulled(jaco: Jaco) -> None:
    box = Box("the box", (0.25, -0.5, 0.2), (0.12, 0.12, 0.4))
    desk, mouse = at_rest(jaco, replace(taught(), things=(box,)))
    hold_towards(desk, jaco, mouse, np.array([0.25, -0.5, 0.25]))
    state = desk.state()

    assert state.dragging == "/hand"
    assert state.message == "The arm cannot follow: the box is in the way."
    assert state.hand.wanted is not None


def test_a_hand_that_only_the_held_tool_keeps_away_is_told_so(jaco: Jaco) -> None:
    desk, mouse = at_rest(jaco)
    desk.leading.hold(True)
    hold_towards(desk, jaco, mouse, np.array([0.0, -0.3, 1.1]))

    assert "the tool is held: let it turn freely" in desk.state().message


def test_while_the_hand_is_there_nothing_is_asked(jaco: Jaco) -> None:
    desk, mouse = at_rest(jaco)
    mouse.press("/hand")
    for _ in range(10):
        mouse.move(WAY / 10)
        assert desk.leading.inquiry is None


def stuck(jaco: Jaco) -> tuple[Desk, Mouse]:
    desk, mouse = at_rest(jaco)
    put(desk, jaco, STUCK_JOINTS)
    hold_towards(desk, jaco, mouse, OPPOSITE)
    return desk, mouse


def test_a_stuck_hand_says_what_stops_it_and_offers_another_posture(jaco: Jaco) -> None:
    state = stuck(jaco)[0].state()

    assert state.stuck
    assert "stuck here (joint 2 at its limit)" in state.message


def test_repositioning_brings_the_hand_there_and_is_not_recorded(jaco: Jaco) -> None:
    desk, mouse = stuck(jaco)
    desk.leading.reposition(mouse.now)
    answer(desk, jaco, mouse)
    kept, joints = desk.store.document.demonstrations[-1].demonstration, [desk.state().hand.joints]
    for _ in range(150):
        mouse.wait(TICK)
        joints.append(desk.state().hand.joints)

    assert np.linalg.norm(mouse.place("/hand") - OPPOSITE) < HERE
    assert np.abs(np.diff(joints, axis=0)).max() <= FASTEST * (TICK + 0.01)
    assert desk.store.document.demonstrations[-1].demonstration is kept
    assert np.linalg.norm(kept.positions[-1] - OPPOSITE) > 0.1
    assert not desk.state().stuck


def test_after_the_release_the_arm_can_still_be_repositioned(jaco: Jaco) -> None:
    desk, mouse = stuck(jaco)
    mouse.release()
    mouse.wait(3.0)
    offered = desk.state().stuck
    desk.leading.reposition(mouse.now)
    answer(desk, jaco, mouse)
    mouse.wait(6.0)

    assert offered
    assert np.linalg.norm(mouse.place("/hand") - OPPOSITE) < HERE


def test_a_way_that_is_found_after_play_was_pressed_is_not_gone(jaco: Jaco) -> None:
    desk, mouse = stuck(jaco)
    desk.leading.reposition(mouse.now)
    desk.play(True, mouse.now)
    mouse.wait(TICK)
    answer(desk, jaco, mouse)
    mouse.wait(6.0)

    assert desk.stage.playback.playing
    assert np.linalg.norm(mouse.place("/hand") - OPPOSITE) > 0.1


def test_an_arm_that_is_not_stuck_is_not_repositioned(desk: Desk, mouse: Mouse) -> None:
    desk.leading.reposition(mouse.now)

    assert desk.leading.inquiry is None
    assert "not stuck" in desk.message


def test_the_released_hand_goes_back_round_what_stands_between(jaco: Jaco) -> None:
    pillar = Box("a pillar", (0.0, -0.5, 0.25), (0.08, 0.2, 0.5))
    desk, mouse = at_rest(jaco, Document("empty", things=(pillar,)))
    ends = jaco.follow(np.linspace([0.3, -0.5, 0.25], [-0.3, -0.45, 0.3], 100)).joints[[0, -1]]
    arm = jaco.under(desk.stage.playing_conditions)
    put(desk, jaco, ends[0])
    desk.stage.driver.released(desk.stage.hand, ends[1], mouse.now)
    passed = []
    for _ in range(200):
        mouse.wait(TICK)
        passed.append(desk.state().hand.joints)

    assert arm.clearance(np.linspace(*ends, 60)).obstacles.min() < 0.0
    assert arm.clearance(np.array(passed)).obstacles.min() > 0.0
    np.testing.assert_allclose(passed[-1], ends[1])
