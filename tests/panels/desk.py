"""What panel tests work with: a taught skill, a state of it, and actions that only take notes."""

from __future__ import annotations

import itertools
import queue
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import viser

from app.document import Document, Shown, View
from app.model import Model, learn
from app.panels import Panels
from app.store import Hand, Playback, State
from gc_core import Demonstration
from tests.support.fake_client import FakeClient

SKILLS = (("reaching", "Reaching"), ("needle", "Needle"))

_drawings = itertools.count(1)

Call = tuple[str, tuple[Any, ...]]


class Notes:
    """`Actions` that only take notes: (name, arguments), in order."""

    def __init__(self) -> None:
        self._calls: queue.Queue[Call] = queue.Queue()

    def __getattr__(self, name: str) -> Callable[..., None]:
        def call(*args: Any, **changes: Any) -> None:
            self._calls.put((name, (*args, *changes.items())))

        return call

    def next(self) -> Call:
        """Wait for the next call and take it."""
        return self._calls.get(timeout=5.0)

    def none(self) -> bool:
        """Whether no call waits."""
        return self._calls.empty()


@dataclass
class Bench:
    """Panels, what they post, and the tab that shows them."""

    panels: Panels
    notes: Notes
    client: FakeClient
    mark: viser.FrameHandle
    """What is sent after a drawing, so that it shows when all of that has come."""

    def draw(self, state: State) -> State:
        """Draw and wait until the tab shows it."""
        self.panels.draw(state)
        drawn = float(next(_drawings))
        self.mark.position = (drawn, 0.0, 0.0)
        self.client.wait(lambda c: c.node(self.mark.name).position[0] == drawn)
        return state

    def edited(self, document: Document) -> Document:
        """A document after the next posted edit."""
        name, (change, *_) = self.notes.next()
        assert name == "edit"
        return change(document)

    def only_undo_is_posted(self) -> bool:
        """Press undo, which arrives after everything before it, and see that nothing else did."""
        self.client.wait(lambda c: any(e.label == "Undo: move goal" and e.usable for e in c.gui))
        self.client.press("Undo: move goal")
        return self.notes.next() == ("undo", ()) and self.notes.none()


def reach(number: int, count: int = 5, duration: float = 3.0) -> Demonstration:
    """A reach from above that begins somewhere on a circle and ends near one place."""
    share = np.linspace(0.0, 1.0, 80)[:, None]
    turn = 2.0 * np.pi * number / count
    start = np.array([0.25, -0.30, 0.55]) + 0.09 * np.array(
        [np.cos(turn), np.sin(turn), 0.2 * np.sin(2.0 * turn)]
    )
    goal = np.array([-0.10, -0.48, 0.12]) + 0.012 * np.array([np.cos(turn), np.sin(turn), 0.0])
    bow = 0.08 * np.sin(np.pi * share) * np.array([0.3, -0.5, 1.0])
    return Demonstration(
        duration * share[:, 0], start + (goal - start) * share + bow, name=f"Reach {number + 1}"
    )


def taught(count: int = 5) -> Document:
    """A skill of `count` demonstrations."""
    shown = tuple(Shown(reach(i, count)) for i in range(count))
    return Document("Reaching", about="This robot was shown how to reach the ball.", demonstrations=shown)


def state_of(document: Document, previous: Model | None = None, **changes: Any) -> State:
    """A state at rest of a document."""
    model = learn(document, previous)
    duration = float(model.runs[0].reproduction.times[-1]) if model.runs else 0.0
    state = State(
        document=document,
        view=View(),
        model=model,
        hand=Hand(joints=np.zeros(6), position=np.array([0.2, -0.3, 0.4])),
        playback=Playback(time=0.4 * duration, duration=duration),
        undo_name="move goal",
    )
    return replace(state, **changes)
