"""Replay and let me correct: the hand yields, what it did is offered, and nothing is kept unasked."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import distance  # pyright: ignore[reportMissingTypeStubs]  # SciPy has none

from app import correcting
from app.actions import Drag, Phase
from app.amending import ONLY_THE_HAND
from app.compliance import MEDIUM
from app.correcting import NOTHING
from app.desk import Desk
from app.document import FloatArray
from app.progress import Progress
from app.proposal import DISCARDED, FIRST_ANSWER, Proposal
from app.replaying import Corrected, Subject
from app.store import State
from app.turning import orientation_of
from tests.app.makers import TICK, Mouse

PULL = 0.08
BEGUN = 0.4
"""From this time of the path on the hand is pulled [s]."""
ASIDE = np.array([0.0, 0.0, PULL])


def replay(desk: Desk, mouse: Mouse, node: str = "/demonstrations/0", *, speed: float = 1.0) -> None:
    """Press the button and wait until the arm has come to the beginning and some way on."""
    desk.look(replay=node, replay_speed=speed, replay_feel="medium")
    desk.start_replay(mouse.now)
    while (running := desk.state().replay) is not None and running.time < BEGUN:
        mouse.wait(TICK)


def corrected(
    desk: Desk, mouse: Mouse, node: str = "/demonstrations/0", by: FloatArray = ASIDE, *, held: float = 0.6
) -> State:
    """Pull the hand of a replay aside, hold it, let it go, and wait for the end."""
    replay(desk, mouse, node)
    mouse.press("/hand")
    for _ in range(6):
        mouse.move(by / 6.0)
    mouse.wait(held)
    mouse.release()
    mouse.wait(6.0)
    return desk.state()


def former(desk: Desk, index: int = 0) -> FloatArray:
    return desk.store.document.demonstrations[index].demonstration.positions


def test_a_replay_goes_the_way_that_was_shown_and_ends_by_itself(desk: Desk, mouse: Mouse) -> None:
    replay(desk, mouse)
    done, path = desk.state().replay, former(desk)
    mouse.wait(6.0)

    assert done is not None
    gaps = np.linalg.norm(done.done[:, None] - path[None], axis=2).min(axis=1)
    assert len(done.done) >= 100 * BEGUN
    assert gaps.max() < 0.01
    assert desk.state().replay is None


def test_nobody_pulled_and_nothing_is_offered(desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document
    replay(desk, mouse)
    mouse.wait(6.0)

    assert desk.state().proposal is None
    assert desk.state().message == NOTHING
    assert desk.store.document is before


def test_the_hand_yields_as_the_stiffness_says_and_comes_back(desk: Desk, mouse: Mouse) -> None:
    shown = desk.store.document.demonstrations[0].demonstration
    corrected(desk, mouse, held=1.0)
    desk.amend(lambda amending: amending.answer(0, mouse.now))
    made = desk.store.document.demonstrations[0].demonstration
    belongs = [np.interp(made.times, shown.times, along) for along in shown.positions.T]
    away = np.linalg.norm(made.positions - np.stack(belongs, axis=1), axis=1)

    assert away.max() == pytest.approx(MEDIUM.deflection(PULL), rel=0.15)
    assert away[:30].max() < 1e-3
    assert away[-10:].max() < 1e-3


@pytest.mark.parametrize("speed", [0.25, 1.0])
def test_it_is_recorded_in_exact_ticks_on_the_clock_of_what_was_shown(
    desk: Desk, mouse: Mouse, speed: float
) -> None:
    shown = desk.store.document.demonstrations[0].demonstration
    replay(desk, mouse, speed=speed)
    mouse.pull("/hand", ASIDE)
    mouse.wait(3.5 / speed)
    desk.amend(lambda amending: amending.answer(0, mouse.now))
    made = desk.store.document.demonstrations[0].demonstration

    np.testing.assert_allclose(np.diff(made.times)[:-1], 0.01 * speed, atol=1e-9)
    assert made.times[-1] == pytest.approx(shown.times[-1], abs=0.02)
    assert made.name == shown.name


def test_what_the_gripper_did_stays(desk: Desk, mouse: Mouse) -> None:
    shown = desk.store.document.demonstrations[0].demonstration
    corrected(desk, mouse)
    desk.amend(lambda amending: amending.answer(0, mouse.now))
    made = desk.store.document.demonstrations[0].demonstration

    assert shown.gripper is not None
    assert made.gripper is not None
    closes = [d.times[int(np.argmax(g >= 0.5))] for d, g in ((shown, shown.gripper), (made, made.gripper))]
    assert closes[0] == pytest.approx(closes[1], abs=0.02)


def test_the_tube_with_the_correction_is_seen_before_it_is_kept(desk: Desk, mouse: Mouse) -> None:
    before, tube = desk.store.document, desk.state().model.cylinder
    state = corrected(desk, mouse)

    assert state.proposal is not None
    assert state.model.cylinder is not tube
    assert state.document.demonstrations[0] is not before.demonstrations[0]
    assert desk.store.document is before


def test_accepting_replaces_one_demonstration_in_one_undo_step(desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document
    corrected(desk, mouse)
    desk.amend(lambda amending: amending.answer(0, mouse.now))
    after = desk.store.document
    kept = [one is other for one, other in zip(before.demonstrations, after.demonstrations, strict=True)]
    desk.undo(mouse.now)

    assert kept == [False, True, True]
    assert desk.state().proposal is None
    assert desk.store.document is before


def test_discarding_leaves_the_document_and_the_model_as_they_were(desk: Desk, mouse: Mouse) -> None:
    before, directrix = desk.store.document, desk.state().model.cylinder.directrix
    corrected(desk, mouse)
    desk.amend(lambda amending: amending.answer(None, mouse.now))

    assert desk.store.document is before
    assert desk.store.undo_name is None
    assert desk.state().message == DISCARDED
    np.testing.assert_array_equal(desk.state().model.cylinder.directrix, directrix)


def test_undo_discards_a_correction_that_waits_and_nothing_else(desk: Desk, mouse: Mouse) -> None:
    mouse.pull("/landmarks/goal", (0.03, 0.0, 0.0))
    moved = desk.store.document
    corrected(desk, mouse)
    desk.undo(mouse.now)

    assert desk.store.document is moved
    assert desk.state().proposal is None


def test_a_corrected_run_becomes_a_rule_that_holds_it_up(desk: Desk, mouse: Mouse) -> None:
    state = corrected(desk, mouse, "/reproductions/0")
    assert state.proposal is not None
    assert [choice.label for choice in state.proposal.choices] == ["Add a rule", "Teach it"]
    demonstrations = desk.store.document.demonstrations
    desk.amend(lambda amending: amending.answer(0, mouse.now))
    run = desk.state().model.runs[0]
    lift = run.reproduction.positions[:, 2] - run.free.positions[:, 2]

    assert desk.store.document.demonstrations is demonstrations
    assert len(desk.store.document.rules) == 1
    assert lift.max() > 0.8 * MEDIUM.deflection(PULL)


def test_a_corrected_run_can_join_the_demonstrations(desk: Desk, mouse: Mouse) -> None:
    corrected(desk, mouse, "/reproductions/0")
    desk.amend(lambda amending: amending.answer(1, mouse.now))

    assert desk.store.document.rules == ()
    assert desk.store.document.demonstrations[3].demonstration.name == "Corrected run 1"


def test_either_choice_can_be_looked_at_first(desk: Desk, mouse: Mouse) -> None:
    corrected(desk, mouse, "/reproductions/0")
    as_rule = desk.state().document
    desk.amending.preview(1)
    as_lesson = desk.state().document

    assert (len(as_rule.rules), len(as_rule.demonstrations)) == (1, 3)
    assert (len(as_lesson.rules), len(as_lesson.demonstrations)) == (0, 4)


def test_stop_keeps_what_was_corrected_and_the_rest_as_it_was(desk: Desk, mouse: Mouse) -> None:
    path = former(desk)
    replay(desk, mouse)
    mouse.pull("/hand", ASIDE)
    desk.amend(lambda amending: amending.end(mouse.now))
    proposal = desk.state().proposal

    assert desk.state().replay is None
    assert proposal is not None
    np.testing.assert_array_equal(proposal.after[-15:], path[-15:])
    steps = np.linalg.norm(np.diff(proposal.after, axis=0), axis=1)
    assert steps.max() < 1.5 * np.linalg.norm(np.diff(path, axis=0), axis=1).max()


def test_a_lost_connection_ends_it_and_keeps_nothing_unasked(desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document
    replay(desk, mouse)
    mouse.press("/hand")
    mouse.move(ASIDE)
    mouse.wait(0.4)
    desk.let_go(mouse.now)
    mouse.wait(1.0)

    assert desk.state().replay is None
    assert desk.store.document is before
    assert desk.state().proposal is not None


def test_only_the_hand_can_be_pulled_while_it_replays(desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document
    replay(desk, mouse)
    mouse.pull("/landmarks/goal", (0.05, 0.0, 0.0))

    assert desk.state().message == ONLY_THE_HAND
    assert desk.state().replay is not None
    assert desk.store.document is before


def test_a_correction_must_be_answered_before_the_next_pull(desk: Desk, mouse: Mouse) -> None:
    corrected(desk, mouse, "/reproductions/0")
    mouse.pull("/landmarks/goal", (0.05, 0.0, 0.0), kept=False)

    assert desk.state().message == FIRST_ANSWER
    assert desk.state().proposal is not None


def test_after_a_replay_it_is_known_how_the_tool_is_turned(desk: Desk, mouse: Mouse) -> None:
    replay(desk, mouse)
    hand = desk.state().hand

    assert hand.turned == orientation_of(desk.stage.arm.tool_pose(hand.joints))


def test_a_motion_that_is_gone_is_replaced_by_the_first_as_the_panel_shows(desk: Desk, mouse: Mouse) -> None:
    desk.look(replay="/reproductions/7")
    desk.start_replay(mouse.now)
    replayed = desk.state().replay

    assert replayed is not None
    np.testing.assert_array_equal(replayed.path, former(desk))


def test_play_ends_a_replay(desk: Desk, mouse: Mouse) -> None:
    replay(desk, mouse)
    desk.play(True, mouse.now)

    assert desk.state().replay is None
    assert desk.state().playback.playing


def test_the_end_that_is_held_is_where_the_motion_ends(desk: Desk, mouse: Mouse) -> None:
    path = former(desk)
    replay(desk, mouse)
    mouse.wait(1.5)
    mouse.press("/hand")
    for _ in range(6):
        mouse.move(ASIDE / 6.0)
    mouse.wait(3.0)
    mouse.release()
    mouse.wait(0.6)
    proposal = desk.state().proposal

    assert proposal is not None
    raised = float(proposal.after[-1, 2] - path[-1, 2])
    assert raised == pytest.approx(MEDIUM.deflection(PULL), rel=0.15)


def test_a_pointer_that_rests_does_not_pull_a_hand_that_comes_nearer(desk: Desk, mouse: Mouse) -> None:
    """viser's plane goes along with the hand."""
    replay(desk, mouse)
    at = desk.state().hand.position
    eye = at - [0.5, 2.0, 0.5]

    def say(phase: Phase, nearer: float) -> None:
        mouse.now += 0.05
        pointer = eye + nearer * (at - eye)
        desk.drag(Drag("/hand", phase, pointer, pointer, mouse.now, eye=eye, ahead=np.array([0.0, 1.0, 0.0])))

    say("start", 1.0)
    for nearer in np.linspace(1.0, 0.8, 10):
        say("update", float(nearer))
    say("end", 0.8)
    mouse.wait(6.0)

    assert desk.state().message == NOTHING


def test_every_event_of_a_pull_is_used(desk: Desk, mouse: Mouse, monkeypatch: pytest.MonkeyPatch) -> None:
    kept: list[Corrected] = []

    def proposed(subject: Subject, corrected: Corrected) -> Proposal:
        kept.append(corrected)
        return original(subject, corrected)

    original = correcting.proposed
    monkeypatch.setattr(correcting, "proposed", proposed)
    replay(desk, mouse)
    mouse.pull("/hand", ASIDE, events=17)
    mouse.wait(6.0)

    assert kept[-1].events == 1 + 17 + 1


def test_after_a_replay_the_playhead_is_at_the_beginning_and_the_hand_stays(desk: Desk, mouse: Mouse) -> None:
    desk.seek(1.0, mouse.now)
    replay(desk, mouse)
    desk.amend(lambda amending: amending.end(mouse.now))
    hand = desk.state().hand.position
    mouse.wait(0.5)

    assert desk.state().playback.time == 0.0
    np.testing.assert_array_equal(desk.state().hand.position, hand)


def held_aside(desk: Desk, mouse: Mouse, node: str) -> Progress:
    """Pull the hand of a replay aside and hold it."""
    replay(desk, mouse, node)
    mouse.press("/hand")
    for _ in range(6):
        mouse.move(ASIDE / 6.0)
    mouse.wait(0.4)
    progress = desk.state().replay
    assert progress is not None
    return progress


def test_the_tube_that_is_outlined_while_the_hand_is_held_is_the_one_that_is_learned(
    desk: Desk, mouse: Mouse
) -> None:
    before, kept = desk.state().model.cylinder, desk.store.document
    progress = held_aside(desk, mouse, "/demonstrations/0")
    while_held = desk.state().model.cylinder, desk.store.document
    desk.amend(lambda amending: amending.end(mouse.now))
    learned = desk.state().model.cylinder

    assert while_held == (before, kept)
    assert progress.effect.startswith("1 of 1 run changes, by up to")
    outline = progress.outline
    assert before is not None
    assert outline is not None
    assert learned is not None
    moved = distance.directed_hausdorff(learned.directrix, before.directrix)[0]
    assert distance.directed_hausdorff(outline.directrix, learned.directrix)[0] < 0.2 * moved


def test_while_the_hand_is_held_in_a_replay_of_a_run_the_tube_stays_and_the_rule_moves_the_run(
    desk: Desk, mouse: Mouse
) -> None:
    progress = held_aside(desk, mouse, "/reproductions/0")

    assert progress.outline is None
    assert progress.effect.startswith("1 of 1 run changes, by up to")


def test_a_click_beside_the_hand_of_a_replay_says_to_take_the_hand_itself(desk: Desk, mouse: Mouse) -> None:
    replay(desk, mouse)
    desk.amend(lambda amending: amending.missed())
    during = desk.state()
    mouse.wait(6.0)
    desk.say("")
    desk.amend(lambda amending: amending.missed())

    assert (during.message, during.replay is None) == (ONLY_THE_HAND, False)
    assert desk.state().message == ""
