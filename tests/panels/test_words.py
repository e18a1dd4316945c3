"""The sentences that panels say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app import bending, edits
from app.document import Document, Shown
from app.lesson import first_minute, tried
from app.panels import words
from app.panels.lesson import page
from app.panels.smoothing import facts
from app.panels.status import status
from app.store import Hand
from gc_core import Demonstration
from tests.panels.desk import state_of, taught


@pytest.mark.parametrize(
    ("length", "said"), [(0.0, "0.0 cm"), (0.034, "3.4 cm"), (0.0996, "10 cm"), (0.12, "12 cm")]
)
def test_lengths_are_said_in_centimetres(length: float, said: str) -> None:
    assert words.cm(length) == said


@pytest.mark.parametrize(
    ("size", "said"),
    [(8.6e-3, "8.6 l"), (0.0149, "14.9 l"), (4.2e-4, "0.42 l"), (8.4e-5, "84 cm³"), (2.5e-6, "2.5 cm³")],
)
def test_volumes_are_said_in_litres_and_small_ones_in_cubic_centimetres(size: float, said: str) -> None:
    assert words.volume(size) == said


@pytest.mark.parametrize(
    ("eta", "part"), [(0.0, "on the middle line"), (0.62, "62 % of the way"), (1.4, "outside")]
)
def test_a_ratio_is_said_in_words(eta: float, part: str) -> None:
    assert part in words.ratio(eta)


def test_every_number_of_demonstrations_has_its_sentence() -> None:
    none, one, five = (words.taught(state_of(taught(n)).model) for n in (0, 1, 5))
    muted = edits.mute_demonstration(taught(1), 0, True)

    assert len({none, one, five, words.taught(state_of(muted).model)}) == 4


def test_the_moved_landmark_and_the_case_are_named() -> None:
    model = state_of(edits.move_landmark(taught(), "goal", np.array([0.0, -0.4, 0.2]))).model

    assert bending.how(model) == "The tube is stretched between the start and the goal."
    assert "two landmarks" in facts(model)


def test_recording_is_said_before_anything_else() -> None:
    hand = Hand(np.zeros(6), np.zeros(3), recording=np.zeros((3, 3)))

    assert "Recording" in status(state_of(taught(), hand=hand, message="Saved."))
    assert "Saved." in status(state_of(taught(), message="Saved."))


def test_what_was_learned_is_said_when_there_is_nothing_newer() -> None:
    quiet, about = (state_of(taught(), message=message) for message in ("", taught().about))

    assert "Learned from 5" in status(quiet)
    assert status(quiet) == status(about)
    assert "Learned from 5" not in status(state_of(taught(), message="Saved."))


def test_a_moved_start_and_a_moved_goal_are_ticked_off() -> None:
    document = taught()
    start = edits.move_start(document, 0, np.array([0.3, -0.3, 0.5]))
    goal = edits.move_landmark(start, "goal", np.array([0.0, -0.4, 0.2]))

    assert tried(document, state_of(start)) == {"start"}
    assert tried(start, state_of(goal)) == {"goal"}


def test_another_skill_ticks_nothing_off() -> None:
    other = edits.move_landmark(edits.add_start(taught(2), np.zeros(3)), "goal", np.array([0.0, -0.4, 0.2]))

    assert tried(taught(), state_of(other)) == frozenset()


def test_a_recorded_motion_counts_when_it_is_one() -> None:
    line = np.linspace(0.0, 1.0, 10)[:, None] * [0.0, 0.0, 1.0]
    long, short = (Hand(np.zeros(6), np.zeros(3), recording=scale * line) for scale in (0.2, 0.01))

    assert tried(None, state_of(taught(), hand=long)) == {"demonstrate"}
    assert tried(None, state_of(taught(), hand=short)) == frozenset()


def test_a_pulled_line_and_an_undone_step_are_ticked_off() -> None:
    document = taught()
    pulled = edits.replace_demonstration(document, 0, replace(document.demonstrations[0].demonstration))

    assert tried(document, state_of(pulled, dragging="/demonstrations/0")) == {"pull"}
    assert tried(pulled, state_of(pulled, redo_name="correct Reach 1")) == {"undo"}


def test_every_step_of_the_lesson_can_be_ticked_off() -> None:
    lesson = first_minute()
    steps = {step for step, _ in lesson.steps}

    assert steps == {"start", "goal", "demonstrate", "pull", "undo"}
    assert page(lesson, "", frozenset(steps)).count("&#10003;") == len(steps)
    assert page(lesson, "", frozenset()).count("&#10003;") == 0


def drawn(count: int, depth: float) -> Document:
    """Demonstrations of half a metre, 10 cm apart at first, and so far out of one plane [m]."""
    share = np.linspace(0.0, 1.0, 60)
    shown: list[Shown] = []
    for number in range(count):
        turn = 2.0 * np.pi * number / count
        across, out = 0.05 * np.cos(turn) * (1.0 - 0.5 * share), depth * np.sin(turn) * (1.0 - 0.5 * share)
        height = 0.3 + across + 0.1 * np.sin(np.pi * share)
        shown.append(Shown(Demonstration(4.0 * share, np.stack([0.5 * share, -0.4 + out, height], axis=1))))
    return Document("Drawn", demonstrations=tuple(shown))


def test_a_tube_drawn_in_one_plane_is_called_flat_and_one_is_told_what_to_do() -> None:
    flat, deep = (status(state_of(drawn(4, depth))) for depth in (0.0005, 0.05))

    assert "hold Shift" in flat
    assert "hold Shift" not in deep


def test_one_flat_demonstration_is_no_flat_tube() -> None:
    assert "hold Shift" not in status(state_of(drawn(1, 0.0)))


def test_what_happened_is_said_before_the_flatness_and_a_warning_stands_alone() -> None:
    said = status(state_of(drawn(3, 0.0), message="That was a demonstration."))
    warned = status(state_of(drawn(3, 0.0), message="The arm cannot follow.", warning=True))

    assert said.index("That was") < said.index("hold Shift")
    assert "hold Shift" not in warned
