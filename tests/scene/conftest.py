"""A scene on a real viser server, seen by a client without a browser."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from operator import ge
from typing import Any

import numpy as np
import pytest
import viser

from app.actions import Drag
from app.arm.protocol import LinkMesh
from app.document import Document, FloatArray, Shown, View
from app.model import learn
from app.scene import Scene, draw_world
from app.store import Hand, Playback, State
from gc_core import Demonstration
from tests.support.fake_client import FakeClient


def demonstration(number: int) -> Demonstration:
    u = np.linspace(0.0, 1.0, 120)
    turn = 2.0 * np.pi * number / 5.0
    width = 0.05 * (1.0 - u) + 0.005
    aside = np.stack([np.cos(turn) * width, np.zeros_like(u), np.sin(turn) * width], axis=1)
    middle = np.stack([0.2 * np.sin(2.0 * u), -0.3 - 0.3 * u, 0.5 - 0.35 * u], axis=1)
    return Demonstration(times=4.0 * u, positions=middle + aside)


@cache
def document(count: int = 5) -> Document:
    return Document("Reaching", demonstrations=tuple(Shown(demonstration(i)) for i in range(count)))


@cache
def state(count: int = 5) -> State:
    model = learn(document(count))
    return State(
        document=model.source,
        view=View(),
        model=model,
        hand=Hand(np.zeros(2), np.array([0.1, -0.4, 0.3])),
        playback=Playback(time=1.0, duration=4.0),
    )


def preview(before: State, shift: FloatArray) -> State:
    """What a person sees while pulling on the first demonstration."""
    first, *others = before.document.demonstrations
    moved = Demonstration(times=first.demonstration.times, positions=first.demonstration.positions + shift)
    after = replace(before.document, demonstrations=(Shown(moved), *others))
    return replace(before, document=after, model=learn(after, before.model), dragging="/hand")


class TwoLinks:
    """An arm of two links that turn about z, as much of it as is drawn."""

    link_meshes = tuple(
        LinkMesh(link, np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], dtype=np.uint32), (40, 40, 40))
        for link in ("upper", "lower")
    )

    def link_poses(self, joints: FloatArray, gripper: float) -> dict[str, FloatArray]:  # noqa: ARG002
        poses = {}
        for link, angle in zip(("upper", "lower"), joints, strict=True):
            pose = np.eye(4)
            pose[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
            poses[link] = pose
        return poses


class Recorder:
    """Actions that only remember; they come from viser's thread."""

    def __init__(self) -> None:
        self.drags: list[Drag] = []
        self.sought: list[float] = []
        self.edits: list[Callable[[Document], Document]] = []
        self.looks: list[dict[str, Any]] = []
        self.misses = 0
        self._news = threading.Condition()

    def drag(self, drag: Drag) -> None:
        with self._news:
            self.drags.append(drag)
            self._news.notify_all()

    def seek(self, time: float) -> None:
        with self._news:
            self.sought.append(time)
            self._news.notify_all()

    def edit(self, f: Callable[[Document], Document], name: str, key: str | None = None) -> None:  # noqa: ARG002
        with self._news:
            self.edits.append(f)
            self._news.notify_all()

    def look(self, **changes: Any) -> None:
        with self._news:
            self.looks.append(changes)
            self._news.notify_all()

    def miss_hand(self) -> None:
        with self._news:
            self.misses += 1
            self._news.notify_all()

    def wait(
        self, *, drags: int = 0, seeks: int = 0, edits: int = 0, looks: int = 0, misses: int = 0
    ) -> None:
        """Wait until so many have arrived."""
        wanted = (drags, seeks, edits, looks, misses)
        with self._news:
            arrived = self._news.wait_for(lambda: all(map(ge, self._counts(), wanted)), timeout=10.0)
        assert arrived, f"{self._counts()} drags, seeks, edits, looks and misses"

    def _counts(self) -> tuple[int, ...]:
        return len(self.drags), len(self.sought), len(self.edits), len(self.looks), self.misses


@dataclass
class Stage:
    """One tab and the scene that is drawn into it."""

    client: FakeClient
    handle: viser.ClientHandle
    scene: Scene
    actions: Recorder
    now: float = 7.0
    mark: float = 0.0

    def draw(self, shown: State) -> None:
        """Draw, and wait until the tab has it."""
        with self.handle.atomic():
            self.scene.draw(shown)
        self.settle()

    def settle(self) -> None:
        """A mark sent after everything else: once it is there, so is all the rest."""
        self.mark += 1.0
        self.handle.scene.add_frame("/mark", show_axes=False, position=(self.mark, 0.0, 0.0))
        self.handle.flush()
        self.client.wait(lambda c: c.node("/mark").position[0] == self.mark)

    def sent(self) -> list[dict[str, Any]]:
        """Messages about the scene since the log was cleared, without those of the mark."""
        return [m for m in self.client.log if m.get("name") not in (None, "/mark")]


@pytest.fixture
def stage() -> Iterator[Stage]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    joined: queue.Queue[viser.ClientHandle] = queue.Queue()
    server.on_client_connect(joined.put)
    draw_world(server.scene, TwoLinks())
    try:
        with FakeClient(f"ws://127.0.0.1:{server.get_port()}/", keep_log=True) as client:
            handle = joined.get(timeout=10.0)
            actions = Recorder()
            made: list[Stage] = []
            scene = Scene(handle.scene, actions, TwoLinks(), lambda: made[0].now)
            made.append(Stage(client, handle, scene, actions))
            yield made[0]
    finally:
        server.stop()
