"""From a pull in the browser to an action: checked, stamped, posted, nothing else.

viser validates nothing that a page sends, so a position that is not finite or not
near the robot goes no further. A pull that began always ends, even when its last event
is bad: then with the last good one.
"""

from collections.abc import Callable, Coroutine
from dataclasses import replace
from typing import Any, Final, Protocol, TypeAlias

import numpy as np
import viser

from app.actions import Actions, Drag
from app.document import FloatArray

FARTHEST: Final = 10.0
"""No pointer is farther from the base than this [m]."""

Event: TypeAlias = viser.SceneNodeDragEvent[Any]


class Pullable(Protocol):
    """What viser can drag: meshes, spheres, frames, but no lines."""

    @property
    def name(self) -> str:
        """In the scene."""
        ...

    def on_drag(self, button: Any = ..., *, modifier: Any = ...) -> Any:
        """Register a callback for the pulls with one button and modifier."""
        ...


def checked_point(values: tuple[float, ...]) -> FloatArray | None:
    """(3,) the point [m], or None when it is not three finite numbers within `FARTHEST`."""
    try:
        point = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        return None
    near = point.shape == (3,) and bool(np.all(np.abs(point) <= FARTHEST))
    return point if near else None


def bind_pull(handle: Pullable, actions: Actions, clock: Callable[[], float], *, aside: bool = False) -> None:
    """Let a node be pulled: freely, with Shift up and down, and ``aside`` with the right button too."""
    pull = _Pull(handle.name, actions, clock)
    for button in ("left", "right") if aside else ("left",):
        for modifier in (None, "shift"):
            handle.on_drag(button, modifier=modifier)(pull.callback())


class _Pull:
    """The pulls on one node."""

    def __init__(self, name: str, actions: Actions, clock: Callable[[], float]) -> None:
        self._name, self._actions, self._clock = name, actions, clock
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
        return Drag(
            node=self._name,
            phase=event.phase,
            grabbed=grabbed,
            pointer=pointer,
            time=now,
            vertical=event.modifier == "shift",
            aside=event.button == "right",
        )
