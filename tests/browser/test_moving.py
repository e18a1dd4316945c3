"""The Move tab with a real mouse: the goal takes all with it; landmarks are added, turned and removed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from app.document import FloatArray
from app.scene.view import VIEWS
from tests.browser.person import Person
from tests.support.chromium import Pixel

pytestmark = pytest.mark.browser

GOAL, RUN, TUBE, FORMER, HAND = "/landmarks/goal", "/reproductions/0/line", "/tube", "/former", "/hand"
FAR = 0.10
"""How far the goal is pulled [m]."""
THERE = 0.005
"""What is this near to where it should be is there [m]."""


def sideways(person: Person, node: str, length: float) -> Pixel:
    """By how many pixels a thing must be pulled to the right to move by a length [m]."""
    view = VIEWS["3D"]
    right = np.cross(np.subtract(view.look_at, view.position), [0.0, 0.0, 1.0])
    here = person.tab.pixel(node)
    there = person.tab.pixel(node, length * right / np.linalg.norm(right))
    return there[0] - here[0], there[1] - here[1]


def ends(person: Person) -> dict[str, FloatArray]:
    """Where the tube, the run and the arm's hand end (3,) [m]; leads the hand there."""
    person.seek_end()
    return {
        "tube": person.tube_end(),
        "run": person.line(RUN)[-1],
        "hand": person.tab.position(HAND),
    }


def test_the_goal_takes_the_ends_of_tube_run_and_arm_with_it_and_undo_brings_them_back(guest: Person) -> None:
    tab = (person := guest).tab
    person.pause()
    before, goal = person.work(), tab.position(GOAL)
    at_first = ends(person)
    person.pause()

    tab.grab(tab.pixel(GOAL))
    by = sideways(person, GOAL, FAR)
    tab.pull(tab.pixel(GOAL), tuple(np.add(tab.pixel(GOAL), by)), steps=8)
    tab.wait_until(lambda: tab.shows("The tube is stretched between the start and the goal."))
    tab.wait_until(lambda: tab.visible(FORMER))
    tab.release()
    after = person.wait_for_change(before, GOAL, TUBE, RUN)
    moved = tab.position(GOAL) - goal
    at_last = ends(person)
    person.undo()

    assert np.linalg.norm(moved) == pytest.approx(FAR, abs=0.005)
    assert {GOAL, TUBE, RUN} <= person.changed(before, after)
    for name, end in at_last.items():
        assert np.linalg.norm(end - at_first[name] - moved) < THERE, name
    assert np.linalg.norm(at_last["tube"] - goal - moved) < THERE
    assert np.linalg.norm(at_last["hand"] - at_last["run"]) < THERE
    person.wait_for_work(before)
    assert not tab.visible(FORMER)
    person.seek_end()
    np.testing.assert_allclose(tab.position(HAND), at_first["hand"], atol=THERE)


def test_a_way_point_is_clicked_on_the_tube_pulled_and_put_back(guest: Person) -> None:
    tab = (person := guest).tab
    person.pause()
    person.open_tab("Move")
    before = person.work()

    person.press_exactly("Way point")
    tab.wait_until(lambda: tab.shows("Now click where it is"))
    line = person.line("/directrix")
    tab.click(tuple(tab.pixels("/directrix", line[100:101])[0]))
    tab.wait_drawn("/landmarks/way point 1")
    added = person.work()
    place = tab.position("/landmarks/way point 1")

    assert person.changed(before, added) == {"/landmarks/way point 1"}
    assert np.linalg.norm(line - place, axis=1).min() < 1e-3

    person.drag(tab.pixel("/landmarks/way point 1"), (0.0, 40.0))
    moved = person.wait_for_change(added, TUBE, "/landmarks/way point 1")
    bent, now = person.line("/directrix"), tab.position("/landmarks/way point 1")
    assert np.linalg.norm(now - place) > 0.02
    assert np.linalg.norm(bent - now, axis=1).min() < THERE
    assert np.linalg.norm(moved[GOAL][0] - before[GOAL][0]) == 0.0
    person.press_exactly("Put all back")
    person.wait_for_work(added)
    for _ in ("put back", "pulled", "added"):
        person.undo()
    person.wait_for_work(before)


def test_an_object_is_turned_by_its_fields_and_by_its_knob_and_removed(guest: Person) -> None:
    tab = (person := guest).tab
    person.pause()
    person.open_tab("Move")
    before = person.work()
    person.press_exactly("Object")
    person.press_exactly("At the playhead")
    tab.wait_drawn("/landmarks/object 1", "/turns/object 1")
    added = person.work()

    person.open_folder("Object 1")
    fill(person, "Object 1 turned [°]", (0.0, 0.0, 30.0))
    turned = person.wait_for_change(added, TUBE)
    assert tab.shows("Object 1 · turned by 30°")
    np.testing.assert_allclose(yaw(person), 30.0, atol=0.1)

    person.press_exactly("Top")  # in the other view a panel is before it
    tab.wait_until(lambda: tab.on_canvas(tab.pixel("/turns/object 1")))
    tab.wait_drawn()
    knob, middle = np.array(tab.pixel("/turns/object 1")), np.array(tab.pixel("/landmarks/object 1"))
    person.drag(tuple(knob), tuple(middle - knob + [-20.0, 20.0]))
    person.wait_for_change(turned, TUBE)
    tab.wait_until(lambda: tab.shows("Undo: turn object 1"))
    assert abs(yaw(person) - 30.0) > 10.0

    person.press_exactly("Remove object 1")
    tab.wait_until(lambda: not tab.visible("/landmarks/object 1"))
    person.wait_for_work(before)
    assert not tab.visible("/turns/object 1")


def yaw(person: Person) -> float:
    """Angle of the knob about its object, as seen from above [deg]."""
    away = person.tab.position("/turns/object 1") - person.tab.position("/landmarks/object 1")
    return float(np.degrees(np.arctan2(away[1], away[0])))


def fill(person: Person, label: str, values: Sequence[float]) -> None:
    """Type three numbers into the fields beside a label."""
    fields = person.tab.page.get_by_text(label, exact=True).locator("xpath=following::input")
    for index, value in enumerate(values):
        fields.nth(index).fill(f"{value:g}")
        fields.nth(index).press("Enter")
