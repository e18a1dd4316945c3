"""Skills keep their laws where their files say that landmarks can be moved to (Fig. 7 of the paper)."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.arm import Jaco
from app.document import SECTION_KINDS
from app.model import STIFFNESS, learn
from app.skills import load_card, load_skill
from gc_core import GeneralizedCylinder, ThinPlateSpline, encode, generalize, register, reproduce
from tests.skills.curves import bow, shape_change

FOLDER = Path(__file__).parents[2] / "static" / "skills"
ALL_KINDS = (*SECTION_KINDS, "hull")
"""Those that a document can have, and the tightest."""
CURVED, PICK = "curved_reach_and_place", "pick_and_place"
EXACT = 0.001
"""How near to its landmark an end is [m]."""


@dataclass(frozen=True)
class Move:
    """Where a skill's landmarks stand; None: where they stood."""

    skill: str
    start: tuple[float, float, float] | None = None
    goal: tuple[float, float, float] | None = None

    def __str__(self) -> str:
        return f"{self.skill}, start {self.start}, goal {self.goal}"


def moves_of(skill: str) -> list[Move]:
    card = load_card(FOLDER, skill)
    return [Move(skill, goal=place) for place in card.new_goals] + [
        Move(skill, start=place) for place in card.new_starts
    ]


CURVED_MOVES, PICK_MOVES = moves_of(CURVED), moves_of(PICK)
every_kind = pytest.mark.parametrize("section", ALL_KINDS)
every_move = pytest.mark.parametrize("move", CURVED_MOVES + PICK_MOVES, ids=str)
curved_still_or_moved = pytest.mark.parametrize("move", [Move(CURVED), *CURVED_MOVES], ids=str)
pick_still_or_moved = pytest.mark.parametrize("move", [Move(PICK), *PICK_MOVES], ids=str)
everywhere = pytest.mark.parametrize("move", [Move(CURVED), *CURVED_MOVES, Move(PICK), *PICK_MOVES], ids=str)


@cache
def taught(skill: str, section: str) -> GeneralizedCylinder:
    document = load_skill(FOLDER, skill)
    shown = [item.demonstration for item in document.demonstrations]
    return encode(shown, section=section, align_by=document.settings.align_by)


@cache
def ends(move: Move) -> tuple[np.ndarray, np.ndarray]:
    """(2, 3) start and goal before and after, as the app has them."""
    before = np.array([taught(move.skill, "circle").directrix[0], load_card(FOLDER, move.skill).goal])
    after = before.copy()
    for row, place in enumerate((move.start, move.goal)):
        if place is not None:
            after[row] = place
    return before, after


@cache
def map_of(move: Move) -> ThinPlateSpline:
    return register(*ends(move), stiffness=STIFFNESS)


@cache
def moved(move: Move, section: str) -> GeneralizedCylinder:
    if move == Move(move.skill):
        return taught(move.skill, section)
    return generalize(taught(move.skill, section), map_of(move))


def new_starts(move: Move) -> np.ndarray:
    """(S, 3) where the skill's own reproductions begin after the move: the start takes them along [m]."""
    before, after = ends(move)
    return np.array(load_card(FOLDER, move.skill).starts) + after[0] - before[0]


def changes(gripper: np.ndarray | None) -> list[tuple[int, float]]:
    """Samples at which the gripper has another value than before, and this value."""
    assert gripper is not None
    return [(int(i), float(gripper[i])) for i in np.flatnonzero(np.diff(gripper)) + 1]


def test_the_papers_experiments_have_three_new_goals_and_four_new_starts() -> None:
    assert len({move.goal for move in CURVED_MOVES} - {None}) == 3
    assert len({move.start for move in PICK_MOVES} - {None}) == 4


@every_move
def test_a_landmark_is_moved_by_a_decimetre_or_more_within_reach(move: Move) -> None:
    before, after = ends(move)

    assert 0.1 < np.linalg.norm(after - before, axis=1).max() < 0.25


@every_kind
@every_move
def test_the_tube_ends_at_the_new_landmarks(move: Move, section: str) -> None:
    directrix = moved(move, section).directrix[[0, -1]]

    assert np.linalg.norm(directrix - ends(move)[1], axis=1).max() <= EXACT


@every_kind
@everywhere
def test_nothing_folds_or_crosses(move: Move, section: str) -> None:
    tube = moved(move, section)

    assert np.isfinite(tube.surface()).all()
    assert not tube.diagnostics.crossing.any()
    assert not tube.diagnostics.folded.any()


@every_kind
@curved_still_or_moved
def test_the_curve_is_kept(move: Move, section: str) -> None:
    law, curve = load_card(FOLDER, CURVED).law, moved(move, section).directrix

    assert bow(curve) >= law["bow"]
    assert shape_change(taught(CURVED, section).directrix, curve) <= law["shape_change"]


@every_kind
@pick_still_or_moved
def test_pick_and_place_is_narrow_at_both_ends_and_wide_in_the_middle(move: Move, section: str) -> None:
    width = 2.0 * moved(move, section).radii.mean(axis=1)
    middle = np.interp(0.5, np.linspace(0.0, 1.0, len(width)), width)

    assert max(width[0], width[-1]) <= load_card(FOLDER, PICK).law["ends_to_middle"] * middle
    assert 0.4 < np.argmax(width) / len(width) < 0.6


@every_kind
@pick_still_or_moved
def test_the_hand_closes_at_the_pick_and_opens_at_the_place(move: Move, section: str) -> None:
    near = load_card(FOLDER, PICK).law["grip_m"]
    start, goal = ends(move)[1]

    for begin in new_starts(move):
        run = reproduce(moved(move, section), begin)
        assert [value for _, value in changes(run.gripper)] == [1.0, 0.0]
        (closes, _), (opens, _) = changes(run.gripper)
        assert np.linalg.norm(run.positions[closes] - start) <= near
        assert np.linalg.norm(run.positions[opens] - goal) <= near


def test_every_demonstration_of_pick_and_place_closes_and_opens_the_hand_once() -> None:
    card = load_card(FOLDER, PICK)
    for item in load_skill(FOLDER, PICK).demonstrations:
        shown = item.demonstration
        assert [value for _, value in changes(shown.gripper)] == [1.0, 0.0], shown.name
        (closes, _), (opens, _) = changes(shown.gripper)
        assert np.linalg.norm(shown.positions[closes] - shown.positions[0]) <= card.law["grip_m"]
        assert np.linalg.norm(shown.positions[opens] - card.goal) <= card.law["grip_m"]


def test_every_demonstration_of_the_curved_reach_ends_at_the_goal() -> None:
    card = load_card(FOLDER, CURVED)

    for item in load_skill(FOLDER, CURVED).demonstrations:
        end = item.demonstration.positions[-1]
        assert np.linalg.norm(end - card.goal) <= card.law["demonstration_end_m"], item.demonstration.name


@pytest.mark.parametrize("section", SECTION_KINDS)
@everywhere
def test_the_skills_own_reproductions_begin_inside_stay_inside_and_end_at_the_goal(
    move: Move, section: str
) -> None:
    tube, law = moved(move, section), load_card(FOLDER, move.skill).law

    for begin in new_starts(move):
        run = reproduce(tube, begin)
        assert run.start_inside
        assert tube.contains(run.positions).all()
        assert np.linalg.norm(run.positions[-1] - ends(move)[1][1]) <= law["reproduction_end_m"]


@every_kind
@every_move
def test_runs_from_all_around_the_new_start_stay_inside(move: Move, section: str) -> None:
    tube = moved(move, section)
    centre, rim = tube.directrix[0], tube.surface()[0]

    runs = reproduce(tube, centre + 0.95 * (rim[:: len(rim) // 8] - centre))

    assert tube.contains(runs.positions.reshape(-1, 3)).all()


@pytest.fixture(scope="module")
def arm() -> Iterator[Jaco]:
    jaco = Jaco()
    yield jaco
    jaco.close()


@every_move
def test_the_arm_follows_the_moved_skill(move: Move, arm: Jaco) -> None:
    tube = moved(move, load_card(FOLDER, move.skill).section)
    shown = load_skill(FOLDER, move.skill).demonstrations
    paths = [tube.directrix, *(reproduce(tube, begin).positions for begin in new_starts(move))]
    paths += [map_of(move)(item.demonstration.positions) for item in shown]

    for path in paths:
        assert arm.follow(path).errors.max() < EXACT


@every_move
def test_a_person_who_moves_the_landmark_sees_the_same_tube(move: Move) -> None:
    document = load_skill(FOLDER, move.skill)
    places = tuple(
        replace(place, now=np.array(now)) if (now := getattr(move, place.name)) is not None else place
        for place in document.landmarks
    )
    seen = learn(replace(document, landmarks=places)).cylinder

    assert seen is not None
    np.testing.assert_allclose(seen.surface(), moved(move, document.settings.section).surface(), atol=1e-9)


def test_turning_scaling_and_shifting_is_no_change_of_shape() -> None:
    curve = taught(CURVED, "circle").directrix
    turn = Rotation.from_rotvec([0.0, 0.0, 0.8]).as_matrix()
    chord = curve[-1] - curve[0]
    about_the_chord = Rotation.from_rotvec(chord / np.linalg.norm(chord)).as_matrix()

    level = curve - np.outer(np.linspace(0.0, 1.0, len(curve)), [0.0, 0.0, chord[2]])
    assert shape_change(level, 1.7 * level @ turn.T + [1.0, 2.0, 3.0]) == pytest.approx(0.0, abs=1e-9)
    assert bow(1.7 * curve @ turn.T) == pytest.approx(bow(curve))
    assert shape_change(curve, curve @ about_the_chord.T) > 0.3


def test_a_straight_line_keeps_no_curve() -> None:
    law, curve = load_card(FOLDER, CURVED).law, taught(CURVED, "circle").directrix
    straight = np.linspace(curve[0], curve[-1], len(curve))

    assert bow(straight) < law["bow"]
    assert shape_change(curve, straight) > law["shape_change"]
