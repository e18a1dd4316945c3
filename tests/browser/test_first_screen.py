"""What a newcomer sees."""

from __future__ import annotations

import numpy as np
import pytest

from tests.browser.person import Person
from tests.support.chromium import near

pytestmark = pytest.mark.browser

LINES = {
    "demonstrations": ((196, 22, 28), 500),
    "directrix": ((31, 63, 168), 200),
    "reproduction": ((224, 75, 220), 100),
}
"""Colours of the paper, and how many pixels of each there are at least."""
HIDE = """names => names.forEach(name => window.__viserMutable.nodeRefFromName[name]
    .traverse(part => { part.visible = false; }))"""


def test_the_first_screen_moves(guest: Person) -> None:
    tab = guest.tab
    before, hand = tab.image().astype(int), tab.position("/hand")

    tab.wait_until(lambda: np.linalg.norm(tab.position("/hand") - hand) > 0.05)
    tab.wait_until(lambda: (np.abs(tab.image().astype(int) - before).max(axis=-1) > 30).sum() > 1000)


def test_the_first_screen_shows_the_lines_in_the_colours_of_the_paper(guest: Person) -> None:
    person = guest
    person.pause()

    image = person.tab.image()

    seen = {what: int(near(image, colour, 50).sum()) for what, (colour, _) in LINES.items()}
    assert all(seen[what] >= least for what, (_, least) in LINES.items()), seen
    assert "Reaching" in person.fields()


def test_the_tube_is_a_grey_veil_and_the_arm_is_a_body(guest: Person) -> None:
    tab = (person := guest).tab
    person.pause()

    with_all = tab.image().astype(int)
    tab.page.evaluate(HIDE, ["/tube"])
    tab.frames(2)
    without_tube = tab.image().astype(int)
    tab.page.evaluate(HIDE, [name for name in tab.names() if name.startswith("/arm/")])
    tab.frames(2)
    without_arm = tab.image().astype(int)

    veiled = np.abs(with_all - without_tube).max(axis=-1) > 4
    assert veiled.sum() > 8000
    colour = with_all[veiled].mean(axis=0)
    assert np.ptp(colour) < 30  # grey
    assert without_tube[veiled].mean() - 90 < colour.mean() < without_tube[veiled].mean()  # see-through
    assert (np.abs(without_tube - without_arm).max(axis=-1) > 20).sum() > 8000
