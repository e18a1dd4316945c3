"""Laws of rules: where they act, what they leave alone, how they move, and what they have in common."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gc_core import (
    Constraint,
    Landmark,
    Reproduction,
    constrain,
    contradictions,
    encode,
    register,
    reproduce,
    same_content,
)
from gc_core.arrays import FloatArray
from gc_core.constraints import LEAST_CORRECTION, planes_at
from gc_core.half_spaces import nearest_allowed, step_to_allowed
from tests.core.shapes import bundle, line, rotation, seeds

LINES = [line((0.0, y, z), (1.0, y, z)) for y, z in ((-0.1, 0.0), (0.1, 0.0), (0.0, 0.1), (0.0, -0.1))]
TUBE = encode(LINES)
UPPER = reproduce(TUBE, (0.0, 0.0, 0.08))
LOWER = reproduce(TUBE, (0.0, 0.0, -0.08))
ABRUPT = 1.01 * LEAST_CORRECTION
"""Where a span ends between two stations, a run is on one side of that step or on the other [m]."""
few = settings(deadline=None, max_examples=40)


def bump(count: int = 200, begin: float = 0.3, end: float = 0.7) -> FloatArray:
    part = np.clip((np.linspace(0.0, 1.0, count) - begin) / (end - begin), 0.0, 1.0)
    return np.sin(np.pi * part) ** 2


def pushed(run: Reproduction, by: tuple[float, float, float], name: str = "", **span: float) -> Constraint:
    return Constraint.from_correction(run, run.positions + np.outer(bump(**span), by), name)


def behind(run: Reproduction, rule: Constraint) -> FloatArray:
    return planes_at(rule, run.stations / run.stations[-1]).behind(run.positions)


LID = pushed(UPPER, (0.0, 0.0, -0.06), "Lid")
WALL = pushed(UPPER, (0.0, 0.06, -0.01), "Wall", begin=0.4, end=0.9)
BENT = register(
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.4, 0.0], [0.5, 0.0, 0.4], [0.5, -0.3, 0.1]],
    [[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.5, 0.5, 0.1], [0.4, 0.0, 0.5], [0.6, -0.2, 0.0]],
)


def moved_by(run: Reproduction, linear: FloatArray, shift: FloatArray) -> Reproduction:
    return replace(run, positions=run.positions @ linear.T + shift)


@pytest.mark.parametrize("stations", [60, 137, 400])
def test_a_rule_means_the_same_for_any_number_of_stations(stations: int) -> None:
    here = constrain(UPPER, [LID])
    there = constrain(reproduce(encode(LINES, stations=stations), (0.0, 0.0, 0.08)), [LID])

    parts = there.stations / there.stations[-1]
    expected = np.interp(parts, here.stations / here.stations[-1], here.positions[:, 2])
    np.testing.assert_allclose(there.positions[:, 2], expected, atol=ABRUPT)


def test_a_rule_acts_at_the_same_places_on_a_run_that_joins_later() -> None:
    late = reproduce(TUBE, (0.31, 0.0, 0.08))
    ruled = constrain(late, [LID])

    assert late.stations[0] > 50.0
    assert behind(ruled, LID).max() <= 1e-9
    expected = np.interp(late.positions[:, 0], UPPER.positions[:, 0], LID.points[:, 2])
    np.testing.assert_allclose(ruled.positions[:, 2], expected, atol=ABRUPT)


def test_a_rule_made_with_a_run_that_joined_later_acts_at_the_same_places_on_a_whole_run() -> None:
    late = reproduce(TUBE, (0.31, 0.0, 0.08))
    rule = Constraint.from_correction(late, late.positions - np.outer(bump(len(late.times)), [0, 0, 0.05]))
    ruled = constrain(UPPER, [rule])

    expected = np.interp(UPPER.positions[:, 0], late.positions[:, 0], rule.points[:, 2])
    np.testing.assert_allclose(ruled.positions[:, 2], expected, atol=ABRUPT)


def test_of_several_runs_one_that_joins_later_obeys_as_if_it_were_alone() -> None:
    late = np.array([0.5, 0.0, 0.08])
    both = constrain(reproduce(TUBE, np.array([UPPER.positions[0], late])), [LID])
    alone = constrain(reproduce(TUBE, late), [LID])

    np.testing.assert_allclose(
        both.positions[1, 1 - len(alone.times) :], alone.positions[1:], rtol=0.0, atol=1e-9
    )


@few
@given(seed=seeds)
def test_rules_commute_with_moving_everything(seed: int) -> None:
    turn, shift = rotation(seed), np.random.default_rng(seed).normal(size=3)
    there = moved_by(UPPER, turn, shift)
    rules = [LID, WALL]
    remade = [
        Constraint.from_correction(there, rule.points @ turn.T + shift)  # the same correction, made there
        for rule in rules
    ]

    expected = moved_by(constrain(UPPER, rules), turn, shift).positions
    np.testing.assert_allclose(constrain(there, remade).positions, expected, atol=1e-9)


@few
@given(seed=seeds)
def test_rules_that_a_rigid_map_carries_are_moved_with_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    before = Landmark(rng.normal(size=3), rng.normal(size=4))
    after = Landmark(rng.normal(size=3), rng.normal(size=4))
    map_ = register([before], [after])
    there = replace(UPPER, positions=map_(UPPER.positions))

    ruled = constrain(there, [LID.carried(map_), WALL.carried(map_)])
    np.testing.assert_allclose(ruled.positions, map_(constrain(UPPER, [LID, WALL]).positions), atol=1e-9)


def test_a_carried_plane_is_the_tangent_plane_of_its_image() -> None:
    carried, active = WALL.carried(BENT), WALL.active
    points, normals = WALL.points[active], WALL.normals[active]
    along = np.cross(normals, [0.3, -0.5, 0.8])
    nearby = 1e-6 * along / np.linalg.norm(along, axis=1, keepdims=True)

    tangent = (BENT(points + nearby) - BENT(points - nearby)) / 2e-6
    leaving = np.einsum("ki,ki->k", tangent, carried.normals[active])
    np.testing.assert_allclose(leaving / np.linalg.norm(tangent, axis=1), 0.0, atol=1e-6)
    np.testing.assert_allclose(carried.points, BENT(WALL.points))


def test_what_was_allowed_is_allowed_after_the_map() -> None:
    carried, active = WALL.carried(BENT), WALL.active
    ahead = BENT(WALL.points + 1e-4 * WALL.normals) - carried.points

    assert np.einsum("ki,ki->k", ahead, carried.normals)[active].min() > 0.0
    np.testing.assert_array_equal(carried.active, active)


def test_a_rule_that_is_carried_and_taken_back_is_as_it_was() -> None:
    back = WALL.carried(BENT).taken_back(BENT, WALL.points)

    np.testing.assert_allclose(back.normals, WALL.normals, atol=1e-9)
    np.testing.assert_array_equal(back.active, WALL.active)
    # Planes that the map makes thinner than a millimetre stay planes.
    np.testing.assert_allclose(back.lengths, WALL.lengths, atol=1e-3)


@few
@given(seed=seeds, start=st.tuples(st.floats(-0.09, 0.09), st.floats(-0.09, 0.09)))
def test_a_rule_of_an_unchanged_path_does_nothing(seed: int, start: tuple[float, float]) -> None:
    idle = Constraint.from_correction(UPPER, UPPER.positions)
    curved = encode(bundle(seed))
    lazy = Constraint.from_correction(curved.directrix, curved.directrix)
    run = reproduce(TUBE, (0.0, *start))

    assert constrain(run, [idle]) is run
    assert constrain(run, [lazy, idle]) is run
    assert same_content(constrain(run, [idle, LID, lazy]), constrain(run, [LID]))


@pytest.mark.parametrize("rules", [[LID], [WALL], [LID, WALL]])
@pytest.mark.parametrize("height", [0.03, 0.08, 0.099])
def test_a_run_that_obeys_is_left_as_it_is(rules: list[Constraint], height: float) -> None:
    once = constrain(reproduce(TUBE, (0.0, 0.0, height)), rules)

    assert constrain(once, rules) is once


@pytest.mark.parametrize("rules", [[LID], [WALL], [LID, WALL]])
@pytest.mark.parametrize("height", [0.06, 0.08, 0.099, 0.4])
def test_no_rule_lets_a_run_leap(rules: list[Constraint], height: float) -> None:
    run = reproduce(TUBE, (0.0, 0.0, height))
    steps = [np.linalg.norm(np.diff(r.positions, axis=0), axis=1) for r in (run, constrain(run, rules))]

    assert steps[1].max() <= 3.0 * steps[0].max()


@few
@given(
    angle=st.floats(95.0, 145.0), begin=st.floats(0.15, 0.6), height=st.floats(-0.05, 0.09), off=st.booleans()
)
def test_rules_that_pull_against_each_other_are_obeyed_without_a_leap(
    angle: float, begin: float, height: float, off: bool
) -> None:
    turn = np.deg2rad(angle)
    by = 0.05 * np.array([0.0, np.sin(turn), -np.cos(turn)])
    against = pushed(LOWER if off else UPPER, tuple(by), begin=begin, end=begin + 0.35)
    run = reproduce(TUBE, (0.0, 0.0, height))
    ruled = constrain(run, [LID, against])

    assert max(behind(ruled, LID).max(), behind(ruled, against).max()) <= 1e-9
    steps = [np.linalg.norm(np.diff(one.positions, axis=0), axis=1).max() for one in (run, ruled)]
    assert steps[1] <= 3.0 * steps[0]
    np.testing.assert_allclose(constrain(run, [against, LID]).positions, ruled.positions, atol=1e-9)


def test_two_rules_together_are_both_obeyed() -> None:
    run = constrain(reproduce(TUBE, (0.0, 0.03, 0.09)), [LID, WALL])

    assert max(behind(run, LID).max(), behind(run, WALL).max()) <= 1e-9


def test_a_rule_made_twice_acts_once() -> None:
    high = reproduce(TUBE, (0.0, 0.0, 0.099))

    np.testing.assert_allclose(
        constrain(high, [LID, LID]).positions, constrain(high, [LID]).positions, atol=1e-12
    )


def test_the_refinement_matrix_is_what_the_teacher_moved() -> None:
    corrected = UPPER.positions + np.outer(bump(), [0.02, 0.0, -0.06])
    rule = Constraint.from_correction(UPPER, corrected)

    np.testing.assert_allclose(
        rule.moves[rule.active], (corrected - UPPER.positions)[rule.active], atol=1e-12
    )
    assert not rule.moves[~rule.active].any()


def half_spaces(seed: int, count: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Common places (20, 3), points and normals (20, count, 3) of planes that leave these in common."""
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(20, count, 3))
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    inner = rng.uniform(-0.25, 0.25, size=(20, 3))
    return inner, inner[:, None] - rng.uniform(0.0, 0.2, size=(20, count, 1)) * normals, normals


@given(seed=seeds, count=st.integers(1, 5))
def test_the_nearest_allowed_place_is_allowed_and_nearest(seed: int, count: int) -> None:
    inner, points, normals = half_spaces(seed, count)
    places = np.random.default_rng(seed + 1).uniform(-0.25, 0.25, size=(20, 3))
    nearest = nearest_allowed(places, points, normals)

    assert np.einsum("pci,pci->pc", nearest[:, None] - points, normals).min() >= -1e-9
    # The nearest place of a convex set sees every other allowed place, such as `inner`, at 90 degrees up.
    assert np.einsum("pi,pi->p", places - nearest, inner - nearest).max() <= 1e-8


@given(seed=seeds, count=st.integers(1, 4))
def test_projecting_twice_is_projecting_once_and_brings_places_no_further_apart(
    seed: int, count: int
) -> None:
    _, points, normals = half_spaces(seed, count)
    rng = np.random.default_rng(seed + 1)
    one, other = rng.uniform(-0.25, 0.25, size=(2, 20, 3))
    one_moved, other_moved = (nearest_allowed(places, points, normals) for places in (one, other))

    np.testing.assert_allclose(nearest_allowed(one_moved, points, normals), one_moved, atol=1e-9)
    apart = np.linalg.norm(one_moved - other_moved, axis=1)
    assert (apart <= np.linalg.norm(one - other, axis=1) + 1e-9).all()


@given(seed=seeds, count=st.integers(2, 5))
def test_the_order_of_planes_does_not_matter_even_where_they_contradict_each_other(
    seed: int, count: int
) -> None:
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(20, count, 3))
    normals[:, 1] = -normals[:, 0]
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    deep, order = rng.uniform(-0.1, 0.2, size=(20, count)), rng.permutation(count)

    one = step_to_allowed(deep, normals)
    np.testing.assert_allclose(step_to_allowed(deep[:, order], normals[:, order]), one, atol=1e-9)


def test_between_opposite_planes_a_place_goes_half_way() -> None:
    normals = np.array([[[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]])

    step = step_to_allowed(np.array([[0.3, 0.1]]), normals)
    np.testing.assert_allclose(step, [[0.0, 0.0, 0.1]], atol=1e-12)


UP = pushed(UPPER, (0.0, 0.0, 0.05), "Above", begin=0.5, end=0.9)


def test_rules_that_exclude_each_other_are_named_with_the_place() -> None:
    (found,) = contradictions([WALL, LID, UP])

    where = np.flatnonzero(LID.active & UP.active)
    assert found.names == ("Lid", "Above")
    assert found.stations == (where[0], where[-1])
    first, last = (round(100 * place / 199) for place in found.stations)
    assert f"Lid and Above contradict each other from {first} to {last} % of the way" in found.sentence()


def test_three_rules_that_only_together_exclude_each_other_are_named() -> None:
    turns = [np.array([0.0, np.cos(a), np.sin(a)]) for a in np.deg2rad([0.0, 120.0, 240.0])]
    rules = [pushed(UPPER, tuple(0.05 * turn), f"Side {j}") for j, turn in enumerate(turns)]

    (found,) = contradictions(rules)
    assert found.names == ("Side 0", "Side 1", "Side 2")
    assert found.sentence().startswith("Side 0, Side 1 and Side 2 contradict each other")


@pytest.mark.parametrize("rules", [[], [LID], [LID, WALL], [LID, LID]])
def test_rules_that_can_be_obeyed_together_are_no_contradiction(rules: list[Constraint]) -> None:
    assert contradictions(rules) == ()


def test_where_rules_contradict_each_other_runs_stay_whole() -> None:
    run = constrain(UPPER, [LID, UP])
    steps = np.linalg.norm(np.diff(run.positions, axis=0), axis=1)

    assert steps.max() < 0.08
    assert constrain(UPPER, []) is UPPER


@few
@given(seed=seeds)
def test_rules_on_curved_skills_are_obeyed_and_move_with_the_map(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cylinder = encode(bundle(seed))
    run = reproduce(cylinder, cylinder.directrix[0])
    rule = Constraint.from_correction(run, run.positions + np.outer(bump(), 0.05 * rng.normal(size=3)))
    other = reproduce(cylinder, cylinder.directrix[0] + 0.5 * cylinder.radii[0, 0] * cylinder.frames[0, :, 1])
    map_ = register(cylinder.directrix[[0, -1]], cylinder.directrix[[0, -1]] + 0.1 * rng.normal(size=(2, 3)))

    for moved, ruled in (
        (other, rule),
        (replace(other, positions=map_(other.positions)), rule.carried(map_)),
    ):
        assert behind(constrain(moved, [ruled]), ruled).max() <= 1e-9
