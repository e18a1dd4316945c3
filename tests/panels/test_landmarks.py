"""The Move tab: every landmark can be added, moved, turned, named, put back and removed without a mouse."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app import edits
from app.document import Document, Place, View
from tests.panels.desk import Bench, state_of, taught

TURN = np.array([0.0, 0.0, 0.5])


def furnished() -> Document:
    """A moved goal and a turned cup."""
    document = edits.add_landmark(taught(), "object", Place("", taught=np.array([0.2, -0.3, 0.03])))
    document = edits.turn_landmark(edits.rename_landmark(document, 2, "cup"), "cup", TURN)
    return edits.move_landmark(document, "goal", np.array([0.0, -0.4, 0.2]))


def says(bench: Bench, label: str) -> bool:
    return any(element.label == label and element.usable for element in bench.client.gui)


def test_every_landmark_says_how_it_was_moved(bench: Bench) -> None:
    bench.draw(state_of(furnished()))

    assert says(bench, "Start")
    assert says(bench, "Goal · moved by 15 cm")
    assert says(bench, "Cup · turned by 29°")


def test_a_landmark_is_renamed(bench: Bench) -> None:
    state = bench.draw(state_of(edits.remove_landmark(taught(), "start")))
    bench.client.set_gui("Called", "red ball")

    assert bench.edited(state.document).landmarks[0].name == "red ball"


def test_what_is_typed_is_for_the_landmark_of_its_row_and_not_for_one_in_its_place(bench: Bench) -> None:
    both = taught()
    bench.draw(state_of(edits.remove_landmark(both, "start")))
    bench.client.set_gui("Called", "red")
    bench.client.set_gui("Called", "red ball")

    assert [place.name for place in bench.edited(bench.edited(both)).landmarks] == ["start", "red ball"]


def test_a_landmark_keeps_its_row_under_another_name(bench: Bench) -> None:
    state = bench.draw(state_of(furnished()))
    renamed = edits.rename_landmark(state.document, 2, "red cup")
    bench.draw(state_of(renamed, state.model))
    bench.client.press("Remove red cup")

    assert [place.name for place in bench.edited(renamed).landmarks] == ["start", "goal"]


def test_an_object_is_turned_by_numbers(bench: Bench) -> None:
    state = bench.draw(state_of(furnished()))
    bench.client.set_gui("Cup turned [°]", (10.0, 0.0, 90.0))
    turn = bench.edited(state.document).landmarks[2].turn

    np.testing.assert_allclose(np.degrees(turn), (10.0, 0.0, 90.0), atol=1e-9)


def test_an_angle_that_was_not_typed_is_not_rounded(bench: Bench) -> None:
    document = edits.turn_landmark(furnished(), "cup", (0.1234567, 0.0, 0.5))
    bench.draw(state_of(document))
    bench.client.set_gui("Cup turned [°]", (7.1, 0.0, 90.0))

    assert bench.edited(document).landmarks[2].turn[0] == 0.1234567


def test_points_have_no_field_to_turn_them(bench: Bench) -> None:
    bench.draw(state_of(taught()))

    assert not says(bench, "Goal turned [°]")


@pytest.mark.parametrize(("name", "index"), [("goal", 1), ("cup", 2)])
def test_one_landmark_is_put_back(bench: Bench, name: str, index: int) -> None:
    state = bench.draw(state_of(furnished()))
    bench.client.press(f"Put {name} back")
    back = bench.edited(state.document).landmarks

    assert (back[index].now, back[index].turn) == (None, None)
    assert sum(place.now is not None or place.turn is not None for place in back) == 1


def test_all_landmarks_are_put_back(bench: Bench) -> None:
    state = bench.draw(state_of(furnished()))
    bench.client.press("Put all back")
    back = bench.edited(state.document).landmarks

    assert all(place.now is None and place.turn is None for place in back)


def test_nothing_can_be_put_back_where_nothing_was_moved(bench: Bench) -> None:
    bench.draw(state_of(taught()))

    assert not bench.client.element("Put all back", "Button").usable


@pytest.mark.parametrize(
    ("label", "kind"), [("Way point", "via"), ("Object", "object"), ("Obstacle", "obstacle")]
)
def test_a_landmark_waits_for_a_click_in_the_scene(bench: Bench, label: str, kind: str) -> None:
    bench.draw(state_of(taught()))
    bench.client.press(label)

    assert bench.notes.next() == ("look", (("placing", kind),))


@pytest.mark.parametrize("kind", ["via", "object", "obstacle"])
def test_a_landmark_is_added_at_the_playhead(bench: Bench, kind: str) -> None:
    state = bench.draw(state_of(taught(), view=View(placing=kind)))
    bench.client.press("At the playhead")

    assert bench.edited(state.document).landmarks[2].kind == kind
    assert bench.notes.next() == ("look", (("placing", None),))


def test_nothing_is_added_after_all(bench: Bench) -> None:
    bench.draw(state_of(taught(), view=View(placing="via")))
    bench.client.press("Not now")

    assert bench.notes.next() == ("look", (("placing", None),))
    assert bench.notes.none()


@pytest.mark.parametrize("kind", ["start", "goal"])
def test_an_end_that_was_removed_is_offered_and_added_at_once(bench: Bench, kind: str) -> None:
    state = bench.draw(state_of(edits.remove_landmark(taught(), kind)))
    bench.client.press(kind.capitalize())

    added = bench.edited(state.document).landmarks[-1]
    assert (added.name, added.kind, added.taught) == (kind, kind, None)


def test_twelve_landmarks_are_enough(bench: Bench) -> None:
    document = taught()
    for _ in range(10):
        document = edits.add_landmark(document, "via", Place("", taught=np.array([0.2, -0.3, 0.1])))
    bench.draw(state_of(document))

    assert not any("Way point" in e.props.get("options", ()) for e in bench.client.gui if e.usable)
    assert "Remove one before you add another" in bench.client.text()


def test_the_smoothing_is_changed_and_its_price_is_said(bench: Bench) -> None:
    state = bench.draw(state_of(edits.set_smoothing(furnished(), 0.2)))
    bench.client.set_gui("Smoothing", 0.4)

    assert bench.edited(state.document).smoothing == 0.4
    assert "mm at lambda = 0.2" in bench.client.text()
    assert "missed by at most 0.0 mm" not in bench.client.text()


def test_a_landmark_without_a_place_yet_says_so(bench: Bench) -> None:
    bench.draw(state_of(Document("empty")))

    assert says(bench, "Start · at the end of the motion, once it is taught")


def test_a_skill_s_own_places_are_one_press_away(bench: Bench) -> None:
    there = np.array([0.1, -0.4, 0.1])
    document = replace(taught(), tries=(Place("goal", now=there), Place("start", now=there + 0.1)))
    bench.draw(state_of(document))
    bench.client.press("Start 1")

    moved = {place.name: place.now for place in bench.edited(document).landmarks}
    np.testing.assert_array_equal(moved["start"], there + 0.1)
    assert moved["goal"] is None


def test_a_place_for_a_landmark_that_is_gone_is_not_offered(bench: Bench) -> None:
    document = replace(taught(), tries=(Place("goal", now=np.zeros(3)),))
    bench.draw(state_of(document))
    bench.client.press("Goal 1")
    bench.draw(state_of(edits.remove_landmark(document, "goal")))

    with pytest.raises(LookupError):
        bench.client.press("Goal 1")


def test_a_name_cannot_smuggle_in_a_picture(bench: Bench) -> None:
    document = edits.rename_landmark(furnished(), 1, "<img src=x onerror=alert(1)>")
    bench.draw(state_of(document))

    assert "<img" not in bench.client.text()


def test_a_drag_sends_little_to_the_panels(bench: Bench) -> None:
    state = bench.draw(state_of(furnished(), dragging="/landmarks/goal"))
    before = bench.client.bytes_received
    further = edits.move_landmark(state.document, "goal", np.array([0.0, -0.38, 0.2]))
    bench.draw(replace(state_of(further, state.model), dragging="/landmarks/goal"))

    assert 0 < bench.client.bytes_received - before < 12_000
