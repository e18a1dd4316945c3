"""Strangers at the websocket: each can lose only its own connection."""

from __future__ import annotations

import contextlib
import queue
import random
import socket
from pathlib import Path
from typing import Any

import msgspec
import pytest
import viser
from viser import _messages as messages
from websockets.exceptions import ConnectionClosed, InvalidStatus

from app.pages import COOKIE
from app.web import (
    MESSAGE_LIMIT,
    BusyPortError,
    CannotListenError,
    code_of,
    known_codes,
    low_latency,
    open_server,
)
from tests.support.fake_client import CHUNK, FakeClient
from tests.web.site import CODE, Site


def test_a_page_of_another_site_is_refused(site: Site) -> None:
    with pytest.raises(InvalidStatus) as refusal, FakeClient(site.ws(), origin="http://evil.example"):
        pass
    assert refusal.value.response.status_code == 403


@pytest.mark.parametrize(
    ("headers", "known"),
    [
        ({}, None),
        ({"X-Forwarded-For": "192.0.2.7"}, frozenset()),
        ({"Forwarded": "for=192.0.2.7", "Cookie": f"{COOKIE}={CODE}"}, {CODE}),
    ],
)
def test_whoever_comes_through_a_proxy_sees_no_skills_but_those_that_the_browser_opened(
    site: Site, headers: dict[str, str], known: set[str] | None
) -> None:
    found: queue.Queue[frozenset[str] | None] = queue.Queue()

    @site.server.on_client_connect
    async def _(client: viser.ClientHandle) -> None:
        found.put(known_codes(client))

    with FakeClient(site.ws(), headers=headers):
        assert found.get(timeout=5) == known


def test_our_own_page_is_let_in(site: Site) -> None:
    site.server.scene.add_frame("/here")
    with FakeClient(site.ws(), origin=f"http://127.0.0.1:{site.port}") as client:
        client.wait_nodes("/here")


def test_an_address_without_a_session_is_refused(site: Site) -> None:
    with pytest.raises(InvalidStatus) as refusal, FakeClient(f"ws://127.0.0.1:{site.port}/"):
        pass
    assert refusal.value.response.status_code == 404


def test_the_code_in_the_address_reaches_the_app(site: Site) -> None:
    codes: queue.Queue[str] = queue.Queue()

    @site.server.on_client_connect
    async def _(client: viser.ClientHandle) -> None:
        codes.put(code_of(client))

    with FakeClient(site.ws("first_code")), FakeClient(site.ws("second-code")):
        assert {codes.get(timeout=5), codes.get(timeout=5)} == {"first_code", "second-code"}


def test_the_code_of_a_tab_that_has_gone_is_an_error_that_says_so(site: Site) -> None:
    left: queue.Queue[viser.ClientHandle] = queue.Queue()
    site.server.on_client_disconnect(left.put)
    with FakeClient(site.ws()) as client:
        client.wait_nodes("/WorldAxes")
    with pytest.raises(LookupError, match="has gone"):
        code_of(left.get(timeout=5))


def test_low_latency_bounds_what_the_kernel_holds_back(site: Site) -> None:
    limits: queue.Queue[int] = queue.Queue()

    @site.server.on_client_connect
    async def _(client: viser.ClientHandle) -> None:
        low_latency(client)
        connection = site.server._websock_server._live_connections[client.client_id]
        raw = connection.transport.get_extra_info("socket")
        limits.put(raw.getsockopt(socket.IPPROTO_TCP, 25))

    with FakeClient(site.ws()):
        assert limits.get(timeout=5) == 64 << 10


def test_a_huge_message_closes_only_its_own_connection(site: Site) -> None:
    site.server.scene.add_frame("/here")
    with FakeClient(site.ws()) as bystander, FakeClient(site.ws()) as stranger:
        stranger.send_raw(bytes(MESSAGE_LIMIT + 1))
        stranger.wait(lambda c: c.closed)
        assert stranger.closed is not None
        assert stranger.closed[0] == 1009
        site.server.scene.add_frame("/later")
        bystander.wait_nodes("/here", "/later")


def test_an_upload_part_of_the_page_fits_into_a_message() -> None:
    part = {"type": "FileTransferPart", "content": bytes(CHUNK), "transfer_uuid": "x" * 36, "part_index": 1}
    assert len(msgspec.msgpack.encode(part)) < MESSAGE_LIMIT


def nonsense(seed: int) -> bytes | str:
    """Text frames, junk, wrong types, unknown messages, missing fields, deep nesting."""
    dice = random.Random(seed)
    kinds = sorted(cls.__name__ for cls in messages.Message.get_subclasses())
    deep: Any = None
    for _ in range(50):
        deep = {"x": [deep]}
    odd = dice.choice([None, -1, 1e308, float("nan"), "text", b"\x00", [], {}, deep, "/hand", 2**63])
    fields = {name: odd for name in dice.sample(["name", "uuid", "updates", "position", "owner", "wxyz"], 4)}
    frames: list[bytes | str] = [
        "a text frame",
        dice.randbytes(dice.randrange(1, 200)),
        msgspec.msgpack.encode(odd),
        msgspec.msgpack.encode({"type": odd if isinstance(odd, str) else "Nothing"}),
        msgspec.msgpack.encode({"type": dice.choice(kinds), **fields}),
        msgspec.msgpack.encode({"type": "GuiUpdateMessage", "uuid": "x", "updates": {"update_cb": []}}),
        msgspec.msgpack.encode({"type": dice.choice(kinds), **fields})[: dice.randrange(1, 40)],
        msgspec.msgpack.encode({"type": dice.choice(kinds), "name": "x" * 200_000, "uuid": "y" * 200_000}),
    ]
    return dice.choice(frames)


def test_four_hundred_malformed_messages_leave_the_server_and_the_other_tabs_alive(site: Site) -> None:
    """Many close their connection; two hundred more, which are understood, in tests/app/test_travelling."""
    with FakeClient(site.ws()) as bystander:
        for seed in range(0, 400, 8):
            with FakeClient(site.ws()) as stranger, contextlib.suppress(ConnectionClosed):
                for message in map(nonsense, range(seed, seed + 8)):
                    stranger.send_raw(message)
        site.server.scene.add_frame("/after")
        bystander.wait_nodes("/after")
    assert site.alive()


def test_a_busy_port_is_an_error_that_says_what_to_do(site: Site, static: Path) -> None:
    with pytest.raises(BusyPortError, match=rf"port {site.port}: another program .* --port") as error:
        open_server(port=site.port, health=dict, static=static)
    assert error.value.port == site.port


def test_an_address_that_is_not_ours_is_an_error_that_says_so(static: Path) -> None:
    with pytest.raises(CannotListenError, match=r"Cannot listen on 192\.0\.2\.1"):
        open_server(host="192.0.2.1", port=0, health=dict, static=static)


@pytest.mark.parametrize("port", [-1, 65536])
def test_a_port_that_cannot_be_is_an_error_that_says_so(static: Path, port: int) -> None:
    with pytest.raises(CannotListenError, match="Cannot listen"):
        open_server(port=port, health=dict, static=static)


def test_a_stopped_server_frees_its_port(static: Path) -> None:
    first = open_server(port=0, health=dict, static=static)
    port = first.get_port()
    first.stop()

    second = open_server(port=port, health=dict, static=static)

    assert second.get_port() == port
    second.stop()


def test_nothing_is_printed(static: Path, capfd: pytest.CaptureFixture[str]) -> None:
    open_server(port=0, health=dict, static=static).stop()
    assert capfd.readouterr().out == ""


def test_nobody_can_open_a_public_tunnel(site: Site) -> None:
    handlers = site.server._websock_server._incoming_handlers
    assert messages.ShareUrlRequest not in handlers
    assert messages.ShareUrlDisconnect not in handlers
    with FakeClient(site.ws()) as client:
        client.send("ShareUrlRequest")
        client.wait(lambda c: c._mirror.theme)
        assert client._mirror.theme["show_share_button"] is False


def test_the_session_and_the_viser_version_fit_together() -> None:
    assert viser.__version__ == "1.1.1"
