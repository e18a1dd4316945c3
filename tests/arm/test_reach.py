"""The shell in which a tool can be."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arm.reach import Shell, length_in_words

SHELL = Shell(shoulder=(0.0, 0.0, 0.3), inner=0.2, outer=0.9, table=0.02)
ANY = st.floats(-5.0, 5.0)


@given(x=ANY, y=ANY, z=ANY)
def test_a_projected_target_stays_where_it_is(x: float, y: float, z: float) -> None:
    once = SHELL.project(np.array([x, y, z]))

    np.testing.assert_allclose(SHELL.project(once), once, atol=1e-9)


@given(x=ANY, y=ANY, z=ANY)
def test_a_projected_target_is_in_the_shell(x: float, y: float, z: float) -> None:
    distance = np.linalg.norm(SHELL.project(np.array([x, y, z])) - SHELL.shoulder)

    assert 0.2 - 1e-9 <= distance <= 0.9 + 1e-9


@given(x=ANY, y=ANY, z=ANY)
def test_a_target_has_a_reason_exactly_when_projecting_moves_it(x: float, y: float, z: float) -> None:
    target = np.array([x, y, z])
    moved = np.linalg.norm(SHELL.project(target) - target)

    assert (SHELL.outside(target) is None) == (moved == 0.0)


def test_a_path_is_projected_point_by_point() -> None:
    path = np.random.default_rng(1).normal(size=(20, 3))

    np.testing.assert_array_equal(SHELL.project(path), [SHELL.project(point) for point in path])


def test_the_table_can_be_left_out() -> None:
    below = np.array([0.3, 0.3, -0.1])

    np.testing.assert_array_equal(SHELL.project(below, above_table=False), below)


@pytest.mark.parametrize(
    ("target", "words"),
    [
        ((0.0, -1.02, 0.3), "12 cm beyond reach"),
        ((0.0, -0.904, 0.3), "4 mm beyond reach"),
        ((0.0, -2.4, 0.3), "1.5 m beyond reach"),
        ((0.3, 0.3, -0.2), "below the table"),
        ((0.05, 0.0, 0.3), "too close to its own base"),
    ],
)
def test_reasons_are_a_teacher_s_words(target: tuple[float, float, float], words: str) -> None:
    assert SHELL.outside(np.array(target)) == words


@given(st.floats(0.0, 10.0))
def test_a_length_in_words_is_never_nothing(metres: float) -> None:
    number, unit = length_in_words(metres).split()

    assert float(number) > 0.0
    assert unit in {"mm", "cm", "m"}
