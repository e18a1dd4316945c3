"""Fixing what was learned with a real mouse: the dip (Fig. 10) and the lid (Figs 11 and 12)."""

from __future__ import annotations

import numpy as np
import pytest

from app.document import FloatArray
from tests.browser.conftest import Visit
from tests.browser.person import Person, Work
from tests.browser.test_kinds import open_skill

pytestmark = pytest.mark.browser

ONE, RUN, TUBE = "/demonstrations/0/line", "/reproductions/0/line", "/tube"
UPPER, LOWER = "/reproductions/0/line", "/reproductions/1/line"
DOWN = np.array([0.0, 0.0, -1.0])
DIP = 0.06
"""How far the first demonstration is pulled down [m]."""
PRESS = 0.05
"""How far the upper run is pressed down [m]."""
SAME = 1e-3
MIDDLE = (0.4, 0.6)


def opened(person: Person, skill: str) -> Work:
    """Open a built-in skill, look at it from the front, and let it rest."""
    tab = person.tab
    before = person.work()
    open_skill(person, skill)
    person.wait_for_change(before, TUBE)
    person.press_exactly("Front")
    person.pause()
    tab.page.locator("text=Suggest what to do next").first.click()
    tab.wait_drawn()
    return person.work()


def press_down(person: Person, line: str, by: float, parts: tuple[float, float]) -> None:
    """Grab a line between two parts of it and pull it down by a length [m]; the caller lets it go."""
    tab = person.tab
    x, y = person.clearest(line, parts)
    points = person.line(line)
    nearest = points[np.argmin(np.linalg.norm(tab.pixels(line, points) - [x, y], axis=1))]
    there, below = tab.pixels(line, np.stack([nearest, nearest + by * DOWN]))
    tab.grab((x, y))
    tab.pull((x, y), (x, y + float(below[1] - there[1])), steps=6)


def depth(before: FloatArray, after: FloatArray) -> float:
    """How far a path of as many points went down where it went down most [m]."""
    return float(((after - before) @ DOWN).max())


def farthest(before: FloatArray, after: FloatArray) -> float:
    return float(np.linalg.norm(after - before, axis=1).max())


def test_a_demonstration_is_made_to_dip_and_the_tube_dips_by_its_share(visit: Visit) -> None:
    tab = (person := visit()).tab
    before = opened(person, "The dip")

    press_down(person, ONE, DIP, MIDDLE)
    tab.wait_until(lambda: tab.shows("1 of 1 run changes, by up to"))
    tab.wait_until(lambda: tab.visible("/replay/former") and tab.visible("/replay/outline"))
    tab.page.keyboard.press("PageUp")
    tab.wait_until(lambda: tab.shows("25 cm wide"))
    tab.release()
    after = person.wait_for_change(before, ONE, TUBE, RUN)
    person.press_exactly("Accept")
    tab.wait_until(lambda: tab.shows("Undo: correct"))

    dip = depth(before[ONE][1:], after[ONE][1:])
    assert dip >= 0.05
    for other in ("/demonstrations/1/line", "/demonstrations/2/line"):
        assert farthest(before[other], after[other]) < SAME
    for end in (1, -1):
        assert np.linalg.norm(after[ONE][end] - before[ONE][end]) < SAME
    for learned in ("/directrix", RUN):
        assert depth(before[learned][1:], after[learned][1:]) == pytest.approx(dip / 3.0, rel=0.1)
    person.undo()
    person.wait_for_work(before)


def add_rule(person: Person, line: str, by: float, parts: tuple[float, float]) -> Work:
    before = person.work()
    press_down(person, line, by, parts)
    person.tab.release()
    person.wait_for_change(before, line)
    person.press_exactly("Add a rule")
    person.tab.wait_until(lambda: not person.tab.shows("Discard"))
    person.tab.wait_drawn()
    return person.work()


def switch(person: Person, rule: int) -> None:
    """Switch a rule on or off in its row."""
    person.tab.page.get_by_label("On", exact=True).nth(rule).click()


def test_the_upper_run_obeys_a_lid_and_the_lower_one_does_not_notice(visit: Visit) -> None:
    tab = (person := visit()).tab
    before = opened(person, "The lid")
    person.open_tab("Fix")

    first = add_rule(person, UPPER, PRESS, (0.35, 0.5))
    second = add_rule(person, UPPER, 0.6 * PRESS, (0.55, 0.7))
    tab.wait_until(lambda: tab.shows("2 rules, 2 switched on."))
    assert tab.visible("/rules/planes")
    assert tab.visible("/rules/arrows")

    assert depth(before[UPPER][1:], first[UPPER][1:]) == pytest.approx(PRESS, abs=0.005)
    for work in (first, second):
        np.testing.assert_array_equal(work[LOWER], before[LOWER])
    assert (second[UPPER][1:, 2] <= first[UPPER][1:, 2] + 1e-6).all()

    switch(person, 0)
    person.wait_for_change(second, UPPER)
    switch(person, 1)
    person.wait_for_work(before)  # to the last point
    switch(person, 1)
    switch(person, 0)
    person.wait_for_work(second)
