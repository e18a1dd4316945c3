"""Recordings of people and arms that nobody tuned for; skipped where they are not present.

Every set, every kind of section and every alignment is measured once (`tests.measurements`); each
test looks at one thing that must hold.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from gc_core import GeneralizedCylinder, encode, generalize, register, reproduce
from gc_core.alignment import ALIGNMENTS
from gc_core.radius import GREATEST_SLOPE
from gc_core.sections import SECTIONS
from tests.core.shapes import moved, rotation
from tests.helpers_data import ALL_SETS, POSE_SETS, load
from tests.measurements import geometry, runs
from tests.measurements.sections import CUTTING, STATIONS, TIGHT, TIGHT_ANGLES, Measured, measure

every_set = pytest.mark.parametrize("name", ALL_SETS)
every_section = pytest.mark.parametrize("section", sorted(SECTIONS))
every_alignment = pytest.mark.parametrize("align_by", ALIGNMENTS)

STARTS = 1000


@cache
def tube(name: str, section: str, align_by: str) -> GeneralizedCylinder:
    return encode(load(name), section=section, align_by=align_by, stations=STATIONS, angles=TIGHT_ANGLES)


@cache
def measured(name: str, section: str, align_by: str) -> Measured:
    return measure(name, load(name), tube(name, section, align_by), align_by, STARTS)


@every_set
@every_section
@every_alignment
def test_every_number_is_finite(name: str, section: str, align_by: str) -> None:
    assert measured(name, section, align_by).finite


@every_set
@every_section
@every_alignment
def test_every_effective_point_is_inside_its_section(name: str, section: str, align_by: str) -> None:
    assert measured(name, section, align_by).ratio <= geometry.HELD


@every_set
@every_section
@every_alignment
def test_every_centre_is_inside_its_section(name: str, section: str, align_by: str) -> None:
    assert measured(name, section, align_by).centres_outside == 0


@every_set
@every_section
@every_alignment
def test_effective_points_are_crossings_unless_said_to_be_missed(
    name: str, section: str, align_by: str
) -> None:
    found = measured(name, section, align_by)

    assert found.off <= 1e-9
    assert found.flat <= 1e-9


@every_set
@every_section
@every_alignment
def test_sections_widen_by_a_stated_slope_at_most(name: str, section: str, align_by: str) -> None:
    assert measured(name, section, align_by).slope <= GREATEST_SLOPE + 1e-6


@every_set
@every_section
@every_alignment
def test_the_tilt_that_is_told_is_that_of_the_planes(name: str, section: str, align_by: str) -> None:
    assert measured(name, section, align_by).tilt_error <= 1e-3


@every_set
@every_section
@every_alignment
def test_every_station_that_cuts_a_neighbour_is_named(name: str, section: str, align_by: str) -> None:
    assert measured(name, section, align_by).unnamed == 0


@every_set
@every_section
@every_alignment
def test_no_run_from_inside_leaves_the_tube(name: str, section: str, align_by: str) -> None:
    found = measured(name, section, align_by)

    assert found.first.outside == 0
    assert found.anywhere.outside == 0


@every_set
@every_section
@every_alignment
def test_no_run_jumps(name: str, section: str, align_by: str) -> None:
    found = measured(name, section, align_by)

    assert found.first.worst <= runs.JUMP
    assert found.anywhere.worst <= runs.JUMP


@every_set
@every_alignment
def test_the_hull_is_as_tight_as_stated(name: str, align_by: str) -> None:
    assert measured(name, "hull", align_by).area <= TIGHT


@every_set
@every_section
@every_alignment
def test_the_tube_contains_its_runs(name: str, section: str, align_by: str) -> None:
    cylinder = tube(name, section, align_by)
    starts = runs.in_first_section(cylinder, 50, np.random.default_rng(1))
    positions = reproduce(cylinder, starts).positions

    assert cylinder.contains(positions.reshape(-1, 3)).all()


@every_set
@every_alignment
def test_a_run_from_each_demonstration_s_start_is_finite(name: str, align_by: str) -> None:
    cylinder = tube(name, "closed_spline", align_by)

    for demonstration in load(name):
        run = reproduce(cylinder, demonstration.positions[0], law="convergent")
        assert np.isfinite(run.positions).all()
        np.testing.assert_allclose(run.positions[0], demonstration.positions[0], atol=1e-12)


@every_set
@every_section
def test_moved_ends_are_met_and_effective_points_stay_inside(name: str, section: str) -> None:
    cylinder = encode(load(name), section=section, align_by="arc_length")
    ends = cylinder.directrix[[0, -1]]
    for seed in range(5):
        targets = ends + np.random.default_rng(seed).uniform(-0.1, 0.1, size=(2, 3))
        moved = generalize(cylinder, register(ends, targets))
        np.testing.assert_allclose(moved.directrix[[0, -1]], targets, atol=1e-9)
        assert np.isfinite(moved.surface()).all()
        assert geometry.ratios_to_polygons(moved).max() <= geometry.HELD


@pytest.mark.parametrize("name", [*POSE_SETS, "lab"])
def test_orientations_are_unit_and_continuous(name: str) -> None:
    orientations = encode(load(name), align_by="arc_length").orientations

    assert orientations is not None
    np.testing.assert_allclose(np.linalg.norm(orientations, axis=1), 1.0, atol=1e-9)
    assert (np.einsum("ij,ij->i", orientations[1:], orientations[:-1]) > 0.8).all()


def test_the_lab_s_stationary_ends_are_cut() -> None:
    diagnostics = encode(load("lab")).diagnostics

    assert (diagnostics.trimmed_end > 1.0).all()
    assert (diagnostics.trimmed_end < 6.0).all()


@every_set
@every_section
@every_alignment
def test_few_stations_cut_a_neighbour(name: str, section: str, align_by: str) -> None:
    found = measured(name, section, align_by)

    assert max(found.cutting, found.overlapping) <= CUTTING * STATIONS


@every_set
def test_a_moved_set_has_the_moved_tube(name: str) -> None:
    turn, shift = rotation(0), np.array([0.3, -0.2, 0.5])
    surface = encode(load(name), section="hull").surface()
    turned = encode(moved(load(name), turn, shift), section="hull").surface()

    np.testing.assert_allclose(turned, surface @ turn.T + shift, atol=1e-9)
