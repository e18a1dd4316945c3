"""A person's timing must not matter: pauses and uneven speed give the tube of an even hand."""

from __future__ import annotations

import numpy as np
import pytest

from app.arm import Jaco
from app.document import Settings
from gc_core import Demonstration
from tests.measurements.alignment import directrix, hausdorff, shapes, station_distance
from tests.measurements.mouse import Habits, drawn_by_a_person, drawn_by_hand

FORGIVEN = 0.005
"""[m]"""


@pytest.fixture(scope="module")
def even_and_uneven() -> tuple[tuple[Demonstration, ...], tuple[Demonstration, ...]]:
    """The same five shapes, drawn evenly and with pauses and uneven speed, through the Jaco."""
    arm, paths = Jaco(), shapes()
    sets = drawn_by_hand(arm, paths), drawn_by_a_person(arm, paths, Habits(tremble=0.0005), seed=3)
    arm.close()
    return sets


def test_pauses_and_uneven_speed_leave_the_directrix_within_5_mm(even_and_uneven) -> None:
    even, uneven = (directrix(one, Settings().align_by) for one in even_and_uneven)

    assert hausdorff(even, uneven) < FORGIVEN
    assert station_distance(even, uneven) < FORGIVEN


def test_the_uneven_demonstrations_are_the_same_shapes_with_another_timing(even_and_uneven) -> None:
    for even, uneven in zip(*even_and_uneven, strict=True):
        assert hausdorff(even.positions, uneven.positions) < FORGIVEN
        assert uneven.times[-1] > even.times[-1] + 0.3


def test_the_directrix_of_what_was_drawn_is_that_of_the_shapes(even_and_uneven) -> None:
    paths = [Demonstration(np.linspace(0.0, 1.0, len(path)), path) for path in shapes()]

    drawn = directrix(even_and_uneven[0], Settings().align_by)

    assert hausdorff(drawn, directrix(paths, Settings().align_by)) < FORGIVEN
