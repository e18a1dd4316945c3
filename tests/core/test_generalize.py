from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gc_core import (
    Demonstration,
    GeneralizedCylinder,
    Landmark,
    encode,
    generalize,
    register,
    reproduce,
    same_content,
)
from gc_core.landmarks import rotation as axes_of
from gc_core.radius import GREATEST_SLOPE
from gc_core.registration import turns_inside_out
from gc_core.sections import SECTIONS
from tests.core.shapes import bundle, line, seeds
from tests.core.steps import JUMP, worst_step_ratio
from tests.core.test_encode import in_plane, ratios_to_polygons

sections = st.sampled_from(sorted(SECTIONS))
shifts = st.tuples(*[st.floats(-0.15, 0.15)] * 3)
near_shifts = st.tuples(*[st.floats(-0.05, 0.05)] * 3)


def ends_moved(cylinder: GeneralizedCylinder, start: tuple, goal: tuple) -> GeneralizedCylinder:
    ends = cylinder.directrix[[0, -1]]
    return generalize(cylinder, register(ends, ends + np.array([start, goal])))


@settings(max_examples=40, deadline=None)
@given(seed=seeds, section=sections)
def test_a_rigid_map_moves_the_cylinder(seed: int, section: str) -> None:
    rng = np.random.default_rng(seed)
    cylinder = encode(bundle(seed), section=section)
    here, there = (
        Landmark(np.zeros(3), np.array([1.0, 0, 0, 0])),
        Landmark(rng.normal(size=3), rng.normal(size=4)),
    )
    moved = generalize(cylinder, register([here], [there]))
    turn = axes_of(there)

    np.testing.assert_allclose(moved.directrix, cylinder.directrix @ turn.T + there.position, atol=1e-9)
    np.testing.assert_allclose(moved.frames, turn @ cylinder.frames, atol=1e-9)
    np.testing.assert_allclose(moved.radii, cylinder.radii, atol=1e-9)
    np.testing.assert_allclose(
        moved.effective_points, cylinder.effective_points @ turn.T + there.position, atol=1e-9
    )


@settings(max_examples=40, deadline=None)
@given(seed=seeds, start=shifts, goal=shifts, section=sections)
def test_the_ends_go_where_the_landmarks_go(seed: int, start: tuple, goal: tuple, section: str) -> None:
    cylinder = encode(bundle(seed), section=section, stations=80)
    moved = ends_moved(cylinder, start, goal)

    np.testing.assert_allclose(
        moved.directrix[[0, -1]], cylinder.directrix[[0, -1]] + [start, goal], atol=1e-9
    )


@settings(max_examples=40, deadline=None)
@given(seed=seeds, start=shifts, goal=shifts, section=sections)
def test_effective_points_are_in_their_planes_and_inside_after_a_map(
    seed: int, start: tuple, goal: tuple, section: str
) -> None:
    moved = ends_moved(encode(bundle(seed), section=section, stations=80), start, goal)

    np.testing.assert_allclose(in_plane(moved, moved.effective_points)[..., 0], 0.0, atol=1e-9)
    assert ratios_to_polygons(moved).max() <= 1.0 + 1e-9


@settings(max_examples=30, deadline=None)
@given(seed=seeds, start=shifts, goal=shifts, section=sections)
def test_runs_from_inside_stay_inside_the_bent_tube(
    seed: int, start: tuple, goal: tuple, section: str
) -> None:
    moved = ends_moved(encode(bundle(seed), section=section, stations=80), start, goal)
    runs = reproduce(moved, moved.directrix[0] + 0.95 * (moved.surface()[0] - moved.directrix[0]))

    assert moved.contains(runs.positions.reshape(-1, 3)).all()


@settings(max_examples=30, deadline=None)
@given(seed=seeds, count=st.integers(3, 6))
def test_any_landmarks_give_a_finite_cylinder(seed: int, count: int) -> None:
    cylinder = encode(bundle(seed), stations=60)
    rng = np.random.default_rng(seed)
    source = cylinder.directrix[rng.choice(60, count, replace=False)]
    moved = generalize(cylinder, register(source, source + rng.normal(scale=0.1, size=(count, 3))))

    assert np.isfinite(moved.surface()).all()
    assert np.isfinite(moved.effective_points).all()


def test_no_landmarks_change_nothing() -> None:
    cylinder = encode(bundle(0))
    same = generalize(cylinder, register([], []))

    np.testing.assert_allclose(same.surface(), cylinder.surface(), atol=1e-9)


def test_a_scaling_scales_the_widths() -> None:
    cylinder = encode(bundle(1), section="circle")
    corners = np.concatenate((np.zeros((1, 3)), np.eye(3)))
    moved = generalize(cylinder, register(corners, 2.0 * corners))

    np.testing.assert_allclose(moved.radii, 2.0 * cylinder.radii, rtol=1e-6)


def test_orientations_turn_with_the_map() -> None:
    shown = [
        Demonstration(d.times, d.positions, np.tile([1.0, 0, 0, 0], (len(d.times), 1))) for d in bundle(2)
    ]
    cylinder = encode(shown)
    turned = Landmark(np.ones(3), np.array([0.8, 0.0, 0.6, 0.0]))
    moved = generalize(cylinder, register([Landmark(np.zeros(3), np.array([1.0, 0, 0, 0]))], [turned]))

    assert moved.orientations is not None
    np.testing.assert_allclose(np.abs(moved.orientations @ [0.8, 0.0, 0.6, 0.0]), 1.0, atol=1e-9)


def test_a_fold_is_reported() -> None:
    cylinder = encode(bundle(3))
    corners = np.concatenate((np.zeros((1, 3)), np.eye(3)))
    mirrored = generalize(cylinder, register(corners, corners * [1.0, 1.0, -1.0]))

    assert mirrored.diagnostics.folded.all()
    assert any("inside out" in sentence for sentence in mirrored.diagnostics.sentences())


def test_the_cylinder_itself_does_not_change() -> None:
    one, other = encode(bundle(4)), encode(bundle(4))
    ends_moved(one, (0.1, 0.0, 0.0), (0.0, 0.1, 0.0))

    assert same_content(one, other)


@settings(max_examples=20, deadline=None)
@given(seed=seeds, start=near_shifts, goal=near_shifts, section=sections)
def test_a_small_move_of_an_end_changes_everything_a_little(
    seed: int, start: tuple, goal: tuple, section: str
) -> None:
    cylinder = encode(bundle(seed), section=section, stations=80)
    ends = cylinder.directrix[[0, -1]]
    targets = [ends + np.array([start, goal]) + np.array([[0.0], [nudge]]) for nudge in (0.0, 1e-5)]
    one, other = (generalize(cylinder, register(ends, target), repair=False) for target in targets)

    np.testing.assert_allclose(other.directrix, one.directrix, atol=1e-4)
    np.testing.assert_allclose(other.frames, one.frames, atol=1e-2)
    np.testing.assert_allclose(other.surface(), one.surface(), atol=1e-3)
    np.testing.assert_allclose(other.effective_points, one.effective_points, atol=1e-3)


@settings(max_examples=20, deadline=None)
@given(seed=seeds, start=shifts, goal=shifts, section=sections)
def test_bent_sections_change_by_a_stated_slope_at_most(
    seed: int, start: tuple, goal: tuple, section: str
) -> None:
    moved = ends_moved(encode(bundle(seed), section=section, stations=80), start, goal)
    slopes = np.abs(np.diff(moved.radii, axis=0)) / np.diff(moved.arc_length)[:, None]

    assert slopes.max() <= GREATEST_SLOPE + 1e-9


@settings(max_examples=20, deadline=None)
@given(seed=seeds, start=shifts, goal=shifts)
def test_runs_in_the_bent_tube_do_not_jump(seed: int, start: tuple, goal: tuple) -> None:
    moved = ends_moved(encode(bundle(seed), stations=80), start, goal)
    runs = reproduce(moved, moved.directrix[0] + 0.95 * (moved.surface()[0] - moved.directrix[0]))

    assert worst_step_ratio(runs.positions).max() < JUMP


@pytest.mark.parametrize("across", [0.5, 1.0, 1.5])
def test_widths_follow_the_map_across_the_tube(across: float) -> None:
    cylinder = encode([line((0.0, y, z), (0.5, y, z)) for y, z in ((0.03, 0.0), (-0.03, 0.0), (0.0, 0.03))])
    corners = np.concatenate((np.zeros((1, 3)), np.eye(3)))
    moved = generalize(cylinder, register(corners, corners * [1.0, across, across]))

    np.testing.assert_allclose(moved.radii, across * cylinder.radii, rtol=1e-6)


def test_a_fold_that_only_the_boundary_sees_is_reported() -> None:
    cylinder = encode([line((0.0, y, 0.0), (0.5, y, 0.0)) for y in (0.05, -0.05)], section="circle")
    beside = np.array([[0.2, 0.05, 0.0], [0.3, 0.05, 0.0]])
    source = np.concatenate((cylinder.directrix[[0, 100, 199]], beside, [[0.25, 0.0, 0.2]]))
    target = source.copy()
    target[3:5] = target[[4, 3]]
    spline = register(source, target)
    told = generalize(cylinder, spline).diagnostics.folded
    on_the_directrix = turns_inside_out(spline, cylinder.directrix)

    assert told[on_the_directrix].all()
    assert told.sum() > on_the_directrix.sum()


def test_orientations_do_not_jump_at_an_end_with_a_landmark() -> None:
    shown = [
        Demonstration(d.times, d.positions, np.tile([1.0, 0, 0, 0], (len(d.times), 1))) for d in bundle(5)
    ]
    cylinder = encode(shown)
    frame = np.array([1.0, 0.0, 0.0, 0.0])
    before = [Landmark(cylinder.directrix[0]), Landmark(cylinder.directrix[-1], frame)]
    after = [Landmark(before[0].position + 0.1), Landmark(before[1].position, np.array([0.9, 0.0, 0.0, 0.4]))]
    turns = generalize(cylinder, register(before, after)).orientations

    assert turns is not None
    step = np.arccos(np.clip(np.einsum("ij,ij->i", turns[1:], turns[:-1]), -1.0, 1.0))
    assert max(step[0], step[-1]) <= 2.0 * max(step[1], step[-2])


@pytest.mark.parametrize("count", [1, 2, 3, 4, 6])
def test_landmarks_that_all_go_to_one_place_leave_a_finite_tube(count: int) -> None:
    cylinder = encode(bundle(6), stations=60)
    source = cylinder.directrix[np.linspace(0, 59, count).astype(int)]
    moved = generalize(cylinder, register(source, np.tile([0.1, 0.2, 0.3], (count, 1))))

    assert np.isfinite(moved.surface()).all()
    assert np.isfinite(reproduce(moved, moved.directrix[0]).positions).all()


@pytest.mark.parametrize("apart", [0.0, 1e-9, 1e-6, 1e-3])
def test_a_goal_dragged_onto_the_start_leaves_a_finite_tube(apart: float) -> None:
    cylinder = encode([line((0.0, y, 0.0), (1.0, y, 0.0)) for y in (0.0, 0.1)])
    source = np.concatenate((cylinder.directrix[[0, -1]], [[0.5, 0.3, 0.0]]))
    target = source.copy()
    target[1] = target[0] + [apart, 0.0, 0.0]
    moved = generalize(cylinder, register(source, target))

    assert np.isfinite(moved.surface()).all()
    assert np.isfinite(reproduce(moved, moved.directrix[0]).positions).all()
