"""The tool and the stuck arm in a tab: what buttons, fields and rings do, with the real arm."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from app.arm import FloatArray, Jaco
from app.document import Document
from app.server import Options, Server
from app.turning import DOWN, apart, from_angles
from tests.app.site import library_in
from tests.support.fake_client import FakeClient

HOLD, FIELD, RINGS = "Hold the tool", "Tool turned [°]", "Rings"
OPPOSITE = np.array([0.068, -0.91, 0.05])
TILTED = from_angles(np.radians([20.0, -10.0, 30.0]))
_numbers = itertools.count()


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    library = library_in(tmp_path_factory.mktemp("library"))
    made = Server(Options("127.0.0.1", 0, library), lambda: Document("My skill"), Jaco)
    yield made
    made.close()


@pytest.fixture
def client(server: Server) -> Iterator[FakeClient]:
    code = f"tool-session-{next(_numbers):04d}"
    with FakeClient(f"ws://127.0.0.1:{server.port}/s/{code}") as made:
        made.wait_nodes("/hand")
        made.wait(lambda c: c.element(FIELD))
        yield made


def ringed(client: FakeClient) -> None:
    client.set_gui(RINGS, True)
    client.wait(lambda c: "/tool" in c.nodes and c.node("/tool").visible)


def test_rings_are_there_only_when_asked_for(client: FakeClient) -> None:
    before = set(client.nodes)
    ringed(client)
    client.set_gui(RINGS, False)
    client.wait(lambda c: not c.node("/tool").visible)

    assert "/tool" not in before


def test_a_pulled_ring_turns_the_tool_which_is_held_from_then_on(client: FakeClient) -> None:
    ringed(client)
    hand = client.world_position("/hand")
    client.drag_gizmo("/tool", [tuple(hand)], TILTED)
    client.wait(lambda c: c.value(HOLD) is True)
    client.wait(lambda c: np.allclose(c.value(FIELD), (20.0, -10.0, 30.0), atol=0.11))
    client.wait(lambda c: "begins here" in c.text())

    assert np.linalg.norm(client.world_position("/hand") - hand) < 0.003


def test_rings_that_cannot_be_turned_so_go_back_to_where_the_tool_is(client: FakeClient) -> None:
    ringed(client)
    up = from_angles(np.array([np.pi, 0.0, 0.0]))
    client.drag_gizmo("/tool", [tuple(client.world_position("/hand"))], up)
    client.wait(lambda c: "cannot be turned any farther" in c.text(), timeout=20.0)

    client.wait(lambda c: apart(tuple(c.node("/tool").wxyz), DOWN) < np.radians(175.0))


def test_rings_that_are_nowhere_are_refused_in_words(client: FakeClient) -> None:
    ringed(client)
    client.drag_gizmo("/tool", [(0.0, 0.0, 0.0)], (float("nan"), 0.0, 0.0, 0.0))

    client.wait(lambda c: "no turn of the tool" in c.text())


def test_typed_angles_and_presses_turn_the_tool_too(client: FakeClient) -> None:
    client.set_gui(FIELD, (10.0, 0.0, 0.0))
    client.wait(lambda c: c.value(HOLD) is True)
    client.press("↻ x")

    client.wait(lambda c: np.allclose(c.value(FIELD), (20.0, 0.0, 0.0), atol=0.11))


def test_a_tool_let_free_is_free(client: FakeClient) -> None:
    client.set_gui(HOLD, True)
    client.wait(lambda c: "held as it is now" in c.text())
    client.set_gui(HOLD, False)

    client.wait(lambda c: "turns freely" in c.text())


def test_a_motion_is_demonstrated_without_a_pointer(client: FakeClient) -> None:
    client.trigger("Record by buttons, or stop")
    client.wait(lambda c: any(e.label == "Stop: that was the motion" for e in c.gui))
    for _ in range(6):
        client.press("+ x")
    client.wait(lambda c: c.world_position("/hand")[0] > 0.065)
    client.press("Stop: that was the motion")

    client.wait(lambda c: "That was a demonstration" in c.text())
    client.wait_nodes("/demonstrations/0")


class Folded(Jaco):
    """A Jaco that rests where joint 2 keeps it from going to `OPPOSITE`."""

    @property
    def home(self) -> FloatArray:
        return np.array([1.463, 5.463, 0.895, -0.022, 3.363, -0.984])


def test_a_stuck_arm_is_repositioned_by_one_press(tmp_path: Path) -> None:
    made = Server(Options("127.0.0.1", 0, library_in(tmp_path)), lambda: Document("My skill"), Folded)
    with contextlib.closing(made), FakeClient(f"ws://127.0.0.1:{made.port}/s/stuck-session-0001") as client:
        client.wait(lambda c: c.element("Hand [cm]"))
        hidden = not client.element("Reposition the arm").usable
        client.set_gui("Hand [cm]", (100.0 * OPPOSITE).tolist())
        client.wait(lambda c: c.element("Reposition the arm").usable, timeout=30.0)
        client.press("Reposition the arm")

        client.wait(lambda c: np.linalg.norm(c.world_position("/hand") - OPPOSITE) < 0.005, timeout=30.0)
        client.wait(lambda c: not c.element("Reposition the arm").usable)
        assert hidden
