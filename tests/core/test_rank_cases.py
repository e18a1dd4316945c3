"""Landmarks that span less than space, hardly more than less, or contradict each other."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gc_core import Landmark, ThinPlateSpline, register
from gc_core.registration import turns_inside_out
from tests.core.shapes import rotation, seeds

EVERYWHERE = np.random.default_rng(0).uniform(-0.3, 0.6, size=(200, 3))

HALVINGS = 4
"""How often a step in which the map changes much is halved, to see whether it then changes less."""

SQUARE = np.array([[0.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.0, 0.3, 0.0], [0.3, 0.3, 0.0]])


def landmarks(seed: int, count: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-0.5, 0.5, size=(count, 3))


@given(seed=seeds)
def test_two_landmarks_never_turn_space_inside_out(seed: int) -> None:
    source, target = landmarks(seed, 2), landmarks(seed + 1, 2)

    assert np.linalg.det(register(source, target).linear) > 0.0


@given(seed=seeds, stretch=st.floats(0.3, 3.0))
def test_two_landmarks_moved_apart_stretch_along_their_chord_only(seed: int, stretch: float) -> None:
    source = landmarks(seed, 2)
    spline = register(source, stretch * source)
    across = np.cross(source[1] - source[0], [0.3, 0.5, 0.7])

    np.testing.assert_allclose(spline.linear @ across, across, atol=1e-9)


def test_two_landmarks_that_swap_turn_half_a_circle() -> None:
    source = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    spline = register(source, source[::-1])

    np.testing.assert_allclose(spline.linear @ spline.linear.T, np.eye(3), atol=1e-9)
    assert "turn" in spline.case


@pytest.mark.parametrize(
    ("source", "target"),
    [
        ([[0, 0, 0], [0, 0, 0]], [[1, 0, 0], [1, 0, 0]]),
        ([[0, 0, 0], [0, 0, 0]], [[1, 0, 0], [0, 1, 0]]),
        ([[0, 0, 0], [1, 0, 0]], [[1, 1, 1], [1, 1, 1]]),
        ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 0, 0], [1, 1, 0], [2, 0, 0]]),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [1, 0, 1], [0, 1, 0]]),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 0, 0], [-1, 0, 0], [0, -1, 0], [-1, -1, 0.2]]),
        (
            [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 1]],
            [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 2]],
        ),
    ],
)
def test_every_degenerate_layout_gives_a_finite_map_that_says_its_case(source: list, target: list) -> None:
    spline = register(np.array(source, dtype=float), np.array(target, dtype=float))

    assert np.isfinite(spline(EVERYWHERE)).all()
    assert np.linalg.det(spline.linear) > 0.0
    assert spline.case


def test_a_rotation_of_a_flat_layout_is_found_whole() -> None:
    source = landmarks(0, 4) * [1.0, 1.0, 0.0]
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])

    np.testing.assert_allclose(register(source, source @ turn.T)(EVERYWHERE), EVERYWHERE @ turn.T, atol=1e-7)


@pytest.mark.parametrize(
    ("source", "words"),
    [
        (np.zeros((0, 3)), "no landmarks"),
        (SQUARE[:1], "one landmark: a translation"),
        (SQUARE[:2], "two landmarks: a stretch"),
        (SQUARE[:3], "three landmarks: an affine map"),
        (SQUARE, "landmarks in a plane"),
        (SQUARE + np.outer([0.0, 0.0, 0.0, 1e-3], [0.0, 0.0, 1.0]), "landmarks almost in a plane"),
        (np.outer([0.0, 1.0, 2.0, 3.0], [0.1, 0.1, 0.0]), "landmarks on a line"),
        (SQUARE[[0, 1, 1]], "(1 in the same place merged)"),
        (np.vstack((np.zeros((1, 3)), np.eye(3))), "an affine map"),
        (np.vstack((np.zeros((1, 3)), np.eye(3), np.ones((1, 3)))), "a thin-plate spline"),
    ],
)
def test_the_case_is_named(source: np.ndarray, words: str) -> None:
    assert words in register(source, source + 0.01).case


def test_frames_are_named_in_the_case() -> None:
    frame = Landmark(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))

    assert "one frame" in register([frame], [frame]).case
    assert "1 frame" in register([frame, Landmark(np.ones(3))], [frame, Landmark(np.zeros(3))]).case


@pytest.mark.parametrize("lift", [1e-9, 1e-6, 1e-4, 1e-3])
def test_a_landmark_hardly_out_of_the_plane_of_the_others_makes_no_wild_map(lift: float) -> None:
    source, target = SQUARE.copy(), SQUARE.copy()
    source[3, 2], target[3] = lift, target[3] + np.array([0.0, 0.02, 0.05])
    spline = register(source, target)

    assert np.linalg.norm(spline.linear - np.eye(3), 2) < 0.5
    assert not turns_inside_out(spline, EVERYWHERE).any()
    assert spline.residual < 1e-12


def lifted(height: float) -> ThinPlateSpline:
    source = SQUARE + np.outer([0.0, 0.0, 0.0, height], [0.0, 0.0, 1.0])
    return register(source, source + np.array([[-0.03, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0.05]]))


def lined_up(aside: float) -> ThinPlateSpline:
    source = np.array([[0.0, 0.0, 0.0], [0.2, aside, 0.0], [0.4, 0.0, 0.0]])
    return register(source, source + np.array([[0, 0, 0], [0, 0.05, 0.02], [0, 0, 0.1]]))


def turning(angle: float) -> ThinPlateSpline:
    about = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0, 0, 1.0]])
    return register(SQUARE[:2], SQUARE[:2] @ about.T)


def plate_turning(angle: float) -> ThinPlateSpline:
    about = np.array([[np.cos(angle), 0.0, np.sin(angle)], [0, 1.0, 0], [-np.sin(angle), 0.0, np.cos(angle)]])
    return register(SQUARE, SQUARE @ about.T + np.outer([0.0, 0.0, 0.0, 0.01], [0.0, 1.0, 1.0]))


def closing(apart: float) -> ThinPlateSpline:
    return register(SQUARE[:2], np.array([[0.0, 0.0, 0.0], [apart, 0.01, 0.0]]))


def pulled_through(height: float) -> ThinPlateSpline:
    return register(SQUARE[:3], [[0.0, height, 0.02], *SQUARE[1:3]])


def passing_the_line(aside: float) -> ThinPlateSpline:
    source = np.array([[0.0, 0.0, 0.0], [0.2, 0.1, 0.0], [0.4, 0.0, 0.0]])
    return register(source, [[0.0, 0.0, 0.0], [0.2, aside, 0.0], [0.4, 0.0, 0.0]])


@pytest.mark.parametrize(
    ("family", "low", "high"),
    [
        (lifted, -0.04, 0.04),
        (lined_up, -0.05, 0.05),
        (turning, 0.0, 3.0),
        (plate_turning, 0.0, 3.0),
        (closing, 0.0, 0.3),
        (pulled_through, -0.2, 0.5),
        (passing_the_line, -0.3, 0.3),
    ],
)
def test_the_map_does_not_jump_while_a_landmark_moves(
    family: Callable[[float], ThinPlateSpline], low: float, high: float
) -> None:
    at = cache(lambda value: family(value)(EVERYWHERE))

    def change(step: tuple[float, float]) -> float:
        return np.linalg.norm(at(step[1]) - at(step[0]), axis=1).max()

    steps = list(pairwise(np.linspace(low, high, 401).tolist()))
    allowed = 0.15 * max(map(change, steps))
    for _ in range(HALVINGS):
        middles = [(a, 0.5 * (a + b), b) for a, b in steps if change((a, b)) > allowed]
        steps = [half for a, middle, b in middles for half in ((a, middle), (middle, b))]

    assert max(map(change, steps), default=0.0) <= allowed


@given(seed=seeds, count=st.integers(1, 6))
def test_landmarks_that_all_go_to_one_place_give_a_map_that_keeps_space_apart(seed: int, count: int) -> None:
    source = landmarks(seed, count)
    spline = register(source, np.tile([0.1, 0.2, 0.3], (count, 1)))

    assert np.isfinite(spline(EVERYWHERE)).all()
    assert not turns_inside_out(spline, EVERYWHERE).all()
    assert spline.residual < 0.01


def test_contradictory_landmarks_meet_in_the_middle() -> None:
    source = np.vstack((np.zeros((1, 3)), np.eye(3), np.eye(3)[2:]))
    target = source.copy()
    target[3:, 2] += [0.04, -0.02]
    spline = register(source, target)

    np.testing.assert_allclose(spline(source[3]), [0.0, 0.0, 1.01], atol=1e-9)
    np.testing.assert_allclose(spline.residual, 0.03, atol=1e-9)


@given(seed=seeds, count=st.integers(2, 6))
def test_a_flat_or_straight_layout_moves_with_the_axes_of_the_room(seed: int, count: int) -> None:
    source = landmarks(seed, count) * ([1.0, 1.0, 0.0] if count > 3 else [1.0, 0.0, 0.0])
    target, turn = source + 0.2 * landmarks(seed + 1, count), rotation(seed)
    one, other = register(source, target), register(source @ turn.T, target @ turn.T)

    np.testing.assert_allclose(other(EVERYWHERE @ turn.T), one(EVERYWHERE) @ turn.T, atol=1e-6)
