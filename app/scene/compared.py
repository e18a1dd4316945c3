"""Runs of other methods beside the tube's: lines that are only looked at."""

from collections.abc import Sequence
from typing import Final

import viser

from app.baselines import Run
from app.compared import LOOKS, TUBE
from app.document import FloatArray
from app.scene.nodes import Line
from app.scene.polyline import dashes, segments, thin_out
from app.scene.style import COMPARED
from app.store import State

POINTS: Final = 80
"""Of each line."""


def compares(state: State) -> bool:
    """Whether compared runs are drawn: the skill's own lines are thin then, so that they are told apart."""
    return state.view.show_compared and state.compared is not None and state.compared.drawn


class ComparedRuns:
    """``/compared/<method>/<k>``, one a start; out of sight when the skill has changed since.

    Lines cannot be picked in viser, so they are in the way of nothing.
    """

    def __init__(self, api: viser.SceneApi) -> None:
        self._api = api
        self._lines: dict[str, list[Line]] = {}
        self._drawn: tuple[dict[str, tuple[Run, ...]], tuple[str, ...]] = {}, ()

    def draw(self, state: State) -> None:
        """Draw the runs of the methods that are chosen."""
        known = state.compared if state.view.show_compared else None
        runs = known.found.runs if known is not None and known.drawn and known.found is not None else {}
        chosen = (TUBE, *state.view.methods)
        if (runs, chosen) == self._drawn:
            return
        self._drawn = runs, chosen
        for name in LOOKS:
            paths = runs.get(name, ()) if name in chosen else ()
            self._show(name, [run.positions for run in paths])

    def _show(self, name: str, paths: Sequence[FloatArray]) -> None:
        look, lines = LOOKS[name], self._lines.setdefault(name, [])
        while len(lines) < len(paths):
            node = f"/compared/{name}/{len(lines)}"
            lines.append(Line(self._api, node, color=look.color, thickness=COMPARED))
        for number, line in enumerate(lines):
            if number >= len(paths):
                line.hide()
                continue
            path = thin_out(paths[number], POINTS)
            line.show(dashes(path) if look.dashed else segments(path))
