"""What panel tests work with: a taught skill, a state of it, and actions that only take notes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from app.document import Document, Shown, View
from app.model import Model, learn
from app.store import Hand, Playback, State
from gc_core import Demonstration


@dataclass
class Notes:
    """`Actions` as a list of calls: (name, arguments)."""

    calls: list[tuple[str, tuple[Any, ...]]] = field(default_factory=list)

    def __getattr__(self, name: str) -> Callable[..., None]:
        def call(*args: Any, **changes: Any) -> None:
            self.calls.append((name, (*args, *changes.items())))

        return call

    def named(self, name: str) -> list[tuple[Any, ...]]:
        """Arguments of the calls of one action."""
        return [arguments for called, arguments in self.calls if called == name]

    def edited(self, document: Document) -> Document:
        """The document after all posted edits."""
        for change, *_ in self.named("edit"):
            document = change(document)
        return document


def reach(number: int, count: int = 5, duration: float = 3.0) -> Demonstration:
    """A reach from above that begins somewhere on a circle and ends near one place."""
    share = np.linspace(0.0, 1.0, 80)[:, None]
    turn = 2.0 * np.pi * number / count
    start = np.array([0.25, -0.30, 0.55]) + 0.09 * np.array([np.cos(turn), np.sin(turn), 0.2 * np.sin(2.0 * turn)])
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
    )
    return replace(state, **changes)
