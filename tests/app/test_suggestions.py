"""The next demonstration is asked for where nobody has been, and for nothing where all sides were shown."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.document import FloatArray
from app.files import read
from app.suggestions import SEEN, suggestion
from gc_core import Demonstration, GeneralizedCylinder, encode
from tests.core.shapes import rotation
from tests.helpers_data import load

SKILLS = Path(__file__).parents[2] / "static" / "skills"


def around(degrees: list[float], radius: float = 0.05, turn: FloatArray | None = None) -> GeneralizedCylinder:
    """Straight demonstrations along x, beside each other in these directions, widest in the middle."""
    part = np.linspace(0.0, 1.0, 80)
    width = radius * (0.3 + 0.7 * np.sin(np.pi * part**1.1))
    shown = []
    for angle in np.radians(degrees):
        path = np.outer(part, [0.8, 0.0, 0.0]) + np.outer(width, [0.0, np.cos(angle), np.sin(angle)])
        shown.append(Demonstration(4.0 * part, path if turn is None else path @ turn.T))
    return encode(shown)


@settings(deadline=None, max_examples=30)
@given(first=st.floats(0.0, 360.0), count=st.integers(4, 7))
def test_the_side_that_was_left_out_is_asked_for(first: float, count: int) -> None:
    # All but one of evenly spread directions, so that the mean moves away from what is missing.
    degrees = [first + 360.0 * j / count for j in range(count)]
    asked = suggestion(around(degrees[1:]))

    missing = np.radians(first)
    if asked is None:
        assert 4.0 * np.pi / count < SEEN + 0.4
    else:
        assert asked.direction @ [0.0, np.cos(missing), np.sin(missing)] > 0.9
        assert asked.reason == ("gap" if count > 4 else asked.reason)


def test_it_is_asked_where_there_is_most_room() -> None:
    asked = suggestion(around([80.0, 100.0, 240.0, 300.0], radius=0.08))

    assert asked is not None
    assert 0.3 < asked.station / 199 < 0.7


def test_a_motion_shown_from_all_sides_needs_no_more() -> None:
    assert suggestion(around([0.0, 90.0, 180.0, 270.0])) is None


def test_where_all_agree_nothing_is_asked_for() -> None:
    assert suggestion(around([80.0, 100.0, 120.0], radius=0.004)) is None


def test_demonstrations_side_by_side_are_asked_to_leave_their_sheet() -> None:
    asked = suggestion(around([0.0, 180.0, 0.5], radius=0.06))

    assert asked is not None
    assert asked.reason == "flat"
    assert abs(asked.direction[2]) > 0.95
    assert ("above" if asked.direction[2] > 0.0 else "below") in asked.sentence


def test_one_demonstration_alone_is_asked_for_another_beside_it() -> None:
    asked = suggestion(around([0.0]))

    assert asked is not None
    assert asked.reason == "alone"
    assert asked.direction[2] == pytest.approx(0.0, abs=1e-6)
    assert "3 cm to the" in asked.sentence


@pytest.mark.parametrize(
    ("degrees", "words"),
    [
        ([150.0, 180.0, 210.0], "to the left of the middle line"),
        ([-30.0, 0.0, 30.0], "to the right of the middle line"),
        ([60.0, 90.0, 120.0], "below the middle line"),
    ],
)
def test_sides_are_named_for_somebody_who_goes_along(degrees: list[float], words: str) -> None:
    # Along x with z up, y is on the left: what lies on the right asks for one on the left.
    cylinder = around(degrees, radius=0.2)
    asked = suggestion(cylinder)

    assert asked is not None
    away = asked.place - cylinder.directrix[asked.station]
    sideways = np.array([0.0, np.cos(np.radians(degrees[1])), np.sin(np.radians(degrees[1]))])
    assert away @ sideways < 0.0
    assert words in asked.sentence


@settings(deadline=None, max_examples=20)
@given(seed=st.integers(0, 1000))
def test_turning_everything_turns_what_is_asked_for(seed: int) -> None:
    degrees, turn = [70.0, 110.0, 200.0], rotation(seed)
    here, there = suggestion(around(degrees)), suggestion(around(degrees, turn=turn))

    assert here is not None
    assert there is not None
    np.testing.assert_allclose(there.place, here.place @ turn.T, atol=1e-6)


def test_showing_what_is_asked_for_helps() -> None:
    shown = [*read(SKILLS / "the_dip.csv", units="m")]
    asked = suggestion(encode(shown, align_by="arc_length"))
    assert asked is not None

    cylinder = encode(shown, align_by="arc_length")
    bump = np.exp(-(((np.arange(200) - asked.station) / 40.0) ** 2))
    away = np.outer(bump, asked.place - cylinder.directrix[asked.station])
    more = encode([*shown, Demonstration(cylinder.times, cylinder.directrix + away)], align_by="arc_length")
    again = suggestion(more)
    assert again is None or again.direction @ asked.direction < 0.9 or again.station != asked.station


@pytest.mark.parametrize("name", ["reaching1", "pouring", "lab"])
def test_real_recordings_are_asked_for_a_place_beside_their_tube(name: str) -> None:
    cylinder = encode(load(name), align_by="arc_length")
    asked = suggestion(cylinder)

    assert asked is not None
    away = np.linalg.norm(asked.place - cylinder.directrix[asked.station])
    assert 0.005 < away < 0.3
    assert abs(asked.direction @ cylinder.frames[asked.station, :, 0]) < 1e-9
