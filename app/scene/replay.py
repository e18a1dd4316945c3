"""A replay in the scene: what it was in dashed grey, what the hand did in green, until it is answered."""

from typing import Final

import numpy as np
import viser

from app.document import FloatArray
from app.scene.nodes import Line
from app.scene.polyline import dashes, segments, thin_out
from app.scene.style import DOUBLE, FREE, REFINED, THICK
from app.store import State

MOST_POINTS: Final = 400
"""Of either line; the green one is redrawn at every tick."""


class Replay:
    """``/replay/former`` and ``/replay/done``."""

    def __init__(self, api: viser.SceneApi) -> None:
        self._former = Line(api, "/replay/former", color=FREE, thickness=THICK)
        self._done = Line(api, "/replay/done", color=REFINED, thickness=DOUBLE)
        self._path: FloatArray | None = None
        self._count = 0

    def draw(self, state: State) -> None:
        """Follow the replay, then the correction that came of it."""
        path, done = corrected(state)
        if path is not self._path:
            self._path = path
            self._former.show(dashes(thin_out(_NOWHERE if path is None else path, MOST_POINTS)))
        if len(done) != self._count:
            self._count = len(done)
            self._done.show(segments(thin_out(done if len(done) else _NOWHERE, MOST_POINTS)))


_NOWHERE: Final = np.zeros((1, 3))


def corrected(state: State) -> tuple[FloatArray | None, FloatArray]:
    """Give the path that is corrected (K, 3), if there is one, and what it became so far (T, 3) [m]."""
    if state.replay is not None:
        return state.replay.path, state.replay.done
    if state.proposal is not None:
        return state.proposal.before, state.proposal.after
    return None, _NOWHERE[:0]
