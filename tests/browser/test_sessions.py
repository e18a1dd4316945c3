"""Who sees what: two people, two tabs, a reload, a restart."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.browser.conftest import Visit, serving
from tests.browser.person import Person, Work

pytestmark = pytest.mark.browser

GOAL, TUBE = "/landmarks/goal", "/tube"


def move_the_goal(person: Person) -> Work:
    before = person.work()
    person.drag(person.tab.pixel(GOAL), (60.0, -30.0))
    return person.wait_for_change(before, GOAL, TUBE)


def test_two_people_do_not_see_each_other(visit: Visit) -> None:
    one, other = visit(), visit()
    one.pause()
    other.pause()
    before = other.work()

    moved = move_the_goal(one)
    other.press_exactly("+ z")  # an answer of the other session, given after that
    other.tab.wait_until(lambda: other.tab.shows("The next demonstration begins here."))

    assert one.tab.page.url != other.tab.page.url
    assert not other.changed(before, other.work())
    assert not one.changed(moved, one.work())


def test_a_second_tab_on_the_same_work_watches(visit: Visit, code: str) -> None:
    first = visit(code)
    first.pause()
    second = visit(code)

    assert second.tab.shows("open in another tab")
    moved = move_the_goal(first)
    second.tab.wait_until(lambda: np.allclose(second.tab.position(GOAL), moved[GOAL][0], atol=1e-6))


def test_a_reload_brings_the_work_back(visit: Visit) -> None:
    person = visit()
    person.pause()
    moved = move_the_goal(person)

    person.tab.page.reload()
    person.tab.wait_drawn(*moved)

    person.wait_for_work(moved)
    assert "My reaching" in person.fields()


def test_the_work_outlives_the_server(visit: Visit, code: str, tmp_path: Path) -> None:
    with serving(tmp_path / "library.db") as server:
        person = visit(code, server)
        person.pause()
        moved = move_the_goal(person)
        person.tab.page.close()

    with serving(tmp_path / "library.db") as server:
        visit(code, server).wait_for_work(moved)
