"""The demonstrations as thin red lines that one pulls to correct them."""

from collections.abc import Callable
from typing import Final

import viser

from app.actions import Actions
from app.document import Shown
from app.scene.geometry import pick_tube
from app.scene.nodes import Line, Mesh
from app.scene.polyline import dashes, segments, thin_out
from app.scene.pulls import bind_pull
from app.scene.style import DEMONSTRATION, MUTED, PICK_RADIUS, THIN
from app.store import State

MOST_POINTS: Final = 150
"""Drawn of one demonstration, all of them points of it."""


class Demonstrations:
    """``/demonstrations/i``, what the pointer hits, with the line in it as ``…/line``."""

    def __init__(self, api: viser.SceneApi, actions: Actions, clock: Callable[[], float]) -> None:
        self._api, self._actions, self._clock = api, actions, clock
        self._lines: list[_Demonstration] = []

    def draw(self, state: State) -> None:
        """Draw all of the document, also those that are muted."""
        shown = state.document.demonstrations if state.view.show_demonstrations else ()
        while len(self._lines) < len(shown):
            name = f"/demonstrations/{len(self._lines)}"
            self._lines.append(_Demonstration(self._api, name, self._actions, self._clock))
        for i, line in enumerate(self._lines):
            line.draw(shown[i] if i < len(shown) else None, state.dragging is not None)


class _Demonstration:
    def __init__(self, api: viser.SceneApi, name: str, actions: Actions, clock: Callable[[], float]) -> None:
        self._pick = Mesh(api, name, opacity=0.0)
        self._line = Line(api, f"{name}/line")
        self._actions, self._clock = actions, clock
        self._bound = False
        self._drawn: Shown | None = None
        self._picked: Shown | None = None

    def draw(self, shown: Shown | None, dragging: bool) -> None:
        if shown is not None and not _same(self._picked, shown) and not (dragging and self._picked):
            self._draw_pick(shown)
        if _same(self._drawn, shown):
            return
        self._drawn = shown
        if shown is None:
            self._pick.hide()
            self._picked = None
        else:
            self._draw_line(shown)

    def _draw_pick(self, shown: Shown) -> None:
        """Invisible: what is dragged already need not be hit, so it waits for the release."""
        self._picked = shown
        handle = self._pick.show(*pick_tube(shown.demonstration.positions, PICK_RADIUS))
        if not self._bound:
            bind_pull(handle, self._actions, self._clock)
            self._bound = True

    def _draw_line(self, shown: Shown) -> None:
        positions = shown.demonstration.positions
        visible = thin_out(positions, MOST_POINTS)
        self._line.look(MUTED if shown.muted else DEMONSTRATION, THIN)
        self._line.show(dashes(visible) if shown.muted else segments(visible))


def _same(one: Shown | None, other: Shown | None) -> bool:
    if one is None or other is None:
        return one is other
    return one.demonstration is other.demonstration and one.muted == other.muted
