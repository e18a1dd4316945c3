"""A click that places a landmark or a thing: on the tube if it is meant, else on the table."""

from typing import Final

import numpy as np
import viser

from app import edits, placing
from app.actions import Actions
from app.document import THING_KINDS, Document, FloatArray, LandmarkKind, Place, ThingKind
from app.model import Model
from app.scene.clicks import Clicks
from app.scene.polyline import nearest_to_ray
from app.scene.pulls import checked_point
from app.store import State

NEAR: Final = 0.04
"""A line of sight this near to the middle line means the middle line [m]."""
TABLE: Final = 1.2
"""Half the side of the table that counts [m]."""


class Placing:
    """Listens for a click in the scene while a landmark or a thing waits for its place."""

    def __init__(self, api: viser.SceneApi, actions: Actions) -> None:
        self._clicks, self._actions = Clicks(api, self._on_click), actions
        self._state: State | None = None

    def draw(self, state: State) -> None:
        """Begin to listen, or stop."""
        self._state = state
        self._clicks.listen(state.view.placing is not None)

    async def _on_click(self, event: viser.SceneClickEvent) -> None:
        state, origin = self._state, checked_point(event.ray_origin)
        direction = checked_point(event.ray_direction)
        kind = None if state is None else state.view.placing
        if state is None or kind is None or origin is None or direction is None or not np.any(direction):
            return
        point = aimed_at(state.model, kind, origin, direction / np.linalg.norm(direction))
        if point is not None:
            self._place(state, kind, point)

    def _place(self, state: State, kind: LandmarkKind | ThingKind, point: FloatArray) -> None:
        if kind in THING_KINDS:
            name = edits.new_thing_name(state.document, kind)
            self._actions.edit(lambda d: edits.add_thing(d, kind, point), f"add {name}")
            self._actions.look(placing=None, thing=name)
            return
        place = placing.placed(state.model, point)
        self._actions.edit(lambda d: _added(d, kind, place), f"add a landmark ({edits.KIND_NAMES[kind]})")
        self._actions.look(placing=None)


def aimed_at(
    model: Model, kind: LandmarkKind | ThingKind, origin: FloatArray, direction: FloatArray
) -> FloatArray | None:
    """Find the point that somebody who looks along a ray means.

    Parameters
    ----------
    model : Model
    kind : {"via", "obstacle", "object", "start", "goal", "box", "ball", "cylinder", "ring"}
        Obstacles, objects and things stand on the table wherever one sees it.
    origin, direction : (3,) array
        Of the ray; the direction has length 1 [m].

    Returns
    -------
    (3,) array or None
        [m]; None where there is neither tube nor table.
    """
    on_ray: FloatArray | None = None
    if model.cylinder is not None:
        directrix = model.cylinder.directrix
        nearest = directrix[nearest_to_ray(directrix, origin, direction, NEAR)]
        on_ray = origin + max(float((nearest - origin) @ direction), 0.0) * direction
        if kind == "via" and float(np.linalg.norm(nearest - on_ray)) <= NEAR:
            return nearest
    height = 0.0 if kind == "via" or kind in THING_KINDS else placing.HALF_AN_OBJECT
    if direction[2] < -1e-3:
        hit = origin + direction * ((height - origin[2]) / direction[2])
        if float(np.abs(hit[:2]).max()) <= TABLE:
            return hit
    return on_ray


def _added(document: Document, kind: LandmarkKind, place: Place) -> Document:
    return edits.add_landmark(document, kind, place)
