"""What is in the way, in the Move tab: added, placed, sized, turned, weighed and removed by numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app import edits
from app.document import THING_KINDS, Document, View
from app.measures import measures, turn_of, underside
from tests.panels.desk import Bench, state_of, taught


def furnished() -> Document:
    document = edits.add_thing(taught(), "box", (0.2, -0.5, 0.0))
    return edits.weigh_thing(edits.add_thing(document, "ball", (0.4, -0.5, 0.0)), "ball 1", 0.15)


def says(bench: Bench, label: str) -> bool:
    return any(element.label == label and element.usable for element in bench.client.gui)


def test_every_thing_says_whether_it_stands_fixed(bench: Bench) -> None:
    bench.draw(state_of(furnished()))

    assert says(bench, "Box 1 · stands fixed")
    assert says(bench, "Ball 1 · can be carried, 150 g")


@pytest.mark.parametrize(
    ("label", "kind"), [("Box", "box"), ("Ball", "ball"), ("Cylinder", "cylinder"), ("Ring", "ring")]
)
def test_a_thing_waits_for_a_click_in_the_scene(bench: Bench, label: str, kind: str) -> None:
    bench.draw(state_of(taught()))
    bench.client.press(label)

    assert bench.notes.next() == ("look", (("placing", kind),))


@pytest.mark.parametrize("kind", THING_KINDS)
def test_a_thing_is_added_beside_the_playhead_without_the_mouse(bench: Bench, kind: str) -> None:
    state = bench.draw(state_of(taught(), view=View(placing=kind)))
    bench.client.press("Beside the playhead")
    (thing,) = bench.edited(state.document).things

    away = np.linalg.norm(state.model.cylinder.directrix[:, :2] - thing.position[:2], axis=1)
    assert underside(thing) == pytest.approx(0.0, abs=1e-12)
    assert away.min() > 0.1
    assert bench.notes.next() == ("look", (("placing", None), ("thing", f"{kind} 1")))


def test_no_thing_is_added_after_all(bench: Bench) -> None:
    bench.draw(state_of(taught(), view=View(placing="box")))
    bench.client.press("Not here")

    assert bench.notes.next() == ("look", (("placing", None),))


def test_a_box_is_placed_sized_turned_and_weighed_by_numbers(bench: Bench) -> None:
    document = edits.add_thing(taught(), "box", (0.2, -0.5, 0.0))
    bench.draw(state_of(document))
    for label, value in (
        ("Box 1 [cm]", (10.0, -50.0, 30.0)),
        ("Depth [cm]", 25.0),
        ("Box 1 turned [°]", (0.0, 0.0, 30.0)),
        ("Weight [g]", 200.0),
    ):
        bench.client.set_gui(label, value)
        document = bench.edited(document)
        assert bench.notes.next() == ("look", (("thing", "box 1"),))
    box = document.things[0]

    np.testing.assert_allclose(box.position, (0.1, -0.5, 0.3))
    np.testing.assert_allclose(measures(box), (0.12, 0.25, 0.20))
    np.testing.assert_allclose(np.degrees(turn_of(box.wxyz)), (0.0, 0.0, 30.0), atol=1e-9)
    assert box.mass == pytest.approx(0.2)


def test_every_kind_has_fields_for_the_measures_that_it_has(bench: Bench) -> None:
    document = edits.add_thing(taught(), "ring", (0.2, -0.5, 0.0))
    bench.draw(state_of(document))

    assert [label for label in ("Opening [cm]", "Thickness [cm]", "Depth [cm]") if says(bench, label)] == [
        "Opening [cm]",
        "Thickness [cm]",
    ]


def test_a_thing_is_removed(bench: Bench) -> None:
    state = bench.draw(state_of(furnished()))
    bench.client.press("Remove box 1")

    assert [thing.name for thing in bench.edited(state.document).things] == ["ball 1"]


def test_what_is_typed_is_for_the_thing_of_its_row_and_not_for_one_in_its_place(bench: Bench) -> None:
    both = replace(furnished(), landmarks=())  # they are called by such fields, too
    bench.draw(state_of(edits.remove_thing(both, "box 1")))
    bench.client.set_gui("Called", "red")
    bench.client.set_gui("Called", "red ball")

    assert [thing.name for thing in bench.edited(bench.edited(both)).things] == ["box 1", "red ball"]
