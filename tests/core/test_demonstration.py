from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gc_core import (
    Demonstration,
    GcError,
    NoMotionError,
    NotFiniteError,
    ShapeError,
    TimesNotIncreasingError,
    TooFarError,
    TooFewSamplesError,
    TooLateError,
    ZeroQuaternionError,
    encode,
)
from gc_core.demonstration import MOST_SAMPLES, STATIONARY_REACH, trim
from tests.core.shapes import bundle, seeds

T = np.linspace(0.0, 1.0, 11)
P = np.outer(T, [0.3, 0.1, 0.0])


def replaced(array: np.ndarray, index: int, value: float) -> np.ndarray:
    copy = array.copy()
    copy[index] = value
    return copy


@pytest.mark.parametrize(
    ("error", "arguments"),
    [
        (ShapeError, {"times": T, "positions": P[:, :2]}),
        (ShapeError, {"times": T[:-1], "positions": P}),
        (ShapeError, {"times": T, "positions": [[1.0, 2.0, 3.0], [1.0]]}),
        (ShapeError, {"times": T, "positions": P, "orientations": np.ones((11, 3))}),
        (ShapeError, {"times": T, "positions": P, "gripper": np.ones(10)}),
        (TooFewSamplesError, {"times": [], "positions": np.zeros((0, 3))}),
        (TooFewSamplesError, {"times": [0.0], "positions": [[0.0, 0.0, 0.0]]}),
        (NotFiniteError, {"times": T, "positions": replaced(P, 4, np.nan)}),
        (NotFiniteError, {"times": replaced(T, 10, np.inf), "positions": P}),
        (TimesNotIncreasingError, {"times": replaced(T, 5, T[4]), "positions": P}),
        (TimesNotIncreasingError, {"times": replaced(T, 1, 5e-324), "positions": P}),
        (TooFarError, {"times": T, "positions": 1e200 * P}),
        (TooFarError, {"times": T, "positions": 1e7 * P}),
        (TooLateError, {"times": 1.7e18 + 1e9 * T, "positions": P}),
        (NoMotionError, {"times": [0.0, 1.0], "positions": [[1.0, 2.0, 3.0], [1.0, 2.0, 3.0]]}),
        (
            ZeroQuaternionError,
            {"times": T, "positions": P, "orientations": replaced(np.ones((11, 4)), 3, 0.0)},
        ),
    ],
)
def test_each_fault_has_its_own_error_that_names_the_demonstration(
    error: type[GcError], arguments: dict
) -> None:
    with pytest.raises(error, match="'pour the tea'") as caught:
        Demonstration(**arguments, name="pour the tea")

    assert str(caught.value).count(".") >= 2, "what is wrong, and what to do"


def test_the_fault_is_located() -> None:
    with pytest.raises(NotFiniteError, match="sample 4"):
        Demonstration(T, replaced(P, 4, np.nan))


def test_a_demonstration_does_not_follow_the_arrays_it_was_made_of() -> None:
    positions = P.copy()
    demonstration = Demonstration(T, positions)
    positions[0] = 9.0

    np.testing.assert_array_equal(demonstration.positions, P)


def test_a_demonstration_cannot_be_written_to() -> None:
    with pytest.raises(ValueError, match="read-only"):
        Demonstration(T, P).positions[0] = 0.0


def test_quaternions_become_sign_continuous() -> None:
    quaternions = np.tile([1.0, 0.0, 0.0, 0.0], (11, 1)) * (-1.0) ** np.arange(11)[:, None]

    orientations = Demonstration(T, P, orientations=quaternions).orientations

    assert orientations is not None
    assert (np.einsum("ij,ij->i", orientations[1:], orientations[:-1]) > 0.0).all()


def with_pauses(start: int, end: int, noise: float = 0.0) -> Demonstration:
    moving = np.outer(np.linspace(0.0, 1.0, 200), [0.4, 0.2, 0.0])
    path = np.concatenate((np.repeat(moving[:1], start, axis=0), moving, np.repeat(moving[-1:], end, axis=0)))
    path = path + noise * np.random.default_rng(0).normal(size=path.shape)
    return Demonstration(0.01 * np.arange(len(path)), path)


def test_standing_still_is_cut_at_both_ends_and_reported() -> None:
    trimmed = trim(with_pauses(80, 150))

    np.testing.assert_allclose((trimmed.cut_start, trimmed.cut_end), (0.8, 1.5), atol=0.05)


def test_the_true_ends_are_kept_when_standing_still_is_cut() -> None:
    demonstration = with_pauses(80, 150, noise=1e-5)
    trimmed = trim(demonstration)

    np.testing.assert_array_equal(trimmed.positions[[0, -1]], demonstration.positions[[0, -1]])


def test_an_evenly_moving_demonstration_is_not_cut() -> None:
    assert len(trim(with_pauses(0, 0)).times) == 200


def test_trimming_leaves_the_demonstration_as_it_was() -> None:
    demonstration = with_pauses(50, 50)
    before = demonstration.positions.copy()
    encode([demonstration])

    np.testing.assert_array_equal(demonstration.positions, before)


def test_what_is_remembered_of_trimming_cannot_be_written_to() -> None:
    part = trim(bundle(0, 1)[0])

    assert not any(array.flags.writeable for array in (part.times, part.positions, part.kept))


def recorded(samples: int) -> np.ndarray:
    u = np.linspace(0.0, 1.0, samples)
    return np.stack((u, 0.1 * np.sin(9.0 * u), 0.1 * np.cos(5.0 * u)), axis=1)


@settings(max_examples=30, deadline=None)
@given(still=st.integers(0, 20), seed=seeds)
def test_what_is_cut_does_not_depend_on_how_long_it_stood_still(still: int, seed: int) -> None:
    demonstration = with_pauses(100 * still, 100 * still, noise=1e-6 * (seed % 3))
    trimmed = trim(demonstration)

    np.testing.assert_allclose((trimmed.cut_start, trimmed.cut_end), still, atol=0.05 * (1 + still))
    assert trimmed.times[-1] > 1.9


def test_repeated_places_are_counted() -> None:
    path = np.repeat(recorded(40), 3, axis=0)

    assert trim(Demonstration(0.01 * np.arange(120), path)).duplicates == 80 - 4, (
        "but not those cut at the ends"
    )


def test_a_glitch_of_the_sensor_does_not_cut_a_slow_motion() -> None:
    path = recorded(500)
    path[250] += 1.0

    assert len(trim(Demonstration(0.01 * np.arange(500), path)).times) == 500


@pytest.mark.parametrize("samples", [MOST_SAMPLES, MOST_SAMPLES + 1, 12_345, 100_000])
def test_a_long_recording_is_reduced_and_keeps_its_ends_and_its_shape(samples: int) -> None:
    demonstration = Demonstration(1e-3 * np.arange(samples), recorded(samples))
    part = trim(demonstration)
    back = np.array([np.interp(demonstration.times, part.times, axis) for axis in part.positions.T]).T

    assert len(part.times) <= MOST_SAMPLES + 2
    np.testing.assert_array_equal(part.positions[[0, -1]], demonstration.positions[[0, -1]])
    np.testing.assert_allclose(back, demonstration.positions, atol=1e-6)
    np.testing.assert_array_equal(demonstration.positions[part.kept.astype(int)], part.positions)


@settings(max_examples=20, deadline=None)
@given(at=st.integers(1, 99_998))
def test_an_excursion_of_a_single_sample_survives_the_reduction(at: int) -> None:
    path = recorded(100_000)
    path[at] += [0.0, 0.0, 0.5]
    part = trim(Demonstration(1e-3 * np.arange(100_000), path))

    assert at in part.kept


def test_what_is_remembered_of_a_demonstration_goes_with_it() -> None:
    demonstration = bundle(0, 1)[0]
    part = weakref.ref(trim(demonstration))
    assert trim(demonstration) is part()
    del demonstration
    gc.collect()

    assert part() is None


def test_huge_quaternions_become_unit_ones() -> None:
    orientations = Demonstration(T, P, orientations=np.full((11, 4), 1e200)).orientations

    np.testing.assert_allclose(orientations, 0.5)


def test_a_slow_approach_is_no_stop() -> None:
    fast = np.outer(np.linspace(0.0, 1.0, 200), [0.5, 0.0, 0.0])
    slow = fast[-1] + np.outer(np.linspace(0.0, 1.0, 500)[1:], [0.0, 0.0, -0.02])
    path = np.concatenate((fast, slow))
    cut = path[int(trim(Demonstration(0.01 * np.arange(699), path)).kept[-2]) :]

    assert np.linalg.norm(cut - path[-1], axis=1).max() < 1.05 * STATIONARY_REACH * 0.5
