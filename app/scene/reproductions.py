"""The reproductions: thick magenta lines with arrowheads, and the balls they start from.

Where rules changed one, the refined path is green, twice as wide, with dots at its
ends, and what it was before is dashed grey.
"""

from collections.abc import Callable

import numpy as np
import viser

from app.actions import Actions
from app.document import FloatArray
from app.model import Run
from app.scene.compared import compares
from app.scene.geometry import arrowheads, pick_tube
from app.scene.grip import Grip
from app.scene.nodes import Ball, Line, Mesh
from app.scene.polyline import dashes, segments
from app.scene.pulls import bind_pull
from app.scene.style import (
    DOT_RADIUS,
    DOUBLE,
    FREE,
    HAND_RADIUS,
    PICK_RADIUS,
    REFINED,
    REPRODUCTION,
    START_GRIP,
    START_GRIP_BESIDE,
    START_RADIUS,
    THICK,
    THIN,
)
from app.scene.view import Eye
from app.store import Hand, State


class Reproductions:
    """``/reproductions/i``, what the pointer hits, with the visible line in it as ``…/line``."""

    def __init__(self, api: viser.SceneApi, actions: Actions, clock: Callable[[], float]) -> None:
        self._api, self._actions, self._clock = api, actions, clock
        self._paths: list[_Path] = []

    def draw(self, state: State) -> None:
        """Draw every run of the model, thin beside those that are compared."""
        runs = state.model.runs if state.view.show_reproductions else ()
        thickness = THIN if compares(state) else THICK
        while len(self._paths) < len(runs):
            name = f"/reproductions/{len(self._paths)}"
            self._paths.append(_Path(self._api, name, self._actions, self._clock))
        for i, path in enumerate(self._paths):
            path.draw(runs[i] if i < len(runs) else None, state.dragging is not None, thickness)


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
        self._thickness = THICK
        self._picked: Run | None = None

    def draw(self, run: Run | None, dragging: bool, thickness: float) -> None:
        if run is not None and run is not self._picked and not (dragging and self._bound):
            self._draw_pick(run)
        if run is self._run and thickness == self._thickness:
            return
        self._run, self._thickness = run, thickness
        if run is None:
            self._pick.hide()
            self._picked = None
        elif run.reproduction is run.free:
            self._draw_free(run.reproduction.positions)
        else:
            self._draw_refined(run.reproduction.positions, run.free.positions)

    def _draw_pick(self, run: Run) -> None:
        """Invisible: what is dragged already need not be hit, so it waits for the release."""
        self._picked = run
        handle = self._pick.show(*pick_tube(run.reproduction.positions, PICK_RADIUS))
        if not self._bound:
            bind_pull(handle, self._actions, self._clock)
            self._bound = True

    def _draw_free(self, positions: FloatArray) -> None:
        self._line.look(REPRODUCTION, self._thickness)
        self._line.show(segments(positions))
        self._arrows.show(*arrowheads(positions))
        self._free.hide()
        for end in self._ends:
            end.hide()

    def _draw_refined(self, positions: FloatArray, before: FloatArray) -> None:
        self._line.look(REFINED, DOUBLE)
        self._line.show(segments(positions))
        self._arrows.hide()
        self._free.show(dashes(before))
        for end, place in zip(self._ends, (positions[0], positions[-1]), strict=True):
            end.show(place)


class Starts:
    """``/start/i``: pull one for another reproduction."""

    def __init__(self, api: viser.SceneApi, actions: Actions, clock: Callable[[], float], eye: Eye) -> None:
        self._api, self._actions, self._clock, self._eye = api, actions, clock, eye
        self._starts: list[_Start] = []

    def draw(self, state: State) -> None:
        """Put a ball where each run begins."""
        runs = state.model.runs if state.view.show_reproductions else ()
        while len(self._starts) < len(runs):
            name = f"/start/{len(self._starts)}"
            self._starts.append(_Start(self._api, name, self._actions, self._clock))
        for i, ball in enumerate(self._starts):
            playing = state.hand if state.playback.playing else None
            ball.draw(runs[i].start if i < len(runs) else None, self._eye.position, playing)


class _Start:
    def __init__(self, api: viser.SceneApi, name: str, actions: Actions, clock: Callable[[], float]) -> None:
        self._ball = Ball(api, name, radius=START_RADIUS, color=REPRODUCTION)
        self._grip = Grip(api, name, START_RADIUS, START_GRIP)
        self._actions, self._clock = actions, clock
        self._bound = False
        self._start: FloatArray | None = None

    def draw(self, start: FloatArray | None, camera: FloatArray, playing: Hand | None) -> None:
        if start is not None:
            self._show(start)
            seen = playing is not None and not hides(playing.position, start, camera, START_RADIUS)
            self._grip.aim(start, camera, length=START_GRIP_BESIDE if seen else None)
        elif self._start is not None:
            self._ball.hide()
        self._start = start

    def _show(self, start: FloatArray) -> None:
        if start is self._start:
            return
        handle = self._ball.show(start)
        if not self._bound:
            bind_pull(handle, self._actions, self._clock, ball=True)
            self._bound = True


def hides(hand: FloatArray, start: FloatArray, camera: FloatArray, radius: float) -> bool:
    """Whether the hand's ball lies over the middle of a start's ball of a radius [m], as seen by the camera.

    Where a larger start's ball holds the hand's, the start is what one sees.
    """
    sight = start - camera
    ahead = float(sight @ (hand - camera)) / max(float(sight @ sight), 1e-12)
    beside = float(np.linalg.norm(hand - camera - ahead * sight))
    within = float(np.linalg.norm(hand - start)) < HAND_RADIUS
    return beside < HAND_RADIUS and (radius < HAND_RADIUS if within else ahead < 1.0)
