from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from gc_core import Constraint, GcError, constrain, encode, reproduce, same_content, soft_correction
from tests.core.shapes import bundle, line

PATH = bundle(0, 1)[0].positions
PULL = np.array([0.0, 0.05, -0.02])
TUBE = encode([line((0.0, y, z), (1.0, y, z)) for y, z in ((-0.1, 0.0), (0.1, 0.0), (0.0, 0.1), (0.0, -0.1))])
UPPER = reproduce(TUBE, (0.0, 0.0, 0.08))
LOWER = reproduce(TUBE, (0.0, 0.0, -0.08))


@given(index=st.integers(0, 119), width=st.floats(0.001, 2.0))
def test_the_pulled_sample_moves_by_the_pull(index: int, width: float) -> None:
    corrected = soft_correction(PATH, index, PULL, width)

    np.testing.assert_allclose(corrected[index], PATH[index] + PULL, atol=1e-12)


@given(index=st.integers(1, 118), width=st.floats(0.001, 2.0))
def test_the_ends_stay_when_the_middle_is_pulled(index: int, width: float) -> None:
    np.testing.assert_array_equal(soft_correction(PATH, index, PULL, width)[[0, -1]], PATH[[0, -1]])


@given(width=st.floats(0.001, 2.0))
def test_a_pulled_end_moves_and_the_other_stays(width: float) -> None:
    corrected = soft_correction(PATH, -1, PULL, width)

    np.testing.assert_allclose(corrected[-1], PATH[-1] + PULL)
    np.testing.assert_array_equal(corrected[0], PATH[0])


@given(index=st.integers(0, 119), width=st.floats(0.05, 0.3))
def test_nothing_moves_beyond_the_width(index: int, width: float) -> None:
    gone = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(PATH, axis=0), axis=1))))
    far = np.abs(gone - gone[index]) > width

    np.testing.assert_array_equal(soft_correction(PATH, index, PULL, width)[far], PATH[far])


def test_a_corrected_straight_line_has_no_corner() -> None:
    straight = np.outer(np.linspace(0.0, 1.0, 2001), [1.0, 0.0, 0.0])
    slope = np.gradient(soft_correction(straight, 900, PULL, 0.3), straight[:, 0], axis=0)

    assert np.linalg.norm(np.diff(slope, axis=0), axis=1).max() < 0.01


def test_samples_in_the_same_place_move_together() -> None:
    waiting = np.repeat(PATH[::10], 5, axis=0)
    corrected = soft_correction(waiting, 31, PULL, 0.2)

    np.testing.assert_array_equal(corrected[30:35], np.broadcast_to(corrected[31], (5, 3)))


@pytest.mark.parametrize(
    "arguments", [(PATH, 500, PULL, 0.1), (PATH, 5, PULL, 0.0), (PATH, 5, PULL[:2], 0.1)]
)
def test_a_pull_that_makes_no_sense_is_refused(arguments: tuple) -> None:
    with pytest.raises(GcError):
        soft_correction(*arguments)


def lid(height: float, begin: int = 60, end: int = 140) -> Constraint:
    """A rule made by pressing the upper run down to a height between two stations."""
    part = np.clip((np.arange(200) - begin) / (end - begin), 0.0, 1.0)
    corrected = UPPER.positions - np.outer((0.08 - height) * np.sin(np.pi * part) ** 2, [0.0, 0.0, 1.0])
    return Constraint.from_correction(UPPER, corrected, name="lid")


def test_the_corrected_run_becomes_the_correction() -> None:
    rule = lid(0.02)
    obeying = constrain(UPPER, [rule])

    np.testing.assert_allclose(obeying.positions[rule.active], rule.points[rule.active], atol=1e-12)


def test_a_run_that_passes_no_plane_is_the_same_object() -> None:
    assert constrain(LOWER, [lid(0.02)]) is LOWER


def test_no_rules_change_nothing() -> None:
    assert constrain(UPPER, []) is UPPER


@settings(deadline=None)
@given(height=st.floats(-0.05, 0.05), start=st.tuples(st.floats(-0.05, 0.05), st.floats(-0.05, 0.09)))
@example(height=0.0, start=(0.0, 1e-10))
def test_no_sample_is_behind_a_plane_afterwards(height: float, start: tuple[float, float]) -> None:
    rule = lid(height)
    run = constrain(reproduce(TUBE, (0.0, *start)), [rule])

    depth = np.einsum("ij,ij->i", run.positions - rule.points, rule.normals)[rule.active]
    assert depth.min() >= -1e-12


def test_a_run_is_not_torn_at_the_ends_of_a_rule() -> None:
    high = reproduce(TUBE, (0.0, 0.0, 0.099))
    steps = np.linalg.norm(np.diff(constrain(high, [lid(0.02)]).positions, axis=0), axis=1)

    assert steps.max() < 2.0 * np.median(steps)


def test_a_run_far_beyond_a_rule_fades_back_to_itself() -> None:
    high = reproduce(TUBE, (0.0, 0.0, 0.099))
    moved = constrain(high, [lid(0.02)])

    np.testing.assert_array_equal(moved.positions[:40], high.positions[:40])
    np.testing.assert_array_equal(moved.positions[160:], high.positions[160:])


def wall(side: float) -> Constraint:
    part = np.clip((np.arange(200) - 50) / 80, 0.0, 1.0)
    moved = UPPER.positions + np.outer(side * np.sin(np.pi * part) ** 2, [0.0, 0.6, 0.8])
    return Constraint.from_correction(UPPER, moved, name="wall")


@settings(deadline=None)
@given(order=st.permutations(range(4)), start=st.tuples(st.floats(-0.05, 0.05), st.floats(-0.09, 0.09)))
def test_the_order_of_rules_does_not_matter(order: list[int], start: tuple[float, float]) -> None:
    rules = [lid(0.02), lid(0.0, 30, 100), wall(-0.03), wall(0.02)]
    run = reproduce(TUBE, (0.0, *start))

    one, other = constrain(run, rules).positions, constrain(run, [rules[j] for j in order]).positions
    np.testing.assert_allclose(one, other, atol=1e-9)


def test_contradicting_rules_give_a_finite_run() -> None:
    up, down = wall(0.05), wall(-0.05)

    assert np.isfinite(constrain(UPPER, [up, down]).positions).all()


def test_several_runs_are_constrained_as_each_alone() -> None:
    both = reproduce(TUBE, np.array([UPPER.positions[0], LOWER.positions[0]]))
    moved = constrain(both, [lid(0.02)]).positions

    np.testing.assert_allclose(moved[0], constrain(UPPER, [lid(0.02)]).positions, atol=1e-12)
    np.testing.assert_array_equal(moved[1], LOWER.positions)


def test_a_rule_of_paths_of_different_length_is_refused() -> None:
    with pytest.raises(GcError, match="corrected"):
        Constraint.from_correction(UPPER.positions, UPPER.positions[:-1])


def test_a_correction_below_a_millimetre_is_no_rule() -> None:
    assert not Constraint.from_correction(UPPER, UPPER.positions + 0.0005).active.any()


def test_the_same_rule_made_twice_has_the_same_content() -> None:
    assert same_content(lid(0.02), lid(0.02))
    assert not same_content(lid(0.02), lid(0.03))


def test_a_rule_of_nothing_is_refused() -> None:
    with pytest.raises(GcError):
        Constraint.from_correction(np.zeros((0, 3)), np.zeros((0, 3)))


def test_a_rule_cannot_be_written_to() -> None:
    rule = Constraint(np.arange(3.0), np.zeros((3, 3)), np.zeros((3, 3)), np.zeros(3))

    assert not any(a.flags.writeable for a in (rule.stations, rule.points, rule.normals, rule.lengths))


def test_no_runs_are_constrained_to_no_runs() -> None:
    cylinder = encode(bundle(0))
    rule = Constraint.from_correction(cylinder.directrix, cylinder.directrix + 0.1)

    assert constrain(reproduce(cylinder, np.zeros((0, 3))), [rule]).positions.shape == (0, 200, 3)


def test_a_sample_between_samples_cannot_be_pulled() -> None:
    with pytest.raises(GcError):
        soft_correction(np.eye(4, 3), 1.5, np.ones(3), 0.1)
