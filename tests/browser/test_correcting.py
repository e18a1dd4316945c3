"""Replay and let me correct, with a real mouse on the moving hand.

How many events a second arrive depends on how fast the page is drawn, and on how fast this mouse is moved: it
waits for the page after each move. So it is asked here that every move arrives; for the rate of a mouse that
waits for nobody see `tests.measurements.events`.
"""

from __future__ import annotations

import itertools
import time

import numpy as np
import pytest

from app import correcting
from app.actions import Drag
from app.compliance import MEDIUM
from app.proposal import Proposal
from app.replaying import Corrected, Replaying
from app.scene.view import VIEWS
from app.subject import Subject
from tests.browser.conftest import Visit
from tests.browser.person import Person
from tests.support.chromium import Pixel, ViserPage

pytestmark = pytest.mark.browser

PULL = 0.08
SPEED = 0.25
LINE, RUN = "/demonstrations/0/line", "/reproductions/0/line"
RIGHT = 745.0
"""The hand comes from beside the panel: it is pulled when it is this far to the left [px]."""
BESIDE = (700.0, 80.0)
"""Where there is nothing but the sky [px]."""
HELD = "You hold the hand."
MOST_EVENTS = 20.0
"""viser's page sends no more in a second."""


def aside(person: Person, length: float) -> Pixel:
    """By how many pixels the hand must be pulled to the right for a length [m]."""
    view = VIEWS["3D"]
    right = np.cross(np.subtract(view.look_at, view.position), [0.0, 0.0, 1.0])
    here = person.tab.pixel("/hand")
    there = person.tab.pixel("/hand", length * right / np.linalg.norm(right))
    return there[0] - here[0], there[1] - here[1]


def catch(tab: ViserPage) -> Pixel:
    """Press the mouse on the moving hand, where it will be when the page sees it; returns where."""
    for _ in range(6):
        before = np.array(tab.pixel("/hand"))
        tab.frames(2)
        now = np.array(tab.pixel("/hand"))
        x, y = (2.0 * now - before).tolist()
        tab.grab((x, y))
        tab.page.mouse.move(x + 5.0, y)
        tab.frames(3)
        if tab.shows(HELD):
            return x, y
        tab.release()
    raise AssertionError("the hand could not be caught")


def test_a_hand_pulled_aside_during_a_replay_yields_as_the_stiffness_says_and_is_recorded(
    visit: Visit, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept: list[Corrected] = []
    trembling = itertools.cycle((0, 1))

    def proposed(subject: Subject, corrected: Corrected) -> Proposal:
        kept.append(corrected)
        return original(subject, corrected)

    original = correcting.proposed
    monkeypatch.setattr(correcting, "proposed", proposed)
    arrived: list[float] = []

    def follow(replaying: Replaying, drag: Drag) -> None:
        arrived.append(drag.time)
        original_follow(replaying, drag)

    original_follow = Replaying.follow
    monkeypatch.setattr(Replaying, "follow", follow)
    tab = (person := visit()).tab
    person.pause()
    before = person.work()
    begin_replay(person)
    x, y = catch(tab)
    by = aside(person, -PULL)
    tab.pull((x + 5.0, y), (x + by[0], y + by[1]), steps=8)
    moves, before_moves, began = 0, len(arrived), time.perf_counter()
    while time.perf_counter() < began + 1.5:
        tab.page.mouse.move(x + by[0], y + by[1] + next(trembling))
        moves += 1
    seconds = time.perf_counter() - began
    tab.wait_until(lambda: tab.shows("changes, by up to") and tab.visible("/replay/outline"))
    tab.page.mouse.move(x + by[0], y + by[1])
    tab.release()
    tab.wait_until(lambda: not tab.shows(HELD))
    events = len(arrived) - before_moves
    tab.click(BESIDE)
    tab.wait_until(lambda: tab.shows("Take the hand itself"))
    tab.page.wait_for_timeout(1500)
    person.press_exactly("Stop")
    tab.wait_until(lambda: tab.shows("Correction of"))
    tab.wait_drawn()
    person.press_exactly("Accept")
    after = person.wait_for_change(before, LINE, "/tube")
    person.undo()
    person.wait_for_work(before)

    corrected = kept[-1]  # before: as if the hand had been let go
    away = np.linalg.norm(corrected.positions - corrected.route, axis=1)
    held = np.flatnonzero(corrected.held)
    assert away.max() == pytest.approx(MEDIUM.deflection(PULL), rel=0.15)
    assert away[held[-1] + 100] < 1e-3
    np.testing.assert_allclose(np.diff(corrected.times[: held[-1]]), 0.01 * SPEED, atol=1e-9)
    assert events >= 0.75 * min(moves, MOST_EVENTS * seconds)
    assert {LINE, "/tube"} <= person.changed(before, after)


def begin_replay(person: Person) -> None:
    """Replay at a quarter of the speed, and wait until the hand can be caught."""
    tab = person.tab
    person.open_tab("Fix")
    tab.wait_until(lambda: tab.shows("Replay and let me correct"))
    choose(person, "½×", "¼×")
    person.press_exactly("Replay and let me correct")
    tab.wait_until(lambda: tab.shows(" s of ") and tab.pixel("/hand")[0] < RIGHT)


def choose(person: Person, shown: str, wanted: str) -> None:
    """Choose another option of a dropdown that shows one."""
    page = person.tab.page
    page.locator(f'input[value="{shown}"]:visible').first.click()
    page.get_by_role("option", name=wanted, exact=True).click()
