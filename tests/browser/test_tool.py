"""Turning the tool with a real mouse, by a ring about the hand."""

from __future__ import annotations

import numpy as np
import pytest

from app.scene.rings import SIZE
from tests.browser.conftest import Visit

pytestmark = pytest.mark.browser

ON_THE_RING = 0.65 * SIZE / np.sqrt(2.0)
"""Along the tool's x and y, to the middle of the ring that turns it about z [m]."""


def test_a_ring_that_is_pulled_turns_the_tool_and_the_hand_stays(visit: Visit) -> None:
    tab = (person := visit()).tab
    person.pause()
    hand = tab.position("/hand")
    person.open_folder("Turn the tool")
    tab.page.get_by_label("Rings", exact=True).click()
    tab.wait_drawn("/tool")
    before = tab.page.evaluate(TURNED)

    begin = tab.pixel("/tool", (ON_THE_RING, ON_THE_RING, 0.0))
    end = tab.pixel("/tool", (2.0 * ON_THE_RING, 0.0, 0.0))
    tab.grab(begin)
    tab.pull(begin, end, steps=8)
    tab.release()
    tab.wait_until(lambda: tab.shows("begins here"))
    person.wait_still()
    after = tab.page.evaluate(TURNED)

    assert np.linalg.norm(tab.position("/hand") - hand) < 0.005
    turned = 2.0 * np.arccos(min(1.0, abs(float(np.dot(before, after)))))
    assert np.radians(15.0) < turned < np.radians(75.0)


TURNED = "() => window.__viserMutable.nodeRefFromName['/arm/j2s6s200_link_6'].quaternion.toArray()"
