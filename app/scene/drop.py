"""How high what is dragged is: a line down to the table, its shadow there, and the height in words."""

from typing import Final

import numpy as np
import viser

from app import measures
from app.document import FloatArray, Shape
from app.scene.geometry import disc
from app.scene.nodes import Label, Line, Mesh
from app.scene.polyline import dashes
from app.scene.style import GUIDE, SHADOW
from app.store import State

SHADOW_RADIUS: Final = 0.022
STANDING: Final = 0.002
"""Lower than this above the table a thing stands on it [m]."""
_ABOVE_TABLE: Final = np.array([0.0, 0.0, 0.0015])
"""The shadow floats so high that the table does not flicker through it [m]."""


class DropLine:
    """``/drop/…``."""

    def __init__(self, api: viser.SceneApi) -> None:
        self._line = Line(api, "/drop/line", color=GUIDE)
        self._shadow = Mesh(api, "/drop/shadow", color=SHADOW)
        self._height = Label(api, "/drop/height")
        self._place: FloatArray | None = None

    def draw(self, state: State) -> None:
        """Draw it under what is dragged, if that is a thing in one place."""
        place = dragged_place(state)
        if place is self._place:
            return
        self._place = place
        if place is None:
            for node in (self._line, self._shadow, self._height):
                node.hide()
            return
        floor = place * [1.0, 1.0, 0.0]
        self._line.show(dashes(np.stack([place, floor])))
        self._shadow.show(*_SHADOW).position = floor + _ABOVE_TABLE
        self._height.show(0.5 * (place + floor), f"{100.0 * place[2]:.0f} cm")


_SHADOW: Final = disc(SHADOW_RADIUS)


def dragged_place(state: State) -> FloatArray | None:
    """(3,) where the dragged hand, start or landmark is, or the underside of a thing [m].

    None for lines, for a thing that stands on the table, and while nothing is dragged.
    """
    name = state.dragging or ""
    if name == "/hand":
        return state.hand.position
    kind, _, rest = name.removeprefix("/").partition("/")
    if kind == "start" and rest.isdecimal() and int(rest) < len(state.model.runs):
        return state.model.runs[int(rest)].start
    if kind == "landmarks":
        return next((anchor.now for anchor in state.model.anchors if anchor.name == rest), None)
    if kind == "obstacles":
        return next((_below(thing) for thing in state.document.things if thing.name == rest), None)
    return None


def _below(thing: Shape) -> FloatArray | None:
    x, y, _ = thing.position
    height = measures.underside(thing)
    return np.array([x, y, height]) if height > STANDING else None
