"""Timing a joint path: within limits at 1 kHz, the same path, no slower than need be."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arm import ArmInputError, FloatArray, Jaco, timing
from app.arm.timing import RATE, TimedPath, retime, too_fast

SPEEDS = np.array([0.6, 0.6, 0.8])
ACCELERATIONS = np.array([1.5, 1.0, 2.0])
few = settings(max_examples=15, deadline=None)


def wavy(seed: int, n_samples: int = 200) -> FloatArray:
    """A smooth joint path (K, 3) of three waves with random amplitudes [rad]."""
    rng = np.random.default_rng(seed)
    share = np.linspace(0.0, 1.0, n_samples)[:, None]
    waves = (rng.normal(size=3) * np.sin(math.pi * k * share + rng.uniform(0, 6, 3)) / k for k in (1, 2, 3))
    return sum(waves, np.zeros((n_samples, 3)))


def at_a_thousand(timed: TimedPath) -> tuple[FloatArray, FloatArray]:
    """Largest speed and acceleration of each joint, by differences at 1 kHz."""
    joints = timed.at(np.arange(0.0, timed.duration + 1.0 / RATE, 1.0 / RATE))
    speeds = np.abs(np.diff(joints, axis=0)).max(axis=0) * RATE
    return speeds, np.abs(np.diff(joints, n=2, axis=0)).max(axis=0) * RATE**2


@pytest.fixture(params=["toppra", "own passes"])
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each way to find the speeds in turn."""
    if request.param == "toppra":
        pytest.importorskip("toppra", reason="toppra has no wheel for this platform")
    else:
        monkeypatch.setattr(timing, "find_spec", lambda _: None)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.usefixtures("way")
def test_no_joint_is_faster_or_accelerates_more_than_allowed(seed: int) -> None:
    speeds, accelerations = at_a_thousand(retime(wavy(seed), SPEEDS, ACCELERATIONS))

    assert np.all(speeds <= SPEEDS * (1.0 + 1e-9))
    assert np.all(accelerations <= ACCELERATIONS * (1.0 + 1e-6))


@pytest.mark.usefixtures("way")
def test_some_limit_is_nearly_used_up() -> None:
    assert too_fast(retime(wavy(1), SPEEDS, ACCELERATIONS), SPEEDS, ACCELERATIONS) > 0.95


@few
@given(seed=st.integers(0, 1000))
def test_the_path_stays_where_it_was(seed: int) -> None:
    path = wavy(seed)
    timed = retime(path, SPEEDS, ACCELERATIONS)

    assert np.sqrt(np.mean((timed.at(timed.times) - path) ** 2)) < 1e-3
    assert np.all(np.diff(timed.times) >= 0.0)


def test_it_begins_and_ends_at_rest() -> None:
    timed = retime(wavy(3), SPEEDS, ACCELERATIONS)
    ends = np.abs(np.diff(timed.at([0.0, 1e-3, timed.duration - 1e-3, timed.duration]), axis=0))

    assert max(ends[0].max(), ends[2].max()) < 1e-5


@pytest.mark.usefixtures("way")
def test_twice_the_speed_and_four_times_the_acceleration_take_half_the_time() -> None:
    slow, fast = retime(wavy(2), SPEEDS, ACCELERATIONS), retime(wavy(2), 2 * SPEEDS, 4 * ACCELERATIONS)

    assert fast.duration == pytest.approx(slow.duration / 2, rel=0.01)


def test_a_straight_line_takes_the_time_of_the_textbook() -> None:
    line = np.linspace(0.0, 1.0, 100)[:, None] * np.array([[1.0, 0.0, 0.0]])
    by_hand = 1.0 / SPEEDS[0] + SPEEDS[0] / ACCELERATIONS[0]

    assert retime(line, SPEEDS, ACCELERATIONS).duration == pytest.approx(by_hand, rel=0.01)


def test_waits_take_no_time() -> None:
    path = wavy(4)
    waiting = np.concatenate([path[:80], np.repeat(path[80:81], 50, axis=0), path[80:]])

    assert retime(waiting, SPEEDS, ACCELERATIONS).duration == pytest.approx(
        retime(path, SPEEDS, ACCELERATIONS).duration, rel=0.02
    )


@pytest.mark.parametrize("n_samples", [1, 2, 3, 4])
def test_few_samples_are_a_path(n_samples: int) -> None:
    path = wavy(5, n_samples)
    timed = retime(path, SPEEDS, ACCELERATIONS)

    assert timed.times.shape == (n_samples,)
    np.testing.assert_allclose(timed.at([0.0, timed.duration]), path[[0, -1]], atol=2e-3)


def test_an_arm_that_stands_still_takes_no_time() -> None:
    timed = retime(np.zeros((50, 3)), SPEEDS, ACCELERATIONS)

    assert timed.duration <= 1.0 / RATE
    np.testing.assert_array_equal(timed.at([0.0, 5.0]), np.zeros((2, 3)))


@pytest.mark.parametrize("bad", [np.zeros(3), np.empty((0, 3)), np.full((4, 3), np.nan)])
def test_what_is_no_path_is_refused(bad: FloatArray) -> None:
    with pytest.raises(ArmInputError, match="path to time"):
        retime(bad, SPEEDS, ACCELERATIONS)


def test_a_jaco_s_timed_path_leads_its_tool_along_the_wanted_one(jaco: Jaco) -> None:
    share = np.linspace(0.0, 1.0, 250)[:, None]
    positions = np.array([0.3, -0.4, 0.3]) + share * [-0.6, 0.0, 0.0] + np.sin(3 * share) * [0.0, -0.15, 0.1]
    path = jaco.follow(positions)
    timed = retime(path.joints, jaco.velocity_limits, jaco.acceleration_limits)
    tips = np.array([jaco.tool_pose(joints)[:3, 3] for joints in timed.at(timed.times)])

    assert np.linalg.norm(tips - positions, axis=1).max() < 2e-3
    assert too_fast(timed, jaco.velocity_limits, jaco.acceleration_limits) <= 1.0
