"""What the motion is tied to, in yellow: pull one and the tube bends.

The goal is a ball on a stand over two rings, as on a target. The start is the stand with
one ring, because the hand and the magenta ball are at its top.
"""

from collections.abc import Callable
from typing import Final

import numpy as np
import viser

from app.actions import Actions
from app.model import Anchor
from app.scene.geometry import stem, together, torus
from app.scene.grip import Grip
from app.scene.nodes import Ball, Line, Mesh
from app.scene.polyline import dashes
from app.scene.pulls import bind_pull
from app.scene.style import GHOST_RADIUS, LANDMARK, LANDMARK_GHOST, LANDMARK_GRIP, LANDMARK_RADIUS
from app.scene.view import Eye
from app.store import State

STEM_RADIUS: Final = 0.003
RING_RADIUS: Final = 0.045
RING_THICKNESS: Final = 0.007
_HERE: Final = np.zeros(3)


class Landmarks:
    """``/landmarks/<name>``, with its origin at the landmark."""

    def __init__(self, api: viser.SceneApi, actions: Actions, clock: Callable[[], float], eye: Eye) -> None:
        self._api, self._actions, self._clock, self._eye = api, actions, clock, eye
        self._marks: dict[str, _Landmark] = {}

    def draw(self, state: State) -> None:
        """Draw every landmark that has a position."""
        anchors = {anchor.name: anchor for anchor in state.model.anchors}
        for name in anchors.keys() - self._marks.keys():
            self._marks[name] = _Landmark(self._api, name, self._actions, self._clock, self._eye)
        for name, mark in self._marks.items():
            mark.draw(anchors.get(name))


class _Landmark:
    def __init__(
        self, api: viser.SceneApi, name: str, actions: Actions, clock: Callable[[], float], eye: Eye
    ) -> None:
        node = f"/landmarks/{name}"
        self._ball = None if name == "start" else Ball(api, node, radius=LANDMARK_RADIUS, color=LANDMARK)
        self._stem = Mesh(api, node if name == "start" else f"{node}/stem", color=LANDMARK)
        self._foot = _RING if name == "start" else _TARGET
        self._ring = Mesh(api, f"{node}/ring", color=LANDMARK)
        self._ghost = Ball(api, f"/taught/{name}", radius=GHOST_RADIUS, color=LANDMARK_GHOST)
        self._way = Line(api, f"/taught/{name}/way", color=LANDMARK)
        self._grip = Grip(api, node, LANDMARK_RADIUS, LANDMARK_GRIP)
        self._actions, self._clock, self._eye = actions, clock, eye
        self._bound = False
        self._anchor: Anchor | None = None
        self._height: float | None = None

    def draw(self, anchor: Anchor | None) -> None:
        if anchor is not self._anchor:
            self._redraw(anchor)
        if anchor is not None and self._ball is not None:
            self._grip.aim(anchor.now, self._eye.position)

    def _redraw(self, anchor: Anchor | None) -> None:
        self._anchor = anchor
        if anchor is None:
            self._hide()
            return
        self._draw_here(anchor)
        self._draw_taught(anchor)

    def _hide(self) -> None:
        (self._ball or self._stem).hide()
        self._ghost.hide()
        self._height = None  # so that the stand is shown again, though it is the same

    def _draw_here(self, anchor: Anchor) -> None:
        # The stand need not follow every tenth of a millimetre.
        height = round(float(anchor.now[2]), 3)
        node = self._stem.handle
        if node is None or height != self._height:
            node = self._stem.show(*stem(height, STEM_RADIUS))
            self._ring.show(*self._foot).position = (0.0, 0.0, 0.5 * RING_THICKNESS - height)
            self._height = height
        if self._ball is None:
            node.position = anchor.now
        else:
            node = self._ball.show(anchor.now)
        if not self._bound:
            bind_pull(node, self._actions, self._clock, ball=True)
            self._bound = True

    def _draw_taught(self, anchor: Anchor) -> None:
        moved = anchor.now is not anchor.taught and not np.array_equal(anchor.now, anchor.taught)
        if not moved:
            self._ghost.hide()
            return
        self._ghost.show(anchor.taught)
        self._way.show(dashes(np.stack([_HERE, anchor.now - anchor.taught])))


_RING: Final = torus(RING_RADIUS, RING_THICKNESS)
_TARGET: Final = together(_RING, torus(0.45 * RING_RADIUS, RING_THICKNESS))
