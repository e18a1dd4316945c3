"""Pulling on what is there changes what it should, and undo brings the former state back."""

from __future__ import annotations

import numpy as np
import pytest

from tests.browser.person import Person
from tests.support.chromium import near

pytestmark = pytest.mark.browser

START, GOAL, RUN, TUBE = "/start/0", "/landmarks/goal", "/reproductions/0/line", "/tube"
DEMONSTRATIONS = {f"/demonstrations/{i}/line" for i in range(5)}
GREEN = (26, 158, 115)


def test_the_start_ball_makes_another_run_and_leaves_the_tube(guest: Person) -> None:
    tab = (person := guest).tab
    person.pause()
    before = person.work()

    person.drag(tab.pixel(START), (-40.0, -30.0))
    after = person.wait_for_change(before, START, RUN)
    tab.wait_until(lambda: tab.shows("Playing"))
    person.undo()

    assert person.changed(before, after) == {START, RUN}
    person.wait_for_work(before)


def test_the_goal_takes_the_tube_with_it_and_leaves_the_demonstrations(guest: Person) -> None:
    tab = (person := guest).tab
    person.pause()
    before = person.work()
    apart = np.linalg.norm(person.tube_end() - tab.position(GOAL))

    person.drag(tab.pixel(GOAL), (70.0, -40.0))
    after = person.wait_for_change(before, GOAL, TUBE)
    moved = tab.position(GOAL)
    apart_now = np.linalg.norm(person.tube_end() - moved)
    person.undo()

    assert np.linalg.norm(moved - before[GOAL][0]) > 0.05
    assert apart < 0.01
    assert apart_now < 0.01
    assert not DEMONSTRATIONS & person.changed(before, after)
    person.wait_for_work(before)


def test_a_demonstration_line_takes_the_tube_with_it_and_no_other_line(guest: Person) -> None:
    person = guest
    person.pause()
    before = person.work()
    line = "/demonstrations/2/line"

    person.drag(person.clearest(line), (10.0, -50.0))
    after = person.wait_for_change(before, line, TUBE)
    person.tab.page.keyboard.press("Control+z")

    assert DEMONSTRATIONS & person.changed(before, after) == {line}
    np.testing.assert_allclose(after[line][1], before[line][1], atol=1e-6)  # its ends stay
    np.testing.assert_allclose(after[line][-1], before[line][-1], atol=1e-6)
    person.wait_for_work(before)


def test_a_run_obeys_the_rule_that_it_was_pulled_to(guest: Person) -> None:
    tab = (person := guest).tab
    person.pause()
    before = person.work()

    person.drag(person.clearest(RUN), (10.0, 50.0))
    after = person.wait_for_change(before, RUN)
    person.open_tab("Fix")
    tab.wait_until(lambda: tab.shows("1 rule, 1 switched on."))
    green = near(tab.image(), GREEN, 50).sum()
    person.undo()

    assert green > 300
    assert person.changed(before, after) == {RUN, "/reproductions/0/free"}
    person.wait_for_work(before)
    tab.wait_until(lambda: tab.shows("There is no rule yet."))


def test_shift_in_mid_pull_moves_only_the_height_and_stays_one_step(
    guest: Person, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Between the two parts lies at least a frame, which takes longer in software than the app allows for.
    monkeypatch.setattr("app.gesture.GRACE", 2.0)
    tab = (person := guest).tab
    person.pause()
    before = person.work()
    x, y = tab.pixel(GOAL)
    tab.grab((x, y))
    tab.pull((x, y), (x + 40.0, y - 20.0), steps=4)
    tab.wait_until(lambda: np.linalg.norm(tab.position(GOAL) - before[GOAL][0]) > 0.02)
    tab.wait_drawn()
    level = tab.position(GOAL)
    tab.page.keyboard.down("Shift")
    tab.pull((x + 40.0, y - 20.0), (x + 70.0, y - 80.0), steps=6)
    tab.wait_until(lambda: tab.position(GOAL)[2] > level[2] + 0.03)
    tab.release(key="Shift")
    after = person.wait_for_change(before, GOAL, TUBE)
    person.undo()

    np.testing.assert_allclose(after[GOAL][0][:2], level[:2], atol=2e-3)
    assert after[GOAL][0][2] > level[2] + 0.03
    person.wait_for_work(before)
    assert tab.page.get_by_role("button", name="Undo", exact=True).is_disabled()
