"""Moving what a motion is tied to: what the tube does, what is said, and that nothing is lost."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app import bending, edits, placing
from app.anchors import matrix, quaternion
from app.desk import Desk
from app.document import Document, Place
from app.inverse import EXACT
from app.model import Model, learn
from app.placing import HALF_AN_OBJECT
from gc_core import same_content
from tests.app.makers import Mouse, desk_of, furnished, taught

BY = np.array([0.05, 0.06, 0.04])
ELSEWHERE = np.array([0.60, -0.25, 0.20])
TURN = np.array([0.3, -0.4, 0.9])


def moved() -> Document:
    return edits.move_landmark(taught(), "goal", ELSEWHERE)


def with_way_point(document: Document) -> Document:
    model = learn(document)
    return edits.add_landmark(document, "via", placing.placed(model, np.array(model.cylinder.directrix[30])))


def only_an_object() -> Document:
    document = edits.remove_landmark(edits.remove_landmark(taught(), "start"), "goal")
    return edits.add_landmark(document, "object", Place("", taught=np.array([0.5, 0.1, 0.2])))


# --- the tube -----------------------------------------------------------------------


@pytest.mark.parametrize("document", [taught(), moved()], ids=["as taught", "moved"])
def test_a_way_point_that_is_added_on_the_middle_line_moves_nothing(document: Document) -> None:
    before, after = learn(document), learn(with_way_point(document))

    np.testing.assert_allclose(after.cylinder.surface(), before.cylinder.surface(), atol=1e-6)


def test_what_is_placed_among_moved_landmarks_is_where_it_was_placed() -> None:
    model = learn(moved())
    point = model.cylinder.directrix[20] + 0.03

    place = placing.placed(model, point)

    np.testing.assert_array_equal(place.now, point)
    np.testing.assert_allclose(model.registration(place.taught[None])[0], point, atol=EXACT)


@pytest.mark.parametrize("kind", ["via", "obstacle", "object"])
def test_beside_the_playhead_a_way_point_is_on_the_middle_line_and_what_stands_is_below_it(kind: str) -> None:
    desk = desk_of()
    desk.stage.seek(1.2)
    state = desk.state()

    place = placing.beside(state.model, state.playback, kind).taught

    away = np.linalg.norm(state.model.cylinder.directrix[:, :2] - place[:2], axis=1).min()
    assert away < 1e-12
    assert (place[2] == HALF_AN_OBJECT) == (kind != "via")


@pytest.mark.parametrize("kind", ["start", "goal", "via"])
def test_nothing_is_beside_the_playhead_where_nothing_was_taught(kind: str) -> None:
    desk = desk_of(Document("empty"))

    assert placing.beside(desk.state().model, desk.state().playback, kind) is None


def test_one_object_turns_the_whole_skill_with_it() -> None:
    document = edits.turn_landmark(only_an_object(), "object 1", TURN)
    document = edits.move_landmark(document, "object 1", ELSEWHERE)
    before, after = learn(taught()), learn(document)

    def turned(places: np.ndarray) -> np.ndarray:
        return (places - np.array([0.5, 0.1, 0.2])) @ matrix(TURN).T + ELSEWHERE

    np.testing.assert_allclose(after.cylinder.directrix, turned(before.cylinder.directrix), atol=1e-9)
    run, moved_run = before.runs[0].reproduction.positions, after.runs[0].reproduction.positions
    np.testing.assert_allclose(moved_run, turned(run), atol=1e-6)


def test_a_matrix_and_a_quaternion_of_a_turn_are_the_same_rotation() -> None:
    w, *xyz = quaternion(TURN)
    cross = np.cross(np.eye(3), xyz)
    rotation = np.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross

    np.testing.assert_allclose(rotation, matrix(TURN), atol=1e-12)


def test_smoothing_misses_the_landmarks_the_more_the_stronger_it_is() -> None:
    document = edits.turn_landmark(furnished(), "cup", TURN)

    missed = [learn(edits.set_smoothing(document, s)).registration.residual for s in (0.0, 0.05, 0.3, 1.0)]

    assert missed[0] < 1e-9
    assert np.all(np.diff(missed) > 1e-3)


def test_another_smoothing_bends_anew_but_encodes_nothing() -> None:
    former = learn(edits.turn_landmark(furnished(), "cup", TURN))

    model = learn(edits.set_smoothing(former.source, 0.3), former)

    assert model.taught is former.taught
    assert np.abs(model.cylinder.directrix - former.cylinder.directrix).max() > 1e-3


def test_all_put_back_is_the_tube_as_it_was_taught() -> None:
    model = learn(edits.put_landmarks_back(edits.turn_landmark(furnished(), "cup", TURN)))

    assert model.registration is None
    assert model.cylinder is model.taught


@pytest.mark.parametrize("left", [(), ("start",), ("goal",), ("cup",), ("goal", "cup")], ids=str)
def test_whatever_landmarks_are_left_the_tube_follows(left: tuple[str, ...]) -> None:
    document = furnished()
    for name in ("start", "goal", "cup"):
        if name not in left:
            document = edits.remove_landmark(document, name)
    model = learn(document)

    assert model.problem is None
    assert bool(bending.how(model)) == any(anchor.moved for anchor in model.anchors)
    assert np.isfinite(model.cylinder.surface()).all()


# --- words ----------------------------------------------------------------------------


def fold() -> Document:
    """The way point is pulled beyond the goal, so that the order along the way is turned round."""
    document = with_way_point(taught())
    ends = learn(document).cylinder.directrix[[30, -1]]
    return edits.move_landmark(document, "way point 1", ends[1] + 0.3 * (ends[1] - ends[0]))


def test_how_the_tube_follows_is_said_for_one_two_and_more_landmarks() -> None:
    one = edits.remove_landmark(moved(), "start")
    turned = edits.turn_landmark(only_an_object(), "object 1", TURN)
    many = edits.move_landmark(with_way_point(furnished()), "start", np.array([0.4, 0.3, 0.5]))

    said = [bending.how(learn(document)) for document in (taught(), one, turned, moved(), furnished(), many)]

    assert said == [
        "",
        "The tube is moved as a whole, with the goal.",
        "The tube is moved and turned as a whole, with object 1.",
        "The tube is stretched between the start and the goal.",
        "The tube is bent smoothly by the start, the goal and the cup.",
        "The tube is bent smoothly by its 4 landmarks.",
    ]


def test_landmarks_that_are_all_moved_alike_move_the_tube_as_a_whole() -> None:
    document, by = moved(), ELSEWHERE - learn(taught()).anchors[1].now
    document = edits.move_landmark(document, "start", learn(document).anchors[0].now + by)

    assert bending.how(learn(document)) == "The tube is moved as a whole, with the start and the goal."


def test_a_fold_names_the_landmark_that_made_it() -> None:
    said = bending.folds(learn(fold()))

    assert said is not None
    assert said.startswith("The tube is turned inside out near way point 1. Move it less")


def test_a_fold_is_said_as_long_as_it_is_there() -> None:
    desk = desk_of(fold())
    folded = desk.state()
    desk.edit(edits.put_landmarks_back, "put all landmarks back", now=1.0)

    assert (folded.warning, "inside out" in folded.message) == (True, True)
    assert "inside out" not in desk.state().message


@pytest.mark.parametrize(
    ("node", "words"), [("/landmarks/goal", "The goal is moved by"), ("/turns/cup", "turned by")]
)
def test_while_a_landmark_is_pulled_it_is_said_what_happens(node: str, words: str) -> None:
    desk = desk_of(furnished())
    mouse = Mouse(desk)
    mouse.press(node, None if node != "/turns/cup" else np.array([0.585, 0.05, 0.30]))
    mouse.move(BY)
    pulled = desk.state()
    mouse.release()
    mouse.wait(0.3)

    assert words in pulled.message
    assert "bent smoothly" in pulled.message
    assert not pulled.warning
    assert words not in desk.state().message


def test_a_goal_beyond_reach_is_said_while_it_is_pulled_there(desk: Desk, mouse: Mouse) -> None:
    mouse.press("/landmarks/goal")
    mouse.move((1.5, 0.0, 0.0))
    state = desk.state()

    assert state.warning
    assert "beyond reach. Keep the goal nearer to the arm." in state.message


@pytest.mark.parametrize(
    ("turn", "degrees"), [((0.0, 0.0, 0.5), 28.6), ((0.5, 0.0, 0.0), 28.6), ((np.pi, 0.0, 0.0), 180.0)]
)
def test_the_angle_of_a_turn_is_the_smallest_that_makes_it(turn: tuple[float, ...], degrees: float) -> None:
    document = edits.turn_landmark(furnished(), "cup", turn)

    assert bending.angle(learn(document).anchors[2]) == pytest.approx(degrees, abs=0.1)


# --- showing among moved landmarks ---------------------------------------------------------


def show(desk: Desk, mouse: Mouse) -> np.ndarray:
    """Pull the hand along some way; returns the way [m]."""
    mouse.press("/hand")
    for _ in range(12):
        mouse.move((0.01, -0.02, -0.01))
    drawn = desk.state().hand.recording
    mouse.release()
    mouse.wait(0.3)
    return drawn


def test_what_is_shown_among_moved_landmarks_is_kept_where_it_would_have_been() -> None:
    desk = desk_of(moved())
    before = desk.state().model
    drawn = show(desk, Mouse(desk))
    kept = desk.store.document.demonstrations[-1]

    assert not kept.muted
    assert "kept where it would have been" in desk.message
    np.testing.assert_allclose(
        before.registration(kept.demonstration.positions[: len(drawn)]), drawn, atol=1e-6
    )


def test_the_bent_tube_then_holds_what_was_shown_where_it_was_shown() -> None:
    ends = learn(taught()).cylinder.directrix[[0, -1]]
    places = tuple(Place(name, taught=end) for name, end in zip(("start", "goal"), ends, strict=True))
    desk = desk_of(edits.move_landmark(replace(taught(), landmarks=places), "goal", ELSEWHERE))
    drawn = show(desk, Mouse(desk))

    passed = desk.state().model.cylinder.aligned[-1]

    gaps = np.linalg.norm(drawn[:, None] - passed[None], axis=2).min(axis=1)
    assert gaps.max() < 0.01


def test_what_has_no_way_back_is_kept_but_muted_and_the_reason_is_said(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("app.drawn.LOST", -1.0)
    desk = desk_of(moved())
    count = len(desk.store.document.demonstrations)
    show(desk, Mouse(desk))

    assert [shown.muted for shown in desk.store.document.demonstrations[count:]] == [True]
    assert desk.warning
    assert "kept, but muted" in desk.message


def test_what_is_shown_among_landmarks_in_their_places_is_kept_as_it_was_drawn(
    desk: Desk, mouse: Mouse
) -> None:
    drawn = show(desk, mouse)
    kept = desk.store.document.demonstrations[-1].demonstration

    np.testing.assert_array_equal(kept.positions[: len(drawn)], drawn)


# --- nothing is lost -------------------------------------------------------------------------


def test_a_knob_that_is_pulled_is_one_step_and_undo_turns_it_back() -> None:
    desk = desk_of(furnished())
    mouse, before = Mouse(desk), desk.store.document

    mouse.pull("/turns/cup", (0.02, 0.06, 0.0), at=np.array([0.585, 0.05, 0.30]))
    after, name = desk.store.document, desk.store.undo_name
    desk.undo(mouse.now)

    assert name == "turn cup"
    assert not same_content(after.landmarks[2].turn, before.landmarks[2].turn)
    assert desk.store.document is before


def test_a_whole_afternoon_of_landmarks_is_undone_step_by_step(desk: Desk, mouse: Mouse) -> None:
    first = picture(desk.state().model)
    point = np.array(desk.state().model.cylinder.directrix[20])
    for change in (
        lambda d: edits.add_landmark(d, "object", Place("", taught=point)),
        lambda d: edits.rename_landmark(d, 2, "cup"),
        lambda d: edits.turn_landmark(d, "cup", TURN),
        lambda d: edits.move_landmark(d, "cup", point + BY),
        lambda d: edits.set_smoothing(d, 0.2),
        lambda d: edits.remove_landmark(d, "start"),
        edits.put_landmarks_back,
    ):
        desk.edit(change, "change a landmark", now=mouse.now)
        assert desk.state().model.problem is None
    steps = 0
    while desk.store.undo_name is not None:
        desk.undo(mouse.now)
        steps += 1

    assert steps == 7
    np.testing.assert_array_equal(picture(desk.state().model), first)


def picture(model: Model) -> np.ndarray:
    return np.concatenate([model.cylinder.surface().ravel(), model.runs[0].reproduction.positions.ravel()])
