"""A person at the app: what one sees of the work, and the ways to change it.

The page is small and its pictures are drawn in software, a few a second; every wait is for something
that the page shows. Positions are in the robot base frame [m].
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from app.document import FloatArray
from tests.support.chromium import Pixel, ViserPage

FIRST_SCREEN: Final = (
    "/hand",
    "/start/0",
    *(f"/demonstrations/{i}/line" for i in range(5)),
    "/directrix",
    "/tube",
    "/reproductions/0/line",
    "/landmarks/start",
    "/landmarks/goal",
    "/arm/j2s6s200_link_6/mesh",
)
SIZE: Final = (1100, 600)
"""Of the window [px]."""
NAMES_OF_WORK: Final = """() => Object.keys(window.__viserMutable.nodeRefFromName).filter(name =>
    /^\\/(tube|directrix|start\\/\\d+|landmarks\\/[^\\/]+|(demonstrations|reproductions)\\/\\d+\\/(line|free))$/
    .test(name))"""
FIELDS: Final = "() => Array.from(document.querySelectorAll('input')).map(field => field.value)"
ASIDE: Final = 1.5
"""Time of *Reaching* at which the hand is far from start and goal [s]."""
CLEAR: Final = 0.12
"""So far is the hand from both, then [m]."""
COARSE: Final = 60 * 24
"""Vertices of the tube while something is dragged."""

Work: TypeAlias = dict[str, FloatArray]
"""Of each visible thing its origin (1, 3) and then its points (n, 3) [m]."""


@dataclass
class Person:
    """Somebody in front of one tab."""

    tab: ViserPage

    # --- looking --------------------------------------------------------------------------------------

    def work(self) -> Work:
        """What is shown of the document; not the hand and the slice, which move by themselves."""
        tab = self.tab
        names = [name for name in tab.page.evaluate(NAMES_OF_WORK) if tab.visible(name)]
        points = {name: tab.points(name) if is_shape(name) else np.zeros((0, 3)) for name in names}
        return {name: np.vstack([tab.position(name)[None], points[name]]) for name in sorted(names)}

    def line(self, name: str) -> FloatArray:
        """(n, 3) the points of a drawn line, one after the other."""
        ends = self.tab.points(name).reshape(-1, 2, 3)
        return np.vstack([ends[:, 0], ends[-1:, 1]])

    def tube_end(self) -> FloatArray:
        """(3,) the middle of the last ring of the tube at rest."""
        return self.tab.points("/tube").reshape(100, 32, 3)[-1].mean(axis=0)

    def fields(self) -> list[str]:
        """What stands in the input fields: the name of the skill, the place of the hand, and more."""
        return self.tab.page.evaluate(FIELDS)

    def wait_for_change(self, before: Work, *names: str) -> Work:
        """Wait until these look otherwise and nothing is held any more; returns the work then."""

        def after() -> Work | None:
            work = self.work()
            tube = work.get("/tube")
            settled = tube is None or len(tube) - 1 != COARSE
            return work if settled and set(names) <= self.changed(before, work) else None

        self.tab.wait_until(after)
        self.tab.wait_drawn()
        return self.work()

    def wait_for_work(self, wanted: Work) -> None:
        """Wait until it looks like this again, to the last point."""
        self.tab.wait_until(lambda: not self.changed(wanted, self.work()))

    @staticmethod
    def changed(before: Work, after: Work) -> set[str]:
        """Names of what looks otherwise, is new or is gone."""
        return {
            name
            for name in before.keys() | after.keys()
            if name not in before or name not in after or not np.array_equal(before[name], after[name])
        }

    # --- buttons --------------------------------------------------------------------------------------

    def pause(self) -> None:
        """Let the hand rest where it is in nobody's way, with the space bar and the field of the playhead."""
        tab = self.tab
        if not tab.shows("Paused"):
            tab.page.evaluate("() => document.activeElement.blur()")
            tab.page.keyboard.press("Space")
            tab.wait_until(lambda: tab.shows("Paused"))
        playhead = tab.page.locator("input:visible").last
        playhead.fill(f"{ASIDE}")
        playhead.press("Enter")
        tab.page.evaluate("() => document.activeElement.blur()")
        tab.wait_until(lambda: min(self._hand_to("/start/0"), self._hand_to("/landmarks/goal")) > CLEAR)
        self.wait_still()

    def seek_end(self) -> None:
        """Lead the paused hand to the end of the run by the field of the playhead; wait until it is there."""
        playhead = self.tab.page.locator("input:visible").last
        playhead.fill("99")
        playhead.press("Enter")
        self.tab.page.evaluate("() => document.activeElement.blur()")
        end = self.line("/reproductions/0/line")[-1]
        self.tab.wait_until(lambda: np.linalg.norm(self.tab.position("/hand") - end) < CLEAR / 4)
        self.wait_still()

    def open_folder(self, title: str) -> None:
        """Open a folder of the panels by the beginning of its title."""
        self.tab.page.get_by_text(re.compile(f"^{re.escape(title)}")).first.click()

    def _hand_to(self, name: str) -> float:
        return float(np.linalg.norm(self.tab.position("/hand") - self.tab.position(name)))

    def wait_still(self) -> None:
        """Wait until the hand does not move any more."""

        def still() -> bool:
            before = self.tab.position("/hand")
            self.tab.wait_drawn()
            return bool(np.array_equal(before, self.tab.position("/hand")))

        self.tab.wait_until(still)

    def undo(self) -> None:
        """Press the button that names what it takes back."""
        self.tab.page.locator('button:has-text("Undo:"):visible').first.click()

    def press_exactly(self, label: str) -> None:
        """Press the button with this label and nothing more."""
        self.tab.page.get_by_role("button", name=label, exact=True).click()

    def open_tab(self, name: str) -> None:
        """Teach, Try, Move, Fix or Compare."""
        self.tab.page.get_by_role("tab", name=name).click()

    # --- mouse ----------------------------------------------------------------------------------------

    def drag(self, start: Pixel, by: Pixel, *, button: str = "left") -> None:
        """Pull whatever is at a pixel."""
        self.tab.drag(start, (start[0] + by[0], start[1] + by[1]), steps=6, button=button)

    def clearest(self, line: str, parts: tuple[float, float] = (0.0, 1.0)) -> Pixel:
        """A pixel of a line, between two parts of it, where nothing else is near that one could grab."""
        own = self._on_screen(line)
        own = own[int(parts[0] * len(own)) : int(parts[1] * len(own))]
        others = np.vstack([self._on_screen(name) for name in self._grabbable() if name != line])
        gaps = np.linalg.norm(own[:, None] - others[None], axis=2).min(axis=1)
        for index in np.argsort(-gaps):
            if self.tab.on_canvas(tuple(own[index])):
                x, y = own[index]
                return float(x), float(y)
        raise LookupError(f"no part of {line} is in sight")

    def _grabbable(self) -> list[str]:
        names = self.work().keys() - {"/tube"}
        return ["/hand", *sorted(names)]

    def _on_screen(self, name: str) -> np.ndarray:
        points = self.line(name) if is_shape(name) else np.zeros((1, 3))
        return self.tab.pixels(name, points[:: max(len(points) // 100, 1)])


def is_shape(name: str) -> bool:
    """Whether a thing is where its points are; others are where their origin is."""
    return not name.startswith(("/start", "/landmarks", "/hand"))
