"""Skills leave by the export dialog and come back by the upload field; strangers do no harm by either."""

from __future__ import annotations

import contextlib
import random
from collections.abc import Iterator
from typing import Any

import msgspec
import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed

from app.exports import FORMATS, pack, unpack
from app.files import inspect_bytes
from app.library import Library
from app.server import Server
from gc_core import same_content
from tests.app.makers import furnished, taught
from tests.app.site import changed, library_in, picture, press, pull, serving, tab
from tests.files.malformed import MALFORMED, TRACES
from tests.support.fake_client import FakeClient

UPLOAD = "Add a recording…"
DIALOG = "Export this skill"
BY = (0.05, -0.04, 0.06)


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> str:
    return library_in(tmp_path_factory.mktemp("library"))


@pytest.fixture(scope="module")
def server(library: str) -> Iterator[Server]:
    with serving(library) as made:
        yield made


@pytest.fixture
def client(server: Server, request: pytest.FixtureRequest) -> Iterator[FakeClient]:
    code = "travel-" + "".join(c for c in request.node.name if c.isalnum())[-50:]
    with tab(server, code) as made:
        yield made


def choose(client: FakeClient, suffix: str) -> None:
    """Choose a kind of file in the open dialog, and wait until it is made."""
    client.set_gui("As", next(o for o in client.element("As").props["options"] if o.endswith(f"({suffix})")))
    client.wait(lambda c: f"{suffix}, " in c.text() and c.element("Download").usable)


def test_the_dialog_shows_what_will_be_in_a_file_before_it_is_taken(client: FakeClient) -> None:
    client.press("Export…")
    client.wait(lambda c: DIALOG in c.modals and "reaching.gcteach" in c.text())
    choose(client, ".csv")
    assert "t,x,y,z,gripper,demo" in client.text()
    assert client.downloads == {}

    client.press("Download")
    client.wait(lambda c: "reaching.csv" in c.downloads)
    client.press("Close")

    client.wait(lambda c: DIALOG not in c.modals)
    found = inspect_bytes("reaching.csv", client.downloads["reaching.csv"]).demonstrations
    assert all(
        same_content(one.positions, shown.demonstration.positions)
        for one, shown in zip(found, taught().demonstrations, strict=True)
    )


def test_what_is_taken_is_what_is_on_the_desk_also_when_that_changes_behind_the_dialog(
    client: FakeClient,
) -> None:
    pull(client, "/start/0", BY)
    client.wait(lambda c: c.value("Skill") == "My reaching")
    client.press("Export…")
    client.wait(lambda c: "my-reaching.gcteach" in c.text())

    press(client, "Undo:")

    client.wait(lambda c: ">reaching.gcteach" in c.text())
    client.press("Download")
    content = client.wait(lambda c: c.downloads.get("reaching.gcteach"))
    assert unpack("reaching.gcteach", content).title == "Reaching"


def test_every_kind_of_file_is_offered(client: FakeClient) -> None:
    client.press("Export…")
    client.wait(lambda c: DIALOG in c.modals)

    assert [o.rpartition("(")[2][:-1] for o in client.element("As").props["options"]] == list(FORMATS)


def test_what_cannot_be_exported_is_said_in_the_dialog(client: FakeClient) -> None:
    client.set_gui("Open", "Teach your own")
    client.wait(lambda c: not c.node("/tube").visible)
    client.press("Export…")
    client.wait(lambda c: DIALOG in c.modals and "my-skill.gcteach" in c.text())

    client.set_gui("As", "Demonstrations as a table (.csv)")

    client.wait(lambda c: "Nothing was shown yet, so" in c.text())
    assert not client.element("Download").usable


def test_a_skill_that_was_exported_is_opened_again_as_it_was(client: FakeClient) -> None:
    pull(client, "/start/0", BY)
    client.wait(lambda c: c.value("Skill") == "My reaching")
    before = picture(client)
    client.press("Export…")
    client.wait(lambda c: DIALOG in c.modals and "my-reaching.gcteach" in c.text())
    client.press("Download")
    content = client.wait(lambda c: c.downloads.get("my-reaching.gcteach"))
    client.press("Close")
    client.set_gui("Open", "Needle")
    client.wait(lambda c: c.value("Skill") == "Needle")

    client.upload(UPLOAD, "my-reaching.gcteach", content)

    client.wait(lambda c: c.value("Skill") == "My reaching" and picture(c) == before)
    assert unpack("a.gcteach", content).title == "My reaching"


def test_opening_a_skill_file_can_be_undone(client: FakeClient) -> None:
    before = picture(client)
    client.upload(UPLOAD, "sent.gcteach", pack(furnished()))
    client.wait(lambda c: "/landmarks/cup" in c.nodes)

    press(client, "Undo:")

    client.wait(lambda c: changed(before, picture(c)) <= {"/obstacles"})


def test_thirty_malformed_uploads_give_a_sentence_each_and_lose_nothing(
    server: Server, client: FakeClient, library: str
) -> None:
    pull(client, "/start/0", BY)
    client.wait(lambda c: c.value("Skill") == "My reaching")
    before, silent = picture(client), []
    for name, content in MALFORMED.items():
        client.upload(UPLOAD, name, content)
        try:
            client.wait(lambda c, name=name: name in c.text() and f"Reading {name}" not in c.text(), 5.0)
        except TimeoutError:
            silent.append(name)

    assert len(MALFORMED) >= 30
    assert silent == []
    assert TRACES == []
    assert picture(client) == before


# --- strangers at the socket ---------------------------------------------------------------------------

ODD: tuple[Any, ...] = (
    None, -1, 1e308, float("nan"), float("inf"), "text", "x" * 100_000, b"\x00\xff", [], {}, True, 2**63,
    [float("nan")] * 3, [float("nan")] * 4, [1e300] * 3, ["a", "b", "c"], [[[]]], "/hand", "../..", "<b>",
)  # fmt: skip


def strange(dice: random.Random, client: FakeClient) -> dict[str, Any]:
    """A message that viser's page never sends, about something that is really there."""
    node = client.nodes[dice.choice(sorted(client.nodes))]
    element, odd, nowhere = dice.choice(client.gui), dice.choice(ODD), [float("nan")] * 3
    far = [1e300] * 3
    here = {"name": node.name, "owner": node.owner, "instance_index": dice.choice([None, -5, 10**9])}
    update = {"type": "GuiUpdateMessage", "uuid": dice.choice([element.uuid, "unknown"])}
    drag = {
        "type": "SceneNodeDragMessage", **here, "phase": dice.choice(["start", "update", "end", "x"]),
        "name": dice.choice([node.name, "/hand", "/start/0", "/landmarks/goal", "/nowhere"]),
        # Places that are none close the connection, see tests/web, and viser then needs 6 s to stop.
        "start_position": dice.choice([nowhere, far, (0.1, 0.2, 0.3)]), "start_screen_pos": (0.5, 0.5),
        "end_position": dice.choice([nowhere, far, (9.0, 9.0, 9.0)]), "end_screen_pos": (0.5, 0.5),
        "button": "left", "modifier": None,
    }  # fmt: skip
    camera = {
        "type": "ViewerCameraMessage", "wxyz": [*nowhere, 0.0], "position": [1e300, float("nan"), 0.0],
        "fov": float("inf"), "near": 0.0, "far": -1.0, "image_height": -1, "image_width": 0,
        "look_at": nowhere, "up_direction": [0.0] * 3,
    }  # fmt: skip
    click = {
        "type": "SceneNodeClickMessage", **here, "ray_origin": nowhere, "ray_direction": [0.0] * 3,
        "screen_pos": (9.0, -9.0), "modifier": None,
    }  # fmt: skip
    part = {
        "type": "FileTransferPart", "source_component_uuid": element.uuid, "transfer_uuid": "t",
        "part_index": dice.choice([-1, 0, 10**9]), "content": b"x" * 1000,
    }  # fmt: skip
    value, prop = {**update, "updates": {"value": odd}}, {**update, "updates": {"update_cb": odd}}
    return dice.choice([drag, drag, value, value, prop, camera, click, part])


def test_two_hundred_strange_messages_harm_neither_the_other_tabs_nor_what_was_saved(
    server: Server, client: FakeClient, library: str
) -> None:
    """Beside the four hundred of tests/web; `nonsense` there closes the connection, these are understood."""
    dice, sent = random.Random(5), 0
    before = picture(client)
    while sent < 200:
        with tab(server, "strangers-code-0001") as stranger, contextlib.suppress(ConnectionClosed):
            while sent < 200 and stranger.closed is None:
                sent += 1
                stranger.send_raw(msgspec.msgpack.encode(strange(dice, stranger)))

    pull(client, "/start/0", BY)
    client.wait(lambda c: "/start/0" in changed(before, picture(c)))
    client.wait(lambda _: "My reaching" in {one.title for one in Library(library).recent()})
    with tab(server, "strangers-code-0001") as again:
        vertices = again.node("/tube").array("vertices")
    assert np.isfinite(vertices).all()
