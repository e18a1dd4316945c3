from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gc_core import (
    NotFiniteError,
    ShapeError,
    TimesNotIncreasingError,
    TooFewSamplesError,
    encode,
    metrics,
    register,
    same_content,
)
from tests.core.shapes import bundle, rotation, seeds


def paths(seed: int, *lengths: int) -> list[np.ndarray]:
    rng = np.random.default_rng(seed)
    return [rng.normal(size=(length, 3)) for length in lengths]


def plain(cost: np.ndarray, join: object) -> float:
    """Least sum or maximum over monotone ways, cell by cell."""
    best = np.full(cost.shape, np.inf)
    for i, j in np.ndindex(*cost.shape):
        before = [best[i - a, j - b] for a, b in ((1, 0), (0, 1), (1, 1)) if i >= a and j >= b]
        best[i, j] = join(min(before), cost[i, j]) if before else cost[i, j]
    return best[-1, -1]


def all_ways(i: int, j: int) -> list[list[tuple[int, int]]]:
    """Every monotone way from cell (0, 0) to cell (i, j), one cell at a time."""
    if (i, j) == (0, 0):
        return [[(0, 0)]]
    before = [(i - a, j - b) for a, b in ((1, 0), (0, 1), (1, 1)) if i >= a and j >= b]
    return [[*way, (i, j)] for cell in before for way in all_ways(*cell)]


@given(seed=seeds, k=st.integers(1, 12), l=st.integers(1, 12))
def test_frechet_and_dtw_are_the_plain_dynamic_programs(seed: int, k: int, l: int) -> None:  # noqa: E741
    a, b = paths(seed, k, l)
    cost = np.linalg.norm(a[:, None] - b, axis=2)

    np.testing.assert_allclose(metrics.frechet(a, b), plain(cost, max))
    np.testing.assert_allclose(metrics.dtw(a, b), plain(cost, lambda x, y: x + y))


@given(seed=seeds)
def test_distances_between_paths_are_symmetric_and_zero_for_the_same(seed: int) -> None:
    a, b = paths(seed, 20, 20)
    for distance in (metrics.frechet, metrics.dtw, metrics.sse):
        np.testing.assert_allclose(distance(a, b), distance(b, a))
        assert distance(a, a) == 0.0


@given(seed=seeds, k=st.integers(1, 5), l=st.integers(1, 5))
def test_frechet_and_dtw_are_the_least_of_all_monotone_ways(seed: int, k: int, l: int) -> None:  # noqa: E741
    a, b = paths(seed, k, l)
    cost = np.linalg.norm(a[:, None] - b, axis=2)
    ways = [cost[tuple(np.array(way).T)] for way in all_ways(k - 1, l - 1)]

    np.testing.assert_allclose(metrics.frechet(a, b), min(way.max() for way in ways))
    np.testing.assert_allclose(metrics.dtw(a, b), min(way.sum() for way in ways))


@given(seed=seeds, turn=seeds, scale=st.floats(0.1, 10.0))
def test_distances_between_paths_ignore_motion_and_follow_scale(seed: int, turn: int, scale: float) -> None:
    a, b = paths(seed, 15, 20)
    there = [scale * path @ rotation(turn).T + np.array([1.0, -2.0, 3.0]) for path in (a, b)]

    for distance in (metrics.frechet, metrics.dtw):
        np.testing.assert_allclose(distance(*there), scale * distance(a, b), rtol=1e-9)


@pytest.mark.parametrize("metric", [metrics.frechet, metrics.dtw, metrics.sse])
def test_what_is_no_path_is_refused(metric: Callable[..., float]) -> None:
    good = np.zeros((4, 3))
    for error, bad in (
        (TooFewSamplesError, np.zeros((0, 3))),
        (ShapeError, np.zeros((4, 2))),
        (NotFiniteError, np.full((4, 3), np.nan)),
    ):
        with pytest.raises(error):
            metric(good, bad)


def test_frechet_of_a_shifted_path_is_the_shift() -> None:
    (a,) = paths(0, 30)

    np.testing.assert_allclose(metrics.frechet(a, a + np.array([0.0, 3.0, 4.0])), 5.0)


@given(seed=seeds, factor=st.floats(0.1, 10.0))
def test_jerk_is_that_of_a_cubic_whatever_the_times(seed: int, factor: float) -> None:
    times = np.cumsum(np.random.default_rng(seed).uniform(0.1, 1.0, 20))
    path = np.stack((factor * times**3, times**2, times), axis=1)

    np.testing.assert_allclose(metrics.jerk(path, times), (6.0 * factor) ** 2, rtol=1e-5)


def test_jerk_needs_four_samples() -> None:
    with pytest.raises(TooFewSamplesError):
        metrics.jerk(np.zeros((3, 3)), np.arange(3.0))


def test_containment_counts_what_is_inside() -> None:
    cylinder = encode(bundle(0))
    points = np.concatenate((cylinder.directrix, cylinder.directrix + 10.0))

    assert metrics.containment(cylinder, points) == 0.5
    assert metrics.volume(cylinder) > 0.0


def test_the_end_error_is_the_distance_to_the_goal() -> None:
    assert metrics.end_error(np.zeros((3, 3)), np.array([0.0, 3.0, 4.0])) == 5.0


def test_the_determinant_is_the_change_of_volume() -> None:
    corners = np.concatenate((np.zeros((1, 3)), np.eye(3)))

    np.testing.assert_allclose(metrics.det_jacobian(register(corners, 2.0 * corners), corners), 8.0)


@settings(max_examples=30, deadline=None)
@given(seed=seeds, regularization=st.sampled_from([0.0, 0.1]))
def test_the_determinant_is_that_of_finite_differences(seed: int, regularization: float) -> None:
    rng = np.random.default_rng(seed)
    source = rng.uniform(-0.5, 0.5, (8, 3))
    spline = register(source, source + rng.normal(scale=0.05, size=(8, 3)), regularization)
    points, step = rng.uniform(-0.4, 0.4, (20, 3)), 1e-6
    columns = [
        (spline(points + step * axis) - spline(points - step * axis)) / (2.0 * step) for axis in np.eye(3)
    ]
    wanted = np.linalg.det(np.stack(columns, axis=2))

    np.testing.assert_allclose(metrics.det_jacobian(spline, points), wanted, atol=1e-6)


@given(seed=seeds, factor=st.floats(0.2, 5.0), shift=st.floats(-100.0, 100.0))
def test_jerk_follows_the_sixth_power_of_the_pace(seed: int, factor: float, shift: float) -> None:
    (path,) = paths(seed, 15)
    times = np.cumsum(np.random.default_rng(seed).uniform(0.1, 1.0, 15))

    np.testing.assert_allclose(
        metrics.jerk(path, factor * times + shift), metrics.jerk(path, times) / factor**6, rtol=1e-6
    )


def test_same_content_sees_a_changed_bit_and_a_changed_type() -> None:
    one = {"a": (np.arange(3.0), [1, None]), "b": float("nan")}

    assert same_content(one, {"a": (np.arange(3.0), [1, None]), "b": float("nan")})
    assert not same_content(one, {"a": (np.arange(3.0) + 1e-16 * np.arange(3), [1, 0]), "b": float("nan")})
    assert not same_content(np.arange(3), np.arange(3.0))
    assert same_content(encode(bundle(1)), encode(bundle(1)))


def test_jerk_refuses_times_that_stand_still() -> None:
    with pytest.raises(TimesNotIncreasingError):
        metrics.jerk(np.eye(4, 3), np.array([0.0, 1.0, 1.0, 2.0]))
