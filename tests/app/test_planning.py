"""What the arm makes of a run: true to the model and to physics, honest, and in time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app import edits, judgement
from app.arm import Arm, Jaco, PlanarArm
from app.arm.physics import World
from app.arm.physics_report import encounters
from app.arm.physics_words import length_in_words, part_in_words
from app.arm.timing import no_faster_than, too_fast
from app.arm.verdict import REACHED
from app.desk import Desk
from app.document import Box
from app.player import Pace
from app.skills import load_skill, skill_names
from tests.app.makers import FIRST_START, Mouse, desk_of, planned, taught

AGREED = 0.005
"""Between kinematics and physics [m]."""
BY = (0.04, -0.03, 0.05)
SHELF = Path(__file__).parents[2] / "static" / "skills"
SHARES = st.lists(st.floats(0.01, 2.0), min_size=2, max_size=30)
WAITS = st.lists(st.floats(0.0, 2.0), min_size=30, max_size=30)


@pytest.fixture(scope="module")
def jaco() -> Iterator[Arm]:
    arm = Jaco()
    yield arm
    arm.close()


@pytest.fixture(scope="module")
def through_a_box(jaco: Arm) -> Desk:
    """*Reaching* with a box put across the path, and what the worker made of it."""
    document = load_skill(SHELF, "reaching")
    middle = Desk(document, jaco).model.runs[0].reproduction.positions[100]
    box = Box("box", (float(middle[0]), float(middle[1]), float(middle[2]) - 0.02), (0.1, 0.1, 0.1))
    desk = Desk(replace(document, things=(box,)), jaco)
    desk.accept_plan(planned(desk))
    return desk


def test_a_run_led_through_a_thing_is_told_with_part_time_and_depth_as_physics_finds_them(
    through_a_box: Desk,
) -> None:
    plan = through_a_box.state().plan
    assert plan is not None
    with World(through_a_box.model.source.things) as world:
        measured = world.clearance(plan.path.joints)
    met = encounters(measured, plan.reproduction.times)
    deepest = max(met, key=lambda each: each.depth)
    told = max(
        (problem for problem in plan.verdict.problems if problem.kind == "thing"),
        key=lambda problem: -measured.distances[problem.worst].min(),
    )

    assert plan.verdict.nearest is not None
    assert -plan.verdict.nearest.distance == pytest.approx(deepest.depth, abs=AGREED)
    there = measured.distances[told.worst].min(axis=1)
    parts = {part_in_words(measured.links[link]) for link in np.flatnonzero(there < there.min() + AGREED)}
    assert any(f"the {part} would be" in told.what for part in parts)
    assert f"{length_in_words(-plan.verdict.nearest.distance)} deep in the box" in told.what
    first, last = plan.reproduction.times[[told.first, told.last]]
    assert min(abs(each.begins - first) for each in met) < 0.1
    assert first - 0.1 < deepest.begins < last + 0.1


def test_the_worst_problem_is_one_warning_above_the_tabs(through_a_box: Desk) -> None:
    state = through_a_box.state()
    assert state.plan is not None

    assert state.warning
    assert judgement.problems(state.plan)[0].what in state.message
    assert judgement.when(state.plan, judgement.problems(state.plan)[0]) in state.message


def test_a_run_through_a_thing_is_played_without_leaps_and_without_touching_the_arm_itself(
    through_a_box: Desk,
) -> None:
    plan = through_a_box.state().plan

    assert plan is not None
    assert plan.verdict.self_distance > 0.0
    assert not [problem for problem in plan.verdict.problems if problem.kind in {"leap", "reach"}]


@pytest.mark.parametrize("name", skill_names(SHELF))
def test_the_arm_can_do_every_run_of_a_built_in_skill_within_its_limits(name: str, jaco: Arm) -> None:
    desk = Desk(load_skill(SHELF, name), jaco)

    for run in range(len(desk.model.runs)):
        plan = planned(desk, run)
        steps = np.abs(np.diff(plan.path.joints, axis=0)) / np.diff(plan.clock)[:, None]
        assert judgement.warning(plan) is None
        assert plan.path.errors.max() < REACHED
        assert plan.verdict.self_distance > 0.0
        assert too_fast(plan.verdict.timed, jaco.velocity_limits, jaco.acceleration_limits) <= 1.0
        assert (steps / jaco.velocity_limits).max() < 1.05


@given(taught=SHARES, fastest=WAITS)
def test_a_pace_is_nowhere_faster_than_taught_nor_than_the_arm_can(
    taught: list[float], fastest: list[float]
) -> None:
    wanted, least = (np.cumsum([0.0, *steps]) for steps in (taught, fastest[: len(taught)]))

    steps = np.diff(no_faster_than(wanted, least))

    assert np.all(steps >= np.diff(wanted) - 1e-9)
    assert np.all(steps >= np.diff(least) - 1e-9)
    np.testing.assert_allclose(steps, np.maximum(np.diff(wanted), np.diff(least)), atol=1e-9)


@given(taught=SHARES, fastest=WAITS, moments=st.lists(st.floats(0.01, 0.5), min_size=1, max_size=20))
def test_playing_on_in_small_steps_is_playing_on_in_one(
    taught: list[float], fastest: list[float], moments: list[float]
) -> None:
    wanted = np.cumsum([0.0, *taught])
    pace = Pace(wanted, no_faster_than(wanted, np.cumsum([0.0, *fastest[: len(taught)]])))
    time = 0.0
    for dt in moments:
        time = pace.later(time, dt)

    assert time == pytest.approx(pace.later(0.0, sum(moments)), abs=1e-6)


@pytest.mark.parametrize("pace", ["taught", "fastest"])
def test_a_planned_run_takes_the_time_that_is_told(pace: str, desk: Desk, mouse: Mouse) -> None:
    plan = planned(desk)
    desk.accept_plan(plan)
    desk.look(pace=pace, loop=False)
    desk.stage.cue(0, desk.model, playing=True)
    needs = plan.verdict.timed.duration if pace == "fastest" else float(plan.clock[-1])

    mouse.wait(0.95 * needs)
    nearly = desk.state().playback
    mouse.wait(0.1 * needs)

    assert (nearly.playing, desk.state().playback.playing) == (True, False)
    assert f"{needs:.1f} s" in judgement.pace(plan)


def test_a_run_taught_too_fast_is_slowed_down_and_told_so(desk: Desk) -> None:
    hurried = replace(
        taught(),
        demonstrations=tuple(
            replace(shown, demonstration=replace(shown.demonstration, times=0.2 * shown.demonstration.times))
            for shown in taught().demonstrations
        ),
    )
    plan = planned(desk_of(hurried))

    assert plan.slowed
    assert plan.clock[-1] >= plan.verdict.timed.duration - 1e-6
    assert judgement.pace(plan).startswith(f"Taught in {plan.taught:.1f} s; the arm needs")


def test_a_plan_outlives_an_edit_that_leaves_its_run_alone(desk: Desk, mouse: Mouse) -> None:
    desk.accept_plan(planned(desk))
    desk.edit(lambda d: replace(d, title="My reach"), "rename", now=mouse.now)

    assert desk.state().plan is not None


def test_a_plan_ends_with_the_conditions_that_it_was_made_for(desk: Desk, mouse: Mouse) -> None:
    desk.accept_plan(planned(desk))
    box = Box("box", (0.5, 0.0, 0.1), (0.1, 0.1, 0.1))
    desk.edit(lambda d: replace(d, things=(box,)), "add a box", now=mouse.now)

    assert desk.state().plan is None
    assert desk.stage.unplanned(desk.model) == (0,)


def test_a_late_plan_of_what_is_gone_says_nothing(mouse: Mouse) -> None:
    desk = desk_of(replace(taught(), starts=(np.array([2.0, 0.0, 0.5]),)))
    late = planned(desk)
    desk.edit(lambda d: edits.move_start(d, 0, FIRST_START), "move start", now=mouse.now)
    desk.state()

    desk.accept_plan(late)

    assert not desk.state().warning
    assert desk.state().plans == ()


def test_the_run_that_is_played_is_planned_first_and_the_others_after_it(desk: Desk, mouse: Mouse) -> None:
    for shift in (0.02, 0.04):
        desk.edit(lambda d, s=shift: edits.add_start(d, FIRST_START - s), "add a start", now=mouse.now)
    desk.state()
    desk.choose_run(1, mouse.now)

    assert desk.stage.unplanned(desk.model) == (1, 0, 2)
    desk.accept_plan(planned(desk, 1))
    assert desk.stage.unplanned(desk.model) == (0, 2)


def test_of_several_runs_that_cannot_be_done_the_one_that_is_played_is_told() -> None:
    desk = desk_of(replace(taught(), starts=tuple(np.array([2.0, y, 0.5]) for y in (0.0, 0.1, 0.2))))
    desk.choose_run(1, 0.0)
    for run in (0, 1, 2):
        desk.accept_plan(planned(desk, run))

    assert desk.message.startswith("The arm cannot do run 2 as it is")


def test_while_a_start_is_pulled_the_other_runs_keep_their_plans(desk: Desk, mouse: Mouse) -> None:
    desk.edit(lambda d: edits.add_start(d, FIRST_START - 0.03), "add a start", now=mouse.now)
    desk.state()
    for run in (0, 1):
        desk.accept_plan(planned(desk, run))
    mouse.press("/start/1")
    mouse.move(BY)

    assert [plan.run for plan in desk.state().plans] == [0]


def test_the_hand_in_the_tube_and_the_whole_arm_are_two_sentences(jaco: Arm) -> None:
    document = load_skill(SHELF, "reaching")
    box = Box("box", (0.35, -0.3, 0.05), (0.08, 0.08, 0.08))
    plan = planned(Desk(replace(document, things=(box,)), jaco))

    inside, clear, *_ = judgement.facts(plan)

    assert inside == "The hand stays inside the tube."
    assert clear.startswith("The whole arm clears the box by")


def test_an_arm_that_knows_no_bodies_has_no_clearance_to_tell() -> None:
    said = " ".join(judgement.facts(planned(Desk(taught(), PlanarArm()))))

    assert "clears" not in said
    assert "itself" not in said
