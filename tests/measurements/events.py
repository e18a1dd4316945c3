"""How many events of a pull, and how many pictures, does the page make in a second while a replay is held?

A mouse that waits for nobody moves 60 times a second: its moves are sent to Chromium without waiting for an
answer, as the operating system would. Run it on a quiet machine:

    python -m tests.measurements.events
"""

from __future__ import annotations

import json
import os
import tempfile
import time
from pathlib import Path

import numpy as np
from playwright.sync_api import sync_playwright
from websockets.sync.client import connect

from app.actions import Drag
from app.replaying import Replaying
from tests.browser.conftest import DENSITY, address, serving
from tests.browser.conftest import come as first_screen
from tests.browser.person import SIZE, Person
from tests.browser.test_correcting import begin_replay, catch
from tests.support.chromium import FLAGS, ViserPage, chromium_program

SECONDS = 5.0
PERIOD = 1.0 / 60.0
REACH = 30.0
"""The mouse moves about the place where the hand was caught by so much [px]."""
PORT = 9237
COUNT = """() => { window.pictures = 0;
    const count = () => { window.pictures++; requestAnimationFrame(count); }; count(); }"""


def measured(person: Person, endpoint: str, arrived: list[float]) -> str:
    """Hold the hand of a replay and move the mouse; says what came of it."""
    tab = person.tab
    person.pause()
    begin_replay(person)
    x, y = catch(tab)
    tab.page.evaluate(COUNT)
    before, began = len(arrived), time.perf_counter()
    moves = 0
    with connect(endpoint, max_size=None) as mouse:
        while (gone := time.perf_counter() - began) < SECONDS:
            at = {"x": x + REACH * np.sin(3.0 * gone), "y": y + REACH * np.sin(5.0 * gone)}
            event = {"type": "mouseMoved", "button": "left", "buttons": 1, **at}
            mouse.send(json.dumps({"id": moves, "method": "Input.dispatchMouseEvent", "params": event}))
            moves += 1
            tab.page.wait_for_timeout(1000.0 * PERIOD)
        seconds, events = time.perf_counter() - began, len(arrived) - before
    pictures = tab.page.evaluate("() => window.pictures")
    tab.release()
    return (
        f"{moves / seconds:.0f} moves, {pictures / seconds:.1f} pictures and {events / seconds:.1f} events "
        f"a second at {DENSITY} of the density, load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"
    )


def main() -> None:
    """Print what was measured."""
    arrived: list[float] = []
    follow = Replaying.follow

    def counted(self: Replaying, drag: Drag) -> None:
        arrived.append(drag.time)
        follow(self, drag)

    Replaying.follow = counted
    flags = [*FLAGS, f"--remote-debugging-port={PORT}"]
    with (
        tempfile.TemporaryDirectory() as folder,
        serving(Path(folder) / "library.db") as server,
        sync_playwright() as driver,
    ):
        browser = driver.chromium.launch(executable_path=chromium_program(), headless=True, args=flags)
        page = browser.new_context(viewport={"width": SIZE[0], "height": SIZE[1]}).new_page()
        page.goto(address(server))
        target = page.context.new_cdp_session(page).send("Target.getTargetInfo")["targetInfo"]["targetId"]
        endpoint = f"ws://127.0.0.1:{PORT}/devtools/page/{target}"
        print(measured(first_screen(ViserPage(page)), endpoint, arrived))
        browser.close()


if __name__ == "__main__":
    main()
