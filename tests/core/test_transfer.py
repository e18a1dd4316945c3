"""Tubes that move with landmarks: every promise holds after any move, and they go where people would go.

Measured by `tests.measurements.transfer`, which makes docs/transfer.md with 25 times as many moves, at
200 stations.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from app.model import STIFFNESS
from gc_core import GeneralizedCylinder, encode, generalize
from gc_core.radius import GREATEST_SLOPE
from gc_core.sections import SECTIONS
from tests.core.objects import KINDS, Turning
from tests.helpers_data import ALL_SETS, load
from tests.measurements import geometry, runs
from tests.measurements.carrying import OBJECT, STIFF, against_the_spline, carried, left_out
from tests.measurements.transfer import Moved, built_in, move, skill, worst_jump

MOVES = 8
MOTIONS = range(30_000, 30_020)
"""Seeds that nothing was chosen with."""

every_tube = pytest.mark.parametrize("name", [*built_in(), *ALL_SETS])
every_section = pytest.mark.parametrize("section", sorted(SECTIONS))


@cache
def tube(name: str, section: str) -> GeneralizedCylinder:
    shown = load(name) if name in ALL_SETS else skill(name)
    return encode(shown, section=section, align_by="arc_length", stations=100)


@cache
def moves(name: str, section: str) -> list[Moved]:
    """By the paper's map and by the app's, points and frames each."""
    stiff = [0.0, 0.0, STIFFNESS, STIFFNESS]
    return [move(tube(name, section), seed, stiffness=stiff[seed % 4]) for seed in range(MOVES)]


@every_tube
@every_section
def test_the_ends_are_where_the_landmarks_are(name: str, section: str) -> None:
    assert max(m.end_error for m in moves(name, section)) < 1.0


@every_tube
@every_section
def test_every_number_of_a_moved_tube_is_finite(name: str, section: str) -> None:
    assert all(m.finite for m in moves(name, section))


@every_tube
@every_section
def test_folds_are_told_where_the_determinant_says_so(name: str, section: str) -> None:
    assert sum(m.untold for m in moves(name, section)) == 0


@every_tube
@every_section
def test_effective_points_and_centres_stay_inside(name: str, section: str) -> None:
    assert max(m.ratio for m in moves(name, section)) <= geometry.HELD
    assert sum(m.centres_outside for m in moves(name, section)) == 0


@every_tube
@every_section
def test_sections_of_a_moved_tube_widen_by_a_stated_slope_at_most(name: str, section: str) -> None:
    assert max(m.slope for m in moves(name, section)) <= GREATEST_SLOPE + 1e-6


@every_tube
@every_section
def test_stations_that_cut_a_neighbour_after_a_move_are_named(name: str, section: str) -> None:
    assert sum(m.unnamed for m in moves(name, section)) == 0


@every_tube
@every_section
def test_no_run_in_a_moved_tube_leaves_it(name: str, section: str) -> None:
    assert sum(m.outside for m in moves(name, section)) == 0


@every_tube
@every_section
def test_no_run_jumps_in_a_moved_tube_that_is_not_folded(name: str, section: str) -> None:
    assert worst_jump(moves(name, section), folded=False) <= runs.JUMP


@every_tube
def test_the_shape_is_kept(name: str) -> None:
    shape = [m.shape for m in moves(name, "circle")]

    assert np.median(shape) < 5.0
    assert max(shape) < 15.0


@cache
def errors(kind: str, turning: Turning) -> dict[str, np.ndarray]:
    return carried(kind, turning, MOTIONS)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("turning", ["turned", "moved alone"])
@pytest.mark.parametrize("layout", [OBJECT, OBJECT + STIFF])
def test_a_start_point_and_an_object_s_frame_halve_the_error_of_the_ramp(
    kind: str, turning: Turning, layout: str
) -> None:
    found = errors(kind, turning)

    assert (found[layout].sum(axis=0) <= 0.5 * found["ramp"].sum(axis=0)).all()


@pytest.mark.parametrize("kind", KINDS)
def test_a_turned_object_needs_its_frame(kind: str) -> None:
    found = errors(kind, "turned")
    points, frame = (found[name].sum(axis=0) for name in ("start and goal points", OBJECT))

    assert (frame < 0.6 * points).all()


@pytest.mark.parametrize("name", ALL_SETS)
def test_a_moved_tube_loses_nothing_against_the_plain_spline(name: str) -> None:
    lines = []
    for tube, own, maps in left_out(name):
        for spline in maps.values():
            moved = generalize(tube, spline)
            np.testing.assert_allclose(moved.directrix, spline(tube.directrix), atol=1e-12)
            lines.append(against_the_spline(tube, moved, spline, own.directrix))

    tubes, splines = np.sum(lines, axis=0)
    assert (tubes <= 1.01 * splines).all()
