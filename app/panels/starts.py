"""Try: where new runs begin, and how far off-centre each of them stays."""

from collections.abc import Sequence
from functools import partial
from typing import Final

import numpy as np
import viser

from app import edits
from app.actions import Actions
from app.binding import QUIET, Changed, Rows, assign, on_choice, on_press
from app.document import Document, FloatArray
from app.model import Model
from app.panels import words
from app.panels.position_field import PositionField
from app.panels.section_svg import ratio_at
from app.player import station_at
from app.store import State

PLAY: Final = "Play this one"
REMOVE: Final = "Remove"
MOST: Final = 12
TURN: Final = 2.4
"""From one start to the next around the first slice [rad]: the golden angle, so that they spread."""
SPREAD: Final = 0.7
"""How far off-centre another start is put [-]."""


class StartsPanel:
    """One row a start; new runs (reproductions) begin there."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._model: Model | None = None
        self._changed = Changed()
        gui.add_html(words.note("Drag the magenta ball, or type where a new run (reproduction) begins."))
        self._rows = Rows(gui.add_folder(None), partial(StartRow, gui, actions))
        self._add = gui.add_button("Add another start", icon=viser.Icon.PLUS, color=QUIET)
        on_press(self._add, self._add_start)
        self._ratio = gui.add_html("")

    def draw(self, state: State) -> None:
        """Follow the starts and the playhead."""
        self._model = state.model
        runs = state.model.runs
        for row in self._rows.fit(len(runs)):
            row.draw(state)
        assign(self._add, disabled=state.model.cylinder is None or len(runs) >= MOST)
        playback = state.playback
        if self._changed(runs, playback.run, round(playback.time, 1)):
            assign(self._ratio, content=words.note(words.escape(where(state))))

    def _add_start(self) -> None:
        model = self._model
        if model is not None and model.cylinder is not None and model.runs:
            self._actions.edit(
                partial(_added, starts=_starts(model), another=another_start(model)), "add a start"
            )


class StartRow:
    """One start: its place, play it, remove it."""

    def __init__(self, gui: viser.GuiApi, actions: Actions, index: int) -> None:
        self._actions, self._index = actions, index
        self._state: State | None = None
        self._position = PositionField(
            gui,
            f"Start {index + 1} [cm]",
            read=self._read,
            write=self._move,
            hint="x, y, z of where this run begins.",
        )
        self._group = gui.add_button_group("", (PLAY, REMOVE))
        on_choice(self._group, self._press)

    def show(self, visible: bool) -> None:
        """Show or hide it."""
        assign(self._position.handle, visible=visible)
        assign(self._group, visible=visible)

    def draw(self, state: State) -> None:
        """Show the place."""
        self._state = state
        assign(self._group, options=(PLAY, REMOVE) if state.document.starts else (PLAY,))
        self._position.draw(state)

    def _read(self, state: State) -> FloatArray:
        return state.model.runs[self._index].start

    def _move(self, position: FloatArray) -> None:
        if self._state is not None:
            # A start is kept where it was taught; landmarks may have carried it along since.
            place = self._state.model.start_taken_back(position)
            change = partial(edits.move_start, index=self._index, position=place)
            self._actions.edit(change, "move start", f"move start {self._index}")

    def _press(self, place: int) -> None:
        if place == 0:
            self._actions.choose_run(self._index)
            self._actions.play(True)
        elif self._state is not None and self._state.document.starts:
            self._actions.edit(partial(edits.remove_start, index=self._index), "remove start")


def another_start(model: Model) -> FloatArray:
    """Propose one more start, in the first slice, away from those there are: (3,) [m]."""
    cylinder = model.cylinder
    if cylinder is None:
        return np.zeros(3)
    angle = TURN * len(model.runs) % (2.0 * np.pi)
    corner = int(np.argmin(np.abs(cylinder.angles % (2.0 * np.pi) - angle)))
    centre, rim = cylinder.directrix[0], cylinder.surface()[0, corner]
    return model.start_taken_back(centre + SPREAD * (rim - centre))


def where(state: State) -> str:
    """Say how far off-centre the playing run is now."""
    runs, run = state.model.runs, state.playback.run
    if run >= len(runs):
        return "There is no run yet, because there is no tube yet."
    reproduction = runs[run].reproduction
    eta = ratio_at(reproduction, station_at(reproduction, state.playback.time))
    return "" if eta is None else f"Run {run + 1} is {words.ratio(eta)} (ratio eta = {eta:.2f})."


def _starts(model: Model) -> tuple[FloatArray, ...]:
    """The document's starts, or the one that every skill has; kept where they were taught."""
    return model.source.starts or tuple(model.start_taken_back(run.start) for run in model.runs)


def _added(document: Document, starts: Sequence[FloatArray], another: FloatArray) -> Document:
    """Add a start; the one that every skill has becomes one's own first."""
    for start in () if document.starts else starts:
        document = edits.add_start(document, start)
    return edits.add_start(document, another)
