"""Where the next demonstration would help most: a disc that pulses while the motion plays."""

from typing import Final

import numpy as np
import viser

from app import advising
from app.document import FloatArray
from app.model import Model
from app.scene.geometry import Faces, Vertices, across
from app.scene.nodes import Label, Mesh
from app.scene.style import DEMONSTRATION
from app.store import State
from app.suggestions import Suggestion

RADIUS: Final = 0.02
CORNERS: Final = 32
PULSE: Final = 0.25
"""It grows and shrinks by this part of its size [-]."""
BEAT: Final = 1.25
"""... once in this time [s]."""
WORDS: Final = "show one here"
ABOVE: Final = np.array([1.5 * RADIUS, 0.0, 1.5 * RADIUS])
"""From the disc to its words, which would cover half of it, from the side and from the top [m]."""


class SuggestionDisc:
    """``/suggestion``; out of sight while something is pulled, replayed or asked."""

    def __init__(self, api: viser.SceneApi) -> None:
        # Solid: bodies that can be picked are invisible, but would cut holes into a translucent one.
        self._disc = Mesh(api, "/suggestion", color=DEMONSTRATION, side="double")
        self._label = Label(api, "/suggestion/words")
        self._model: Model | None = None
        self._suggestion: Suggestion | None = None
        self._size = 1.0

    def draw(self, state: State) -> None:
        """Follow the model at rest, and the playhead."""
        if not wanted(state):
            self._disc.hide()
            return
        if state.model is not self._model:
            self._model = state.model
            self._put(advising.advice(state.model, state.postures).suggestion, state.model)
        if self._suggestion is None:
            self._disc.hide()
            return
        self._disc.reveal()
        self._pulse(state.playback.time if state.playback.playing else 0.0)

    def _put(self, suggestion: Suggestion | None, model: Model) -> None:
        self._suggestion = suggestion
        if suggestion is None or model.cylinder is None:
            return
        handle = self._disc.show(*disc(model.cylinder.frames[suggestion.station, :, 0]))
        handle.position = suggestion.place
        self._label.show(ABOVE, WORDS)

    def _pulse(self, time: float) -> None:
        size = round(1.0 + PULSE * float(np.sin(2.0 * np.pi * time / BEAT)), 2)
        if size != self._size and self._disc.handle is not None:
            self._disc.handle.scale = self._size = size


def wanted(state: State) -> bool:
    """Whether nothing else has a person's attention."""
    busy = (state.dragging, state.hand.recording, state.replay, state.proposal, state.view.placing)
    return state.view.suggest and state.view.show_demonstrations and all(one is None for one in busy)


def disc(axis: FloatArray) -> tuple[Vertices, Faces]:
    """A disc about the origin, across an axis (3,): vertices (n + 1, 3) and faces (n, 3)."""
    _, aside, up = across(axis[None])
    turn = np.linspace(0.0, 2.0 * np.pi, CORNERS, endpoint=False)[:, None]
    rim = RADIUS * (np.cos(turn) * aside + np.sin(turn) * up)
    corner = np.arange(CORNERS, dtype=np.uint32)
    faces = np.stack([np.full(CORNERS, CORNERS, dtype=np.uint32), corner, (corner + 1) % CORNERS], axis=1)
    return np.concatenate([rim, np.zeros((1, 3))]).astype(np.float32), faces.astype(np.uint32)
