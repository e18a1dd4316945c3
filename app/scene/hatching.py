"""Amber dashes over the stretches of a run that the arm cannot do as it is."""

from typing import Final

import numpy as np
import viser

from app import judgement
from app.document import FloatArray
from app.scene.nodes import Line
from app.scene.polyline import arc_length, dashes
from app.scene.style import HATCHED, WARNING
from app.store import Plan, State

SHORTEST: Final = 0.03
"""A stretch is hatched over at least this length, so that a single place is seen too [m]."""
DASH, GAP = 0.008, 0.011
"""The gap is the longer one: the line below stays the line [m]."""


class Hatching:
    """``/reproductions/i/hatching``: drawn while the plan is about what is shown."""

    def __init__(self, api: viser.SceneApi) -> None:
        self._api = api
        self._lines: list[Line] = []
        self._drawn: tuple[Plan, ...] = ()

    def draw(self, state: State) -> None:
        """Follow the plans."""
        plans = state.plans if state.view.show_reproductions else ()
        if plans is self._drawn or plans == self._drawn:
            return
        self._drawn = plans
        by_run = {plan.run: plan for plan in plans}
        while len(self._lines) <= max(by_run, default=-1):
            name = f"/reproductions/{len(self._lines)}/hatching"
            self._lines.append(Line(self._api, name, color=WARNING, thickness=HATCHED))
        for run, line in enumerate(self._lines):
            line.show(hatched(by_run[run]) if run in by_run else np.empty((0, 2, 3)))


def hatched(plan: Plan) -> FloatArray:
    """Give the dashes (k, 2, 3) over all that the arm cannot do in a run [m]."""
    positions = plan.reproduction.positions
    length = arc_length(positions)
    wrong = np.zeros(len(positions), dtype=np.bool_)
    for problem in judgement.problems(plan):
        middle = 0.5 * (length[problem.first] + length[problem.last])
        begin = min(max(middle - 0.5 * SHORTEST, 0.0), max(length[-1] - SHORTEST, 0.0))
        low = min(length[problem.first], begin)
        high = max(length[problem.last], begin + SHORTEST)
        wrong |= (length >= low) & (length <= high)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], wrong, [False]]).astype(np.int8)))
    stretches = [dashes(positions[a:b], DASH, GAP) for a, b in edges.reshape(-1, 2).tolist()]
    return np.concatenate([np.empty((0, 2, 3)), *stretches])
