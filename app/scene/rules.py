"""Rules in the scene: their planes where runs are held by them, and the arrows of the one that is looked at.

The arrows are the refinement matrix V: from where a run was to where the teacher wanted it.
"""

from typing import Final

import numpy as np
import viser

from app import biting
from app.binding import Changed
from app.biting import Bite
from app.document import FloatArray
from app.scene.geometry import Faces, Vertices, across
from app.scene.nodes import Line, Mesh
from app.scene.style import REFINED
from app.store import State
from gc_core import Constraint
from gc_core.arrays import evenly

MOST_PLANES: Final = 12
MOST_ARROWS: Final = 24
HALF: Final = 0.022
"""Half the side of a plane that is drawn [m]."""
BARB: Final = 0.25
"""Length of an arrow's barbs, as a part of the arrow [-]."""
ARROW_WIDTH: Final = 2.5


class Rules:
    """``/rules/planes`` and ``/rules/arrows``."""

    def __init__(self, api: viser.SceneApi) -> None:
        # Solid: a translucent mesh inside the translucent tube is not seen at all.
        self._planes = Mesh(api, "/rules/planes", color=REFINED, side="double")
        self._arrows = Line(api, "/rules/arrows", color=REFINED, thickness=ARROW_WIDTH)
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Follow the rules; while something else than a line is pulled they stay as they were."""
        if state.dragging is not None and state.correction is None:
            return
        model, seen = state.model, state.view.show_reproductions
        if not self._changed(model.runs, model.source.rules, model.registration, state.view.rule, seen):
            return
        chosen = biting.shown(model, state.view.rule) if seen else None
        self._arrows.show(_NO_ARROWS if chosen is None else arrows(chosen))
        centres, normals = thinned(biting.bites(model)) if seen else (_NOWHERE, _NOWHERE)
        if len(centres):
            self._planes.show(*quads(centres, normals))
        else:
            self._planes.hide()


_NOWHERE: Final = np.zeros((0, 3))
_NO_ARROWS: Final = np.zeros((0, 2, 3))


def thinned(found: tuple[Bite, ...]) -> tuple[FloatArray, FloatArray]:
    """Centres and normals (P, 3) of the planes to draw: a few, spread over all that bite."""
    centres = np.concatenate([_NOWHERE, *(bite.places for bite in found)])
    normals = np.concatenate([_NOWHERE, *(bite.normals for bite in found)])
    kept = evenly(len(centres), MOST_PLANES)
    return centres[kept], normals[kept]


def quads(centres: FloatArray, normals: FloatArray) -> tuple[Vertices, Faces]:
    """Squares across normals (P, 3) about centres (P, 3): vertices (4 P, 3) and faces (2 P, 3)."""
    _, aside, up = across(normals)
    corners = [centres + HALF * (x * aside + y * up) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    vertices = np.stack(corners, axis=1).reshape(-1, 3).astype(np.float32)
    first = 4 * np.arange(len(centres), dtype=np.uint32)[:, None]
    halves = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)
    faces = np.concatenate([first + half for half in halves])
    return vertices, faces


def arrows(rule: Constraint) -> FloatArray:
    """Segments (k, 2, 3) of arrows along the corrections of a rule [m]: each a shaft and two barbs."""
    active = np.flatnonzero(rule.active)
    kept = active[evenly(len(active), MOST_ARROWS)]
    tips, moves = rule.points[kept], rule.moves[kept]
    _, aside, _ = across(moves)
    back = tips - BARB * moves
    wide = 0.5 * BARB * np.linalg.norm(moves, axis=1)[:, None] * aside
    pairs = [(tips - moves, tips), (back + wide, tips), (back - wide, tips)]
    return np.concatenate([np.stack(pair, axis=1) for pair in pairs])
