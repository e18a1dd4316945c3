"""The reproductions: thick magenta lines with arrowheads, and the balls they start from.

Where rules changed one, the refined path is green, twice as wide, with dots at its
ends, and what it was before is dashed grey.
"""

from collections.abc import Callable
from typing import Final

import numpy as np
import viser

from app.actions import Actions
from app.document import FloatArray
from app.model import Run
from app.scene.geometry import arrowheads, dashes, pick_tube, segments
from app.scene.nodes import Ball, Line, Mesh
from app.scene.pulls import bind_pull
from app.scene.style import (
    DOUBLE,
    FREE,
    PICK_RADIUS,
    REFINED,
    REPRODUCTION,
    START_RADIUS,
    START_RADIUS_IN_TRY,
    THICK,
)
from app.store import State

DOT_RADIUS: Final = 0.009


class Reproductions:
    """``/reproductions/i``, what the pointer hits, with the visible line in it as ``…/line``."""

    def __init__(self, api: viser.SceneApi, actions: Actions, clock: Callable[[], float]) -> None:
        self._api, self._actions, self._clock = api, actions, clock
        self._paths: list[_Path] = []

    def draw(self, state: State) -> None:
        """Draw every run of the model."""
        runs = state.model.runs if state.view.show_reproductions else ()
        while len(self._paths) < len(runs):
            name = f"/reproductions/{len(self._paths)}"
            self._paths.append(_Path(self._api, name, self._actions, self._clock))
        for i, path in enumerate(self._paths):
            path.draw(runs[i] if i < len(runs) else None)


class _Path:
    def __init__(self, api: viser.SceneApi, name: str, actions: Actions, clock: Callable[[], float]) -> None:
        self._pick = Mesh(api, name, opacity=0.0)
        self._line = Line(api, f"{name}/line")
        self._arrows = Mesh(api, f"{name}/arrows", color=REPRODUCTION)
        self._ends = [
            Ball(api, f"{name}/{end}", radius=DOT_RADIUS, color=REFINED) for end in ("first", "last")
        ]
        self._free = Line(api, f"{name}/free", color=FREE)
        self._actions, self._clock = actions, clock
        self._bound = False
        self._run: Run | None = None

    def draw(self, run: Run | None) -> None:
        if run is self._run:
            return
        self._run = run
        if run is None:
            self._pick.hide()
            return
        positions = run.reproduction.positions
        handle = self._pick.show(*pick_tube(positions, PICK_RADIUS))
        if not self._bound:
            bind_pull(handle, self._actions, self._clock)
            self._bound = True
        if run.reproduction is run.free:
            self._draw_free(positions)
        else:
            self._draw_refined(positions, run.free.positions)

    def _draw_free(self, positions: FloatArray) -> None:
        self._line.show(segments(positions), color=REPRODUCTION, thickness=THICK)
        self._arrows.show(*arrowheads(positions))
        self._free.hide()
        for end in self._ends:
            end.hide()

    def _draw_refined(self, positions: FloatArray, before: FloatArray) -> None:
        self._line.show(segments(positions), color=REFINED, thickness=DOUBLE)
        self._arrows.hide()
        self._free.show(dashes(before))
        for end, place in zip(self._ends, (positions[0], positions[-1]), strict=True):
            end.show(place)


class Starts:
    """``/start/i``: pull one for another reproduction."""

    def __init__(self, api: viser.SceneApi, actions: Actions, clock: Callable[[], float]) -> None:
        self._api, self._actions, self._clock = api, actions, clock
        self._balls: list[Ball] = []
        self._drawn: list[tuple[FloatArray | None, float]] = []

    def draw(self, state: State) -> None:
        """Put a ball where each run begins; a larger one in Try."""
        runs = state.model.runs if state.view.show_reproductions else ()
        scale = START_RADIUS_IN_TRY / START_RADIUS if state.view.tab == "Try" else 1.0
        while len(self._balls) < len(runs):
            self._add(runs[len(self._balls)].start)
        for i, ball in enumerate(self._balls):
            start = runs[i].start if i < len(runs) else None
            if _is_drawn((start, scale), self._drawn[i]):
                continue
            self._drawn[i] = (start, scale)
            if start is None:
                ball.hide()
            else:
                ball.show(start, scale=scale)

    def _add(self, start: FloatArray) -> None:
        ball = Ball(self._api, f"/start/{len(self._balls)}", radius=START_RADIUS, color=REPRODUCTION)
        bind_pull(ball.show(start), self._actions, self._clock)
        self._balls.append(ball)
        self._drawn.append((None, np.nan))


def _is_drawn(wanted: tuple[FloatArray | None, float], drawn: tuple[FloatArray | None, float]) -> bool:
    return wanted[0] is drawn[0] and (wanted[1] == drawn[1] or wanted[0] is None)
