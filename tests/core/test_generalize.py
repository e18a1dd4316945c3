from __future__ import annotations

import numpy as np
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
from gc_core.landmarks import quaternion_matrices
from gc_core.sections import SECTIONS
from tests.core.shapes import bundle, seeds
from tests.core.test_encode import in_plane, ratios_to_polygons

sections = st.sampled_from(sorted(SECTIONS))
shifts = st.tuples(*[st.floats(-0.15, 0.15)] * 3)


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
    turn = quaternion_matrices(there.orientation)

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
