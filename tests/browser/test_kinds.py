"""Another built-in skill, and the three pictures of its tube."""

from __future__ import annotations

import numpy as np
import pytest

from tests.browser.conftest import Visit
from tests.browser.person import Person

pytestmark = pytest.mark.browser

PICTURES = "label[for]:has(svg)"


def open_skill(person: Person, name: str) -> None:
    tab = person.tab
    tab.page.locator('input[role=combobox][value="another skill…"]').click()
    tab.page.get_by_role("option", name=name).click()
    tab.wait_until(lambda: name in person.fields())


def test_the_needle_is_opened_and_a_picture_chooses_its_kind_of_slice(visit: Visit) -> None:
    tab = (person := visit()).tab
    person.pause()
    reaching = person.work()

    open_skill(person, "Needle")
    needle = person.wait_for_change(reaching, "/tube", "/directrix")
    assert widths(needle["/tube"][1:]).argmin() in range(40, 60)  # the eye, half of the way along

    pictures = tab.page.locator(PICTURES)
    tab.wait_until(lambda: pictures.count() == 3)
    boxes = [pictures.nth(i).bounding_box() for i in range(3)]
    assert len({round(box["y"]) for box in boxes}) == 1  # side by side
    pictures.nth(0).locator("svg").first.click()
    circle = person.wait_for_change(needle, "/tube")

    assert np.ptp(radii(circle["/tube"][1:])[0]) < 1e-4 < np.ptp(radii(needle["/tube"][1:])[0])
    assert "My needle" in person.fields()
    person.undo()
    person.wait_for_work(needle)


def radii(tube: np.ndarray) -> np.ndarray:
    """(100, 32) from the middle of each ring of the tube at rest to its points [m]."""
    rings = tube.reshape(100, 32, 3)
    return np.linalg.norm(rings - rings.mean(axis=1, keepdims=True), axis=2)


def widths(tube: np.ndarray) -> np.ndarray:
    """(100,) how wide the tube is, from its beginning to its end [m]."""
    return 2.0 * radii(tube).mean(axis=1)
