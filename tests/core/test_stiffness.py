"""Maps with a stiff affine part: a landmark that is pulled takes along what is near it, not all space."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from app.model import STIFFNESS
from gc_core import GeneralizedCylinder, Landmark, ThinPlateSpline, encode, generalize, register
from tests.core.shapes import bundle, rotation, seeds

EVERYWHERE = np.random.default_rng(0).uniform(-0.5, 0.5, size=(200, 3))
ARCH = np.array([[0.0, 0.0, 0.0], [0.15, 0.01, 0.12], [0.35, -0.01, 0.12], [0.5, 0.0, 0.0]])
"""Four landmarks along a motion over something, hardly out of one plane [m]."""


def landmarks(seed: int, count: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-0.5, 0.5, size=(count, 3))


def pulled(seed: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Landmarks, and where they are after each was pulled by a few centimetres."""
    source = landmarks(seed, count)
    return source, source + 0.1 * landmarks(seed + 1, count)


@given(seed=seeds, count=st.integers(1, 9), stiffness=st.sampled_from([0.003, STIFFNESS, 1.0]))
def test_a_stiff_map_meets_its_targets_exactly(seed: int, count: int, stiffness: float) -> None:
    source, target = landmarks(seed, count), landmarks(seed + 1, count)

    np.testing.assert_allclose(register(source, target, stiffness=stiffness)(source), target, atol=1e-7)


@given(seed=seeds, count=st.integers(4, 9), stiffness=st.sampled_from([0.003, STIFFNESS, 1.0]))
def test_bending_and_the_affine_part_are_in_balance(seed: int, count: int, stiffness: float) -> None:
    source, target = pulled(seed, count)
    spline = ThinPlateSpline.fit(source, target, 0.0, stiffness)
    assume("in a plane" not in spline.case)
    moment = (source - spline.origin).T @ spline.weights

    np.testing.assert_allclose(moment, stiffness * spline.scale * (spline.linear - np.eye(3)).T, atol=1e-9)


@given(seed=seeds, count=st.integers(4, 8))
def test_a_landmark_that_is_added_where_a_stiff_map_takes_it_changes_nothing(seed: int, count: int) -> None:
    source, target = pulled(seed, count)
    one = register(source, target, stiffness=STIFFNESS)
    assume("in a plane" not in one.case)
    more = np.vstack((source, landmarks(seed + 2, 1)))
    other = register(more, np.vstack((target, one(more[-1:]))), stiffness=STIFFNESS)

    np.testing.assert_allclose(other(EVERYWHERE), one(EVERYWHERE), atol=1e-6)


@given(seed=seeds, count=st.integers(0, 6))
def test_a_shift_of_all_landmarks_shifts_everything(seed: int, count: int) -> None:
    source = landmarks(seed, count)
    shift = landmarks(seed + 1, 1) if count else 0.0

    np.testing.assert_allclose(
        register(source, source + shift, stiffness=STIFFNESS)(EVERYWHERE), EVERYWHERE + shift, atol=1e-7
    )


@given(seed=seeds, count=st.integers(2, 6))
def test_a_stiff_map_moves_with_the_axes_of_the_room(seed: int, count: int) -> None:
    (source, target), turn = pulled(seed, count), rotation(seed)
    one = register(source, target, stiffness=STIFFNESS)
    other = register(source @ turn.T, target @ turn.T, stiffness=STIFFNESS)

    np.testing.assert_allclose(other(EVERYWHERE @ turn.T), one(EVERYWHERE) @ turn.T, atol=1e-6)


@pytest.mark.parametrize("which", range(4))
@pytest.mark.parametrize("way", np.concatenate((np.eye(3), -np.eye(3))).tolist())
def test_one_landmark_of_four_takes_nothing_much_farther_than_itself(which: int, way: list) -> None:
    target = ARCH.copy()
    target[which] += 0.06 * np.array(way)
    near = EVERYWHERE * [0.7, 0.2, 0.3] + [0.25, 0.0, 0.06]
    gone = np.linalg.norm(register(ARCH, target, stiffness=STIFFNESS)(near) - near, axis=1)

    assert gone.max() <= 0.12


def along(cylinder: GeneralizedCylinder, seed: int, count: int) -> np.ndarray:
    """Start, goal, and places near the tube between them (count, 3) [m]."""
    rng = np.random.default_rng(seed)
    between = cylinder.directrix[rng.choice(np.arange(10, 50), count - 2, replace=False)]
    return np.concatenate((cylinder.directrix[[0, -1]], between + rng.normal(scale=0.02, size=between.shape)))


@settings(max_examples=20, deadline=None)
@given(seed=seeds, count=st.integers(3, 5))
@example(seed=15, count=4)
def test_a_small_pull_of_a_way_point_changes_the_tube_a_little(seed: int, count: int) -> None:
    cylinder = encode(bundle(seed), stations=60)
    source, way = along(cylinder, seed, count), rotation(seed)[0]
    targets = [source + np.eye(count)[:, 2:3] * (0.06 + nudge) * way for nudge in (0.0, 1e-5)]
    one, other = (
        generalize(cylinder, register(source, target, stiffness=STIFFNESS), repair=False).surface()
        for target in targets
    )

    assert np.linalg.norm(other - one, axis=2).max() <= 1e-3


def test_a_turned_frame_still_takes_its_axes_along() -> None:
    before = [Landmark(np.zeros(3)), Landmark(np.array([0.4, 0.0, 0.0]), np.array([1.0, 0.0, 0.0, 0.0]))]
    after = [Landmark(np.zeros(3)), Landmark(np.array([0.4, 0.1, 0.0]), np.array([0.8, 0.0, 0.0, 0.6]))]
    spline = register(before, after, stiffness=STIFFNESS)
    turn = register(before[1:], after[1:])
    tip = np.array([[0.5, 0.0, 0.0]])

    np.testing.assert_allclose(spline(tip), turn(tip), atol=1e-9)


def test_a_stiff_map_says_so() -> None:
    assert "stiff" in register(ARCH, ARCH + 0.01, stiffness=STIFFNESS).case
    assert "stiff" not in register(ARCH, ARCH + 0.01).case
