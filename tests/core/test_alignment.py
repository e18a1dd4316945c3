from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

from gc_core import Demonstration, UnknownOptionError, encode
from gc_core.alignment import ALIGNMENTS, Alignment, align
from gc_core.arrays import FloatArray
from gc_core.demonstration import trim
from gc_core.warping import EVEN, warp
from tests.core.shapes import bundle, moved, rotation, seeds

every_alignment = pytest.mark.parametrize("align_by", ALIGNMENTS)


def aligned(
    shown: list[Demonstration], align_by: str = "dtw", directrix: FloatArray | None = None
) -> Alignment:
    return align(tuple(trim(demonstration) for demonstration in shown), 100, align_by, directrix)


def spread(alignment: Alignment) -> float:
    """Root mean square distance of corresponding places from their mean [m]."""
    away = alignment.aligned - alignment.aligned.mean(axis=0)
    return float(np.sqrt((away**2).sum(axis=2).mean()))


def with_bump(place: float, height: float, aside: float = 0.0) -> Demonstration:
    """A way of half a metre with a detour over something that stands elsewhere each time."""
    u = np.linspace(0.0, 1.0, 800)
    bump = height * np.exp(-(((u - place) / 0.04) ** 2))
    return Demonstration(3.0 * u, np.stack((0.5 * u, 0.1 * np.sin(3.0 * u), bump - aside), axis=1))


@settings(max_examples=30, deadline=None)
@given(seed=seeds, count=st.integers(1, 6), align_by=st.sampled_from(ALIGNMENTS))
def test_clocks_run_forward_from_the_start_to_the_end(seed: int, count: int, align_by: str) -> None:
    shown = bundle(seed, count)
    alignment = aligned(shown, align_by)

    assert (np.diff(alignment.moments, axis=1) > 0.0).all()
    for j, demonstration in enumerate(shown):
        np.testing.assert_allclose(alignment.aligned[j, [0, -1]], demonstration.positions[[0, -1]], atol=1e-9)


@settings(max_examples=30, deadline=None)
@given(seed=seeds)
def test_warping_brings_demonstrations_nearer_than_their_path_lengths_do(seed: int) -> None:
    shown = bundle(seed, 4)

    assert spread(aligned(shown, "dtw")) <= 1.01 * spread(aligned(shown, "arc_length"))


def test_a_detour_of_one_demonstration_shifts_nothing_behind_it() -> None:
    shown = [with_bump(0.3, 0.1), with_bump(0.5, 0.0, 0.02), with_bump(0.5, 0.0, 0.04)]
    forward = {kind: aligned(shown, kind).aligned[:, 60:95, 0] for kind in ("dtw", "arc_length")}
    apart = {kind: np.ptp(x, axis=0).max() for kind, x in forward.items()}

    assert apart["dtw"] < 0.01
    assert apart["dtw"] < 0.3 * apart["arc_length"]


@settings(max_examples=30, deadline=None)
@given(seed=seeds, turn=seeds, scale=st.floats(0.5, 20.0))
def test_warping_commutes_with_rigid_motion_and_scale(seed: int, turn: int, scale: float) -> None:
    shown, linear, shift = bundle(seed), scale * rotation(turn), np.array([0.3, -0.2, 0.1])
    here, there = aligned(shown), aligned(moved(shown, linear, shift))

    np.testing.assert_allclose(there.moments, here.moments, atol=1e-6)
    np.testing.assert_allclose(there.aligned, here.aligned @ linear.T + shift, atol=1e-6 * scale)


@settings(max_examples=20, deadline=None)
@given(seed=seeds, order=st.permutations(range(5)))
def test_warping_does_not_depend_on_the_order(seed: int, order: list[int]) -> None:
    shown = bundle(seed, 5)

    np.testing.assert_allclose(
        aligned([shown[j] for j in order]).moments, aligned(shown).moments[order], atol=1e-9
    )


@settings(max_examples=20, deadline=None)
@given(seed=seeds, pace=st.floats(0.5, 2.0))
def test_warping_and_arc_length_ignore_at_which_pace_it_was_shown(seed: int, pace: float) -> None:
    shown = bundle(seed, 3)
    hurried = [Demonstration(4.0 * (d.times / d.times[-1]) ** pace, d.positions) for d in shown]

    for align_by in ("arc_length", "dtw"):
        np.testing.assert_allclose(
            aligned(hurried, align_by).aligned, aligned(shown, align_by).aligned, atol=2e-3
        )


@settings(max_examples=20, deadline=None)
@given(seed=seeds)
def test_the_mean_of_warped_demonstrations_has_no_stairs(seed: int) -> None:
    directrix = aligned(bundle(seed, 5)).directrix
    steps = np.linalg.norm(np.diff(directrix, axis=0), axis=1)

    assert steps.min() > 0.5 * np.median(steps)
    assert steps.max() < 1.05 * np.median(steps)


@settings(max_examples=30, deadline=None)
@given(seed=seeds, count=st.integers(2, 300))
def test_a_matching_is_strictly_increasing_and_covers_both_paths(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = (np.cumsum(rng.normal(size=(count, 3)), axis=0) for _ in range(2))
    where = warp(a, b)

    assert (np.diff(where) >= EVEN - 1e-9).all()
    np.testing.assert_allclose(where[[0, -1]], [0.0, count - 1.0], atol=1e-9)


@settings(max_examples=20, deadline=None)
@given(seed=seeds, count=st.integers(2, 300))
def test_a_path_matches_itself_sample_by_sample(seed: int, count: int) -> None:
    path = np.cumsum(np.random.default_rng(seed).normal(size=(count, 3)), axis=0)

    np.testing.assert_allclose(warp(path, path), np.arange(count), atol=1e-9)


def test_a_given_directrix_is_what_demonstrations_are_warped_onto() -> None:
    u = np.linspace(0.0, 1.0, 400)[:, None] ** 2
    curve = u * [0.5, 0.15, 0.1]
    part = np.linspace(0.0, 1.0, 300)[:, None]
    across = np.array([0.15, -0.5, 0.0])
    straight = [Demonstration(part[:, 0], part * [0.5, 0.15, 0.1] + aside * across) for aside in (0.02, 0.04)]
    alignment = aligned(straight, "dtw", curve)

    np.testing.assert_allclose(alignment.directrix[[0, -1]], curve[[0, -1]], atol=1e-12)
    away = alignment.aligned - alignment.directrix
    assert np.ptp(np.linalg.norm(away, axis=2), axis=1).max() < 0.001


@every_alignment
def test_an_alignment_that_was_asked_for_is_told(align_by: str) -> None:
    assert encode(bundle(0), align_by=align_by).diagnostics.align_by == align_by


@every_alignment
def test_ten_times_the_samples_give_the_same_middle(align_by: str) -> None:
    few, many = (encode(bundle(3, 3, samples), align_by=align_by).directrix for samples in (1_500, 15_000))

    np.testing.assert_allclose(many, few, atol=1e-3)


def posed(seed: int, count: int = 4, samples: int = 120) -> list[Demonstration]:
    """Demonstrations whose tool turns by up to a radian about a few axes."""
    rng = np.random.default_rng(seed)
    part = np.linspace(0.0, 1.0, samples)[:, None]
    return [
        Demonstration(
            d.times,
            d.positions,
            orientations=Rotation.from_rotvec(part * axis + rng.normal(scale=0.1, size=3)).as_quat(
                scalar_first=True
            ),
        )
        for d, axis in zip(bundle(seed, count, samples), rng.normal(scale=0.6, size=(count, 3)), strict=True)
    ]


def orientations_of(shown: list[Demonstration], align_by: str = "time") -> FloatArray:
    orientations = encode(shown, align_by=align_by, stations=50).orientations
    assert orientations is not None
    return orientations


def angles_between(a: FloatArray, b: FloatArray) -> FloatArray:
    """Angles of the rotations from quaternions (N, 4) to others [rad]."""
    turn = Rotation.from_quat(a, scalar_first=True).inv() * Rotation.from_quat(b, scalar_first=True)
    return turn.magnitude()


def turned_by(turn: Rotation, quaternions: FloatArray | None) -> FloatArray:
    return (turn * Rotation.from_quat(quaternions, scalar_first=True)).as_quat(scalar_first=True)


@settings(max_examples=20, deadline=None)
@given(seed=seeds, turn=seeds)
def test_turning_every_tool_turns_the_mean_tool(seed: int, turn: int) -> None:
    shown, by = posed(seed), Rotation.random(random_state=turn)
    turned = [
        Demonstration(
            d.times,
            d.positions,
            orientations=(by * Rotation.from_quat(d.orientations, scalar_first=True)).as_quat(
                scalar_first=True
            ),
        )
        for d in shown
    ]
    wanted = turned_by(by, orientations_of(shown))

    assert angles_between(orientations_of(turned), wanted).max() < 1e-6


@settings(max_examples=20, deadline=None)
@given(seed=seeds, signs=st.lists(st.sampled_from([1.0, -1.0]), min_size=4, max_size=4))
def test_a_quaternion_and_its_negative_are_one_orientation(seed: int, signs: list[float]) -> None:
    shown = posed(seed)
    other = [
        Demonstration(d.times, d.positions, orientations=sign * np.asarray(d.orientations))
        for sign, d in zip(signs, shown, strict=True)
    ]

    assert angles_between(orientations_of(other), orientations_of(shown)).max() < 1e-6


@settings(max_examples=20, deadline=None)
@given(seed=seeds, count=st.integers(1, 5), align_by=st.sampled_from(ALIGNMENTS))
def test_mean_orientations_are_unit_and_do_not_jump(seed: int, count: int, align_by: str) -> None:
    mean = orientations_of(posed(seed, count), align_by)

    np.testing.assert_allclose(np.linalg.norm(mean, axis=1), 1.0, atol=1e-12)
    assert (np.einsum("ij,ij->i", mean[1:], mean[:-1]) > 0.99).all()


@settings(max_examples=20, deadline=None)
@given(seed=seeds)
def test_between_samples_a_tool_turns_evenly(seed: int) -> None:
    few = posed(seed, 1, 4)[0]
    turning = Slerp(few.times, Rotation.from_quat(few.orientations, scalar_first=True))
    cylinder = encode([few], stations=50)
    assert cylinder.orientations is not None

    wanted = turning(np.clip(cylinder.times, 0.0, few.times[-1])).as_quat(scalar_first=True)
    assert angles_between(cylinder.orientations, wanted).max() < 1e-6


@settings(max_examples=20, deadline=None)
@given(seed=seeds, count=st.integers(1, 7), scale=st.sampled_from([1.0, 255.0, 1e308]))
def test_the_gripper_takes_one_of_its_two_states_and_does_not_chatter(
    seed: int, count: int, scale: float
) -> None:
    rng = np.random.default_rng(seed)
    shown = [
        Demonstration(
            d.times,
            d.positions,
            gripper=scale * (d.times > rng.uniform(0.3, 0.7) * d.times[-1]).astype(float),
        )
        for d in bundle(seed, count)
    ]
    gripper = encode(shown, stations=50).gripper
    assert gripper is not None

    assert set(np.unique(gripper)) == {0.0, scale}
    assert np.count_nonzero(np.diff(gripper)) == 1


def test_the_alignments_are_named_to_who_asks_for_another() -> None:
    with pytest.raises(UnknownOptionError, match="'time', 'arc_length', 'dtw'"):
        encode(bundle(0), align_by="place")
