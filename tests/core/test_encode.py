from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gc_core import (
    Demonstration,
    GcError,
    GeneralizedCylinder,
    InvalidSettingError,
    NoDemonstrationsError,
    OpposedDemonstrationsError,
    UnknownOptionError,
    coarser,
    encode,
)
from gc_core.alignment import ALIGNMENTS
from gc_core.sections import SECTIONS
from tests.core.shapes import bundle, line, moved, rotation, seeds

sections = st.sampled_from(sorted(SECTIONS))
alignments = st.sampled_from(ALIGNMENTS)


def in_plane(cylinder: GeneralizedCylinder, points: np.ndarray) -> np.ndarray:
    """Points (N, n, 3) in the axes of their station's section: (N, n, 3), height first."""
    return np.einsum("ijk,ikl->ijl", points - cylinder.directrix[:, None], cylinder.frames)


def turn(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def ratios_to_polygons(cylinder: GeneralizedCylinder) -> np.ndarray:
    """Effective points by the polygons of `surface()`, by plain geometry: inside when at most 1."""
    vertices = in_plane(cylinder, cylinder.surface())[:, None, :, 1:]
    following = np.roll(vertices, -1, axis=2)
    points = in_plane(cylinder, cylinder.effective_points)[:, :, None, 1:]
    edge = following - vertices
    outward = np.stack((edge[..., 1], -edge[..., 0]), axis=-1)
    within = (turn(vertices, points) >= -1e-15) & (turn(points, following) >= -1e-15)
    assert within.any(axis=2).all(), "every direction belongs to an edge"
    height = (points * outward).sum(-1) / (vertices * outward).sum(-1)
    return np.where(within, height, 0.0).max(axis=2)


@settings(max_examples=40, deadline=None)
@given(
    seed=seeds,
    count=st.integers(1, 9),
    section=sections,
    align_by=alignments,
    angles=st.sampled_from([8, 64, 129]),
)
def test_every_effective_point_is_inside_its_section(
    seed: int, count: int, section: str, align_by: str, angles: int
) -> None:
    cylinder = encode(bundle(seed, count), section=section, align_by=align_by, angles=angles, stations=60)

    assert ratios_to_polygons(cylinder).max() <= 1.0 + 1e-12


@settings(max_examples=30, deadline=None)
@given(seed=seeds, count=st.integers(1, 6), section=sections)
def test_the_least_half_width_holds(seed: int, count: int, section: str) -> None:
    cylinder = encode(
        bundle(seed, count, spread=1e-6), section=section, stations=50, minimum_half_width=0.003
    )

    assert cylinder.radii.min() >= 0.003


@settings(max_examples=30, deadline=None)
@given(seed=seeds, section=sections)
def test_effective_points_lie_in_their_planes(seed: int, section: str) -> None:
    cylinder = encode(bundle(seed), section=section, stations=50)

    np.testing.assert_allclose(in_plane(cylinder, cylinder.effective_points)[..., 0], 0.0, atol=1e-12)


def test_effective_points_are_true_crossings_of_the_recorded_lines() -> None:
    shown = bundle(3, samples=20)
    cylinder = encode(shown, stations=80)

    for j, demonstration in enumerate(shown):
        points = cylinder.effective_points[~cylinder.diagnostics.missed[:, j], j]
        begin, step = demonstration.positions[:-1], np.diff(demonstration.positions, axis=0)
        part = ((points[:, None] - begin) * step).sum(-1) / (step**2).sum(-1)
        foot = begin + np.clip(part, 0.0, 1.0)[..., None] * step
        np.testing.assert_allclose(
            np.linalg.norm(points[:, None] - foot, axis=2).min(axis=1), 0.0, atol=1e-12
        )


@settings(max_examples=30, deadline=None)
@given(seed=seeds, turn=seeds, section=sections, align_by=alignments)
def test_encoding_commutes_with_rigid_motion(seed: int, turn: int, section: str, align_by: str) -> None:
    shown, linear, shift = bundle(seed), rotation(turn), np.array([1.0, -2.0, 0.5])
    here = encode(shown, section=section, align_by=align_by, stations=50)
    there = encode(moved(shown, linear, shift), section=section, align_by=align_by, stations=50)

    np.testing.assert_allclose(there.directrix, here.directrix @ linear.T + shift, atol=1e-9)
    np.testing.assert_allclose(there.frames, linear @ here.frames, atol=1e-7)
    np.testing.assert_allclose(there.radii, here.radii, rtol=1e-3, atol=1e-6)


@settings(max_examples=30, deadline=None)
@given(seed=seeds, scale=st.floats(0.5, 20.0), section=sections)
def test_encoding_commutes_with_scaling(seed: int, scale: float, section: str) -> None:
    shown = bundle(seed)
    here = encode(shown, section=section, stations=50)
    there = encode(
        moved(shown, scale * np.eye(3), np.zeros(3)),
        section=section,
        stations=50,
        minimum_half_width=0.001 * scale,
    )

    np.testing.assert_allclose(there.directrix, scale * here.directrix, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(there.radii, scale * here.radii, rtol=1e-5)


@settings(max_examples=30, deadline=None)
@given(seed=seeds, order=st.permutations(range(5)), section=sections)
def test_the_order_of_the_demonstrations_does_not_matter(seed: int, order: list[int], section: str) -> None:
    shown = bundle(seed, 5)
    one, other = encode(shown, section=section), encode([shown[j] for j in order], section=section)

    np.testing.assert_allclose(other.directrix, one.directrix, atol=1e-12)
    np.testing.assert_allclose(other.radii, one.radii, rtol=1e-6)


SYMMETRIC = {
    "two lines": [(0.0, 0.0), (0.05, 0.03)],
    "the same twice": [(0.0, 0.0), (0.0, 0.0), (0.1, 0.02)],
    "a square": [(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.0, 0.1)],
    "a square and the middle of a side": [(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.0, 0.1), (0.05, 0.0)],
}


def parallel(places: list[tuple[float, float]]) -> list[Demonstration]:
    return [line((0.0, y, z), (0.5, y, z)) for y, z in places]


@settings(max_examples=40, deadline=None)
@given(places=st.sampled_from(sorted(SYMMETRIC)), section=sections, data=st.data())
def test_the_order_does_not_matter_where_ties_could_decide(
    places: str, section: str, data: st.DataObject
) -> None:
    shown = parallel(SYMMETRIC[places])
    order = data.draw(st.permutations(range(len(shown))))
    one = encode(shown, section=section, stations=20)
    other = encode([shown[j] for j in order], section=section, stations=20)

    np.testing.assert_array_equal(other.surface(), one.surface())
    np.testing.assert_array_equal(other.frames, one.frames)
    np.testing.assert_array_equal(other.effective_points, one.effective_points[:, order])
    np.testing.assert_array_equal(other.aligned, one.aligned[order])


@settings(max_examples=30, deadline=None)
@given(turn=seeds, section=sections)
def test_a_demonstration_between_two_others_bends_their_side_alike_in_all_directions(
    turn: int, section: str
) -> None:
    shown = parallel(SYMMETRIC["a square and the middle of a side"])
    here = encode(shown, section=section, stations=20)
    there = encode(moved(shown, rotation(turn), np.zeros(3)), section=section, stations=20)

    np.testing.assert_allclose(there.volume, here.volume, rtol=1e-6)


def test_what_is_said_of_a_demonstration_is_said_in_the_order_given() -> None:
    late, early = with_pause(bundle(1, 1)[0], 0.0, 2.0), bundle(1, 2)[1]

    for shown in ([late, early], [early, late]):
        told = encode(shown).diagnostics
        assert [cut > 1.0 for cut in told.trimmed_start] == [d is late for d in shown]


def test_mean_orientations_have_signs_that_ignore_the_order() -> None:
    first, second = bundle(1, 2)
    quaternion = np.array([0.8, 0.6, 0.0, 0.0])
    shown = [
        Demonstration(d.times, d.positions, np.tile(sign * quaternion, (len(d.times), 1)))
        for d, sign in ((first, 1.0), (second, -1.0))
    ]

    np.testing.assert_array_equal(encode(shown).orientations, encode(shown[::-1]).orientations)


@settings(max_examples=20, deadline=None)
@given(seed=seeds, section=sections)
def test_sections_change_slowly_along_the_curve(seed: int, section: str) -> None:
    cylinder = encode(bundle(seed, 5), section=section)

    slope = np.abs(np.diff(cylinder.radii, axis=0)) / np.diff(cylinder.arc_length)[:, None]
    assert slope.max() <= 2.0 + 1e-9


@pytest.mark.parametrize("section", sorted(SECTIONS))
@pytest.mark.parametrize("count", [2, 3, 5])
def test_demonstrations_side_by_side_in_a_plane_work(section: str, count: int) -> None:
    shown = [line((0.0, 0.03 * j, 0.0), (0.5, 0.03 * j, 0.0)) for j in range(count)]
    cylinder = encode(shown, section=section)

    assert np.isfinite(cylinder.surface()).all()
    assert ratios_to_polygons(cylinder).max() <= 1.0 + 1e-12


@pytest.mark.parametrize("section", sorted(SECTIONS))
def test_demonstrations_that_meet_in_one_point_work(section: str) -> None:
    cylinder = encode(
        [line((0.0, 0.0, 0.0), (0.5, y, z)) for y, z in ((0, 0.1), (0.1, 0), (0, -0.1))], section=section
    )

    assert np.isfinite(cylinder.surface()).all()
    assert cylinder.radii.min() >= 0.001


def test_identical_demonstrations_give_the_least_tube_around_them() -> None:
    shown = line((0.0, 0.0, 0.0), (0.3, 0.2, 0.1))
    cylinder = encode([shown, shown], section="circle")

    np.testing.assert_allclose(cylinder.radii, 0.001, rtol=0.01)


@pytest.mark.parametrize("section", sorted(SECTIONS))
def test_one_demonstration_gives_a_tube_of_stated_width_and_says_so(section: str) -> None:
    cylinder = encode(bundle(1, 1), section=section, single_half_width=0.03)

    np.testing.assert_allclose(cylinder.radii, 0.03, rtol=0.02)
    assert any("6 cm wide" in sentence for sentence in cylinder.diagnostics.sentences())


def test_the_hull_is_tighter_than_the_spline_and_the_spline_than_the_circle() -> None:
    volumes = [encode(bundle(2, 5), section=kind).volume for kind in ("hull", "closed_spline", "circle")]

    assert volumes == sorted(volumes)


def test_the_volume_of_a_straight_round_tube_is_that_of_a_prism() -> None:
    cylinder = encode(
        [line((0.0, 0.0, 0.0), (0.5, 0.0, 0.0))], section="circle", single_half_width=0.05, angles=64
    )
    area = 0.5 * 64 * np.sin(2.0 * np.pi / 64) * cylinder.radii[0, 0] ** 2

    np.testing.assert_allclose(cylinder.volume, area * 0.5, rtol=1e-9)


def with_pause(demonstration: Demonstration, part: float, seconds: float) -> Demonstration:
    index = int(part * len(demonstration.times))
    wait = np.full(int(100 * seconds), index)
    order = np.concatenate((np.arange(index), wait, np.arange(index, len(demonstration.times))))
    return Demonstration(0.02 * np.arange(len(order)), demonstration.positions[order])


def test_arc_length_alignment_ignores_pauses() -> None:
    shown = bundle(5, 4)
    paused = [with_pause(demonstration, 0.2 * (j + 1), 3.0) for j, demonstration in enumerate(shown)]
    even, uneven = (encode(each, align_by="arc_length").directrix for each in (shown, paused))

    assert np.linalg.norm(even - uneven, axis=1).max() < 0.005


@pytest.mark.parametrize("align_by", ALIGNMENTS)
def test_the_mean_time_law_keeps_a_pause_that_all_make(align_by: str) -> None:
    paused = [with_pause(demonstration, 0.5, 3.0) for demonstration in bundle(6, 3)]
    times = encode(paused, align_by=align_by).times

    assert (np.diff(times) > 0.0).all()
    np.testing.assert_allclose(times[-1], np.mean([d.times[-1] for d in paused]), rtol=0.02)
    assert np.diff(times).max() > 2.0


def test_a_given_directrix_is_used() -> None:
    curve = np.outer(np.linspace(0.0, 1.0, 300), [0.5, 0.15, 0.1])
    cylinder = encode(bundle(7), directrix=curve)

    np.testing.assert_allclose(cylinder.directrix[[0, -1]], curve[[0, -1]], atol=1e-12)
    np.testing.assert_allclose(np.cross(np.diff(cylinder.directrix, axis=0), curve[-1]), 0.0, atol=1e-12)


def test_orientations_are_averaged_as_rotations_whatever_their_signs() -> None:
    angles = np.array([-0.2, 0.1, 0.4])
    shown = []
    for j, (angle, plain) in enumerate(zip(angles, bundle(8, 3), strict=True)):
        quaternion = (-1.0) ** j * np.array([np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)])
        shown.append(Demonstration(plain.times, plain.positions, np.tile(quaternion, (len(plain.times), 1))))

    mean = encode(shown).orientations

    assert mean is not None
    np.testing.assert_allclose(np.abs(mean[:, 3] / mean[:, 0]), np.tan(0.1 / 2), atol=1e-3)


def test_orientations_that_one_demonstration_lacks_are_left_out() -> None:
    first, second = bundle(9, 2)
    with_one = Demonstration(first.times, first.positions, np.tile([1.0, 0, 0, 0], (len(first.times), 1)))

    assert encode([with_one, second]).orientations is None


def test_the_gripper_follows_the_majority_and_switches_once() -> None:
    closing = (0.4, 0.5, 0.9)
    shown = [
        Demonstration(d.times, d.positions, gripper=(np.linspace(0, 1, len(d.times)) > at).astype(float))
        for d, at in zip(bundle(10, 3), closing, strict=True)
    ]
    gripper = encode(shown).gripper

    assert gripper is not None
    assert np.count_nonzero(np.diff(gripper)) == 1
    assert set(np.unique(gripper)) == {0.0, 1.0}


@pytest.mark.parametrize(
    ("error", "options"),
    [
        (UnknownOptionError, {"section": "square"}),
        (UnknownOptionError, {"align_by": "distance"}),
        (UnknownOptionError, {"directrix": "median"}),
        (InvalidSettingError, {"stations": 3}),
        (InvalidSettingError, {"stations": np.nan}),
        (InvalidSettingError, {"angles": np.inf}),
        (InvalidSettingError, {"angles": 2}),
        (InvalidSettingError, {"minimum_half_width": 0.0}),
        (InvalidSettingError, {"minimum_half_width": 1e-200}),
        (InvalidSettingError, {"minimum_half_width": 1e160}),
        (GcError, {"directrix": np.array([[0.0, 0.0, 0.0], [1e160, 0.0, 0.0]])}),
        (GcError, {"directrix": np.zeros((5, 2))}),
    ],
)
def test_unknown_options_are_refused(error: type[GcError], options: dict) -> None:
    with pytest.raises(error):
        encode(bundle(0), **options)


def test_the_valid_options_are_named() -> None:
    with pytest.raises(UnknownOptionError, match="'time', 'arc_length'"):
        encode(bundle(0), align_by="distance")


def test_nothing_shown_is_refused() -> None:
    with pytest.raises(NoDemonstrationsError):
        encode([])


def test_demonstrations_in_opposite_directions_are_refused() -> None:
    with pytest.raises(OpposedDemonstrationsError):
        encode([line((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)), line((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))])


def test_the_slope_says_where_circles_are_no_envelope_of_spheres() -> None:
    def cone(growth: float) -> GeneralizedCylinder:
        sides = [(1.0, growth, 0.0), (1.0, -growth, 0.0), (1.0, 0.0, growth), (1.0, 0.0, -growth)]
        return encode([line((0.0, 0.0, 0.0), side) for side in sides], section="circle")

    np.testing.assert_allclose(np.median(cone(0.3).slope), 0.3, rtol=0.01)
    assert (cone(0.9).slope < 1.0).all()
    assert (cone(1.3).slope > 1.0).any()


@settings(max_examples=20, deadline=None)
@given(seed=seeds, section=sections, angles=st.sampled_from([8, 32, 41]))
def test_a_coarser_tube_still_holds_every_effective_point(seed: int, section: str, angles: int) -> None:
    cylinder = coarser(encode(bundle(seed), section=section, stations=60), angles)

    assert cylinder.surface().shape == (60, angles, 3)
    assert ratios_to_polygons(cylinder).max() <= 1.0 + 1e-9


def test_a_tube_that_is_coarse_enough_stays_the_same() -> None:
    cylinder = encode(bundle(3), stations=60, angles=32)

    assert coarser(cylinder, 32) is cylinder


def test_a_tube_is_made_coarser_once() -> None:
    cylinder = encode(bundle(3), stations=60)

    assert coarser(cylinder, 32) is coarser(cylinder, 32)
