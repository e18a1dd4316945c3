"""A person with a mouse who draws a given shape: evenly, or with pauses and uneven speed.

Only what a browser would send is made: a pointer position each 50 ms while it moves. What
is recorded comes from the real desk, its servo and an arm.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from app.actions import Drag
from app.arm import Arm
from app.desk import Desk
from app.document import Document, FloatArray
from app.gesture import GRACE
from gc_core import Demonstration

EVENT: Final = 0.05
"""Between two events of a browser [s]."""
PACE: Final = 0.25
"""Of an even hand [m/s]."""

Events: TypeAlias = FloatArray
"""(E, 4) time [s] and pointer [m]."""


@dataclass(frozen=True)
class Habits:
    """How unevenly a person draws."""

    pauses: tuple[int, int] = (1, 3)
    """Fewest and most in one demonstration."""
    pause: tuple[float, float] = (0.3, 1.5)
    """Shortest and longest [s]."""
    factors: tuple[float, float] = (0.4, 2.5)
    """Slowest and fastest part, as a multiple of an even pace."""
    tremble: float = 0.0
    """Standard deviation of the pointer while it pauses; 0: it lies still and sends nothing [m]."""


def drawn_evenly(path: FloatArray) -> Events:
    """Draw a path (K, 3) at one pace."""
    _, length = _measured(path)
    seconds = length[-1] / PACE
    times = np.append(np.arange(EVENT, seconds, EVENT), seconds)
    return _events(path, times, PACE * times)


def drawn_unevenly(path: FloatArray, habits: Habits, rng: np.random.Generator) -> Events:
    """Draw a path (K, 3) with pauses, and each part between them in several paces."""
    _, length = _measured(path)
    knots = np.sort(rng.uniform(0.0, length[-1], 6))
    low, high = np.log(habits.factors)
    factors = np.exp(rng.uniform(low, high, 7))
    stops = np.sort(rng.uniform(0.05, 0.95, rng.integers(*habits.pauses, endpoint=True))) * length[-1]
    time, gone, parts = 0.0, 0.0, []
    while gone < length[-1]:
        ahead = gone + PACE * factors[np.searchsorted(knots, gone)] * EVENT
        time += EVENT
        gone = min(ahead, length[-1])
        parts.append(_events(path, np.array([time]), np.array([gone])))
        if len(stops) and gone >= stops[0]:
            parts.append(_pause(parts[-1][-1], rng.uniform(*habits.pause), habits.tremble, rng))
            time, stops = float(parts[-1][-1, 0]), stops[1:]
    return np.concatenate(parts)


def recorded(arm: Arm, path: FloatArray, events: Events) -> Demonstration:
    """Pull the hand of a desk by the events; give what the desk kept."""
    desk = Desk(Document("measured"), arm)
    desk.leading.move(path[0], 0.0)
    for tick in range(150):
        desk.tick(0.04 * tick, 0.04)
    hand = desk.state().hand.position
    offset = hand - path[0]
    began = 10.0
    desk.drag(Drag("/hand", "start", hand, hand, began))
    for time, *pointer in events:
        desk.drag(Drag("/hand", "update", hand, np.array(pointer) + offset, began + time))
    ended = began + float(events[-1, 0]) + EVENT
    desk.drag(Drag("/hand", "end", hand, events[-1, 1:] + offset, ended))
    desk.tick(ended + 2.0 * GRACE, 0.04)
    return desk.store.document.demonstrations[-1].demonstration


def drawn_by_hand(arm: Arm, shapes: Sequence[FloatArray]) -> tuple[Demonstration, ...]:
    """Draw every shape evenly."""
    return tuple(recorded(arm, path, drawn_evenly(path)) for path in shapes)


def drawn_by_a_person(
    arm: Arm, shapes: Sequence[FloatArray], habits: Habits, seed: int
) -> tuple[Demonstration, ...]:
    """Draw every shape with a person's timing."""
    rng = np.random.default_rng(seed)
    return tuple(recorded(arm, path, drawn_unevenly(path, habits, rng)) for path in shapes)


def _pause(last: FloatArray, seconds: float, tremble: float, rng: np.random.Generator) -> Events:
    """Rest at the last event (4,); a pointer that lies still sends one event when it goes on."""
    times = last[0] + np.arange(EVENT, seconds + EVENT, EVENT)
    if tremble <= 0.0:
        times = times[-1:]
    places = last[1:] + tremble * rng.standard_normal((len(times), 3))
    return np.column_stack([times, places])


def _events(path: FloatArray, times: FloatArray, gone: FloatArray) -> Events:
    points, length = _measured(path)
    return np.column_stack([times, *(np.interp(gone, length, points[:, axis]) for axis in range(3))])


def _measured(path: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The path, and how long it is up to each of its points [m]."""
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    return path, np.concatenate([[0.0], np.cumsum(steps)])
