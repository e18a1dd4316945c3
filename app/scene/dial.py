"""A dial about an object: pull its knob around, and the object turns about the vertical."""

from collections.abc import Callable
from typing import Final

import numpy as np
import viser

from app.actions import Actions
from app.anchors import Anchor, matrix
from app.scene.geometry import torus
from app.scene.grip import Grip
from app.scene.nodes import Ball, Line, Mesh
from app.scene.pulls import bind_pull
from app.scene.style import LANDMARK, LANDMARK_GRIP, OBJECT_AXES, OBJECT_HALF
from app.scene.view import Eye

RADIUS: Final = 0.085
"""Of the dial [m]."""
KNOB_RADIUS: Final = 0.013
THICKNESS: Final = 0.004
_RING: Final = torus(RADIUS, THICKNESS)


class Dial:
    """``/turns/<name>``, the knob, at the angle by which the object was turned; only objects have one."""

    def __init__(
        self, api: viser.SceneApi, name: str, actions: Actions, clock: Callable[[], float], eye: Eye
    ) -> None:
        self._knob = Ball(api, f"/turns/{name}", radius=KNOB_RADIUS, color=LANDMARK)
        self._ring = Mesh(api, f"/turns/{name}/ring", color=LANDMARK)
        self._axes = tuple(
            Line(api, f"/turns/{name}/{axis}", color=color, thickness=3.0)
            for axis, color in zip("xyz", OBJECT_AXES, strict=True)
        )
        self._grip = Grip(api, f"/turns/{name}", KNOB_RADIUS, LANDMARK_GRIP)
        self._actions, self._clock, self._eye = actions, clock, eye
        self._bound = False
        self._anchor: Anchor | None = None

    def draw(self, anchor: Anchor | None) -> None:
        """Put it about an object; anything else has none."""
        anchor = anchor if anchor is not None and anchor.kind == "object" else None
        if anchor is not self._anchor:
            self._anchor = anchor
            if anchor is None:
                self._knob.hide()
            else:
                self._show(anchor)
        if anchor is not None:
            self._grip.aim(anchor.now + _arm(anchor), self._eye.position)

    def _show(self, anchor: Anchor) -> None:
        arm, rotation = _arm(anchor), matrix(anchor.turn)
        node = self._knob.show(anchor.now + arm)
        self._ring.show(*_RING).position = -arm
        for line, axis in zip(self._axes, rotation.T, strict=True):
            line.show(np.stack([OBJECT_HALF * axis, 1.9 * OBJECT_HALF * axis])[None] - arm)
        if not self._bound:
            bind_pull(node, self._actions, self._clock, ball=True, level=True)
            self._bound = True


def _arm(anchor: Anchor) -> np.ndarray:
    """(3,) from an object to its knob [m]."""
    yaw = 0.0 if anchor.turn is None else float(anchor.turn[2])
    return RADIUS * np.array([np.cos(yaw), np.sin(yaw), 0.0])
