"""Pauses are found and cut out, trembles are smoothed, and what was meant stays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from app.document import FloatArray
from app.mending import STILL_REACH, pauses, smoothed, tremble, trimmed
from gc_core import Demonstration, encode
from tests.core.shapes import bundle

few = settings(deadline=None, max_examples=30)
RATE = 50.0


def reach(seconds: float = 4.0) -> FloatArray:
    """A minimum-jerk reach of 60 cm with a bow (T, 3), from where it begins to be seen."""
    u = np.linspace(0.08, 0.92, round(seconds * RATE))
    way = u**3 * (10.0 - 15.0 * u + 6.0 * u**2)
    return np.stack((0.6 * way, 0.1 * np.sin(np.pi * way), 0.3 - 0.2 * way), axis=1)


def recording(path: FloatArray, **more: object) -> Demonstration:
    return Demonstration(np.arange(len(path)) / RATE, path, name="Reach", **more)


def waiting(part: float, seconds: float, trembling: float = 0.0) -> Demonstration:
    """A reach in which the hand waits after a part of the samples."""
    path = reach()
    at = round(part * (len(path) - 1))
    shaken = np.random.default_rng(0).uniform(-1.0, 1.0, (round(seconds * RATE), 3)) * trembling
    return recording(np.concatenate((path[: at + 1], path[at] + shaken, path[at + 1 :])))


def test_a_gap_in_a_recording_is_no_pause() -> None:
    whole = recording(reach())
    later = whole.times + (np.arange(len(whole.times)) > 80)

    assert pauses(replace(whole, times=later)) == ()


@pytest.mark.parametrize("usual", [0.005, 0.01, 0.05, 0.15])
@pytest.mark.parametrize("slow", [0.003, 0.0045])
def test_a_hand_that_creeps_on_is_slow_and_does_not_stand_still(usual: float, slow: float) -> None:
    speeds = np.repeat([usual, slow, usual], round(4.0 * RATE))
    shown = recording(np.outer(np.cumsum(speeds) / RATE, [1.0, 0.0, 0.0]))

    assert pauses(shown) == ()
    assert trimmed(shown) is shown


def test_a_hand_that_sinks_a_little_while_it_waits_stands_still() -> None:
    sunk = np.cumsum(np.full((250, 1), 0.001 / RATE), axis=0) * [0.0, 0.0, -1.0]
    path = reach()
    shown = recording(np.concatenate((path[:100], path[99] + sunk, path[100:] + sunk[-1])))

    assert [pause.seconds > 4.5 for pause in pauses(shown)] == [True]


def test_a_motion_without_a_stop_has_no_pause() -> None:
    shown = recording(reach())

    assert pauses(shown) == ()
    assert trimmed(shown) is shown


@few
@given(part=st.floats(0.15, 0.85), seconds=st.floats(1.0, 4.0), trembling=st.sampled_from((0.0, 0.0005)))
def test_a_pause_is_found_where_it_is(part: float, seconds: float, trembling: float) -> None:
    (pause,) = pauses(waiting(part, seconds, trembling))

    assert pause.where == "middle"
    assert pause.begins == pytest.approx(part * 4.0, abs=0.3)
    assert pause.seconds == pytest.approx(seconds, abs=0.6)


@pytest.mark.parametrize(("part", "where"), [(0.0, "start"), (1.0, "end")])
def test_standing_still_at_an_end_is_said_to_be_there(part: float, where: str) -> None:
    (pause,) = pauses(waiting(part, 2.0))

    assert pause.where == where


@few
@given(part=st.floats(0.0, 1.0), seconds=st.floats(1.0, 4.0), trembling=st.sampled_from((0.0, 0.0005)))
@example(part=0.96875, seconds=1.0, trembling=0.0)
def test_what_is_trimmed_has_no_pause_and_the_same_path(
    part: float, seconds: float, trembling: float
) -> None:
    shown = waiting(part, seconds, trembling)
    mended = trimmed(shown)

    assert pauses(mended) == ()
    assert mended.times[-1] == pytest.approx(4.0, abs=0.6)
    np.testing.assert_array_equal(mended.positions[[0, -1]], shown.positions[[0, -1]])
    nearest = np.linalg.norm(shown.positions[:, None] - mended.positions[None], axis=2).min(axis=1)
    assert nearest.max() <= 2.0 * STILL_REACH  # before the stop, and what little is left beside an end


def test_a_trimmed_demonstration_is_learned_from_as_one_without_a_pause() -> None:
    others = [recording(reach() + np.array([0.0, y, 0.0])) for y in (-0.03, 0.03)]
    with_pause, without = waiting(0.5, 2.0), recording(reach())

    shown = (without, with_pause, trimmed(with_pause))
    middle = [encode([*others, d], align_by="time").directrix for d in shown]
    off = [np.linalg.norm(line - middle[0], axis=1).max() for line in middle[1:]]
    assert off[1] < 0.1 * off[0]


def test_a_hand_that_waits_while_it_grips_is_left_alone() -> None:
    shown = waiting(0.5, 1.5)
    gripper = (shown.times > 2.7).astype(float)

    assert pauses(shown) != ()
    assert pauses(replace(shown, gripper=gripper)) == ()


def test_orientations_and_gripper_stay_with_their_samples() -> None:
    shown = waiting(0.5, 2.0)
    half = 0.1 + 0.2 * np.arange(len(shown.times)) / len(shown.times)
    turned = np.stack((np.cos(half), 0 * half, 0 * half, np.sin(half)), axis=1)
    mended = trimmed(replace(shown, orientations=turned, gripper=np.zeros(len(shown.times))))

    assert mended.orientations is not None
    assert len(mended.orientations) == len(mended.gripper) == len(mended.times) < len(shown.times)
    np.testing.assert_allclose(mended.orientations[[0, -1]], turned[[0, -1]])


@few
@given(seed=st.integers(0, 1000), size=st.floats(0.002, 0.005))
def test_smoothing_takes_the_tremble_and_leaves_the_motion(seed: int, size: float) -> None:
    calm = reach()
    shaken = calm + np.random.default_rng(seed).uniform(-size, size, calm.shape)
    mended = smoothed(recording(shaken))

    assert tremble(mended) < 0.1 * tremble(recording(shaken))
    np.testing.assert_allclose(mended.positions[[0, -1]], shaken[[0, -1]], atol=1e-12)
    assert np.linalg.norm(mended.positions - calm, axis=1)[5:-5].max() < size + 0.003


def test_smoothing_a_calm_motion_hardly_changes_it() -> None:
    shown = recording(reach())

    assert np.linalg.norm(smoothed(shown).positions - shown.positions, axis=1).max() < 0.002


@pytest.mark.parametrize(("size", "speed"), [(2.0, 1.0), (1.0, 3.0), (0.5, 0.5)])
def test_tremble_depends_neither_on_size_nor_on_speed(size: float, speed: float) -> None:
    shown = bundle(3)[0]
    other = Demonstration(shown.times / speed, size * shown.positions)

    assert tremble(other) == pytest.approx(tremble(shown), rel=1e-6)
