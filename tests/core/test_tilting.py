"""Sections that would cross their neighbours are found and mended by tilting the planes; the rest stays."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gc_core import Demonstration, GeneralizedCylinder, Landmark, encode, generalize, register, reproduce
from gc_core.arrays import FloatArray
from gc_core.frames import tangents
from gc_core.sections import SECTIONS
from tests.core.shapes import bundle, line, moved, rotation, seeds
from tests.core.steps import worst_step_ratio
from tests.core.test_encode import in_plane, ratios_to_polygons
from tests.helpers_data import ALL_SETS, load

every_section = pytest.mark.parametrize("section", sorted(SECTIONS))


def bend(radius: float, reach: float, turn: float = 0.5 * np.pi) -> list[Demonstration]:
    """Four demonstrations round a bend; on its inside they reach as far as `reach` from the middle one."""
    legs, samples = 0.3, 400
    along = np.linspace(0.0, 2.0 * legs + radius * turn, samples)
    angle = np.clip((along - legs) / radius, 0.0, turn)
    before = np.minimum(along, legs)[:, None] * [1.0, 0.0, 0.0]
    after = np.maximum(along - legs - radius * turn, 0.0)[:, None] * [np.cos(turn), np.sin(turn), 0.0]
    round_ = radius * np.stack((np.sin(angle), 1.0 - np.cos(angle), 0.0 * angle), axis=1)
    middle = before + round_ + after
    inward = np.stack((-np.sin(angle), np.cos(angle), 0.0 * angle), axis=1)
    times = np.linspace(0.0, 5.0, samples)
    offsets = (reach * inward, -reach * inward, [0.0, 0.0, 0.03], [0.0, 0.0, -0.03])
    return [Demonstration(times, middle + offset) for offset in offsets]


@every_section
@pytest.mark.parametrize("reach", [0.05, 0.06])
def test_sections_wider_than_their_bend_are_found_and_mended(section: str, reach: float) -> None:
    shown = bend(0.048, reach)

    upright = encode(shown, section=section, align_by="arc_length", repair=False)
    mended = encode(shown, section=section, align_by="arc_length")

    assert upright.diagnostics.crossing.any()
    assert not upright.diagnostics.tilt.any()
    assert not mended.diagnostics.crossing.any()
    assert mended.diagnostics.tilt.max() > np.radians(2.0)


@every_section
def test_tilted_sections_hold_true_crossings_of_the_demonstrations(section: str) -> None:
    shown = bend(0.048, 0.06)
    cylinder = encode(shown, section=section, align_by="arc_length")

    np.testing.assert_allclose(in_plane(cylinder, cylinder.effective_points)[..., 0], 0.0, atol=1e-9)
    assert ratios_to_polygons(cylinder).max() <= 1.0 + 1e-9
    inner = ~cylinder.diagnostics.missed
    for j, demonstration in enumerate(shown):
        pieces = demonstration.positions[:-1], demonstration.positions[1:]
        for point in cylinder.effective_points[inner[:, j], j][::10]:
            assert distance_to_pieces(point, *pieces) < 1e-9


def distance_to_pieces(point: np.ndarray, begin: np.ndarray, end: np.ndarray) -> float:
    along = end - begin
    part = np.einsum("ij,ij->i", point - begin, along) / np.einsum("ij,ij->i", along, along)
    nearest = begin + np.clip(part, 0.0, 1.0)[:, None] * along
    return float(np.linalg.norm(nearest - point, axis=1).min())


@settings(max_examples=20, deadline=None)
@given(seed=seeds)
def test_where_nothing_crosses_the_planes_are_perpendicular(seed: int) -> None:
    cylinder = encode(bundle(seed))

    if not encode(bundle(seed), repair=False).diagnostics.crossing.any():
        assert not cylinder.diagnostics.tilt.any()
        np.testing.assert_array_equal(cylinder.frames[:, :, 0], tangents(cylinder.directrix))


def test_straight_motions_have_no_crossing_sections() -> None:
    straight = encode([line((0.0, y, 0.0), (1.0, y, 0.0)) for y in (0.0, 0.1)])

    assert not straight.diagnostics.crossing.any()
    assert not straight.diagnostics.tilt.any()


@settings(max_examples=10, deadline=None)
@given(seed=seeds, shift=st.floats(-1.0, 1.0))
def test_the_mended_tube_moves_with_its_demonstrations(seed: int, shift: float) -> None:
    shown, turn = bend(0.048, 0.06), rotation(seed)
    one = encode(shown, align_by="arc_length")
    other = encode(moved(shown, turn, np.full(3, shift)), align_by="arc_length")

    np.testing.assert_allclose(other.surface(), one.surface() @ turn.T + shift, atol=1e-6)
    np.testing.assert_allclose(other.diagnostics.tilt, one.diagnostics.tilt, atol=1e-6)


@settings(max_examples=10, deadline=None)
@given(seed=seeds)
def test_a_rigid_map_moves_a_mended_tube(seed: int) -> None:
    cylinder, turn = encode(bend(0.048, 0.06), align_by="arc_length"), rotation(seed)
    source = cylinder.directrix[[0, 60, 120, 199]] + np.eye(4, 3)
    moved_tube = generalize(cylinder, register(source, source @ turn.T + 0.1))

    np.testing.assert_allclose(moved_tube.surface(), cylinder.surface() @ turn.T + 0.1, atol=1e-7)
    np.testing.assert_allclose(moved_tube.diagnostics.tilt, cylinder.diagnostics.tilt, atol=1e-6)


def test_a_map_that_bends_the_tube_too_sharply_is_mended_too() -> None:
    tube = encode([line((0.0, y, z), (1.0, y, z)) for y, z in ((-0.08, 0.0), (0.08, 0.0), (0.0, 0.05))])
    source = [
        Landmark(np.array(p)) for p in ((0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (0.5, 0.2, 0.0), (1.0, 0.0, 0.0))
    ]
    target = [
        Landmark(np.array(p)) for p in ((0.0, 0.0, 0.0), (0.5, 0.1, 0.0), (0.5, 0.14, 0.0), (0.62, -0.2, 0.0))
    ]
    bent = register(source, target)

    upright = generalize(tube, bent, repair=False).diagnostics.crossing.sum()
    assert upright > 0
    assert generalize(tube, bent).diagnostics.crossing.sum() < upright


@pytest.mark.parametrize("section", ["closed_spline", "circle", "hull"])
@pytest.mark.parametrize("name", ALL_SETS)
def test_at_most_one_in_fifty_sections_of_any_recording_crosses_a_neighbour(name: str, section: str) -> None:
    cylinder = encode(load(name), section=section, align_by="arc_length")

    assert cylinder.diagnostics.crossing.mean() <= 0.02


def test_frames_of_tilted_sections_do_not_spin() -> None:
    cylinder = encode(load("pouring"), section="hull", align_by="time")
    starts = cylinder.directrix[0] + 0.9 * (cylinder.surface()[0, ::4] - cylinder.directrix[0])

    assert cylinder.diagnostics.tilt.max() > np.radians(45.0)
    assert worst_step_ratio(reproduce(cylinder, starts, at=0).positions).max() < 5.0


def hooked(back: float) -> list[Demonstration]:
    """Two straight motions that begin by going back a little."""
    along = np.concatenate((np.linspace(0.0, -back, 20), np.linspace(-back, 0.5, 400)[1:]))
    side = np.array([0.0, 0.02, 0.0])
    path = along[:, None] * [1.0, 0.0, 0.0]
    return [Demonstration(0.01 * np.arange(len(path)), path + shift) for shift in (side, -side)]


def ahead(cylinder: GeneralizedCylinder) -> bool:
    return bool((np.diff(cylinder.directrix[:, 0]) > 0.0).all())


@pytest.mark.parametrize("align_by", ["time", "arc_length"])
def test_a_small_hook_of_the_hand_is_left_out_of_the_directrix(align_by: str) -> None:
    cylinder = encode(hooked(0.006), align_by=align_by)

    assert ahead(cylinder)
    assert cylinder.diagnostics.smoothed.any()
    assert not cylinder.diagnostics.smoothed[10:].any()
    assert not cylinder.diagnostics.crossing.any()
    np.testing.assert_allclose(cylinder.directrix[[0, -1]], [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]], atol=1e-12)


def rounded_hook(radius: float, back: float) -> FloatArray:
    """A straight motion that turns round, goes back a little and turns round again."""
    turn = np.linspace(0.0, np.pi, 200)
    sine, rise = radius * np.sin(turn), radius * (1.0 - np.cos(turn))
    along = np.concatenate(
        (
            np.linspace(0.0, 0.25, 1500),
            0.25 + sine[1:],
            0.25 - np.linspace(0.0, back, 200)[1:],
            0.25 - back - sine[1:],
            np.linspace(0.25 - back, 0.5, 1500)[1:],
        )
    )
    aside = np.concatenate(
        (np.zeros(1500), rise[1:], np.full(199, rise[-1]), rise[-1] + rise[1:], np.full(1499, 2.0 * rise[-1]))
    )
    return np.stack((along, aside, 0.0 * along), axis=1)


@pytest.mark.parametrize("stations", [200, 500, 1000, 2000])
def test_a_rounded_hook_is_left_out_however_many_stations_there_are(stations: int) -> None:
    path, side = rounded_hook(0.001, 0.004), np.array([0.0, 0.0, 0.02])
    shown = [Demonstration(0.001 * np.arange(len(path)), path + shift) for shift in (side, -side)]
    cylinder = encode(shown, stations=stations, align_by="arc_length")

    assert cylinder.diagnostics.smoothed.any()
    assert cylinder.diagnostics.crossing.sum() <= 2


def test_a_long_way_back_stays_in_the_directrix() -> None:
    cylinder = encode(hooked(0.1), align_by="arc_length")

    assert not ahead(cylinder)
    assert not cylinder.diagnostics.smoothed.any()


def test_a_point_does_not_jump_when_a_plane_passes_the_beginning_of_its_demonstration() -> None:
    late = line((0.2, 0.03, 0.0), (1.0, 0.03, 0.0))
    shown = [line((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)), late]
    cylinder = encode(shown, align_by="time")

    jumps = np.linalg.norm(np.diff(cylinder.effective_points, axis=0), axis=2)
    assert jumps.max() <= 1.01 * np.diff(cylinder.arc_length).max()
    assert cylinder.diagnostics.missed[:, 1].any()
    assert not cylinder.diagnostics.missed[-1].any()


@every_section
def test_the_volume_of_a_motion_that_turns_back_on_itself_is_positive(section: str) -> None:
    def there_and_back(top: tuple[float, float, float], end: tuple[float, float, float]) -> Demonstration:
        corners = np.array([(0.01, -0.5, 0.25), top, end])
        path = np.concatenate([np.linspace(a, b, 80)[:-1] for a, b in pairwise(corners)] + [corners[-1:]])
        return Demonstration(np.linspace(0.0, 8.0, len(path)), path)

    shown = [
        there_and_back((-0.02, -0.52, 0.43), (-0.03, -0.55, 0.08)),
        there_and_back((-0.08, -0.56, 0.46), (-0.05, -0.55, 0.08)),
    ]

    assert encode(shown, section=section).volume > 1e-4
