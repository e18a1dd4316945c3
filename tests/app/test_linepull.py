"""Pulling on a line: what it becomes, what is asked, and that nothing is kept unasked."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app import edits, linepull
from app.arm.protocol import JointPath
from app.desk import Desk
from app.document import FloatArray
from app.linepull import LinePull
from app.model import learn
from app.panels.proposal import effect
from app.proposal import FIRST_ANSWER
from app.seat import answer
from gc_core import same_content
from tests.app.makers import Mouse, demonstration, desk_of, place_of, taught

LINES = ("/demonstrations/1", "/reproductions/0")
BY = np.array([0.0, 0.0, -0.05])
WALL = 0.10
"""An arm that is made for these tests goes no lower than this [m]."""


def not_below(path: FloatArray) -> str | None:
    """Nothing is reached below a height."""
    return "below the wall" if path[:, 2].min() < WALL else None


def hold(width: float = 0.2, *, unreachable=lambda _: None, node: str = LINES[0]) -> LinePull:
    model = learn(taught())
    pull = linepull.take(node, place_of(node, model, BY), model, width, unreachable=unreachable)
    assert pull is not None
    return pull


@given(width=st.floats(0.02, 0.6), wider=st.floats(1.05, 3.0))
def test_a_wider_pull_takes_more_of_the_line_along_and_its_place_as_far(width: float, wider: float) -> None:
    pull = hold(width)
    wide = pull.widened(width * wider)
    moved = [np.linalg.norm(one.reached(BY).positions - one.path, axis=1) for one in (pull, wide)]

    assert (moved[1] >= moved[0] - 1e-12).all()
    np.testing.assert_allclose([one[pull.index] for one in moved], 0.05, atol=1e-12)


def test_a_pull_goes_as_far_as_the_arm_and_says_what_holds_it_back() -> None:
    pull = hold(unreachable=not_below)
    reach = pull.reached(10.0 * BY)
    farther = pull.path + 1.02 * (reach.positions - pull.path)

    assert reach.why == "below the wall"
    assert not_below(reach.positions) is None
    assert not_below(farther) is not None


def test_a_line_that_was_out_of_reach_already_is_not_held_back() -> None:
    pull = hold(unreachable=lambda _: "12 cm beyond reach")

    assert pull.reached(BY).moved == pytest.approx(0.05)


def test_while_a_line_is_pulled_it_is_said_how_many_runs_change(desk: Desk, mouse: Mouse) -> None:
    mouse.press("/demonstrations/1")
    mouse.move(2.0 * BY)

    assert desk.state().message.startswith("1 of 1 run changes, by up to ")
    assert not desk.state().warning


def test_the_width_can_be_changed_while_pulling(desk: Desk, mouse: Mouse) -> None:
    mouse.press("/demonstrations/1")
    mouse.move(BY)
    narrow = desk.state().correction
    desk.look(pull_width=0.4)
    wide = desk.state().correction

    assert narrow is not None
    assert wide is not None
    assert np.abs(wide.after - wide.before).sum() > 1.2 * np.abs(narrow.after - narrow.before).sum()
    assert "40 cm wide" in desk.state().message


@pytest.mark.parametrize("node", LINES)
def test_nothing_is_stored_before_the_answer(node: str, desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document
    mouse.pull(node, BY, kept=False)
    state = desk.state()

    assert desk.store.document is before
    assert state.proposal is not None
    assert not same_content(state.document, before)


@pytest.mark.parametrize("node", LINES)
def test_a_connection_lost_in_mid_pull_leaves_nothing_half_applied(
    node: str, desk: Desk, mouse: Mouse
) -> None:
    before = desk.store.document
    mouse.press(node)
    mouse.move(BY)
    desk.let_go(mouse.now)

    assert desk.store.document is before
    assert desk.state().dragging is None
    assert desk.state().correction is None


@pytest.mark.parametrize("node", LINES)
def test_undo_discards_what_was_pulled_and_nothing_else(node: str, desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document
    mouse.pull(node, BY, kept=False)
    asked = desk.state()
    assert (asked.undo_name, asked.redo_name) == ("discard the correction", None)
    desk.undo(mouse.now)

    assert desk.store.document is before
    assert desk.state().document is before


def test_the_line_of_a_run_asks_what_becomes_of_it(desk: Desk, mouse: Mouse) -> None:
    mouse.pull("/reproductions/0", BY, kept=False)
    proposal = desk.state().proposal

    assert proposal is not None
    assert [choice.label for choice in proposal.choices] == ["Add a rule", "Teach it"]


def test_a_pulled_run_that_is_taught_joins_as_it_was_pulled(desk: Desk, mouse: Mouse) -> None:
    run = desk.state().model.runs[0].reproduction
    mouse.pull("/reproductions/0", BY, kept=False)
    desk.amend(lambda amending: amending.answer(1, mouse.now))
    made = desk.store.document.demonstrations[-1].demonstration

    assert np.linalg.norm(made.positions - run.positions, axis=1).max() == pytest.approx(0.05, abs=1e-9)
    np.testing.assert_array_equal(made.times, run.times)
    assert desk.store.document.rules == ()


def test_where_landmarks_fold_space_a_pulled_run_can_be_taught_and_still_asks(mouse: Mouse) -> None:
    folded = edits.move_landmark(taught(), "goal", learn(taught()).cylinder.directrix[0] + 1e-4)
    mouse.desk = desk = desk_of(folded)
    mouse.pull("/reproductions/0", np.array([0.3, 0.3, 0.0]), kept=False)
    said = desk.state()
    mouse.pull("/landmarks/goal", BY, kept=False)

    assert said.warning
    assert said.message.startswith("The landmarks are moved so far that space folds")
    assert [choice.label for choice in said.proposal.choices] == ["Teach it"]
    assert desk.store.document is folded


def test_a_step_back_is_taken_even_where_what_is_held_cannot_be_kept(mouse: Mouse) -> None:
    folded = edits.move_landmark(taught(), "goal", learn(taught()).cylinder.directrix[0] + 1e-4)
    mouse.desk = desk = desk_of(taught())
    desk.edit(lambda _: folded, "move the goal", now=mouse.now)
    mouse.press("/reproductions/0")
    mouse.move([0.3, 0.3, 0.0])
    desk.undo(mouse.now)  # the correction, which cannot be a rule
    desk.undo(mouse.now)

    assert desk.store.undo_name is None


def test_whoever_goes_on_accepts_what_there_is_only_one_thing_to_do_with(desk: Desk, mouse: Mouse) -> None:
    mouse.pull("/demonstrations/1", BY, kept=False)
    shown = desk.state().document
    mouse.pull("/demonstrations/0", BY, kept=False)

    assert same_content(desk.store.document, shown)
    assert desk.state().proposal is not None


def test_a_run_that_waits_for_its_answer_keeps_other_pulls_waiting(desk: Desk, mouse: Mouse) -> None:
    before = desk.store.document
    mouse.pull("/reproductions/0", BY, kept=False)
    mouse.pull("/landmarks/goal", BY, kept=False)

    assert desk.store.document is before
    assert desk.state().message == FIRST_ANSWER


@pytest.mark.parametrize("node", LINES)
def test_a_line_can_be_pulled_again_before_it_is_answered(node: str, desk: Desk, mouse: Mouse) -> None:
    mouse.pull(node, BY, kept=False)
    once = desk.state().proposal
    assert once is not None
    places = [once.after[len(once.after) // part] for part in (2, 4)]
    mouse.pull(node, BY, at=places[1], kept=False)
    twice = desk.state().proposal
    desk.amend(lambda amending: amending.answer(0, mouse.now))
    desk.undo(mouse.now)

    assert twice is not None
    assert twice.before is once.before
    assert twice.after[len(once.after) // 4, 2] == pytest.approx(places[1][2] - 0.05, abs=1e-6)
    assert desk.store.undo_name is None


def test_a_slip_of_the_hand_leaves_the_correction_that_waits(desk: Desk, mouse: Mouse) -> None:
    mouse.pull("/reproductions/0", BY, kept=False)
    waiting = desk.state().proposal
    mouse.pull("/reproductions/0", (0.0003, 0.0, 0.0), events=1, kept=False)

    assert desk.state().proposal is waiting


@pytest.fixture
def stiff(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> Desk:
    """A desk whose arm cannot follow where a line is lower than any that was shown."""

    def follow(self: object, positions: FloatArray, *_: object) -> JointPath:
        low = positions[:, 2] < demonstration(1).positions[:, 2].min() - 0.01
        return JointPath(np.zeros((len(positions), 2)), np.where(low, 0.03, 0.0))

    monkeypatch.setattr(type(desk.stage.arm), "follow", follow)
    return desk


def test_a_line_that_the_arm_cannot_follow_is_not_recorded(stiff: Desk, mouse: Mouse) -> None:
    before = stiff.store.document
    mouse.pull("/demonstrations/1", 6.0 * BY)

    assert stiff.state().proposal is None
    assert stiff.store.document is before
    assert "stays 3.0 cm off" in stiff.state().message


def test_a_run_that_the_arm_cannot_follow_can_be_a_rule_only_and_still_asks(
    stiff: Desk, mouse: Mouse
) -> None:
    before = stiff.store.document
    mouse.pull("/reproductions/0", 6.0 * BY, kept=False)
    mouse.pull("/landmarks/goal", BY, kept=False)
    proposal = stiff.state().proposal

    assert proposal is not None
    assert [choice.label for choice in proposal.choices] == ["Add a rule"]
    assert stiff.store.document is before


@pytest.mark.parametrize("node", LINES)
def test_a_line_moved_by_numbers_becomes_what_the_mouse_makes_of_it(
    node: str, desk: Desk, mouse: Mouse
) -> None:
    place = linepull.place_on(node, 0.4, desk.state().model, None)
    assert place is not None
    mouse.pull(node, BY, at=place, kept=False)
    pulled = desk.state().proposal
    desk.undo(mouse.now)
    desk.leading.move_line(node, 0.4, BY, mouse.now)
    moved = desk.state().proposal

    assert pulled is not None
    assert moved is not None
    np.testing.assert_allclose(moved.after, pulled.after, atol=1e-12)
    assert [one.label for one in moved.choices] == [one.label for one in pulled.choices]


def test_a_line_moved_twice_by_numbers_goes_on_from_the_same_place(desk: Desk, mouse: Mouse) -> None:
    share, before = 0.4, desk.state()
    for _ in range(2):
        desk.leading.move_line(LINES[1], share, 0.4 * BY, mouse.now)
    state = desk.state()
    places = [linepull.place_on(LINES[1], share, one.model, one.proposal) for one in (before, state)]

    assert places[0] is not None
    assert places[1] is not None
    np.testing.assert_allclose(places[1] - places[0], 0.8 * BY, atol=1e-9)


def test_numbers_that_lead_a_line_out_of_reach_say_what_holds_it_back(desk: Desk, mouse: Mouse) -> None:
    for _ in range(3):
        desk.leading.move_line(LINES[0], 0.5, np.array([0.5, 0.0, 0.0]), mouse.now)

    assert desk.state().message.startswith("The arm cannot follow")
    assert desk.state().warning


@pytest.mark.parametrize("by", [(np.nan, 0.0, 0.0), (9.0, 0.0, 0.0)])
def test_numbers_that_make_no_sense_move_no_line(by: tuple[float, ...], desk: Desk, mouse: Mouse) -> None:
    desk.leading.move_line(LINES[0], 0.5, np.array(by), mouse.now)

    assert desk.state().proposal is None


def test_what_teaching_a_pulled_run_changes_is_said_in_centimetres_though_runs_get_other_lengths(
    desk: Desk, mouse: Mouse
) -> None:
    mouse.pull(LINES[1], BY, kept=False)
    desk.amending.preview(1)
    state = desk.state()

    assert state.proposal is not None
    assert "1 of 1 run changes, by up to" in effect(state.proposal, state)


def test_a_rule_that_is_made_shows_its_arrows(desk: Desk, mouse: Mouse) -> None:
    desk.look(rule=None)
    mouse.pull(LINES[1], BY, kept=False)
    answer(desk, 0, mouse.now)

    assert desk.view.rule == -1
