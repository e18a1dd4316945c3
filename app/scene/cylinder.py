"""What was learned: the tube, its middle line, and the slice at the playhead."""

from typing import Any, Final

import numpy as np
import viser

from app.actions import Actions
from app.document import FloatArray
from app.scene.compared import compares
from app.scene.geometry import pick_tube, tube_mesh
from app.scene.nodes import Line, Mesh
from app.scene.playhead import station_at, time_of
from app.scene.polyline import along, nearest_to_ray, segments
from app.scene.pulls import checked_point
from app.scene.style import DIRECTRIX, FORMER_OPACITY, SECTION, THICK, THIN, TUBE, TUBE_OPACITY
from app.store import State
from gc_core import GeneralizedCylinder
from gc_core.arrays import evenly

AT_REST: Final = (100, 32)
"""Stations and angles of the drawn tube."""
WHILE_DRAGGING: Final = (60, 24)
CLICK_RADIUS: Final = 0.005
"""Of what can be clicked along the directrix [m]; thin, for it swallows pulls on lines behind it."""
CLEAR_ENDS: Final = 0.04
"""Nothing to click this near to the ends of the directrix, where start and goal are pulled [m]."""
DOT_SIZE: Final = 0.008


class Tube:
    """``/tube``: never interactive, because it would swallow the press on what lies inside it."""

    def __init__(self, api: viser.SceneApi) -> None:
        self._mesh = Mesh(api, "/tube", color=TUBE, opacity=TUBE_OPACITY, side="double")
        # Bodies that can be picked are invisible but fill the depth buffer. Being the first
        # translucent one, the tube is drawn before them and they cut no holes into it.
        self._mesh.show(*_NOTHING)
        self._mesh.hide()
        self._drawn: tuple[GeneralizedCylinder | None, tuple[int, int]] = (None, AT_REST)

    def draw(self, state: State) -> None:
        """Draw the cylinder, coarsely while something is dragged."""
        cylinder = state.model.cylinder if state.view.show_tube else None
        size = WHILE_DRAGGING if state.dragging else AT_REST
        if cylinder is self._drawn[0] and (size == self._drawn[1] or cylinder is None):
            return
        self._drawn = (cylinder, size)
        if cylinder is None:
            self._mesh.hide()
            return
        self._mesh.show(*tube_mesh(rings(cylinder, size)))


class FormerTube:
    """``/former``: the tube as it was taught, faint, while landmarks are moved; never interactive."""

    def __init__(self, api: viser.SceneApi) -> None:
        self._mesh = Mesh(api, "/former", color=TUBE, opacity=FORMER_OPACITY, side="double")
        self._mesh.show(*_NOTHING)  # early, as `Tube`
        self._mesh.hide()
        self._drawn: GeneralizedCylinder | None = None

    def draw(self, state: State) -> None:
        """Show or hide it; it is made anew only at rest, when something else was taught."""
        taught = state.model.taught
        if state.model.registration is None or taught is None or not state.view.show_tube:
            self._mesh.hide()
        elif taught is self._drawn or (self._drawn is not None and state.dragging):
            self._mesh.reveal()
        else:
            self._drawn = taught
            self._mesh.show(*tube_mesh(rings(taught, WHILE_DRAGGING)))


def rings(cylinder: GeneralizedCylinder, size: tuple[int, int]) -> FloatArray:
    """(n, m, 3) at most ``size`` stations and angles of the surface, its ends among them [m]."""
    surface = cylinder.surface()
    stations = evenly(surface.shape[0], size[0])
    # One angle more than is drawn: the last is the first again.
    angles = evenly(surface.shape[1] + 1, size[1] + 1)[:-1]
    return surface[np.ix_(stations, angles)]


class Directrix:
    """``/directrix``: a click moves the playhead there."""

    def __init__(self, api: viser.SceneApi, actions: Actions) -> None:
        self._line = Line(api, "/directrix", color=DIRECTRIX, thickness=THICK)
        self._pick = Mesh(api, "/directrix/pick", opacity=0.0)
        self._actions = actions
        self._bound = False
        self._cylinder: GeneralizedCylinder | None = None
        self._thickness = THICK
        self._picked: GeneralizedCylinder | None = None
        self._state: State | None = None

    def draw(self, state: State) -> None:
        """Draw the middle line of the cylinder."""
        self._state = state
        cylinder = state.model.cylinder
        if cylinder is not None and cylinder is not self._picked and not (state.dragging and self._bound):
            self._draw_pick(cylinder)
        thickness = THIN if compares(state) else THICK
        if cylinder is self._cylinder and thickness == self._thickness:
            return
        self._cylinder, self._thickness = cylinder, thickness
        self._line.look(DIRECTRIX, thickness)
        if cylinder is None:
            self._line.hide()
        else:
            self._line.show(segments(cylinder.directrix))

    def _draw_pick(self, cylinder: GeneralizedCylinder) -> None:
        """Invisible; waits for the release of what is dragged."""
        self._picked = cylinder
        length = float(cylinder.arc_length[-1])
        inner = along(cylinder.directrix, np.linspace(CLEAR_ENDS, max(length - CLEAR_ENDS, CLEAR_ENDS), 100))
        handle = self._pick.show(*pick_tube(inner, CLICK_RADIUS))
        if not self._bound:
            handle.on_click(self._on_click)
            self._bound = True

    async def _on_click(self, event: viser.SceneNodePointerEvent[Any]) -> None:
        state, origin = self._state, checked_point(event.ray_origin)
        direction = checked_point(event.ray_direction)
        if state is None or state.model.cylinder is None or origin is None or direction is None:
            return
        if state.replay is not None or not np.any(direction):  # a replay has no playhead to move
            return
        station = nearest_to_ray(state.model.cylinder.directrix, origin, direction, 2.0 * CLICK_RADIUS)
        time = time_of(state.model, state.playback.run, station)
        if time is not None:
            self._actions.seek(time)


class Section:
    """``/section``: the slice at the playhead and the points where the demonstrations cross it."""

    def __init__(self, api: viser.SceneApi) -> None:
        self._api = api
        self._ring = Line(api, "/section", color=SECTION, thickness=3.0)
        self._dots: viser.PointCloudHandle | None = None
        self._drawn: tuple[GeneralizedCylinder | None, int | None] = (None, None)

    def draw(self, state: State) -> None:
        """Draw the slice at the station of the playhead."""
        cylinder = state.model.cylinder if state.view.show_tube else None
        station = station_at(state.model, state.playback) if cylinder is not None else None
        if cylinder is self._drawn[0] and station == self._drawn[1]:
            return
        self._drawn = (cylinder, station)
        if cylinder is None or station is None:
            self._ring.hide()
            if self._dots is not None:
                self._dots.visible = False
            return
        ring = cylinder.surface()[station]
        self._ring.show(segments(np.concatenate([ring, ring[:1]])))
        self._draw_dots(cylinder.effective_points[station])

    def _draw_dots(self, points: FloatArray) -> None:
        shown = points[np.all(np.isfinite(points), axis=1)].astype(np.float32)
        if self._dots is None:
            self._dots = self._api.add_point_cloud(
                "/section/dots", shown, SECTION, point_size=DOT_SIZE, point_shape="circle",
                precision="float32", point_shading="flat",
            )  # fmt: skip
            return
        self._dots.points = shown
        self._dots.visible = len(shown) > 0


_NOTHING: Final = tube_mesh(np.zeros((2, 3, 3)))
