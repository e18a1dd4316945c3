"""Units, frames and what a person is told before a file is accepted."""

import numpy as np
import pytest

from app.files import FRAMES, IN_FRONT, METRES, Unit, inspect_bytes
from tests.files.makers import GOOD, csv_of, line, npy_of


@pytest.mark.parametrize("unit", METRES)
def test_the_unit_of_an_arms_motion_is_guessed_from_its_size(unit: Unit) -> None:
    reading = inspect_bytes("a.npy", npy_of(line(scale=0.4 / METRES[unit])))

    assert reading.unit == unit
    np.testing.assert_allclose(reading.accepted(frame="as recorded")[0].positions, line(scale=0.4))


@pytest.mark.parametrize("unit", METRES)
def test_a_stated_unit_beats_the_guess(unit: Unit) -> None:
    reading = inspect_bytes("a.npy", npy_of(line()))

    found = reading.accepted(unit, "as recorded")

    np.testing.assert_allclose(found[0].positions, line() * METRES[unit])


def test_moving_in_front_of_the_arm_is_one_translation_of_all() -> None:
    paths = np.stack([line() + 5.0, line() + 5.3])
    reading = inspect_bytes("a.npy", npy_of(paths))

    found = np.stack([d.positions for d in reading.accepted("m", "moved in front of the arm")])

    shift = found - paths
    np.testing.assert_allclose(shift, np.broadcast_to(shift[0, 0], shift.shape), atol=1e-12)
    middle = 0.5 * (found.min(axis=(0, 1)) + found.max(axis=(0, 1)))
    np.testing.assert_allclose(middle, IN_FRONT, atol=1e-12)


def test_a_motion_within_reach_stays_where_it_was_recorded() -> None:
    path = line(scale=0.2) + np.array([-0.1, -0.6, 0.2])

    assert inspect_bytes("a.npy", npy_of(path)).frame == FRAMES[0]


def test_a_motion_out_of_reach_is_offered_in_front_of_the_arm() -> None:
    assert inspect_bytes("a.npy", npy_of(line(scale=0.2) + 3.0)).frame == FRAMES[1]


def test_without_times_a_hundred_samples_a_second_are_assumed_and_said() -> None:
    reading = inspect_bytes("a.csv", csv_of(line(), "x,y,z"))

    assert not reading.times_in_file
    assert reading.durations == pytest.approx([0.19])
    assert "100 samples a second" in reading.summary


def test_with_times_nothing_is_assumed() -> None:
    reading = inspect_bytes("a.csv", GOOD["a.csv"])

    assert reading.times_in_file
    assert "assumed" not in reading.summary


def test_the_summary_says_how_many_how_large_and_in_which_unit() -> None:
    reading = inspect_bytes("a.npy", npy_of(np.stack([line(scale=50.0)] * 3)))

    for words in ("3 demonstrations", "50 x 42 x 50 cm", "read as cm"):
        assert words in reading.summary
