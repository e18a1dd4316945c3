"""The paper's figures: what is on each, whatever it looks like."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from importlib import import_module
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_hex
from matplotlib.quiver import Quiver

from app.document import Document, Settings
from app.edits import skill_of
from app.figures import FIGURES, NothingToDrawError, paper_figure, sheet
from app.figures.constraint import pressed_run
from app.figures.subject import Subject
from app.figures.views import letters_of
from app.resources import static_folder
from app.skills import load_skill
from gc_core import Demonstration
from tests.baselines.makers import needs_primitives


@cache
def subjects_of(name: str) -> tuple[Subject, ...]:
    """The skills of a figure, with fewer slices."""
    loaded = [load_skill(static_folder() / "skills", skill) for skill in FIGURES[name].skills]
    return tuple(Subject(replace(each, settings=replace(each.settings, stations=60))) for each in loaded)


@cache
def figure_of(name: str) -> Any:
    entry = FIGURES[name]
    with sheet.styled():
        return getattr(import_module(f"app.figures.{entry.module}"), entry.function)(subjects_of(name))


def lines_of(axes: Any, colour: str) -> list[np.ndarray]:
    """Paths of one colour, without single points and dots."""
    return [
        line.get_xydata()
        for line in axes.lines
        if to_hex(line.get_color()) == colour.lower()
        and line.get_linestyle() != "None"
        and len(line.get_xydata()) > 1
    ]


def counts(name: str, colour: str) -> list[int]:
    return [len(lines_of(axes, colour)) for axes in figure_of(name).axes]


@pytest.mark.parametrize("name", sorted(set(FIGURES) - {"2", "5", "7", "11", "12"}, key=int))
def test_where_demonstrations_are_drawn_all_of_them_are(name: str) -> None:
    shown = {len(subject.paths) for subject in subjects_of(name)}
    # The corrected one of Fig. 10 has a colour of its own.
    allowed = {0} | shown | ({len(subjects_of(name)[0].paths) - 1} if name == "10" else set())

    found = set(counts(name, sheet.DEMONSTRATION))
    assert shown <= found <= allowed


def test_each_cross_section_has_a_frame_of_three_axes() -> None:
    axes = figure_of("2").axes[0]
    arrows = sum(isinstance(each, Quiver) for each in axes.collections)
    rings = [line for line in lines_of(axes, sheet.INK) if np.array_equal(line[0], line[-1])]

    assert arrows == 3 * len(rings) > 0


def test_both_slices_of_the_ratio_rule_have_one_ratio() -> None:
    titles = [axes.get_title() for axes in figure_of("5").axes[1:]]

    assert len({title.partition("η")[2] for title in titles}) == 1


def test_three_kinds_of_section_have_the_same_number_of_runs() -> None:
    assert counts("6", sheet.REPRODUCTION) == [2, 0, 2, 0, 2, 0]


def test_each_moved_landmark_is_joined_to_where_it_was() -> None:
    joined = [
        sum(np.ptp(line, axis=0).max() > 1.0 for line in lines_of(axes, sheet.GOAL))
        for axes in figure_of("7").axes
    ]

    assert joined == [0, 1, 1, 1, 1, 1, 1, 1]


def test_four_skills_have_a_tube_each() -> None:
    skins = [sum(isinstance(c, PolyCollection) for c in axes.collections) for axes in figure_of("8").axes]

    assert skins == [1, 1, 1, 1]


@needs_primitives
def test_five_runs_of_each_method_begin_at_the_starts() -> None:
    assert counts("9", sheet.REPRODUCTION)[:5] == [5] * 5


def test_one_corrected_demonstration_is_drawn_with_what_it_was() -> None:
    before, after = figure_of("10").axes

    assert lines_of(before, sheet.REFINED) == []
    assert len(lines_of(after, sheet.REFINED)) == len(lines_of(after, sheet.INK)[:1]) == 1


def test_arrows_of_the_refinement_matrix_lead_from_the_run_to_its_correction() -> None:
    axes = figure_of("11").axes[0]
    (arrows,) = [each for each in axes.collections if isinstance(each, Quiver)]
    tips = np.asarray(arrows.get_offsets()) + np.stack([arrows.U, arrows.V], axis=1)

    (corrected,) = lines_of(axes, sheet.REFINED)
    assert np.linalg.norm(tips[:, None] - corrected, axis=2).min(axis=1).max() < 1e-6


def test_a_lower_run_that_the_rule_moves_is_not_called_untouched() -> None:
    subject = subjects_of("12")[0]
    labels = figure_of("12").axes[0].get_legend_handles_labels()[1]
    upper = pressed_run(subject).upper
    both_high = replace(subject.document, starts=(upper.positions[0], upper.positions[0]))
    with sheet.styled():
        twice = import_module("app.figures.constraint").draw_obeying((Subject(both_high),))

    assert "lower run, untouched" in labels
    assert "lower run, untouched" not in twice.axes[0].get_legend_handles_labels()[1]


@pytest.mark.parametrize("count", [0, 1])
def test_a_run_is_pressed_down_above_another_however_few_starts_there_are(count: int) -> None:
    document = subjects_of("11")[0].document
    pressed = pressed_run(Subject(replace(document, starts=document.starts[:count])))

    assert pressed.upper.positions[0, 2] > pressed.lower.positions[0, 2]


def test_letters_of_axes_that_are_seen_as_one_stand_apart() -> None:
    axes = np.array([[0.7, -0.2], [0.7, -0.2], [0.0, 0.95]])

    for given in (axes, axes[::-1], np.array([[0.63, -0.24], [0.78, 0.2], [0.0, 0.95]])):
        letters = letters_of(given)
        assert min(np.linalg.norm(a - b) for a, b in combinations(letters, 2)) > 0.5


def test_frenet_frames_of_a_straight_motion_are_not_said_to_turn() -> None:
    part = np.linspace(0.0, 1.0, 100)
    straight = Demonstration(part, np.outer(part, [0.3, 0.0, 0.0]))
    with sheet.styled():
        figure = import_module("app.figures.anatomy").draw((Subject(skill_of("Straight", [straight])),))

    assert "turns by 0°" in figure.axes[1].get_title()


def test_a_figure_is_the_same_file_each_time() -> None:
    document = replace(subjects_of("11")[0].document, settings=Settings(stations=40))

    assert paper_figure("11", document) == paper_figure("11", document)


def test_what_a_file_does_not_say_is_made_up_around_its_ends() -> None:
    subject = subjects_of("7")[0]
    bare = Subject(skill_of("Bare", subject.demonstrations))

    for kind, end in (("start", bare.ends[0]), ("goal", bare.ends[1])):
        away = np.linalg.norm(np.array(bare.moved(kind, 4)) - end, axis=1)
        assert away == pytest.approx(np.full(4, away[0]))
        assert away[0] > 0.05
    assert bare.starts.shape == (2, 3)
    assert bare.cylinder.contains(bare.starts).all()


def test_a_skill_without_demonstrations_is_refused_in_a_sentence() -> None:
    with pytest.raises(NothingToDrawError, match="Empty"):
        paper_figure("4", Document("Empty"))
