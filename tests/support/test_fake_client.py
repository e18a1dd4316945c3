"""The fake client against a bare viser server: what it does must reach viser's callbacks."""

from __future__ import annotations

import queue
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import viser

from tests.support.fake_client import FakeClient


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    made = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield made
    made.stop()


@pytest.fixture
def url(server: viser.ViserServer) -> str:
    return f"ws://127.0.0.1:{server.get_port()}"


def take(events: queue.Queue[Any], count: int) -> list[Any]:
    return [events.get(timeout=5.0) for _ in range(count)]


def test_a_node_drag_arrives_as_start_updates_and_end(server: viser.ViserServer, url: str) -> None:
    ball = server.scene.add_icosphere("/ball", radius=0.1, position=(1.0, 0.0, 0.0))
    events: queue.Queue[tuple[str, tuple[float, float, float]]] = queue.Queue()

    @ball.on_drag("left")
    async def _(event: viser.SceneNodeDragEvent[Any]) -> None:
        events.put((event.phase, event.end_position))

    with FakeClient(url) as client:
        client.wait(lambda c: c.node("/ball").drags)
        client.drag("/ball", [(1.0, 0.5, 0.0), (1.0, 1.0, 0.0)])

        assert take(events, 4) == [
            ("start", (1.0, 0.0, 0.0)),
            ("update", (1.0, 0.5, 0.0)),
            ("update", (1.0, 1.0, 0.0)),
            ("end", (1.0, 1.0, 0.0)),
        ]


def test_a_drag_with_a_modifier_reaches_only_its_own_binding(server: viser.ViserServer, url: str) -> None:
    ball = server.scene.add_icosphere("/ball", radius=0.1)
    events: queue.Queue[str | None] = queue.Queue()

    @ball.on_drag("left", modifier="shift")
    async def _(event: viser.SceneNodeDragEvent[Any]) -> None:
        events.put(event.modifier)

    with FakeClient(url) as client:
        client.wait(lambda c: c.node("/ball").drags)
        client.drag("/ball", [(0.0, 0.0, 1.0)], modifier="shift")
        assert take(events, 3) == ["shift"] * 3
        with pytest.raises(LookupError, match="does not listen"):
            client.drag("/ball", [(0.0, 0.0, 1.0)])


def test_a_drag_on_a_clients_own_node_reaches_it(server: viser.ViserServer, url: str) -> None:
    events: queue.Queue[str] = queue.Queue()

    @server.on_client_connect
    async def _(client: viser.ClientHandle) -> None:
        ball = client.scene.add_icosphere("/mine", radius=0.1)

        @ball.on_drag("left")
        async def _(event: viser.SceneNodeDragEvent[Any]) -> None:
            events.put(event.phase)

    with FakeClient(url) as client:
        client.wait(lambda c: c.node("/mine").drags)
        client.drag("/mine", [(0.0, 0.0, 1.0)])
        assert take(events, 3) == ["start", "update", "end"]


def test_the_mirror_follows_a_mesh_and_its_pose(server: viser.ViserServer, url: str) -> None:
    mesh = server.scene.add_mesh_simple("/tube", np.zeros((4, 3)), np.array([[0, 1, 2], [1, 2, 3]]))
    with FakeClient(url) as client:
        client.wait_nodes("/tube")
        mesh.vertices = np.arange(12, dtype=np.float32).reshape(4, 3)
        mesh.position = (1.0, 2.0, 3.0)
        mesh.visible = False
        client.wait(lambda c: not c.node("/tube").visible and c.node("/tube").position[2] == 3.0)
        np.testing.assert_array_equal(client.node("/tube").array("vertices", -1, 3), mesh.vertices)
        mesh.remove()
        client.wait(lambda c: "/tube" not in c.nodes)


def test_a_nodes_world_position_includes_its_parents(server: viser.ViserServer, url: str) -> None:
    half = float(np.sqrt(0.5))
    server.scene.add_frame("/arm", wxyz=(half, 0.0, 0.0, half), position=(1.0, 0.0, 0.0))
    server.scene.add_frame("/arm/hand", position=(1.0, 0.0, 0.0))
    with FakeClient(url) as client:
        client.wait(lambda c: c.node("/arm/hand").position[0] == 1.0 and c.node("/arm").wxyz[3] > 0.5)
        np.testing.assert_allclose(client.world_position("/arm/hand"), (1.0, 1.0, 0.0), atol=1e-6)


def test_a_slider_set_by_label_reaches_the_server(server: viser.ViserServer, url: str) -> None:
    slider = server.gui.add_slider("Gain", 0.0, 1.0, 0.1, 0.5)
    values: queue.Queue[float] = queue.Queue()

    @slider.on_update
    async def _(_: Any) -> None:
        values.put(slider.value)

    with FakeClient(url) as client:
        client.wait(lambda c: c.element("Gain"))
        client.set_gui("Gain", 0.9)
        assert (take(values, 1), client.value("Gain")) == ([0.9], 0.9)
        slider.value = 0.2
        client.wait(lambda c: c.value("Gain") == 0.2)


def test_a_button_is_pressed_only_when_a_person_could(server: viser.ViserServer, url: str) -> None:
    button = server.gui.add_button("Go")
    presses: queue.Queue[str] = queue.Queue()

    @button.on_click
    async def _(_: Any) -> None:
        presses.put("go")

    with FakeClient(url) as client:
        client.wait(lambda c: c.element("Go"))
        client.press("Go")
        assert take(presses, 1) == ["go"]
        button.disabled = True
        client.wait(lambda c: not c.element("Go").usable)
        with pytest.raises(LookupError, match="greyed out"):
            client.press("Go")


def test_a_click_on_a_node_arrives_with_its_ray(server: viser.ViserServer, url: str) -> None:
    ball = server.scene.add_icosphere("/ball", radius=0.1)
    rays: queue.Queue[np.ndarray] = queue.Queue()

    @ball.on_click
    async def _(event: viser.SceneNodePointerEvent[Any]) -> None:
        rays.put(np.asarray(event.ray_direction))

    with FakeClient(url) as client:
        client.wait(lambda c: c.node("/ball").clicks)
        client.click("/ball")
        np.testing.assert_allclose(take(rays, 1)[0], -np.ones(3) / np.sqrt(3.0))


def test_an_upload_of_several_parts_arrives_whole(server: viser.ViserServer, url: str) -> None:
    button = server.gui.add_upload_button("Open a file")
    content = bytes(range(256)) * 4096
    files: queue.Queue[bytes] = queue.Queue()

    @button.on_upload
    async def _(_: Any) -> None:
        files.put(button.value.content)

    with FakeClient(url) as client:
        client.wait(lambda c: c.element("Open a file"))
        transfer = client.upload("Open a file", "paths.npy", content)
        assert take(files, 1) == [content]
        client.wait(lambda c: c.uploaded(transfer) == len(content))


def test_notices_and_commands_are_seen(server: viser.ViserServer, url: str) -> None:
    undone: queue.Queue[str] = queue.Queue()
    command = server.gui.add_command("Undo", hotkey="Z", modifier="cmd/ctrl")

    @command.on_trigger
    async def _(_: Any) -> None:
        undone.put("undo")

    @server.on_client_connect
    async def _(client: viser.ClientHandle) -> None:
        client.add_notification("Saved", "My reaching")

    with FakeClient(url) as client:
        client.wait(lambda c: c.notices == [("Saved", "My reaching")] and c.commands)
        client.trigger("Undo")
        assert take(undone, 1) == ["undo"]


def test_bytes_and_times_are_counted(server: viser.ViserServer, url: str) -> None:
    server.scene.add_mesh_simple("/m", np.zeros((1000, 3)), np.zeros((1, 3), np.uint32))
    with FakeClient(url) as client:
        client.wait_nodes("/m")
        client.wait_quiet()
        assert client.bytes_received > 12_000
        assert client.first_message_at is not None
        assert client.last_message_at is not None
        assert client.connected_at <= client.first_message_at <= client.last_message_at


def test_a_wait_that_fails_says_what_there_is(server: viser.ViserServer, url: str) -> None:
    server.scene.add_frame("/here")
    with FakeClient(url) as client:
        client.wait_nodes("/here")
        with pytest.raises(TimeoutError, match="/here"):
            client.wait_nodes("/nowhere", timeout=0.05)
