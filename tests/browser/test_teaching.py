"""Teaching a motion from nothing: pull the hand to the ball, three times."""

from __future__ import annotations

import numpy as np
import pytest

from app.document import FloatArray
from tests.browser.conftest import Visit
from tests.browser.person import Person

pytestmark = pytest.mark.browser

GOAL = "/landmarks/goal"
HAND = "/hand"
LEFT = 290.0
"""Near the left edge of the 3D canvas [px]."""
HOME = np.array([0.0098, -0.4998, 0.2500])
"""Where the hand of the resting arm is [m]."""
CLOSE = 0.02
"""How near to the hand a demonstration begins, and to the ball it ends [m]."""


def empty_table(visit: Visit) -> Person:
    person = visit()
    person.tab.press("Teach your own")
    person.tab.wait_until(lambda: not any(name.startswith("/demonstrations") for name in person.work()))
    assert goes_back_to(person, HOME)  # wherever the playback had brought the hand
    return person


def pull_the_hand_to_the_ball(person: Person, number: int) -> FloatArray:
    """Demonstrate; returns where the hand was before."""
    tab = person.tab
    began = tab.position(HAND)
    tab.drag(tab.pixel(HAND), tab.pixel(GOAL), steps=10)
    tab.wait_until(lambda: f"/demonstrations/{number}/line" in person.work())
    return began


def goes_back_to(person: Person, place: FloatArray) -> bool:
    """Whether the hand comes to a place by itself."""
    tab = person.tab
    return bool(tab.wait_until(lambda: np.linalg.norm(tab.position(HAND) - place) < 0.002))


def type_hand(person: Person, *coordinates: float) -> None:
    """Put the hand somewhere by its number fields [cm]."""
    fields = person.tab.page.locator("input:visible")
    values = fields.evaluate_all("all => all.map(field => parseFloat(field.value))")
    shown = np.lib.stride_tricks.sliding_window_view(np.array(values, dtype=float), 3)
    off = np.nan_to_num(np.abs(shown - 100.0 * person.tab.position(HAND)).max(axis=1), nan=np.inf)
    first = int(np.argmin(off))
    assert off[first] < 0.06  # of what is shown rounded to millimetres
    for axis, value in enumerate(coordinates):
        fields.nth(first + axis).fill(f"{value}")
        fields.nth(first + axis).press("Enter")
        wanted = 0.01 * value
        person.tab.wait_until(lambda a=axis, w=wanted: abs(person.tab.position(HAND)[a] - w) < 0.002)


def test_three_demonstrations_on_an_empty_table_lead_to_the_ball(visit: Visit) -> None:
    tab = (person := empty_table(visit)).tab
    assert set(person.work()) == {GOAL}
    assert "My skill" in person.fields()
    goal = tab.position(GOAL)
    starts = [pull_the_hand_to_the_ball(person, 0)]
    assert goes_back_to(person, starts[0])
    person.drag(tab.pixel(HAND), (-70.0, -30.0), button="right")
    tab.wait_until(lambda: np.linalg.norm(tab.position(HAND) - starts[0]) > 0.05)
    person.wait_still()
    starts.append(pull_the_hand_to_the_ball(person, 1))
    assert goes_back_to(person, starts[1])
    type_hand(person, 10.0, -35.0, 40.0)
    person.wait_still()
    starts.append(pull_the_hand_to_the_ball(person, 2))
    assert goes_back_to(person, starts[2])

    person.wait_still()
    lines = [person.line(f"/demonstrations/{i}/line") for i in range(3)]
    apart = [np.linalg.norm(one - other) for one, other in zip(starts, starts[1:] + starts[:1], strict=True)]
    assert min(apart) > 0.05
    assert max(np.linalg.norm(line[0] - start) for line, start in zip(lines, starts, strict=True)) < CLOSE
    assert max(np.linalg.norm(line[-1] - goal) for line in lines) < CLOSE
    assert {"/tube", "/directrix", "/reproductions/0/line", "/start/0"} <= set(person.work())
    assert np.linalg.norm(person.line("/reproductions/0/line")[-1] - goal) < 2 * CLOSE


def step_back(person: Person) -> None:
    """Turn the mouse wheel until the picture is about half as large."""
    tab = person.tab

    def size() -> float:
        return float(np.linalg.norm(np.subtract(tab.pixel(GOAL), tab.pixel("/start/0"))))

    wanted = 0.5 * size()
    tab.page.mouse.move(500.0, 60.0)
    while size() > wanted:
        tab.page.mouse.wheel(0.0, 200.0)
        tab.frames(3)


def test_a_hand_pulled_out_of_reach_turns_amber_and_says_why(visit: Visit) -> None:
    tab = (person := visit()).tab
    person.pause()
    before = person.work()
    step_back(person)
    began = tab.position(HAND)
    x, y = tab.pixel(HAND)
    calm = tab.image()[round(y), round(x)].astype(int)
    tab.grab((x, y))
    tab.pull((x, y), (x, 30.0), steps=4)
    tab.pull((x, 30.0), (LEFT, 30.0), steps=6)

    tab.wait_until(lambda: tab.visible("/wanted/ghost"))
    tab.wait_until(lambda: tab.shows("The arm cannot follow"))
    tab.wait_drawn()
    stuck = tab.position(HAND)
    x, y = tab.pixel(HAND)
    amber = tab.image()[round(y), round(x)].astype(int)
    tab.release()

    assert np.linalg.norm(stuck) < 1.2  # no farther than the arm is long
    assert np.linalg.norm(tab.position("/wanted/ghost") - stuck) > 0.01
    assert amber[0] - amber[2] > 60 > calm[0] - calm[2]
    assert goes_back_to(person, began)
    after = person.wait_for_change(before, "/demonstrations/5/line")
    assert np.all(np.isfinite(after["/tube"]))
