"""A real page in headless Chromium: open it, wait until it is drawn, pull on things, look at the pixels.

One browser for the whole run, one context (so its own storage) for each page. viser 1.1.1's page leaves its
scene on ``window.__viserMutable``; everything here reads that. Positions are in viser's world frame [m],
pixels in CSS pixels from the top left. Nothing sleeps outside the page, whose clock must run.

    def test_story(open_page):
        page = open_page(f"http://127.0.0.1:{port}/")
        page.wait_drawn("/hand")
        page.drag_node("/hand", by=(0, -80))
"""

from __future__ import annotations

import io
import shutil
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path as FilePath
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, ConsoleMessage, Page, sync_playwright

PROGRAMS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = [
    "--no-sandbox",
    "--disable-gpu-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--webgl-antialiasing-mode=none",
    "--disable-gpu-rasterization",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-timer-throttling",
    "--disable-renderer-backgrounding",
    "--disable-backgrounding-occluded-windows",
]
MOUNTED = """names => { const m = window.__viserMutable;
    return Boolean(m && m.camera && m.canvas && names.every(n => m.nodeRefFromName[n])); }"""
FRAME = """const frame = async () => { window.__viserMutable.requestRender();
    await new Promise(done => requestAnimationFrame(() => setTimeout(done, 0))); };"""
# What plays fills the queue again and again: only what waits now has to be taken out of it.
DRAWN = f"""async () => {{ {FRAME}
    const last = window.__viserMutable.messageQueue.at(-1);
    while (last && window.__viserMutable.messageQueue.includes(last)) await frame();
    await frame(); await frame(); }}"""
FRAMES = f"async count => {{ {FRAME} for (let i = 0; i < count; i++) await frame(); }}"
PIXELS = """([name, local]) => { const m = window.__viserMutable, o = m.nodeRefFromName[name];
    o.updateWorldMatrix(true, false);
    const r = m.canvas.getBoundingClientRect();
    return local.map(at => {
        const p = new o.position.constructor(...at).applyMatrix4(o.matrixWorld).project(m.camera);
        return [r.left + (p.x + 1) / 2 * r.width, r.top + (1 - p.y) / 2 * r.height]; }); }"""
WORLD = """name => { const refs = window.__viserMutable.nodeRefFromName, o = refs[name], root = refs[""];
    o.updateWorldMatrix(true, false); root.updateWorldMatrix(true, false);
    const toWorld = root.matrixWorld.clone().invert();
    const at = new o.position.constructor().setFromMatrixPosition(o.matrixWorld);
    return at.applyMatrix4(toWorld).toArray(); }"""
POINTS = """name => { let found = null;
    window.__viserMutable.nodeRefFromName[name].traverse(o => {
        const a = o.geometry && o.geometry.attributes;
        if (found || !a) return;
        if (a.instanceStart) found = Array.from(a.instanceStart.data.array);
        else if (a.position) found = Array.from(a.position.array); });
    return found; }"""
VISIBLE = """name => { let o = window.__viserMutable.nodeRefFromName[name];
    if (!o) return false;
    for (; o; o = o.parent) if (!o.visible) return false;
    return true; }"""
ON_CANVAS = "([x, y]) => document.elementFromPoint(x, y) === window.__viserMutable.canvas"

# Chromium's own remark on a listener inside viser's page; it says nothing about ours.
KNOWN_REMARKS = ("Unable to preventDefault inside passive event listener",)

Pixel = tuple[float, float]


class ViserPage:
    """One tab. `page` is playwright's own, for what is not here."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.faults: list[str] = []
        """Uncaught exceptions and console errors of the page."""
        page.on("pageerror", lambda error: self.faults.append(str(error)))
        page.on("console", self._on_console)

    def _on_console(self, message: ConsoleMessage) -> None:
        if message.type == "error" and not message.text.startswith(KNOWN_REMARKS):
            self.faults.append(message.text)

    # --- waiting --------------------------------------------------------------------------------------

    def wait_drawn(self, *names: str, timeout: float = 90.0) -> None:
        """Wait until these nodes are there, and what was sent up to then is on the screen."""
        self.page.wait_for_function(MOUNTED, arg=list(names), timeout=1000 * timeout)
        self.page.evaluate(DRAWN)

    def frames(self, count: int) -> None:
        """Let the page draw so many pictures."""
        self.page.evaluate(FRAMES, count)

    def wait_until(self, condition: Callable[[], Any], timeout: float = 20.0) -> Any:
        """Wait, with the page running, until `condition` holds, and return what it gave."""
        end = time.perf_counter() + timeout
        while not (result := condition()):
            if time.perf_counter() > end:
                raise TimeoutError(f"not so after {timeout} s; page faults: {self.faults}")
            self.page.wait_for_timeout(20)
        return result

    # --- reading --------------------------------------------------------------------------------------

    def names(self) -> list[str]:
        """Names of the nodes that are mounted."""
        return self.page.evaluate(
            "() => { const r = window.__viserMutable.nodeRefFromName;"
            " return Object.keys(r).filter(n => r[n]); }"
        )

    def pixel(self, name: str, local: Sequence[float] = (0.0, 0.0, 0.0)) -> Pixel:
        """Where a point of a node's own frame [m] is on the screen."""
        x, y = self.pixels(name, [local])[0]
        return float(x), float(y)

    def pixels(self, name: str, local: Sequence[Sequence[float]] | np.ndarray) -> np.ndarray:
        """(n, 2) where points (n, 3) of a node's own frame [m] are on the screen."""
        points = np.asarray(local, dtype=float).reshape(-1, 3)
        return np.asarray(self.page.evaluate(PIXELS, [name, points.tolist()]), dtype=float)

    def visible(self, name: str) -> bool:
        """Whether a node is there and neither it nor what it hangs on is hidden."""
        return bool(self.page.evaluate(VISIBLE, name))

    def on_canvas(self, at: Pixel) -> bool:
        """Whether the 3D canvas is what one sees at that pixel."""
        return bool(self.page.evaluate(ON_CANVAS, [float(v) for v in at]))

    def position(self, name: str) -> np.ndarray:
        """(3,) origin of a node in the world [m], as the page has it."""
        return np.asarray(self.page.evaluate(WORLD, name), dtype=float)

    def points(self, name: str) -> np.ndarray:
        """(n, 3) vertices of a mesh, or the ends of line segments one after the other, own frame [m]."""
        found = self.page.evaluate(POINTS, name)
        if found is None:
            raise LookupError(f"{name} has no geometry in the page; nodes are {self.names()}")
        return np.asarray(found, dtype=float).reshape(-1, 3)

    def image(self) -> np.ndarray:
        """(height, width, 3) uint8 picture of the whole page."""
        png = self.page.screenshot()
        return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"))

    def save(self, path: FilePath) -> None:
        """Write the picture of the page to a PNG file."""
        self.page.screenshot(path=str(path))

    def shows(self, text: str) -> bool:
        """Whether a person can read this on the page now."""
        return self.page.locator(f"text={text} >> visible=true").count() > 0

    # --- hands ----------------------------------------------------------------------------------------

    def drag(
        self, start: Pixel, end: Pixel, *, steps: int = 10, key: str | None = None, button: str = "left"
    ) -> None:
        """Pull the mouse from one pixel to another in `steps` of 40 ms; `key` is held, e.g. ``"Shift"``."""
        self.grab(start, key=key, button=button)
        self.pull(start, end, steps)
        self.release(key=key, button=button)

    def drag_node(
        self,
        name: str,
        *,
        by: Pixel,
        local: Sequence[float] = (0.0, 0.0, 0.0),
        steps: int = 10,
        key: str | None = None,
        button: str = "left",
    ) -> None:
        """Pull on a node, grabbed at a point of its own frame [m], by so many pixels right and down."""
        x, y = self.pixel(name, local)
        self.drag((x, y), (x + by[0], y + by[1]), steps=steps, key=key, button=button)

    def grab(self, at: Pixel, *, key: str | None = None, button: str = "left") -> None:
        """Press the mouse; AssertionError when a panel covers that pixel."""
        if not self.on_canvas(at):
            raise AssertionError(f"pixel {at} is not on the 3D canvas: a panel covers it or it is off screen")
        self.page.mouse.move(*at)
        self.frames(2)  # the page sees what is under the pointer when it draws
        if key is not None:
            self.page.keyboard.down(key)
        self.page.mouse.down(button=_button(button))

    def pull(self, start: Pixel, end: Pixel, steps: int = 10) -> None:
        """Move the pressed mouse evenly."""
        for step in range(1, steps + 1):
            share = step / steps
            self.page.mouse.move(
                start[0] + (end[0] - start[0]) * share, start[1] + (end[1] - start[1]) * share
            )
            self.page.wait_for_timeout(40)

    def release(self, *, key: str | None = None, button: str = "left") -> None:
        """Let go of the mouse and of the key."""
        self.page.mouse.up(button=_button(button))
        if key is not None:
            self.page.keyboard.up(key)

    def click(self, at: Pixel) -> None:
        """Click on the 3D canvas."""
        self.grab(at)
        self.release()

    def press(self, label: str) -> None:
        """Press the visible button or tab with this text."""
        self.page.locator(f'button:has-text("{label}"):visible').first.click()


def _button(name: str) -> Any:
    return name


def near(image: np.ndarray, colour: Sequence[int], tolerance: int = 40) -> np.ndarray:
    """(height, width) bool: which pixels are within `tolerance` of a colour in each channel."""
    return (np.abs(image.astype(int) - np.asarray(colour)) <= tolerance).all(axis=-1)


def share(image: np.ndarray, colour: Sequence[int], tolerance: int = 40) -> float:
    """Which part of the pixels is near a colour, 0 to 1."""
    return float(near(image, colour, tolerance).mean())


def chromium_program() -> str:
    """The path of a Chromium; fails the test when there is none."""
    for name in PROGRAMS:
        found = shutil.which(name)
        if found is not None:
            return found
    pytest.fail(
        f"The browser tests need one of {', '.join(PROGRAMS)} on the PATH, and there is none. "
        "On Debian: apt-get install chromium"
    )


@pytest.fixture(scope="session")
def chromium() -> Iterator[Browser]:
    """The one browser of the test run."""
    program = chromium_program()
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=program, headless=True, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture
def open_page(chromium: Browser) -> Iterator[Callable[..., ViserPage]]:
    """``open_page(url, width=1280, height=720)``: a fresh tab with storage of its own."""
    contexts = []

    def opener(url: str, width: int = 1280, height: int = 720) -> ViserPage:
        context = chromium.new_context(viewport={"width": width, "height": height})
        contexts.append(context)
        tab = ViserPage(context.new_page())
        tab.page.goto(url)
        return tab

    yield opener
    for context in contexts:
        context.close()
