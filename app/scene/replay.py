"""A correction in the scene, while a line is pulled or replayed and until it is answered.

What the line was is dashed grey; what it becomes is green, twice as wide, with dots at its ends; the tube
that would be learned is outlined by green rings.
"""

from typing import Final

import numpy as np
import viser

from app import linepull
from app.binding import Changed
from app.document import FloatArray
from app.scene.cylinder import rings
from app.scene.nodes import Ball, Line
from app.scene.polyline import dashes, segments, thin_out
from app.scene.style import DOT_RADIUS, DOUBLE, FREE, REFINED, THICK, THIN
from app.store import State
from gc_core import GeneralizedCylinder

PLACE_RADIUS: Final = 0.014
OUTLINE: Final = (10, 24)
"""Rings of the outline, and corners of each."""
MOST_POINTS: Final = 150
"""Of either line; the green one is redrawn at every tick."""


class Replay:
    """``/replay/former``, ``/replay/done`` with its ends, ``/replay/outline``, and ``/replay/place``.

    That is where a line is moved by buttons and numbers.
    """

    def __init__(self, api: viser.SceneApi) -> None:
        self._ends = [
            Ball(api, f"/replay/{end}", radius=DOT_RADIUS, color=REFINED) for end in ("first", "last")
        ]
        self._place = Ball(api, "/replay/place", radius=PLACE_RADIUS, color=REFINED)
        self._placed = Changed()
        self._outline = Line(api, "/replay/outline", color=REFINED, thickness=THIN)
        self._drawn: FloatArray | None = None
        self._outlined: GeneralizedCylinder | None = None
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
        # What a replay did so far only grows; a line that is pulled keeps its length.
        if len(done) != self._count or (state.replay is None and done is not self._drawn):
            self._count, self._drawn = len(done), done
            self._done.show(segments(thin_out(done if len(done) else _NOWHERE, MOST_POINTS)))
            self._draw_ends(done)
        self._draw_outline(outlined(state))
        self._draw_place(state)

    def _draw_place(self, state: State) -> None:
        view, waiting = state.view, state.proposal
        if not self._placed(view.line, view.line_share, state.model, waiting):
            return
        place = linepull.place_on(view.line, view.line_share, state.model, waiting) if view.line else None
        if place is None:
            self._place.hide()
        else:
            self._place.show(place)

    def _draw_ends(self, done: FloatArray) -> None:
        for ball, place in zip(self._ends, (0, -1), strict=True):
            if len(done):
                ball.show(done[place])
            else:
                ball.hide()

    def _draw_outline(self, cylinder: GeneralizedCylinder | None) -> None:
        if cylinder is self._outlined:
            return
        self._outlined = cylinder
        if cylinder is None:
            self._outline.hide()
            return
        around = rings(cylinder, OUTLINE)
        self._outline.show(np.stack([around, np.roll(around, -1, axis=1)], axis=2).reshape(-1, 2, 3))


_NOWHERE: Final = np.zeros((1, 3))
_NONE: Final = _NOWHERE[:0]


def corrected(state: State) -> tuple[FloatArray | None, FloatArray]:
    """Give the path that is corrected (K, 3), if there is one, and what it became so far (T, 3) [m]."""
    if state.correction is not None:
        return state.correction.before, state.correction.after
    if state.replay is not None:
        return state.replay.path, state.replay.done
    if state.proposal is not None:
        return state.proposal.before, state.proposal.after
    return None, _NONE


def outlined(state: State) -> GeneralizedCylinder | None:
    """Give the tube that a correction would make, where it is another one than before."""
    if not state.view.show_tube:
        return None
    if state.replay is not None:
        return state.replay.outline
    correction = state.correction or state.proposal
    same = correction is None or state.model.cylinder is correction.among.cylinder
    return None if same else state.model.cylinder
