"""The browser helpers against a bare viser server: real mouse, real pixels."""

from __future__ import annotations

import queue
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
import viser
from playwright.sync_api import Browser

from tests.support.chromium import PROGRAMS, ViserPage, chromium_program, share

pytestmark = pytest.mark.browser
RED, BLUE = (220, 20, 20), (20, 40, 220)
TRIANGLE = np.array([[0.0, 0.6, 0.0], [0.0, 1.0, 0.0], [0.0, 0.8, 0.4]], np.float32)


@dataclass
class Stage:
    """A ball to pull, a triangle and a line."""

    server: viser.ViserServer
    events: queue.Queue[tuple[str, str | None, np.ndarray]] = field(default_factory=queue.Queue)

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.server.get_port()}/"


@pytest.fixture(scope="module")
def stage() -> Iterator[Stage]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    server.scene.configure_default_lights(True, cast_shadow=False)
    server.initial_camera.position = (4.0, 0.0, 0.0)
    server.initial_camera.look_at = (0.0, 0.0, 0.0)
    made = Stage(server)
    ball = server.scene.add_icosphere("/ball", radius=0.3, color=RED, position=(0.0, -0.5, 0.2))
    server.scene.add_mesh_simple("/triangle", TRIANGLE, np.array([[0, 1, 2]]), color=BLUE, side="double")
    server.scene.add_line_segments("/line", TRIANGLE[None, :2], colors=BLUE, thickness=0.02)

    async def note(event: viser.SceneNodeDragEvent[Any]) -> None:
        made.events.put((event.phase, event.modifier, np.asarray(event.end_position)))
        ball.position = event.end_position

    ball.on_drag("left")(note)
    ball.on_drag("left", modifier="shift")(note)
    yield made
    server.stop()


@pytest.fixture(scope="module")
def page(stage: Stage, chromium: Browser) -> Iterator[ViserPage]:
    """One tab for all: each test finds the ball where the one before let go of it."""
    context = chromium.new_context(viewport={"width": 960, "height": 540})
    tab = ViserPage(context.new_page())
    tab.page.goto(stage.url)
    tab.wait_drawn("/ball", "/triangle", "/line")
    yield tab
    context.close()
    assert tab.faults == []


def drained(stage: Stage, page: ViserPage) -> list[tuple[str, str | None, np.ndarray]]:
    got: list[tuple[str, str | None, np.ndarray]] = []

    def ended() -> bool:
        while not stage.events.empty():
            got.append(stage.events.get())
        return bool(got) and got[-1][0] == "end"

    page.wait_until(ended)
    return got


def test_a_real_mouse_drag_moves_the_ball(stage: Stage, page: ViserPage) -> None:
    before = page.position("/ball")

    page.drag_node("/ball", by=(0.0, -80.0))

    events = drained(stage, page)
    assert [events[0][0], events[-1][0]] == ["start", "end"]
    page.wait_until(lambda: np.allclose(page.position("/ball"), events[-1][2], atol=1e-5))
    assert page.position("/ball")[2] > before[2] + 0.1


def test_a_drag_with_shift_carries_the_modifier(stage: Stage, page: ViserPage) -> None:
    page.drag_node("/ball", by=(40.0, 0.0), key="Shift")

    assert {modifier for _, modifier, _ in drained(stage, page)} == {"shift"}


def test_geometry_and_pixels_are_read_back(page: ViserPage) -> None:
    np.testing.assert_allclose(page.points("/triangle"), TRIANGLE, atol=1e-6)
    np.testing.assert_allclose(page.points("/line"), TRIANGLE[:2], atol=1e-6)
    image = page.image()
    x, y = (round(v) for v in page.pixel("/ball"))
    red, _, blue = (int(v) for v in image[y, x])
    assert red - blue > 60  # the light and its reflections change the shade, not the hue
    assert share(image, image[y, x]) > 0.001


def test_a_grab_under_a_panel_is_refused(page: ViserPage) -> None:
    with pytest.raises(AssertionError, match="not on the 3D canvas"):
        page.grab((5000.0, 5000.0))


def test_no_browser_is_a_failure_that_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda _: None)
    with pytest.raises(pytest.fail.Exception, match=f"one of {PROGRAMS[0]}.*apt-get install"):
        chromium_program()
