"""The replay page, opened from a file by a browser that has no network."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Request

from app import skills
from app.arm.jaco import Jaco
from app.exports import Subject, parcel
from app.model import learn
from app.resources import static_folder
from app.scene.style import DEMONSTRATION
from tests.support.chromium import ViserPage, near

pytestmark = pytest.mark.browser
HAND = "/arm/j2s6s200_link_6"


def test_the_replay_page_shows_the_tube_and_the_moving_arm_without_a_server(
    chromium: Browser, tmp_path: Path
) -> None:
    document = skills.load_skill(static_folder() / "skills", "reaching")
    made = parcel(".html", Subject(document, learn(document), Jaco))
    (tmp_path / made.name).write_bytes(made.content)
    context = chromium.new_context(viewport={"width": 640, "height": 420}, offline=True)
    asked: list[str] = []
    tab = ViserPage(context.new_page())

    def note(request: Request) -> None:
        asked.append(request.url)

    tab.page.on("request", note)
    tab.page.goto((tmp_path / made.name).as_uri())
    tab.wait_until(lambda: tab.page.evaluate("() => Boolean(window.__viserMutable?.nodeRefFromName)"), 60.0)
    tab.wait_until(lambda: {"/tube", HAND, "/demonstrations/4", "/reproductions/0"} <= set(tab.names()), 60.0)
    tab.wait_until(lambda: near(tab.image(), DEMONSTRATION, 40).sum() > 50, 60.0)
    early, first = tab.position(HAND), tab.image()
    tab.wait_until(lambda: np.linalg.norm(tab.position(HAND) - early) > 0.1)
    tab.wait_until(lambda: (np.abs(tab.image().astype(int) - first).max(axis=-1) > 40).mean() > 0.01)

    assert len(made.content) < 10e6
    assert tab.page.title() == "Reaching - gc-teach"
    assert tab.page.get_by_text("middle line").is_visible()
    assert len(tab.points("/tube")) == 100 * 32
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
    context.close()
