"""What stands in the way and what can be carried: solid bodies with edges, pulled along the table.

With Shift they are pulled up and down. The thing that is worked on has small balls beside
its sides; pulling one of them sizes it.
"""

from collections.abc import Callable

import numpy as np
import viser

from app import measures
from app.actions import Actions
from app.document import Box, Cylinder, FloatArray, Shape, Sphere
from app.scene.bodies import ball, cuboid, cuboid_edges, hoop, rod
from app.scene.geometry import Faces, Vertices, torus
from app.scene.nodes import Ball, Line, Mesh
from app.scene.pulls import bind_pull
from app.scene.style import CARRIED, HANDLE_RADIUS, THING, THING_EDGE
from app.store import State


class Things:
    """``/obstacles/<name>``, with its origin at the middle of the thing, and ``/sizes/<name>/<number>``."""

    def __init__(self, api: viser.SceneApi, actions: Actions, clock: Callable[[], float]) -> None:
        self._api, self._actions, self._clock = api, actions, clock
        self._bodies: dict[str, _Body] = {}
        self._drawn: tuple[tuple[Shape, ...], str] = ((), "")

    def draw(self, state: State) -> None:
        """Draw every thing, and the handles of the one that is worked on."""
        things, chosen = state.document.things, state.view.thing
        if state.trial is not None:
            things = state.trial.moved(things)
        if things is self._drawn[0] and chosen == self._drawn[1]:
            return
        self._drawn = things, chosen
        named = {thing.name: thing for thing in things}
        for name in named.keys() - self._bodies.keys():
            self._bodies[name] = _Body(self._api, name, self._actions, self._clock)
        for name, body in self._bodies.items():
            body.draw(named.get(name), chosen == name)


class _Body:
    def __init__(self, api: viser.SceneApi, name: str, actions: Actions, clock: Callable[[], float]) -> None:
        self._api, self._name, self._actions, self._clock = api, name, actions, clock
        self._mesh = Mesh(api, f"/obstacles/{name}", color=THING)
        self._edges = Line(api, f"/obstacles/{name}/edges", color=THING_EDGE)
        self._handles: list[Ball] = []
        self._thing: Shape | None = None
        self._size: object = None
        self._carried, self._chosen = False, False

    def draw(self, thing: Shape | None, chosen: bool) -> None:
        if thing is self._thing and chosen == self._chosen:
            return
        if thing is None:
            self._mesh.hide()
        elif thing is not self._thing:
            self._show(thing)
        self._thing, self._chosen = thing, chosen
        self._show_handles(measures.handles(thing) if chosen and thing is not None else ())

    def _show(self, thing: Shape) -> None:
        size, node = (type(thing), measures.measures(thing)), self._mesh.handle
        new = node is None
        if node is None or size != self._size:
            node = self._mesh.show(*body(thing))
            self._edges.show(edges(thing))
            self._size = size
        self._mesh.reveal()
        node.position, node.wxyz = np.array(thing.position), np.array(thing.wxyz)
        carried = thing.mass > 0.0
        if carried != self._carried:
            node.color, self._carried = CARRIED if carried else THING, carried
        if new:
            bind_pull(node, self._actions, self._clock, level=True)

    def _show_handles(self, handles: tuple[measures.Handle, ...]) -> None:
        while len(self._handles) < len(handles):
            number = len(self._handles)
            handle = Ball(self._api, f"/sizes/{self._name}/{number}", radius=HANDLE_RADIUS, color=THING_EDGE)
            bind_pull(handle.show(handles[number].place), self._actions, self._clock, ball=True)
            self._handles.append(handle)
        for number, ball_ in enumerate(self._handles):
            if number < len(handles):
                ball_.show(handles[number].place + 1.5 * HANDLE_RADIUS * handles[number].along)
            else:
                ball_.hide()


def body(thing: Shape) -> tuple[Vertices, Faces]:
    """Shape a thing about its middle, not turned."""
    if isinstance(thing, Box):
        return cuboid(np.array(thing.size), np.eye(3))
    if isinstance(thing, Sphere):
        vertices, faces = ball(1.0)
        return vertices * np.float32(thing.radius), faces
    if isinstance(thing, Cylinder):
        return rod(thing.radius, thing.length)
    return torus(thing.radius, 2.0 * thing.wall, around=64, sides=16)


def edges(thing: Shape) -> FloatArray:
    """(k, 2, 3) lines that show the shape of a thing, in its own frame [m]."""
    if isinstance(thing, Box):
        return cuboid_edges(np.array(thing.size))
    if isinstance(thing, Sphere):
        return hoop(thing.radius)
    if isinstance(thing, Cylinder):
        high = 0.5 * thing.length
        return np.concatenate([hoop(thing.radius, high), hoop(thing.radius, -high)])
    return np.concatenate([hoop(thing.radius + thing.wall), hoop(thing.radius - thing.wall)])
