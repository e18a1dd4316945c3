"""A server that is killed in the middle of anything loses at most the gesture in progress."""

from __future__ import annotations

import random
import threading
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed

from app.document import Document
from app.library import Library
from app.model import learn
from tests.app.site import FIRST_SCREEN, library_in, pull
from tests.support.databases import sound
from tests.support.fake_client import FakeClient
from tests.support.killable import Killable

CODE = "killed-again-and-again"
GOAL, START = "/landmarks/goal", "/start/0"
LONGEST = 1.2
"""A server lives at most so long after the first screen is there [s]."""


def steps(client: FakeClient) -> int:
    """Undo steps that the tab lists."""
    return sum(bool(option) for option in client.element("Version", "Dropdown").props["options"])


def places(client: FakeClient) -> np.ndarray:
    """(2, 3) where the tab shows goal and start [m]."""
    return np.array([client.world_position(GOAL), client.world_position(START)])


def places_in(document: Document) -> np.ndarray:
    """(2, 3) where a saved document has them [m]."""
    (goal,) = (anchor.now for anchor in learn(document).anchors if anchor.name == "goal")
    return np.array([goal, document.starts[0]])


def work(client: FakeClient, dice: random.Random) -> list[np.ndarray]:
    """Pull at things until the server is gone; what was shown as saved, each time it was."""
    acknowledged: list[np.ndarray] = []
    try:
        while client.closed is None:
            before = steps(client)
            pull(client, dice.choice((GOAL, START)), [dice.uniform(-0.02, 0.02) for _ in range(3)], events=4)
            done = client.wait(
                lambda c, n=before: "saved" if steps(c) > n and "Saved" in c.text() else c.closed
            )
            if done == "saved":
                acknowledged.append(places(client))
    except ConnectionClosed:
        pass
    return acknowledged


def missing(saved: Sequence[Document], acknowledged: list[np.ndarray]) -> list[np.ndarray]:
    """What was acknowledged and is in no saved version."""
    found = [places_in(document) for document in saved]

    def held(shown: np.ndarray) -> bool:
        return any(np.all(np.abs(one - shown) < 1e-6) for one in found)

    return [shown for shown in acknowledged if not held(shown)]


def kill_and_look(folder: Path, dice: random.Random, known: int, acknowledged: list[np.ndarray]) -> int:
    """One life of a server, which begins with so many steps; returns how many it leaves.

    ``acknowledged`` grows by what it said to have saved.
    """
    server = Killable(library_in(folder))
    end = threading.Timer(dice.uniform(0.0, LONGEST), server.kill)
    try:
        with FakeClient(f"ws://127.0.0.1:{server.port}/s/{CODE}") as client:
            client.wait_nodes(*FIRST_SCREEN)
            client.wait(lambda c: steps(c) == known and "Saved" in c.text())
            end.start()
            acknowledged += work(client, dice)
    finally:
        end.cancel()
        server.kill()
    assert sound(folder / "library.db")
    library = Library(library_in(folder))
    kept = library.open(CODE)
    saved = [] if kept is None else [version.document for version in kept.history.versions]
    library.close()
    assert missing(saved, acknowledged) == []
    return max(len(saved) - 1, 0)


@pytest.mark.parametrize(
    ("lives", "enough"),
    [pytest.param(5, 2, id="some"), pytest.param(50, 50, id="many", marks=pytest.mark.soak)],
)
def test_all_that_was_said_to_be_saved_is_there_after_each_kill(
    tmp_path: Path, lives: int, enough: int
) -> None:
    dice = random.Random(lives)
    acknowledged: list[np.ndarray] = []
    known, lived = 0, 0
    while lived < lives or (len(acknowledged) < enough and lived < 3 * lives):  # a busy machine saves less
        known, lived = kill_and_look(tmp_path, dice, known, acknowledged), lived + 1

    assert len(acknowledged) >= enough
