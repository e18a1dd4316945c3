"""A box is put in the way with a real mouse: the hand that is pulled towards it stops, and the words say why."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from tests.browser.conftest import Visit

pytestmark = pytest.mark.browser

BOX, HAND, SIDE = "/obstacles/box 1", "/hand", "/sizes/box 1/0"
TALL = 0.8
"""Seen from above one cannot lead the hand over a box so high [m]."""
HALF = 0.06
"""Of the box's width [m]."""


def test_a_hand_that_is_pulled_towards_a_box_stops_before_it_and_this_is_said(visit: Visit) -> None:
    tab = (person := visit()).tab
    person.pause()
    person.open_tab("Move")
    person.press_exactly("Box")
    person.press_exactly("Beside the playhead")
    tab.wait_drawn(BOX, SIDE)
    save(tab, "1")
    person.open_folder("Box 1")
    height = tab.page.get_by_text("Height [cm]", exact=True).locator("xpath=following::input").first
    height.fill(f"{100.0 * TALL:g}")
    height.press("Enter")
    tab.wait_until(lambda: abs(tab.position(BOX)[2] - 0.5 * TALL) < 1e-3)
    save(tab, "2")
    person.press_exactly("Top")
    tab.wait_until(lambda: tab.on_canvas(tab.pixel(BOX)))
    tab.wait_drawn()
    before = tab.position(BOX)
    person.drag(tab.pixel(BOX), (-60.0, 0.0))
    tab.wait_until(lambda: tab.shows("Undo: move box 1"))
    moved = tab.position(BOX) - before

    save(tab, "3")
    tab.grab(tab.pixel(HAND))
    tab.pull(tab.pixel(HAND), tab.pixel(BOX), steps=8)
    save(tab, "4a")
    tab.wait_until(lambda: tab.shows("box 1 is in the way"))
    apart = np.abs(tab.position(HAND) - tab.position(BOX))[:2]
    save(tab, "4")
    tab.release()

    assert np.linalg.norm(moved[:2]) > 0.05
    assert abs(moved[2]) < 1e-6
    assert apart.max() > HALF


def save(tab, name):
    folder = os.environ.get("SHOTS")
    if folder:
        tab.save(Path(folder) / f"things{name}.png")
