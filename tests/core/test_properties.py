"""The properties of the method, over wild bundles: hairpins, coils, noise, few samples, 1 cm to 100 m.

Where each property lives (`shapes.bundle` is gentle, `shapes.bundles` is wild):

* frames are rotations, and do not spin on a planar curve: test_frames; here, of encoded bundles
* encoding commutes with rigid motion and scale, in any order of the demonstrations: test_encode on gentle
  bundles, frames and sections too; here on wild ones, what ties and rounding cannot choose
* every effective point is inside its section: test_encode, test_real_data; here
* eta = 0 gives the directrix, eta = 1 the boundary: test_reproduce; here
* a run from eta <= 1 stays inside: test_reproduce, test_generalize (bent tubes), test_real_data; here
* a run from a demonstration's own start stays within the tube's width of it: here
* the thin-plate spline meets affine maps and its targets exactly, and is the identity when nothing moves:
  test_registration
* generalizing by a rigid motion moves the cylinder: test_generalize; here
* a rule leaves runs that never pass its planes bit-identical, off = as before: test_refinement; here
* the order of rules does not matter: test_refinement
"""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from gc_core import (
    Constraint,
    GeneralizedCylinder,
    Landmark,
    constrain,
    encode,
    generalize,
    register,
    reproduce,
)
from gc_core.alignment import ALIGNMENTS
from gc_core.arrays import FloatArray
from gc_core.landmarks import rotation as axes_of
from gc_core.radius import radius_at
from gc_core.sections import SECTIONS
from tests.core.shapes import FLAT_PATHS, Bundle, bundles, hairpins, moved, rotation, seeds
from tests.core.test_encode import in_plane, ratios_to_polygons

sections = st.sampled_from(sorted(SECTIONS))
alignments = st.sampled_from(ALIGNMENTS)
some = settings(max_examples=25, deadline=None)


def learned(
    bundle: Bundle, section: str = "closed_spline", align_by: str = "arc_length"
) -> GeneralizedCylinder:
    return encode(
        bundle.shown,
        section=section,
        align_by=align_by,
        stations=40,
        angles=32,
        minimum_half_width=bundle.half_width,
        single_half_width=10.0 * bundle.half_width,
    )


def starts(cylinder: GeneralizedCylinder, ratios: FloatArray) -> FloatArray:
    """Starts (R, 3) at ratios (R,) in the first section, all round."""
    angles = 2.0 * np.pi * np.arange(len(ratios)) / len(ratios)
    edge = radius_at(cylinder.radii, np.zeros(len(ratios), dtype=np.intp), angles)
    across = np.stack((np.cos(angles), np.sin(angles)), axis=1) @ cylinder.frames[0, :, 1:].T
    return cylinder.directrix[0] + (ratios * edge)[:, None] * across


@some
@given(bundle=bundles() | hairpins(), section=sections, align_by=alignments)
def test_frames_are_rotations(bundle: Bundle, section: str, align_by: str) -> None:
    frames = learned(bundle, section, align_by).frames

    gram = np.swapaxes(frames, 1, 2) @ frames
    np.testing.assert_allclose(gram, np.broadcast_to(np.eye(3), gram.shape), atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(frames), 1.0, atol=1e-9)


@some
@given(bundle=bundles(FLAT_PATHS, noises=(0.0,)), align_by=alignments)
def test_frames_of_a_planar_motion_do_not_spin(bundle: Bundle, align_by: str) -> None:
    flat = Bundle(moved(bundle.shown, np.diag([1.0, 1.0, 0.0]), np.zeros(3)), bundle.size)
    frames = learned(flat, align_by=align_by).frames

    up = frames[0].T @ [0.0, 0.0, 1.0]
    np.testing.assert_allclose(
        np.einsum("nij,i->nj", frames, [0.0, 0.0, 1.0]), np.tile(up, (40, 1)), atol=1e-6
    )


@some
@given(bundle=bundles() | hairpins(), section=sections, align_by=alignments)
def test_every_effective_point_is_in_its_plane_and_inside_its_section(
    bundle: Bundle, section: str, align_by: str
) -> None:
    cylinder = learned(bundle, section, align_by)

    height = in_plane(cylinder, cylinder.effective_points)[..., 0]
    np.testing.assert_allclose(height, 0.0, atol=1e-9 * bundle.size)
    assert ratios_to_polygons(cylinder).max() <= 1.0 + 1e-9


@some
@given(bundle=bundles(), section=sections, align_by=st.sampled_from(("time", "arc_length")), turn=seeds)
def test_a_moved_bundle_has_the_moved_cylinder(
    bundle: Bundle, section: str, align_by: str, turn: int
) -> None:
    linear, shift = rotation(turn), bundle.size * np.array([1.0, -2.0, 0.5])
    here = learned(bundle, section, align_by)
    there = learned(Bundle(moved(bundle.shown, linear, shift), bundle.size), section, align_by)

    exact = 1e-6 * bundle.size  # not by warping, whose ties rounding decides
    np.testing.assert_allclose(there.directrix, here.directrix @ linear.T + shift, atol=exact)
    np.testing.assert_allclose(there.frames[:, :, 0], here.frames[:, :, 0] @ linear.T, atol=1e-5)
    # An end of a demonstration that lies on the first or last plane is before or behind it by rounding.
    np.testing.assert_allclose(
        there.effective_points, here.effective_points @ linear.T + shift, atol=10.0 * exact
    )


@some
@given(bundle=bundles(sizes=st.just(1.0)), section=sections, align_by=alignments, power=st.floats(-2.0, 2.0))
def test_a_scaled_bundle_has_the_scaled_cylinder(
    bundle: Bundle, section: str, align_by: str, power: float
) -> None:
    scale = 10.0**power
    here = learned(bundle, section, align_by)
    there = learned(
        Bundle(moved(bundle.shown, scale * np.eye(3), np.zeros(3)), scale * bundle.size), section, align_by
    )

    np.testing.assert_allclose(there.directrix, scale * here.directrix, atol=1e-6 * scale)
    np.testing.assert_allclose(there.effective_points, scale * here.effective_points, atol=1e-5 * scale)


@some
@given(bundle=bundles(least=2), section=sections, align_by=alignments, data=st.data())
def test_the_order_of_the_demonstrations_does_not_matter(
    bundle: Bundle, section: str, align_by: str, data: st.DataObject
) -> None:
    order = data.draw(st.permutations(range(len(bundle.shown))))
    one = learned(bundle, section, align_by)
    other = learned(Bundle([bundle.shown[j] for j in order], bundle.size), section, align_by)

    np.testing.assert_array_equal(other.surface(), one.surface())
    np.testing.assert_array_equal(other.effective_points, one.effective_points[:, order])


@some
@given(bundle=bundles() | hairpins(), section=sections)
def test_ratio_nought_is_the_directrix_and_ratio_one_the_boundary(bundle: Bundle, section: str) -> None:
    cylinder = learned(bundle, section)
    middle = reproduce(cylinder, cylinder.directrix[0], at=0)
    edges = reproduce(cylinder, cylinder.surface()[0], at=0)

    exact = 1e-9 * bundle.size
    np.testing.assert_allclose(middle.positions, cylinder.directrix, atol=exact)
    np.testing.assert_allclose(edges.positions, np.swapaxes(cylinder.surface(), 0, 1), atol=exact)


@some
@given(
    bundle=bundles() | hairpins(),
    section=sections,
    align_by=alignments,
    law=st.sampled_from(["fixed", "convergent"]),
    ratio=st.floats(0.0, 1.0),
)
def test_runs_from_inside_stay_inside(
    bundle: Bundle, section: str, align_by: str, law: str, ratio: float
) -> None:
    cylinder = learned(bundle, section, align_by)
    runs = reproduce(cylinder, starts(cylinder, np.full(6, ratio)), law=law)

    assert np.all(runs.start_inside)
    assert cylinder.contains(runs.positions.reshape(-1, 3)).all()


@some
@given(bundle=bundles() | hairpins(), section=sections, align_by=alignments)
def test_a_run_from_a_demonstration_s_start_stays_within_the_tube_s_width_of_it(
    bundle: Bundle, section: str, align_by: str
) -> None:
    cylinder = learned(bundle, section, align_by)
    widths = 2.0 * cylinder.radii.max(axis=1)
    for j, demonstration in enumerate(bundle.shown):
        start = demonstration.positions[0]
        run = reproduce(cylinder, start, outside="boundary", at=0)
        off = np.linalg.norm(start - cylinder.effective_points[0, j])
        away = np.linalg.norm(run.positions - cylinder.effective_points[:, j], axis=1)

        assert (away <= widths + off + 1e-9 * bundle.size).all()


@some
@given(bundle=bundles() | hairpins(), section=sections, seed=seeds)
def test_generalizing_by_a_rigid_motion_moves_the_cylinder(bundle: Bundle, section: str, seed: int) -> None:
    cylinder, rng = learned(bundle, section), np.random.default_rng(seed)
    before = Landmark(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))
    after = Landmark(bundle.size * rng.normal(size=3), rng.normal(size=4))
    assert after.orientation is not None
    turn = axes_of(after)
    there = generalize(cylinder, register([before], [after]))

    exact = 1e-7 * bundle.size
    np.testing.assert_allclose(there.directrix, cylinder.directrix @ turn.T + after.position, atol=exact)
    np.testing.assert_allclose(there.frames, turn @ cylinder.frames, atol=1e-6)
    np.testing.assert_allclose(there.radii, cylinder.radii, atol=exact)


def rule(cylinder: GeneralizedCylinder, ratio: float, push: FloatArray) -> Constraint:
    """A run was moved by a push about one third of the way."""
    original = reproduce(cylinder, starts(cylinder, np.array([ratio]))[0], at=0)
    bump = np.exp(-(((np.arange(len(original.positions)) - 13.0) / 4.0) ** 2))
    return Constraint.from_correction(original, original.positions + bump[:, None] * push)


pushes = st.tuples(*[st.floats(-0.1, 0.1)] * 3).filter(lambda push: np.linalg.norm(push) > 0.005)


@some
@given(bundle=bundles(sizes=st.just(1.0)), push=pushes, ratio=st.floats(0.0, 1.0))
def test_a_rule_leaves_runs_that_pass_no_plane_of_it_as_they_are(
    bundle: Bundle, push: tuple[float, float, float], ratio: float
) -> None:
    cylinder = learned(bundle)
    one = rule(cylinder, 0.0, np.array(push))
    runs = reproduce(cylinder, starts(cylinder, np.full(6, ratio)), at=0)
    depth = np.einsum("skc,kc->sk", runs.positions - one.points, one.normals)
    passes = ((depth < 0.0) & one.active).any(axis=1)
    ruled = constrain(runs, [one])

    np.testing.assert_array_equal(ruled.positions[~passes], runs.positions[~passes])
    assert (ruled.positions[passes] != runs.positions[passes]).any(axis=(1, 2)).all()
    after = np.einsum("skc,kc->sk", ruled.positions - one.points, one.normals)
    assert after[:, one.active].min(initial=0.0) >= -1e-9


@some
@given(bundle=bundles(sizes=st.just(1.0)), push=pushes, ratio=st.floats(0.0, 1.0))
def test_a_rule_that_nothing_passes_changes_nothing_about_the_others_and_no_rule_nothing_at_all(
    bundle: Bundle, push: tuple[float, float, float], ratio: float
) -> None:
    cylinder = learned(bundle)
    run = reproduce(cylinder, starts(cylinder, np.array([ratio]))[0], at=0)
    one = rule(cylinder, 0.0, np.array(push))
    away = 100.0 * np.array(push) / np.linalg.norm(push)
    idle = Constraint.from_correction(run.positions - 2.0 * away, run.positions - away)

    ruled = constrain(run, [one]).positions
    np.testing.assert_array_equal(constrain(run, [one, idle]).positions, ruled)
    np.testing.assert_array_equal(constrain(run, [idle, one]).positions, ruled)
    assert constrain(run, [idle]) is constrain(run, []) is run
