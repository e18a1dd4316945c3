"""From a pull in the browser to an action: checked, stamped, posted, nothing else.

viser validates nothing that a page sends, so a position that is not finite or not
near the robot goes no further. A pull that began always ends, even when its last event
is bad: then with the last good one.

viser moves the pointer in a plane through the point that was hit, which lies on the near
side of a ball. Seen in perspective, the ball would then fall behind the pointer; so the
pointer of a ball is projected into the plane through its middle.
"""

from collections.abc import Callable, Coroutine
from dataclasses import replace
from typing import Any, Final, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt
import viser

from app.actions import Actions, Drag
from app.document import FloatArray

FARTHEST: Final = 10.0
"""No pointer is farther from the base than this [m]."""
LEVEL: Final = 0.15
"""Seen flatter than this, a height says nothing about depth: sine of the angle [-]."""

Event: TypeAlias = viser.SceneNodeDragEvent[Any]


class Pullable(Protocol):
    """What viser can drag: meshes, spheres, frames, but no lines."""

    @property
    def name(self) -> str:
        """In the scene."""
        ...

    @property
    def position(self) -> FloatArray:
        """(3,) origin [m]."""
        ...

    def on_drag(self, button: Any = ..., *, modifier: Any = ...) -> Any:
        """Register a callback for the pulls with one button and modifier."""
        ...


def checked_point(values: npt.ArrayLike, farthest: float = FARTHEST) -> FloatArray | None:
    """(3,) the point [m], or None when it is not three finite numbers within ``farthest``."""
    try:
        point = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        return None
    near = point.shape == (3,) and bool(np.all(np.abs(point) <= farthest))
    return point if near else None


def bind_pull(
    handle: Pullable,
    actions: Actions,
    clock: Callable[[], float],
    *,
    ball: bool = False,
    aside: bool = False,
    level: bool = False,
) -> None:
    """Let a node be pulled: freely, and with Shift up and down.

    Parameters
    ----------
    handle
        Of viser.
    actions
        Gets every checked event.
    clock
        Session time now [s].
    ball
        Whether it is pulled at its origin, wherever it was hit.
    aside
        Whether the right button pulls too.
    level
        Whether the pointer is drawn along the line of sight to the height of what was grabbed; not with
        Shift, which means the height.
    """
    pull = _Pull(handle, actions, clock, ball, level)
    for button in ("left", "right") if aside else ("left",):
        for modifier in (None, "shift"):
            handle.on_drag(button, modifier=modifier)(pull.callback())


def depth_ratio(camera: FloatArray, look_at: FloatArray, hit: FloatArray, origin: FloatArray) -> float:
    """How much farther from the camera an origin is than the point that was hit, along the view.

    Parameters
    ----------
    camera, look_at, hit, origin : (3,) array
        [m].

    Returns
    -------
    float
        1 where the camera makes no sense: it came from the page.
    """
    ahead = look_at - camera
    near, far = float((hit - camera) @ ahead), float((origin - camera) @ ahead)
    ratio = far / near if near > 0.0 else 1.0
    return ratio if 0.2 < ratio < 5.0 else 1.0


def levelled(camera: FloatArray, pointer: FloatArray, height: float) -> FloatArray:
    """Find where the line of sight to a pointer meets a height; the pointer itself where it hardly does.

    Parameters
    ----------
    camera, pointer : (3,) array
        [m].
    height : float
        [m].

    Returns
    -------
    (3,) array
        [m].
    """
    sight = pointer - camera
    down = camera[2] - height
    if abs(down) < LEVEL * float(np.linalg.norm(sight)) or abs(sight[2]) < 1e-9:
        return pointer
    share = -down / sight[2]
    return camera + share * sight if 0.3 < share < 3.0 else pointer


def unit(direction: FloatArray) -> FloatArray | None:
    """Give a direction (3,) the length 1; None where it makes no sense: it came from the page."""
    length = float(np.linalg.norm(direction))
    return direction / length if np.isfinite(length) and length > 0.0 else None


class _Pull:
    """The pulls on one node."""

    def __init__(
        self, handle: Pullable, actions: Actions, clock: Callable[[], float], ball: bool, level: bool
    ) -> None:
        self._handle, self._actions, self._clock = handle, actions, clock
        self._ball, self._level = ball, level
        self._ratio = 1.0
        self._ahead: FloatArray | None = None
        self._last: Drag | None = None

    def callback(self) -> Callable[[Event], Coroutine[Any, Any, None]]:
        async def on_pull(event: Event) -> None:
            self._take(event)

        return on_pull

    def _take(self, event: Event) -> None:
        now = self._clock()
        drag = self._checked(event, now)
        if drag is None and event.phase == "end" and self._last is not None:
            drag = replace(self._last, phase="end", time=now)
        if drag is None:
            return
        self._last = None if drag.phase == "end" else drag
        self._actions.drag(drag)

    def _checked(self, event: Event, now: float) -> Drag | None:
        grabbed, pointer = checked_point(event.start_position), checked_point(event.end_position)
        if grabbed is None or pointer is None:
            return None
        camera = checked_point(event.client.camera.position) if self._ball or self._level else None
        if camera is not None and self._ball:
            if event.phase == "start":
                look_at = np.asarray(event.client.camera.look_at)
                self._ahead = unit(look_at - camera)
                self._ratio = depth_ratio(camera, look_at, grabbed, self._handle.position)
            grabbed = camera + self._ratio * (grabbed - camera)
            pointer = camera + self._ratio * (pointer - camera)
        if camera is not None and self._level and event.modifier != "shift":
            pointer = levelled(camera, pointer, float(grabbed[2]))
        return Drag(
            node=self._handle.name,
            phase=event.phase,
            grabbed=grabbed,
            pointer=pointer,
            time=now,
            vertical=event.modifier == "shift",
            aside=event.button == "right",
            eye=camera,
            ahead=self._ahead if self._ball else None,
        )
