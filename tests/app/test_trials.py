"""A run in a physical world: what the worker says, and what is shown of it."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from threading import Event

import numpy as np
import pytest

from app.actor import Actor
from app.arm import Jaco
from app.arm.physics_engine import missing
from app.arm.shapes import Box, Cylinder, Shape
from app.desk import Desk
from app.document import Document, Settings, Shown
from app.simulating import SupersededError, around, simulate
from app.skills import empty_skill, load_skill
from app.store import Task
from app.trial import Trial
from app.trials import Trials
from gc_core import Demonstration
from tests.arm.test_physics_missing import NoPybullet

needs_pybullet = pytest.mark.skipif(
    missing() is not None, reason="pybullet is not installed (the extra `physics`)"
)

SKILLS = Path(__file__).resolve().parents[2] / "static" / "skills"
FROM, TO = np.array([0.12, -0.5, 0.068]), np.array([-0.15, -0.48, 0.068])
CUP = Cylinder("cup", (0.12, -0.5, 0.03), 0.02, 0.06, mass=0.1)
CUBE = Box("cube", (-0.2, -0.48, 0.2), (0.06, 0.2, 0.4))


@pytest.fixture(scope="module")
def jaco() -> Iterator[Jaco]:
    arm = Jaco()
    yield arm
    arm.close()


def carrying(*things: Shape) -> Document:
    """A skill that closes the hand, carries something over, and opens it."""
    share = np.linspace(0.0, 1.0, 80)[:, None]
    eased = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    gripper = ((share[:, 0] > 0.1) & (share[:, 0] < 0.9)).astype(float)

    def shown(aside: float) -> Shown:
        over = np.array([0.0, aside, 0.12]) * 4.0 * eased * (1.0 - eased)
        return Shown(Demonstration(4.0 * share[:, 0], FROM + eased * (TO - FROM) + over, gripper=gripper))

    demonstrations = tuple(shown(aside) for aside in (-0.02, 0.0, 0.02))
    return Document(
        "Carry", demonstrations=demonstrations, settings=Settings(stations=60), starts=(FROM,), things=things
    )


def desk_with(jaco: Jaco, *things: Shape) -> Desk:
    desk = Desk(carrying(*things), jaco)
    desk.stage.pause()
    desk.state()
    return desk


def nobody(_: float) -> None:
    """Watch without a word."""


def tried(desk: Desk) -> Trial:
    task = desk.stage.task(desk.model)
    assert task is not None
    return simulate(task, Jaco, nobody)


@pytest.fixture(scope="module")
def carried(jaco: Jaco) -> tuple[Desk, Trial]:
    desk = desk_with(jaco, CUP)
    return desk, tried(desk)


@needs_pybullet
def test_what_the_hand_closes_on_is_carried_to_where_it_opens(carried: tuple[Desk, Trial]) -> None:
    trial = carried[1]
    assert trial.played is not None
    way = trial.played.objects["cup"][:, :3, 3]

    assert any(sentence.startswith("The hand carries the cup from ") for sentence in trial.said)
    assert way[:, 2].max() > CUP.position[2] + 0.05
    np.testing.assert_allclose(way[-1, :2] - CUP.position[:2], (TO - FROM)[:2], atol=0.02)


@needs_pybullet
def test_what_stands_in_the_way_is_touched_and_said_with_part_thing_time_and_force(jaco: Jaco) -> None:
    desk = desk_with(jaco, CUBE)
    desk.stage.heed(replace(desk.stage.arm.conditions, obstacles=()))
    said = " ".join(tried(desk).said)

    assert " touches the cube at " in said
    assert " N." in said


@needs_pybullet
def test_what_happened_is_shown_in_the_time_that_it_took_and_stays_at_its_end(
    carried: tuple[Desk, Trial],
) -> None:
    desk, trial = carried
    assert trial.played is not None
    desk.stage.accept_trial(trial)
    desk.play_trial(True, 0.0)
    moving = [desk.tick(0.04 * i, 0.04) for i in range(200)]
    shown = desk.state()

    assert moving.count(True) == pytest.approx(trial.played.times[-1] / 0.04, abs=2)
    assert shown.trial is not None
    assert shown.trial.time == trial.played.times[-1]
    np.testing.assert_array_equal(shown.hand.joints, trial.played.joints[-1])


@needs_pybullet
def test_a_changed_skill_makes_a_trial_stale_and_ends_its_show(carried: tuple[Desk, Trial]) -> None:
    desk, trial = carried
    desk.stage.accept_trial(trial)
    desk.play_trial(True, 0.0)
    desk.edit(lambda d: replace(d, starts=(FROM + 0.01,)), "move start", now=1.0)
    stale = desk.state().trial
    desk.undo(2.0)

    assert stale is not None
    assert stale.stale
    assert stale.time is None


def test_another_title_leaves_a_trial_as_it_is(jaco: Jaco) -> None:
    desk = desk_with(jaco)
    desk.stage.accept_trial(Trial(desk.model, 0))
    desk.edit(lambda d: replace(d, title="Carry it"), "rename the skill", now=1.0)
    trial = desk.state().trial

    assert trial is not None
    assert not trial.stale


@needs_pybullet
def test_things_are_shown_where_physics_put_them_while_it_is_shown(carried: tuple[Desk, Trial]) -> None:
    trial = carried[1]
    assert trial.played is not None
    end = float(trial.played.times[-1])
    (shown,) = replace(trial, time=end).moved((CUP,))

    np.testing.assert_allclose(shown.position, trial.played.objects["cup"][-1, :3, 3], atol=1e-9)
    assert trial.moved((CUP,)) == (CUP,)


def task_of(desk: Desk) -> Task:
    task = desk.stage.task(desk.model)
    assert task is not None
    return task


@needs_pybullet
def test_nobody_waits_and_the_work_ends_at_once(carried: tuple[Desk, Trial]) -> None:
    told: list[float] = []

    def watch(share: float) -> None:
        told.append(share)
        if len(told) == 3:
            raise SupersededError

    with pytest.raises(SupersededError):
        simulate(task_of(carried[0]), Jaco, watch)

    assert told == sorted(told)
    assert told[-1] < 0.5


@needs_pybullet
def test_the_newest_trial_wins_and_tells_how_far_it_is(
    carried: tuple[Desk, Trial], monkeypatch: pytest.MonkeyPatch
) -> None:
    desk = carried[0]
    told: list[float] = []
    done, accept = Event(), desk.stage.accept_trial

    def accept_and_tell(trial: Trial) -> None:  # a busy machine may draw the last one only
        accept(trial)
        told.append(trial.share)
        if trial.share == 1.0:
            done.set()

    def report(error: Exception) -> None:
        raise error

    monkeypatch.setattr(desk.stage, "accept_trial", accept_and_tell)
    actor = Actor(tick=lambda: False, draw=lambda: None, report=report, name="test")
    with ThreadPoolExecutor(1) as workers:
        trials = Trials(workers, actor, Jaco)
        actor.post(lambda: trials.begin(desk, 0.0))
        actor.post(lambda: trials.begin(desk, 0.0))
        finished = done.wait(30.0)
    actor.close()

    assert finished
    assert told.count(1.0) == 1
    assert any(0.0 < share < 1.0 for share in told)


def test_without_pybullet_the_trial_says_what_to_install(
    carried_task: Task, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delitem(sys.modules, "pybullet", raising=False)
    monkeypatch.setattr(sys, "meta_path", [NoPybullet(), *sys.meta_path])
    trial = simulate(carried_task, Jaco, nobody)

    assert "pip install 'gc-teach[physics]'" in trial.said[0]
    assert trial.played is None


@pytest.fixture
def carried_task(jaco: Jaco) -> Task:
    return task_of(desk_with(jaco))


def test_a_trial_is_of_what_was_just_edited(jaco: Jaco) -> None:
    desk = desk_with(jaco, CUP)
    actor = Actor(tick=lambda: False, draw=lambda: None, report=lambda _: None, name="test")
    with ThreadPoolExecutor(1) as workers:
        trials = Trials(workers, actor, Jaco)
        desk.edit(lambda d: replace(d, starts=(FROM + 0.01,)), "move start", now=1.0)
        trials.begin(desk, 1.0)
        trial = desk.state().trial
        trials.give_up()
    actor.close()

    assert trial is not None
    assert not trial.stale


def test_what_is_carried_is_there_when_a_landmark_has_its_name(carried_task: Task) -> None:
    source = replace(carried_task.model.source, things=(CUP,))
    post = replace(CUP, position=(0.3, -0.4, 0.1), mass=0.0)
    task = replace(
        carried_task,
        model=replace(carried_task.model, source=source),
        conditions=replace(carried_task.conditions, obstacles=(post,)),
    )
    things = around(task)

    assert CUP in things
    assert len({thing.name for thing in things}) == len(things) == 2


@needs_pybullet
@needs_pybullet
def test_a_trial_of_another_skill_is_forgotten(carried: tuple[Desk, Trial]) -> None:
    desk, trial = carried
    desk.undo(0.0)
    desk.stage.accept_trial(trial)
    assert desk.state().trial is not None

    desk.open(empty_skill(), 1.0)
    forgotten = desk.state().trial
    desk.undo(2.0)

    assert forgotten is None


def test_another_run_ends_the_show_of_a_trial(carried: tuple[Desk, Trial]) -> None:
    desk, trial = carried
    desk.learned()
    desk.stage.accept_trial(replace(trial, source=desk.model))
    desk.play_trial(True, 0.0)
    desk.choose_run(0, 0.1)
    shown = desk.state().trial

    assert shown is not None
    assert shown.time is None


@needs_pybullet
def test_a_run_that_physics_cannot_begin_says_why(jaco: Jaco) -> None:
    desk = desk_with(jaco)
    block = Box("block", (0.12, -0.5, 0.068), (0.1, 0.1, 0.1))
    task = task_of(desk)
    source = replace(task.model, source=replace(task.model.source, things=(block,)))
    trial = simulate(replace(task, model=source), Jaco, nobody)

    assert "deep in the block where the path begins" in trial.said[0]
    assert trial.played is None


@needs_pybullet
def test_the_cup_of_pick_and_place_is_carried_to_where_the_hand_opens(
    jaco: Jaco,
) -> None:
    document = load_skill(SKILLS, "pick_and_place")
    desk = Desk(document, jaco)
    desk.state()
    trial = tried(desk)
    assert trial.played is not None
    end = trial.played.objects["cup"][-1, :3, 3]

    assert [carried.object for carried in trial.played.carried] == ["cup"]
    assert np.linalg.norm(end[:2] - desk.model.runs[0].reproduction.positions[-1, :2]) < 0.03
    assert trial.played.objects["cup"][-1, 2, 2] > 0.99
