"""Pulling the hand is recording: what is kept is where the hand really was."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from app.arm import Arm, Jaco, PlanarArm
from app.desk import Desk
from app.document import Document, Place
from app.driver import RETURN
from app.leading import SHORTEST
from tests.app.makers import Mouse, desk_of, taught

WAY = np.array([0.12, 0.06, -0.10])
FAR_AWAY = np.array([1.5, 0.0, 0.3])


@pytest.fixture(scope="module")
def jaco() -> Iterator[Jaco]:
    arm = Jaco()
    yield arm
    arm.close()


@pytest.fixture(params=["planar", "jaco"])
def arm(request: pytest.FixtureRequest) -> Arm:
    return PlanarArm() if request.param == "planar" else request.getfixturevalue("jaco")


def last(desk: Desk):
    return desk.store.document.demonstrations[-1].demonstration


def test_a_demonstration_goes_from_where_the_hand_was_to_where_it_was_let_go(arm: Arm) -> None:
    desk = Desk(taught(), arm)
    mouse = Mouse(desk)
    start = desk.state().hand.position

    mouse.pull("/hand", WAY, events=30)

    np.testing.assert_array_equal(last(desk).positions[0], start)
    assert np.linalg.norm(last(desk).positions[-1] - (start + WAY)) < 0.005


def test_a_demonstration_is_sampled_in_exact_hundredths_of_a_second(arm: Arm) -> None:
    desk = Desk(taught(), arm)
    mouse = Mouse(desk, now=123.456)

    mouse.pull("/hand", WAY)

    times = last(desk).times
    np.testing.assert_allclose(times, 0.01 * np.arange(len(times)), atol=1e-9)


def test_the_hand_keeps_within_the_arms_speed_and_never_jumps(arm: Arm) -> None:
    desk = Desk(taught(), arm)
    mouse = Mouse(desk)

    mouse.pull("/hand", WAY, events=2)

    steps = np.linalg.norm(np.diff(last(desk).positions, axis=0), axis=1)
    assert np.max(steps) < 0.05


def test_a_demonstration_does_not_depend_on_when_the_session_ticks(arm: Arm) -> None:
    recorded = []
    for ticks in (0, 3):
        desk = Desk(taught(), arm)
        mouse = Mouse(desk)
        mouse.press("/hand")
        for _ in range(12):
            for tick in range(ticks):
                desk.tick(mouse.now + 0.015 * (tick + 1), 0.015)
            mouse.move(WAY / 12)
        mouse.release()
        mouse.wait(0.2)
        recorded.append(last(desk).positions)

    np.testing.assert_allclose(recorded[0], recorded[1], atol=1e-9)


def test_too_short_a_pull_is_not_kept_and_says_so(desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document

    mouse.pull("/hand", (0.5 * SHORTEST, 0.0, 0.0))

    assert desk.store.document is before
    assert desk.warning
    assert "not kept" in desk.message


def test_a_kept_demonstration_is_announced(desk: Desk, mouse: Mouse) -> None:
    mouse.pull("/hand", 1.3 * WAY)

    assert not desk.warning
    assert "That was a demonstration" in desk.message


def test_a_demonstration_that_ends_far_from_the_goal_says_how_far(desk: Desk, mouse: Mouse) -> None:
    goal = next(anchor.now for anchor in desk.model.anchors if anchor.kind == "goal")

    mouse.pull("/hand", (0.0, 0.0, 0.2))

    away = float(np.linalg.norm(last(desk).positions[-1] - goal))
    assert away > 0.1
    assert f"{100.0 * away:.0f} cm from the goal" in desk.message


def test_grabbing_the_hand_pauses_the_playback() -> None:
    desk = desk_of()
    mouse = Mouse(desk)
    mouse.wait(0.5)
    mouse.press("/hand")

    assert desk.state().playback.playing is False


def test_after_the_release_the_arm_goes_back_by_itself_and_is_not_recorded(arm: Arm) -> None:
    desk = Desk(taught(), arm)
    desk.stage.pause()
    mouse = Mouse(desk)
    joints = desk.state().hand.joints
    mouse.pull("/hand", WAY)
    kept = last(desk)

    mouse.wait(RETURN + 0.2)

    np.testing.assert_array_equal(desk.state().hand.joints, joints)
    assert last(desk) is kept
    assert desk.tick(mouse.now, 0.04) is False


def test_a_ring_shows_where_the_hand_goes_back_to_until_it_is_there(desk: Desk, mouse: Mouse) -> None:
    start = mouse.place("/hand")
    mouse.press("/hand")
    mouse.move(WAY)
    pulled = desk.state().hand.returns_to
    mouse.release()
    mouse.wait(0.4)
    returning = desk.state().hand.returns_to
    mouse.wait(RETURN)

    np.testing.assert_allclose(pulled, start)
    np.testing.assert_allclose(returning, start)
    assert desk.state().hand.returns_to is None


def test_the_next_demonstration_begins_where_the_last_one_did(desk: Desk, mouse: Mouse) -> None:
    mouse.pull("/hand", WAY)
    mouse.wait(RETURN + 0.2)
    mouse.pull("/hand", WAY)

    first, second = (shown.demonstration for shown in desk.store.document.demonstrations[-2:])
    np.testing.assert_allclose(second.positions[0], first.positions[0], atol=1e-9)


def test_a_pull_aside_moves_the_hand_and_records_nothing(arm: Arm) -> None:
    desk = Desk(taught(), arm)
    mouse, before = Mouse(desk), desk.store.document
    start = desk.state().hand.position

    mouse.pull("/hand", WAY, aside=True)
    mouse.wait(RETURN + 0.2)

    assert desk.store.document is before
    assert np.linalg.norm(desk.state().hand.position - (start + WAY)) < 0.005


def test_the_next_demonstration_begins_where_the_hand_was_put_aside(desk: Desk, mouse: Mouse) -> None:
    mouse.pull("/hand", (0.05, 0.0, 0.05), aside=True)
    aside = desk.state().hand.position

    mouse.pull("/hand", WAY)

    np.testing.assert_array_equal(last(desk).positions[0], aside)


def test_pulling_aside_shows_no_recording(desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document
    mouse.press("/hand", aside=True)
    mouse.move(WAY)
    state = desk.state()

    assert (state.hand.recording, state.hand.returns_to, state.document) == (None, None, before)


def test_a_demonstration_right_after_a_pull_aside_is_recorded(desk: Desk, mouse: Mouse) -> None:
    mouse.press("/hand", aside=True)
    mouse.move((0.03, 0.0, 0.0))
    mouse.release()
    mouse.press("/hand")
    for _ in range(4):
        mouse.move(WAY / 4)
    mouse.release()
    mouse.wait(0.2)

    assert len(desk.store.document.demonstrations) == 4


def test_a_lost_connection_keeps_what_was_drawn(arm: Arm) -> None:
    desk = Desk(taught(), arm)
    mouse = Mouse(desk)
    start = desk.state().hand.position
    mouse.press("/hand")
    for _ in range(12):
        mouse.move(WAY / 12)

    desk.let_go(mouse.now + 2.0)

    np.testing.assert_array_equal(last(desk).positions[0], start)
    assert np.linalg.norm(last(desk).positions[-1] - (start + WAY)) < 0.005


def test_shift_in_mid_pull_is_one_demonstration(desk: Desk, mouse: Mouse) -> None:
    start = mouse.place("/hand")
    mouse.press("/hand")
    for _ in range(6):
        mouse.move((0.01, 0.01, 0.0))
    mouse.release()
    mouse.press("/hand", vertical=True)
    for _ in range(6):
        mouse.move((0.05, 0.05, 0.01))
    mouse.release()
    mouse.wait(0.2)

    assert len(desk.store.document.demonstrations) == 4
    np.testing.assert_allclose(last(desk).positions[-1] - start, (0.06, 0.06, 0.06), atol=0.005)


def test_the_preview_begins_with_what_was_drawn_and_ends_at_the_end_of_the_tube(
    desk: Desk, mouse: Mouse
) -> None:
    cylinder = desk.state().model.cylinder
    mouse.pull("/hand", cylinder.directrix[0] - mouse.place("/hand"), aside=True)
    mouse.press("/hand")
    for station in range(0, 30, 2):
        mouse.move(cylinder.directrix[station + 2] - cylinder.directrix[station])
    state = desk.state()
    preview = state.document.demonstrations[-1].demonstration

    drawn = state.hand.recording
    np.testing.assert_array_equal(preview.positions[: len(drawn)], drawn)
    width = np.max(cylinder.radii[-1])
    assert np.linalg.norm(preview.positions[-1] - cylinder.directrix[-1]) <= width + 1e-6


def test_a_preview_never_runs_backwards_in_time(desk: Desk, mouse: Mouse) -> None:
    mouse.press("/hand")
    for _ in range(20):
        mouse.move((0.01, -0.01, -0.005))
        shown = desk.state().document.demonstrations[-1].demonstration
        assert np.all(np.diff(shown.times) > 0.0)


def test_a_first_demonstration_shows_a_tube_around_the_part_drawn() -> None:
    desk = desk_of(Document("empty", landmarks=(Place("start"), Place("goal", taught=np.zeros(3)))))
    mouse = Mouse(desk)
    mouse.press("/hand")
    for _ in range(10):
        mouse.move((0.01, 0.01, -0.005))
    state = desk.state()

    assert state.model.cylinder is not None
    drawn = state.hand.recording
    assert np.linalg.norm(state.model.cylinder.directrix[-1] - drawn[-1]) < 0.02


def test_what_cannot_be_reached_is_said_shown_and_not_recorded(desk: Desk, mouse: Mouse) -> None:
    start = mouse.place("/hand")
    mouse.press("/hand")
    for _ in range(10):
        mouse.move(FAR_AWAY / 10)
    mouse.wait(0.8)
    state = desk.state()
    mouse.release()
    mouse.wait(0.2)

    assert state.hand.shortfall is not None
    np.testing.assert_allclose(state.hand.wanted, start + FAR_AWAY, atol=1e-9)
    assert state.warning
    assert "cannot follow" in state.message
    assert np.max(np.linalg.norm(last(desk).positions, axis=1)) < 1.2


def test_closing_the_hand_in_mid_pull_is_recorded(desk: Desk, mouse: Mouse) -> None:
    mouse.press("/hand")
    for _ in range(6):
        mouse.move(WAY / 12)
    desk.toggle_gripper()
    for _ in range(6):
        mouse.move(WAY / 12)
    mouse.release()
    mouse.wait(0.2)

    gripper = last(desk).gripper
    assert (gripper[0], gripper[-1]) == (0.0, 1.0)
    assert np.count_nonzero(np.diff(gripper)) == 1


def test_a_hand_moved_by_numbers_arrives_stays_and_records_nothing(arm: Arm) -> None:
    desk = Desk(taught(), arm)
    mouse, before, there = Mouse(desk), desk.store.document, desk.state().hand.position + WAY

    desk.leading.move(there, mouse.now)
    mouse.wait(2.0)

    assert desk.store.document is before
    assert np.linalg.norm(desk.state().hand.position - there) < 0.005
    assert desk.tick(mouse.now, 0.04) is False


def test_an_empty_skill_learns_from_what_is_shown() -> None:
    desk = desk_of(Document("empty", landmarks=(Place("start"), Place("goal", taught=np.zeros(3)))))
    mouse = Mouse(desk)
    for _ in range(3):
        mouse.pull("/hand", WAY)
        mouse.wait(RETURN + 0.2)

    state = desk.state()
    assert len(state.document.demonstrations) == 3
    assert state.model.problem is None
    assert state.model.cylinder is not None


def test_a_hand_that_numbers_cannot_bring_there_says_so(arm: Arm) -> None:
    desk = Desk(taught(), arm)
    mouse = Mouse(desk)

    desk.leading.move(FAR_AWAY, mouse.now)
    mouse.wait(12.0)

    state = desk.state()
    assert state.warning
    assert "reach" in state.message
    assert state.hand.wanted is not None


def test_a_hand_moved_by_numbers_to_where_it_can_be_says_no_warning(arm: Arm) -> None:
    desk = Desk(taught(), arm)
    mouse = Mouse(desk)

    desk.leading.move(desk.state().hand.position + WAY, mouse.now)
    mouse.wait(2.0)

    assert not desk.state().warning


def test_what_is_recorded_of_the_gripper_is_what_is_shown_though_a_run_was_played(
    desk: Desk, mouse: Mouse
) -> None:
    desk.toggle_gripper()
    desk.stage.play(True)
    mouse.wait(1.0)
    mouse.pull("/hand", WAY)

    assert desk.state().view.gripper_closed
    assert set(last(desk).gripper) == {1.0}


def test_a_tug_much_shorter_than_the_motion_is_kept_but_teaches_nothing(desk: Desk, mouse: Mouse) -> None:
    tube, before = desk.model.cylinder, desk.store.document

    mouse.pull("/hand", (0.05, 0.0, 0.0))
    desk.state()
    shown = desk.store.document.demonstrations[-1]
    radii = None if desk.model.cylinder is None else desk.model.cylinder.radii
    said = desk.message
    desk.undo(mouse.now)

    assert shown.muted
    assert "That was only" in said
    assert tube is not None
    np.testing.assert_array_equal(radii, tube.radii)
    assert desk.store.document is before
