"""The hand: what one grabs, what it recorded so far, and why it cannot follow."""

from collections.abc import Callable
from typing import Final

import numpy as np
import viser

from app.actions import Actions
from app.document import FloatArray
from app.scene.geometry import circle
from app.scene.grip import Grip
from app.scene.nodes import Ball, Label, Line
from app.scene.polyline import dashes, segments, thin_out
from app.scene.pulls import bind_pull
from app.scene.style import (
    DEMONSTRATION,
    GHOST_RADIUS,
    GUIDE,
    HAND,
    HAND_GRIP,
    HAND_RADIUS,
    THICK,
    WARNING,
    WARNING_GHOST,
)
from app.scene.view import Eye
from app.store import Hand, State

MOVING: Final = 1.5
"""While it plays the hand is harder to hit; its grip is that much wider."""
MOST_POINTS: Final = 150
"""Of the recording so far; it is redrawn twenty times a second."""
_BESIDE: Final = np.array([0.02, 0.0, 0.03])


class HandBall:
    """``/hand``: neutral, amber while it cannot follow."""

    def __init__(self, api: viser.SceneApi, actions: Actions, clock: Callable[[], float], eye: Eye) -> None:
        self._ball = Ball(api, "/hand", radius=HAND_RADIUS, color=HAND)
        self._grip = Grip(api, "/hand", HAND_RADIUS, HAND_GRIP)
        self._actions, self._clock, self._eye = actions, clock, eye
        self._bound = False
        self._hand: Hand | None = None

    def draw(self, state: State) -> None:
        """Put the ball at the tool tip."""
        hand = state.hand
        self._draw_ball(hand)
        self._grip.aim(hand.position, self._eye.position, scale=MOVING if state.playback.playing else 1.0)

    def _draw_ball(self, hand: Hand) -> None:
        if hand is self._hand:
            return
        self._hand = hand
        handle = self._ball.show(hand.position, color=WARNING if hand.shortfall else HAND)
        if not self._bound:
            bind_pull(handle, self._actions, self._clock, ball=True, aside=True)
            self._bound = True


class Shortage:
    """``/wanted/…``: where the pointer wants the hand, a dashed tether to it, and the reason."""

    def __init__(self, api: viser.SceneApi) -> None:
        self._ghost = Ball(api, "/wanted/ghost", radius=GHOST_RADIUS, color=WARNING_GHOST)
        self._tether = Line(api, "/wanted/tether", color=WARNING)
        self._reason = Label(api, "/wanted/reason")
        self._hand: Hand | None = None

    def draw(self, state: State) -> None:
        """Show the tether, or nothing while the hand is where it is wanted."""
        hand = state.hand
        if hand is self._hand:
            return
        self._hand = hand
        if hand.shortfall is None or hand.wanted is None:
            for node in (self._ghost, self._tether, self._reason):
                node.hide()
            return
        self._ghost.show(hand.wanted)
        self._tether.show(dashes(np.stack([hand.position, hand.wanted])))
        self._reason.show(hand.wanted + _BESIDE, hand.shortfall.reason)


class Recording:
    """``/recording``: the demonstration so far; ``/returns_to``: where the hand goes after the release."""

    def __init__(self, api: viser.SceneApi) -> None:
        self._line = Line(api, "/recording", color=DEMONSTRATION, thickness=THICK)
        self._ring = Line(api, "/returns_to", color=GUIDE)
        self._recording: FloatArray | None = None
        self._returns_to: FloatArray | None = None

    def draw(self, state: State) -> None:
        """Draw what is new since the last time."""
        recording, returns_to = state.hand.recording, state.hand.returns_to
        if recording is not self._recording:
            self._recording = recording
            self._line.show(segments(thin_out(recording if recording is not None else _NOWHERE, MOST_POINTS)))
        if returns_to is not self._returns_to:
            self._returns_to = returns_to
            self._ring.show(segments(_ring_around(returns_to)))


_NOWHERE: Final = np.zeros((1, 3))


def _ring_around(place: FloatArray | None) -> FloatArray:
    if place is None:
        return _NOWHERE
    ring = circle(1.2 * HAND_RADIUS)
    return place + np.concatenate([ring, ring[:1]])
