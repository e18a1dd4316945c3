"""What the motion is tied to, in yellow: pull one and the tube bends.

The goal is a ball on a stand over two rings, as on a target. The start is the stand with
one ring, because the hand and the magenta ball are at its top. A way point is a small ball,
an obstacle a post, an object a box with its axes and a dial to turn it.
"""

from collections.abc import Callable
from typing import Final

import numpy as np
import viser

from app.actions import Actions
from app.anchors import Anchor, matrix
from app.document import LandmarkKind
from app.scene.bodies import ball, box, post
from app.scene.dial import Dial
from app.scene.geometry import Faces, Vertices, stem, together, torus
from app.scene.grip import Grip
from app.scene.nodes import Ball, Line, Mesh
from app.scene.polyline import dashes
from app.scene.pulls import bind_pull
from app.scene.style import (
    GHOST_RADIUS,
    LANDMARK,
    LANDMARK_GHOST,
    LANDMARK_GRIP,
    LANDMARK_RADIUS,
    OBJECT_HALF,
    VIA_RADIUS,
)
from app.scene.view import Eye
from app.store import State

STEM_RADIUS: Final = 0.003
RING_RADIUS: Final = 0.045
RING_THICKNESS: Final = 0.007
_HERE: Final = np.zeros(3)
_RING: Final = torus(RING_RADIUS, RING_THICKNESS)
_TARGET: Final = together(_RING, torus(0.45 * RING_RADIUS, RING_THICKNESS))
_SMALL: Final = torus(0.5 * RING_RADIUS, 0.6 * RING_THICKNESS)


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
        self._body = Mesh(api, node, color=LANDMARK)
        self._stem = Mesh(api, f"{node}/stem", color=LANDMARK)
        self._ring = Mesh(api, f"{node}/ring", color=LANDMARK)
        self._ghost = Ball(api, f"/taught/{name}", radius=GHOST_RADIUS, color=LANDMARK_GHOST)
        self._way = Line(api, f"/taught/{name}/way", color=LANDMARK)
        self._grip = Grip(api, node, LANDMARK_RADIUS, LANDMARK_GRIP)
        self._dial = Dial(api, name, actions, clock, eye)
        self._actions, self._clock, self._eye = actions, clock, eye
        self._bound = False
        self._anchor: Anchor | None = None
        self._looks: tuple[object, ...] | None = None

    def draw(self, anchor: Anchor | None) -> None:
        if anchor is not self._anchor:
            self._redraw(anchor)
        if anchor is not None and anchor.kind != "start":
            self._grip.aim(anchor.now, self._eye.position, scale=GRIPS.get(anchor.kind, 1.0))
        self._dial.draw(anchor)

    def _redraw(self, anchor: Anchor | None) -> None:
        self._anchor = anchor
        if anchor is None:
            self._body.hide()
            self._ghost.hide()
            return
        self._draw_here(anchor)
        self._draw_taught(anchor)

    def _draw_here(self, anchor: Anchor) -> None:
        # The stand need not follow every tenth of a millimetre.
        height = round(float(anchor.now[2]), 3)
        looks = (anchor.kind, height if anchor.kind in TALL or anchor.kind in FEET else None, anchor.turn)
        node = self._body.handle
        if node is None or not self._shown(looks):
            node = self._body.show(*body(anchor, height))
            self._draw_stand(anchor.kind, height)
            self._looks = looks
        else:
            self._body.reveal()
        node.position = anchor.now
        if not self._bound:
            bind_pull(node, self._actions, self._clock, ball=True)
            self._bound = True

    def _shown(self, looks: tuple[object, ...]) -> bool:
        former = self._looks
        return former is not None and former[:2] == looks[:2] and former[2] is looks[2]

    def _draw_stand(self, kind: LandmarkKind, height: float) -> None:
        foot = FEET.get(kind)
        if foot is None:
            self._ring.hide()
        else:
            self._ring.show(*foot).position = (0.0, 0.0, 0.5 * RING_THICKNESS - height)
        if kind in TALL:
            self._stem.hide()
        else:
            self._stem.show(*stem(height, STEM_RADIUS))

    def _draw_taught(self, anchor: Anchor) -> None:
        if np.array_equal(anchor.now, anchor.taught):
            self._ghost.hide()
            return
        self._ghost.show(anchor.taught)
        self._way.show(dashes(np.stack([_HERE, anchor.now - anchor.taught])))


def body(anchor: Anchor, height: float) -> tuple[Vertices, Faces]:
    """Shape a landmark so high [m] over the table, about its own place."""
    if anchor.kind == "start":
        return stem(height, STEM_RADIUS)
    if anchor.kind == "obstacle":
        return post(OBJECT_HALF, -height, OBJECT_HALF)
    if anchor.kind == "object":
        return box(OBJECT_HALF, matrix(anchor.turn))
    return ball(VIA_RADIUS if anchor.kind == "via" else LANDMARK_RADIUS)


FEET: Final = {"start": _RING, "goal": _TARGET, "via": _SMALL, "object": _SMALL}
"""What lies on the table under a landmark."""
TALL: Final = ("start", "obstacle")
"""Those that stand on the table themselves."""
GRIPS: Final[dict[LandmarkKind, float]] = {"via": VIA_RADIUS / LANDMARK_RADIUS}
"""How much thinner the rod is by which one is grabbed."""
