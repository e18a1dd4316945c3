"""What the measurements call wrong is wrong: each of them finds a fault that was put in."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gc_core import Demonstration, GeneralizedCylinder, encode
from gc_core.arrays import FloatArray
from tests.core.shapes import bundle, line
from tests.measurements import geometry, runs

BEND = 0.2
"""Radius of the arc [m]."""


@pytest.fixture(scope="module")
def straight() -> GeneralizedCylinder:
    """Around four parallel lines through the corners of a square, 2 cm from their middle."""
    corners = 0.02 * np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])
    shown = [line(tuple(corner), tuple(corner + np.array([0.5, 0.0, 0.0]))) for corner in corners]
    return encode(shown, section="circle", stations=50, angles=128)


def around_a_bend(radius: float) -> GeneralizedCylinder:
    """A tube of a radius [m] around a quarter of a circle, its planes across it."""
    angle = np.linspace(0.0, np.pi / 2.0, 200)
    arc = BEND * np.stack((np.cos(angle), np.sin(angle), 0.0 * angle), axis=1)
    thin = encode([Demonstration(angle, arc)], stations=50)
    return replace(thin, radii=np.full_like(thin.radii, radius))


def test_a_tube_wider_than_its_bend_cuts_itself_everywhere() -> None:
    assert geometry.cutting_stations(around_a_bend(1.1 * BEND)).all()
    assert geometry.overlapping_stations(around_a_bend(1.1 * BEND)).all()


def test_a_tube_narrower_than_its_bend_cuts_itself_nowhere() -> None:
    assert not geometry.cutting_stations(around_a_bend(0.9 * BEND)).any()
    assert not geometry.overlapping_stations(around_a_bend(0.9 * BEND)).any()


def test_a_section_that_is_turned_over_cuts_its_neighbours(straight: GeneralizedCylinder) -> None:
    frames = straight.frames.copy()
    tangent, n, b = frames[20].T
    frames[20] = np.stack((n, -tangent, b), axis=1)
    turned = replace(straight, frames=frames)

    np.testing.assert_array_equal(np.flatnonzero(geometry.cutting_stations(turned)), [19, 20, 21])
    np.testing.assert_allclose(geometry.tilts(turned)[20], np.pi / 2.0)


def test_a_directrix_that_runs_backwards_cuts_its_neighbours(straight: GeneralizedCylinder) -> None:
    directrix = straight.directrix.copy()
    directrix[20] = directrix[18] - 1e-3

    assert geometry.cutting_stations(replace(straight, directrix=directrix))[[19, 20]].all()


def test_a_circle_round_a_square_has_half_pi_of_its_area(straight: GeneralizedCylinder) -> None:
    np.testing.assert_allclose(geometry.area_ratios(straight), np.pi / 2.0, rtol=2e-3)


def test_thin_hulls_are_left_out_of_the_area() -> None:
    flat = encode([line((0.0, y, 0.0), (0.5, y, 0.0)) for y in (-0.02, 0.0, 0.02)], stations=50)

    assert len(geometry.area_ratios(flat)) == 0


def test_a_section_that_is_too_small_leaves_points_outside(straight: GeneralizedCylinder) -> None:
    assert geometry.ratios_to_polygons(straight).max() <= geometry.HELD
    shrunk = replace(straight, radii=0.9 * straight.radii)
    np.testing.assert_allclose(geometry.ratios_to_polygons(shrunk).max(), 1.0 / 0.9, rtol=1e-3)


def test_a_polygon_beside_its_centre_is_found(straight: GeneralizedCylinder) -> None:
    radii = straight.radii.copy()
    radii[7, 60:] *= -1.0

    np.testing.assert_array_equal(
        np.flatnonzero(~geometry.centres_inside(replace(straight, radii=radii))), [7]
    )


def test_an_effective_point_that_is_no_crossing_is_found() -> None:
    shown = bundle(0)
    cylinder = encode(shown)
    points = cylinder.effective_points.copy()
    where = int(np.flatnonzero(~cylinder.diagnostics.missed[:, 0])[50])
    points[where, 0] += 0.001 * cylinder.frames[where, :, 1]

    assert geometry.off_demonstrations(cylinder, shown) < 1e-9
    np.testing.assert_allclose(
        geometry.off_demonstrations(replace(cylinder, effective_points=points), shown), 0.001, rtol=1e-6
    )


def test_misses_at_the_ends_are_told_from_those_inside() -> None:
    missed = np.zeros((10, 2), dtype=bool)
    missed[:2, 0] = missed[9, 1] = missed[5, 1] = True

    assert geometry.missed_at_ends_and_inside(missed) == (3, 1)


def path_of(steps: FloatArray) -> FloatArray:
    """One path (1, K + 1, 3) with these steps (K,)."""
    x = np.concatenate(([0.0], np.cumsum(steps)))
    return np.stack((x, 0.0 * x, 0.0 * x), axis=1)[None]


@pytest.mark.parametrize("where", [0, 3, 30, 59])
def test_a_long_step_is_found_wherever_it_is(where: int) -> None:
    steps = np.full(60, 0.01)
    steps[where] = 0.06
    ratios = geometry.steps_by_median(path_of(steps))[0]

    np.testing.assert_allclose(ratios, np.where(np.arange(60) == where, 6.0, 1.0))


def test_waiting_is_no_step_and_does_not_lower_the_median() -> None:
    steps = np.concatenate((np.zeros(40), np.full(20, 0.01)))

    np.testing.assert_allclose(geometry.steps_by_median(path_of(steps))[0], [0.0] * 40 + [1.0] * 20)


def test_the_median_is_that_of_the_21_steps_around() -> None:
    steps = np.random.default_rng(0).uniform(0.001, 0.01, 60)
    ratios = geometry.steps_by_median(path_of(steps))[0]

    for at in range(60):
        around = steps[max(at - 10, 0) : at + 11]
        np.testing.assert_allclose(ratios[at], steps[at] / np.median(around))


def test_samples_beyond_the_boundary_are_outside(straight: GeneralizedCylinder) -> None:
    stations = np.arange(50, dtype=np.float64)
    ring = straight.surface()[:, ::16] - straight.directrix[:, None]
    for share, held in ((0.99, True), (1.01, False)):
        paths = np.swapaxes(straight.directrix[:, None] + share * ring, 0, 1)
        assert (runs.inside(straight, paths, stations) == held).all()


def test_starts_anywhere_lie_in_the_tube(straight: GeneralizedCylinder) -> None:
    starts = runs.anywhere(straight, 500, np.random.default_rng(0))

    assert straight.contains(starts).all()
    assert np.ptp(starts[:, 0]) > 0.45
