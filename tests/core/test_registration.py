from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.interpolate import RBFInterpolator

from gc_core import InvalidSettingError, Landmark, LandmarkMismatchError, ThinPlateSpline, register
from gc_core.landmarks import rotation as axes_of
from gc_core.registration import turns_inside_out
from tests.core.shapes import rotation, seeds

EVERYWHERE = np.random.default_rng(0).uniform(-0.5, 0.5, size=(200, 3))


def landmarks(seed: int, count: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-0.5, 0.5, size=(count, 3))


@given(seed=seeds, count=st.integers(0, 8))
def test_the_map_is_the_identity_when_nothing_moves(seed: int, count: int) -> None:
    marks = landmarks(seed, count)

    np.testing.assert_allclose(register(marks, marks)(EVERYWHERE), EVERYWHERE, atol=1e-7)


@given(seed=seeds, count=st.integers(1, 9))
def test_the_map_meets_its_targets_exactly(seed: int, count: int) -> None:
    source, target = landmarks(seed, count), landmarks(seed + 1, count)
    spline = register(source, target)

    np.testing.assert_allclose(spline(source), target, atol=1e-7)
    assert spline.residual < 1e-7


@given(seed=seeds, count=st.integers(4, 9))
def test_affine_maps_are_found_exactly(seed: int, count: int) -> None:
    source = landmarks(seed, count) + np.eye(4, 3)[np.arange(count) % 4]
    linear = np.random.default_rng(seed).normal(size=(3, 3))
    spline = register(source, source @ linear.T + 1.0)
    assume("in a plane" not in spline.case)

    np.testing.assert_allclose(spline(EVERYWHERE), EVERYWHERE @ linear.T + 1.0, atol=1e-6)
    assert spline.bending_energy < 1e-9


@given(seed=seeds)
def test_one_landmark_translates(seed: int) -> None:
    (a,), (b,) = landmarks(seed, 1), landmarks(seed + 1, 1)

    np.testing.assert_allclose(
        register([Landmark(a)], [Landmark(b)])(EVERYWHERE), EVERYWHERE + b - a, atol=1e-12
    )


def frame(seed: int) -> Landmark:
    rng = np.random.default_rng(seed)
    return Landmark(rng.normal(size=3), rng.normal(size=4))


@given(seed=seeds)
def test_one_frame_moves_rigidly(seed: int) -> None:
    jacobian = register([frame(seed)], [frame(seed + 1)]).jacobian(EVERYWHERE[:1])[0]

    np.testing.assert_allclose(jacobian @ jacobian.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(jacobian) > 0.0


@settings(deadline=None)
@given(seed=seeds)
def test_frames_take_their_axes_along(seed: int) -> None:
    source, target = [frame(seed), frame(seed + 1)], [frame(seed + 2), frame(seed + 3)]
    spline = register(source, target)
    arm = register(source[:1], target[:1])

    np.testing.assert_allclose(spline(source[0].position[None]), target[0].position[None], atol=1e-7)
    assert source[0].orientation is not None
    axis = source[0].position + 0.1 * axes_of(source[0])[:, 1]
    np.testing.assert_allclose(spline(axis[None]), arm(axis[None]), atol=1e-7)


@settings(deadline=None)
@given(seed=seeds, count=st.integers(5, 9), regularization=st.sampled_from([0.0, 0.1, 1.0]))
def test_the_spline_is_scipy_s_with_the_scaled_domain(seed: int, count: int, regularization: float) -> None:
    source, target = landmarks(seed, count), landmarks(seed + 1, count)
    ours = ThinPlateSpline.fit(source, target, regularization)
    assume("in a plane" not in ours.case)
    theirs = RBFInterpolator(
        source / ours.scale, target, kernel="linear", degree=1, smoothing=regularization
    )(EVERYWHERE / ours.scale)

    np.testing.assert_allclose(ours(EVERYWHERE), theirs, atol=1e-6)


@given(seed=seeds, count=st.integers(1, 8))
def test_the_bending_energy_of_an_affine_map_is_none(seed: int, count: int) -> None:
    source, linear = landmarks(seed, count), np.eye(3) + 0.3 * np.random.default_rng(seed).normal(size=(3, 3))
    spline = register(source, source @ linear.T)
    assume("in a plane" not in spline.case and "on a line" not in spline.case)

    assert spline.bending_energy <= 1e-15


@given(seed=seeds, count=st.integers(5, 8), more=st.floats(1.1, 5.0))
def test_the_bending_energy_grows_with_the_square_of_the_bending(seed: int, count: int, more: float) -> None:
    source = landmarks(seed, count)
    bend = 0.1 * np.random.default_rng(seed + 1).normal(size=(count, 3))
    one, other = (ThinPlateSpline.fit(source, source + size * bend) for size in (1.0, more))

    np.testing.assert_allclose(other.bending_energy, more**2 * one.bending_energy, rtol=1e-6)


@given(seed=seeds, count=st.integers(5, 8))
def test_the_bending_energy_does_not_change_when_everything_is_moved(seed: int, count: int) -> None:
    source, target, turn = landmarks(seed, count), landmarks(seed + 1, count), rotation(seed)
    one = ThinPlateSpline.fit(source, target)
    before = ThinPlateSpline.fit(source @ turn.T + 1.0, target)
    after = ThinPlateSpline.fit(source, target @ turn.T + 1.0)

    assume("in a plane" not in one.case)
    np.testing.assert_allclose([before.bending_energy, after.bending_energy], one.bending_energy, rtol=1e-6)


def test_the_bending_energy_is_the_integral_of_the_squared_second_derivatives() -> None:
    spline = ThinPlateSpline.fit(landmarks(3, 6), landmarks(4, 6))
    # Cells grow with the distance: second derivatives fall with its third power.
    stretch = np.linspace(-3.0, 3.0, 86)
    at, width = np.sinh(0.5 * (stretch[1:] + stretch[:-1])), np.diff(np.sinh(stretch))
    total = 0.0
    for x, thickness in zip(at, width, strict=True):
        y, z = (side.ravel() for side in np.meshgrid(at, at))
        away = np.stack((np.full_like(y, x), y, z), axis=1)[:, None] - spline.centres
        far = np.linalg.norm(away, axis=2)
        unit = away / far[..., None]
        bend = (np.eye(3) - unit[..., :, None] * unit[..., None, :]) / far[..., None, None]
        second = np.einsum("lo,plij->poij", spline.weights / spline.scale, bend)
        total += thickness * float((second**2).sum(axis=(1, 2, 3)) @ np.outer(width, width).ravel())

    np.testing.assert_allclose(total, 8.0 * np.pi * spline.bending_energy, rtol=0.08)


@given(seed=seeds)
def test_more_regularization_bends_less_and_misses_more(seed: int) -> None:
    source, target = landmarks(seed, 7), landmarks(seed + 1, 7)
    stiff, soft = (ThinPlateSpline.fit(source, target, value) for value in (1.0, 0.01))

    assert stiff.bending_energy <= soft.bending_energy + 1e-12
    assert stiff.residual >= soft.residual - 1e-12


@given(seed=seeds, count=st.integers(1, 8), size=st.floats(0.05, 2.0))
def test_space_is_inside_out_where_the_jacobian_says_so(seed: int, count: int, size: float) -> None:
    source = landmarks(seed, count)
    spline = register(source, source + size * landmarks(seed + 1, count))

    np.testing.assert_array_equal(
        turns_inside_out(spline, EVERYWHERE), np.linalg.det(spline.jacobian(EVERYWHERE)) <= 0.0
    )


@given(seed=seeds, count=st.integers(1, 8))
def test_the_jacobian_is_the_derivative(seed: int, count: int) -> None:
    spline = register(landmarks(seed, count), landmarks(seed + 1, count))
    points, step = landmarks(seed + 2, 20) + 2.0, 1e-5
    differences = [
        (spline(points + step * axis) - spline(points - step * axis)) / (2 * step) for axis in np.eye(3)
    ]

    np.testing.assert_allclose(spline.jacobian(points), np.stack(differences, axis=2), atol=1e-6)


def test_landmarks_must_be_paired() -> None:
    with pytest.raises(LandmarkMismatchError):
        register(landmarks(0, 2), landmarks(0, 3))


def test_regularization_must_not_be_negative() -> None:
    with pytest.raises(InvalidSettingError):
        register(landmarks(0, 2), landmarks(1, 2), -1.0)


@pytest.mark.parametrize("count", [0, 1, 2, 6])
@pytest.mark.parametrize("orientation", [None, np.array([1.0, 0.0, 0.0, 0.0])])
def test_a_map_cannot_be_written_to(count: int, orientation: np.ndarray | None) -> None:
    before, after = ([Landmark(place, orientation) for place in landmarks(seed, count)] for seed in (0, 1))
    spline = register(before, after)

    for array in (spline.centres, spline.weights, spline.linear, spline.origin, spline.image):
        assert not array.flags.writeable


def test_a_frame_spans_space() -> None:
    assert register([frame(0)], [frame(1)]).rank == 3


def test_places_may_be_given_as_lists() -> None:
    spline = register(landmarks(0, 6), landmarks(1, 6))

    np.testing.assert_array_equal(spline([[0, 0, 0]]), spline(np.zeros((1, 3))))
    np.testing.assert_array_equal(spline.jacobian([[0, 0, 0]]), spline.jacobian(np.zeros((1, 3))))
