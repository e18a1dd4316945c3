"""A box is put in the way with a real mouse: the hand pulled towards it stops, and the words say why."""

from __future__ import annotations

import numpy as np
import pytest

from tests.browser.conftest import Visit

pytestmark = pytest.mark.browser

BOX, HAND, SIDE = "/obstacles/box 1", "/hand", "/sizes/box 1/0"
TALL = 0.8
"""Seen from above one cannot lead the hand over a box so high [m]."""
SHORT = 0.03
"""The hand stays this far from the middle of the box; its open fingers may stand around a corner [m]."""


def test_a_hand_that_is_pulled_towards_a_box_stops_before_it_and_this_is_said(visit: Visit) -> None:
    tab = (person := visit()).tab
    person.pause()
    person.open_tab("Move")
    person.press_exactly("Box")
    person.press_exactly("Beside the playhead")
    tab.wait_drawn(BOX, SIDE)
    person.open_folder("Box 1")
    height = tab.page.get_by_text("Height [cm]", exact=True).locator("xpath=following::input").first
    height.fill(f"{100.0 * TALL:g}")
    height.press("Enter")
    tab.wait_until(lambda: abs(tab.position(BOX)[2] - 0.5 * TALL) < 1e-3)
    person.press_exactly("Top")
    tab.wait_until(lambda: tab.on_canvas(tab.pixel(BOX)))
    tab.wait_drawn()
    before = tab.position(BOX)
    person.drag(tab.pixel(BOX), (30.0, 20.0))
    tab.wait_until(lambda: tab.shows("Undo: move box 1"))
    moved = tab.position(BOX) - before

    person.wait_still()
    tab.grab(tab.pixel(HAND))
    tab.pull(tab.pixel(HAND), tab.pixel(BOX), steps=8)
    tab.wait_until(lambda: tab.shows("box 1 is in the way"))
    apart = (tab.position(HAND) - tab.position(BOX))[:2]
    tab.release()

    assert np.linalg.norm(moved[:2]) > 0.05
    assert abs(moved[2]) < 1e-6
    assert np.linalg.norm(apart) > SHORT
