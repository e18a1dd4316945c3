"""The pulled hand: exact ticks, the same motion however the calls are cut, no stop-and-go."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.arm import Arm, ArmInputError, FloatArray, Jaco, PlanarArm
from app.servo import ARRIVED, SETTLE_TIME, Motion, Servo, advance, begin, return_home, settle

NONE = np.empty((0, 4))
RAISED = np.array([0.0, 0.0, 0.02])
cheap = settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


def tip(arm: Arm, joints: FloatArray) -> FloatArray:
    return arm.tool_pose(joints)[:3, 3]


def straight(arm: Arm, times: FloatArray, velocity: tuple[float, float, float]) -> FloatArray:
    """Events (E, 4) of a pointer that leaves the hand at the first time with one velocity [m/s]."""
    return np.column_stack([times, tip(arm, arm.home) + (times - times[0])[:, None] * np.array(velocity)])


def speeds(motion: Motion) -> FloatArray:
    return np.linalg.norm(np.diff(motion.positions, axis=0), axis=1) / np.diff(motion.times)


def chunked(servo: Servo, arm: Arm, events: FloatArray, ends: list[float]) -> Motion:
    """Advance in pieces, each told of what arrived by its end."""
    parts: list[Motion] = []
    last = -math.inf
    for end in ends:
        now = events[(events[:, 0] > last) & (events[:, 0] <= end)]
        servo, motion = advance(servo, arm, now, end)
        parts.append(motion)
        last = end
    return Motion(*(np.concatenate(columns) for columns in zip(*map(columns_of, parts), strict=True)))


def columns_of(motion: Motion) -> tuple[FloatArray, FloatArray, FloatArray]:
    return motion.times, motion.joints, motion.positions


@cheap
@given(start=st.floats(0.0, 1000.0), lasts=st.floats(0.0, 0.5))
def test_ticks_are_exact_multiples_of_ten_milliseconds(start: float, lasts: float) -> None:
    arm = PlanarArm()
    servo, motion = advance(begin(arm, arm.home, start), arm, NONE, start + lasts)

    np.testing.assert_array_equal(motion.times, np.round(motion.times * 100) / 100)
    np.testing.assert_allclose(np.diff(motion.times), 0.01, atol=1e-9)
    assert start + lasts - 0.01 - 1e-9 < servo.time <= start + lasts


@cheap
@given(
    cuts=st.lists(st.floats(1.0, 2.0), max_size=12),
    gaps=st.lists(st.floats(0.0, 0.3), min_size=1, max_size=12),
    seed=st.integers(0, 1000),
)
def test_the_motion_does_not_depend_on_how_the_calls_are_cut(
    cuts: list[float], gaps: list[float], seed: int
) -> None:
    arm = PlanarArm()
    times = 1.0 + np.cumsum(gaps)
    offsets = np.random.default_rng(seed).uniform(-0.1, 0.1, (len(times), 3))
    events = np.column_stack([times, tip(arm, arm.home) + offsets])
    servo = begin(arm, arm.home, 1.0)
    whole = advance(servo, arm, events, 2.5)[1]
    pieces = chunked(servo, arm, events, [*sorted(cuts), 2.5])

    np.testing.assert_array_equal(pieces.times, whole.times)
    np.testing.assert_array_equal(pieces.joints, whole.joints)
    np.testing.assert_array_equal(pieces.positions, whole.positions)


def test_a_jaco_s_motion_does_not_depend_on_how_the_calls_are_cut(jaco: Jaco) -> None:
    events = straight(jaco, np.arange(1.0, 1.8, 0.05), (0.2, 0.1, 0.15))
    servo = begin(jaco, jaco.home, 1.0)
    whole = advance(servo, jaco, events, 2.0)[1]
    pieces = chunked(servo, jaco, events, [1.004, 1.05, 1.0501, 1.333, 1.5, 2.0])

    np.testing.assert_array_equal(pieces.joints, whole.joints)


@pytest.mark.parametrize("velocity", [(0.1, 0.0, 0.0), (0.2, 0.1, 0.15), (0.0, 0.02, 0.0)])
def test_a_steady_pointer_makes_a_steady_hand(arm: Arm, velocity: tuple[float, float, float]) -> None:
    events = straight(arm, 1.0 + 0.05 * np.arange(30), velocity)
    _, motion = advance(begin(arm, arm.home, 1.0), arm, events, events[-1, 0])
    recorded = speeds(motion)[12:] / np.linalg.norm(velocity)

    assert 0.89 < recorded.min() <= recorded.max() < 1.02
    np.testing.assert_allclose(recorded[18:], 1.0, atol=0.01)


@cheap
@given(seed=st.integers(0, 10_000))
def test_an_unsteady_network_does_not_make_the_hand_stop_and_go(seed: int) -> None:
    arm = PlanarArm()
    late = np.random.default_rng(seed).uniform(-0.01, 0.01, 40)
    events = straight(arm, 1.0 + 0.05 * np.arange(40) + late, (0.2, 0.1, 0.1))
    _, motion = advance(begin(arm, arm.home, events[0, 0]), arm, events, events[-1, 0])
    recorded = speeds(motion)[30:] / np.linalg.norm((0.2, 0.1, 0.1))

    assert np.mean(recorded < 0.89) < 0.02
    assert recorded.max() < 1.15


def test_the_hand_is_one_event_and_little_more_behind(arm: Arm) -> None:
    velocity = np.array([0.2, 0.0, 0.0])
    events = straight(arm, 1.0 + 0.05 * np.arange(30), (0.2, 0.0, 0.0))
    _, motion = advance(begin(arm, arm.home, 1.0), arm, events, events[-1, 0])
    behind = np.linalg.norm(events[-1, 1:] - motion.positions[-1]) / np.linalg.norm(velocity)

    assert 0.04 < behind < 0.075


def test_after_a_pause_the_hand_does_not_dawdle(arm: Arm) -> None:
    begins, pause = tip(arm, arm.home), 3.0
    events = np.array([[1.0, *begins], [1.0 + pause, *(begins + RAISED)]])
    _, motion = advance(begin(arm, arm.home, 1.0), arm, events, 1.0 + pause + 0.1)

    np.testing.assert_allclose(motion.positions[motion.times < 4.0], begins[None].repeat(299, 0), atol=1e-3)
    np.testing.assert_allclose(motion.positions[-1], events[-1, 1:], atol=ARRIVED)


def test_nothing_moves_before_the_pointer_does(arm: Arm) -> None:
    _, motion = advance(begin(arm, arm.home, 1.0), arm, NONE, 1.3)

    assert len(motion.times) == 30
    np.testing.assert_allclose(motion.positions, tip(arm, arm.home)[None].repeat(30, 0), atol=1e-3)


def test_settling_brings_the_hand_to_the_last_target(arm: Arm) -> None:
    events = straight(arm, 1.0 + 0.05 * np.arange(10), (0.3, 0.1, 0.1))
    servo, _ = advance(begin(arm, arm.home, 1.0), arm, events, events[-1, 0])
    servo, motion = settle(servo, arm)

    assert np.linalg.norm(motion.positions[-1] - events[-1, 1:]) <= ARRIVED
    assert 0.0 < motion.times[-1] - events[-1, 0] < 0.15


def test_settling_waits_for_events_that_are_still_on_their_way(arm: Arm) -> None:
    events = straight(arm, 1.0 + 0.05 * np.arange(10), (0.2, 0.0, 0.0))
    servo, _ = advance(begin(arm, arm.home, 1.0), arm, events, 1.25)
    _, motion = settle(servo, arm)

    assert np.linalg.norm(motion.positions[-1] - events[-1, 1:]) <= ARRIVED


def test_settling_gives_up_where_the_hand_cannot_go(arm: Arm) -> None:
    events = straight(arm, 1.0 + 0.05 * np.arange(20), (0.0, -3.0, 0.0))
    servo, _ = advance(begin(arm, arm.home, 1.0), arm, events, events[-1, 0])
    _, motion = settle(servo, arm)

    assert len(motion.times) <= round(SETTLE_TIME * 100)


def test_a_settled_hand_needs_no_more_ticks(arm: Arm) -> None:
    _, motion = settle(begin(arm, arm.home, 1.0), arm)
    servo, _ = advance(begin(arm, arm.home, 1.0), arm, NONE, 2.0)
    again = settle(servo, arm)[1]

    assert len(motion.times) <= 2
    assert again.joints.shape == (0, len(arm.home))
    assert again.positions.shape == (0, 3)


def test_two_events_at_one_time_are_the_later_one(arm: Arm) -> None:
    begins = tip(arm, arm.home)
    events = np.array([[1.0, *begins], [1.05, *begins], [1.05, *(begins + RAISED)]])
    _, motion = advance(begin(arm, arm.home, 1.0), arm, events, 1.4)

    np.testing.assert_allclose(motion.positions[-1], events[-1, 1:], atol=ARRIVED)


@pytest.mark.parametrize("column", [0, 2])
def test_a_target_that_is_no_number_is_refused(column: int) -> None:
    arm = PlanarArm()
    event = np.array([[1.0, 0.3, 0.3, 0.3]])
    event[0, column] = math.nan

    with pytest.raises(ArmInputError, match="finite"):
        advance(begin(arm, arm.home, 1.0), arm, event, 1.5)


def test_a_servo_is_not_changed_by_being_advanced() -> None:
    arm = PlanarArm()
    servo = begin(arm, arm.home, 1.0)
    events = straight(arm, 1.0 + 0.05 * np.arange(10), (0.3, 0.1, 0.1))
    first = advance(servo, arm, events, 1.5)[1]

    np.testing.assert_array_equal(advance(servo, arm, events, 1.5)[1].joints, first.joints)


def test_the_return_ends_exactly_at_the_goal(arm: Arm) -> None:
    goal = arm.home + 0.3
    motion = return_home(arm, arm.home, goal)

    np.testing.assert_array_equal(motion.joints[-1], goal)
    assert motion.times[-1] == 1.0


def test_the_return_starts_and_ends_gently(arm: Arm) -> None:
    goal = arm.home + 0.3
    steps = np.abs(np.diff(np.vstack([arm.home, return_home(arm, arm.home, goal).joints]), axis=0)).max(
        axis=1
    )

    assert max(steps[0], steps[-1]) < 0.01 * steps.max()
    assert steps.max() < 2.0 * 0.3 / 100


def test_the_return_never_leaves_the_way_between_the_postures(arm: Arm) -> None:
    share = (return_home(arm, arm.home, arm.home + 0.3).joints - arm.home) / 0.3

    assert np.all(np.diff(share, axis=0) >= -1e-12)
    np.testing.assert_allclose(share, share[:, :1].repeat(len(arm.home), axis=1), atol=1e-9)
