"""What the arm makes of a run, on the timeline and in Try: words, and ways to get there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app import judgement
from app.arm import PlanarArm
from app.arm.verdict import Kind, Problem
from app.panels.timeline import MOST_PROBLEMS
from app.panels.verdict import CHECKING, verdict
from app.planning import plan_run
from app.scene.hatching import SHORTEST, hatched
from app.store import Plan, State
from tests.panels.desk import Bench, state_of, taught


def problem(first: int, last: int, kind: Kind = "thing", what: str = "the forearm is in the box") -> Problem:
    return Problem(kind, first, last, (first + last) // 2, what, "Move the box.")


def planned(*problems: Problem) -> State:
    """A state whose run has these problems."""
    state, arm = state_of(taught()), PlanarArm()
    made = plan_run(arm, state.model, 0, arm.conditions, arm.home)
    plan = replace(made, verdict=replace(made.verdict, problems=problems))
    return replace(state, plan=plan, plans=(plan,))


def plan_of(state: State) -> Plan:
    assert state.plan is not None
    return state.plan


def rows(bench: Bench) -> list[str]:
    return [e.label for e in bench.client.gui if e.kind == "Button" and "forearm" in e.label and e.usable]


def test_a_press_on_a_problem_stops_the_playhead_where_it_is_worst(bench: Bench) -> None:
    state = bench.draw(planned(problem(40, 60)))
    (label,) = rows(bench)
    bench.client.press(label)

    assert label.startswith(judgement.when(plan_of(state), problem(40, 60)))
    assert bench.notes.next() == ("play", (False,))
    assert bench.notes.next() == ("seek", (judgement.worst_at(plan_of(state), problem(40, 60)),))


def test_the_timeline_shows_the_first_few_problems_and_none_once_they_are_gone(bench: Bench) -> None:
    bench.draw(planned(*(problem(10 * i, 10 * i + 3) for i in range(MOST_PROBLEMS + 2))))
    shown = len(rows(bench))
    bench.draw(planned())

    assert (shown, rows(bench)) == (MOST_PROBLEMS, [])


@pytest.mark.parametrize(("label", "pace"), [("As fast as it can", "fastest"), ("✓ As taught", "taught")])
def test_the_pace_is_chosen(bench: Bench, label: str, pace: str) -> None:
    bench.draw(planned())
    bench.client.set_gui("Play it", label)

    assert bench.notes.next() == ("look", (("pace", pace),))


def test_until_the_worker_has_come_to_it_nothing_is_claimed() -> None:
    assert CHECKING in verdict(state_of(taught()))


def test_being_slower_than_taught_is_told_but_is_no_problem() -> None:
    said = verdict(planned(problem(20, 50, "speed")))

    assert "The arm can do run 1." in said
    assert "Taught in" in said


def test_a_persons_names_of_things_are_harmless_in_the_panel() -> None:
    said = verdict(planned(problem(20, 50, what="the hand would be in <b>bold</b>")))

    assert "<b>bold" not in said
    assert "&lt;b&gt;bold" in said


@pytest.mark.parametrize(("first", "last"), [(40, 80), (60, 60), (0, 3), (190, 198)])
def test_the_hatching_lies_on_the_run_over_the_problem_and_hardly_beyond(first: int, last: int) -> None:
    state = planned(problem(first, last))
    positions = plan_of(state).reproduction.positions
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(positions, axis=0), axis=1))])

    ends = hatched(plan_of(state)).reshape(-1, 3)
    nearest = np.linalg.norm(ends[:, None] - positions, axis=2)
    where = length[nearest.argmin(axis=1)]

    step = np.diff(length).max()
    assert nearest.min(axis=1).max() <= step
    assert where.min() >= min(length[first], length[last] - SHORTEST) - step
    assert where.max() <= max(length[last], length[first] + SHORTEST) + step
    assert np.ptp(where) >= 0.5 * SHORTEST - step


def test_what_the_arm_can_do_is_not_hatched() -> None:
    assert len(hatched(plan_of(planned(problem(20, 50, "speed"))))) == 0
