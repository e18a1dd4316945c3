"""What a tab may send: uploads within the limit, and values."""

from __future__ import annotations

import queue
from dataclasses import dataclass, field
from typing import Any

import pytest
import viser

from app.uploads import MAX_AT_ONCE, MIN_PART, Announcement, UploadLedger
from tests.support.fake_client import CHUNK, FakeClient
from tests.web.site import Site

LIMIT = 1 << 20


@dataclass
class Desk:
    """What one tab finds: an upload button and a slider, both its own."""

    clients: queue.Queue[viser.ClientHandle] = field(default_factory=queue.Queue)
    files: queue.Queue[tuple[str, bytes]] = field(default_factory=queue.Queue)
    values: queue.Queue[float] = field(default_factory=queue.Queue)


@pytest.fixture
def desk(site: Site) -> Desk:
    made = Desk()

    @site.server.on_client_connect
    async def _(client: viser.ClientHandle) -> None:
        button = client.gui.add_upload_button("Open")
        slider = client.gui.add_slider("Gain", 0.0, 1.0, 0.1, 0.5)

        @button.on_upload
        async def _(_: Any) -> None:
            made.files.put((button.value.name, button.value.content))

        @slider.on_update
        async def _(_: Any) -> None:
            made.values.put(slider.value)

        made.clients.put(client)

    return made


def held(client: viser.ClientHandle) -> int:
    """Bytes of unfinished uploads that viser keeps for a tab."""
    states = client.gui._current_file_upload_states.values()
    return sum(len(part) for state in states for part in state["parts"].values())


def test_a_file_within_the_limit_arrives_whole(site: Site, desk: Desk) -> None:
    content = bytes(range(256)) * (3 * CHUNK // 512)
    with FakeClient(site.ws()) as client:
        client.wait(lambda c: c.element("Open"))
        client.upload("Open", "paths.npy", content)
        assert desk.files.get(timeout=5) == ("paths.npy", content)
        client.upload("Open", "again.npy", content)
        assert desk.files.get(timeout=5) == ("again.npy", content)
    assert site.refused == []


def test_an_empty_file_arrives_so_that_the_app_can_say_what_is_wrong(site: Site, desk: Desk) -> None:
    with FakeClient(site.ws()) as client:
        client.wait(lambda c: c.element("Open"))
        client.upload("Open", "empty.csv", b"")
        assert desk.files.get(timeout=5) == ("empty.csv", b"")


def test_a_file_above_the_limit_is_refused_before_memory_grows(site: Site, desk: Desk) -> None:
    with FakeClient(site.ws(), keep_log=True) as client:
        client.wait(lambda c: c.element("Open"))
        transfer = client.upload("Open", "huge.npy", bytes(LIMIT + 1))
        client.wait(lambda c: c.uploaded(transfer) == LIMIT + 1)
        client.wait(lambda c: any(m["type"] == "RemoveNotificationMessage" for m in c.log))
        handle = desk.clients.get(timeout=5)
        client.upload("Open", "small.npy", b"fits")
        assert desk.files.get(timeout=5) == ("small.npy", b"fits")
        assert held(handle) == 0
        assert site.refused == [(handle.client_id, "huge.npy", LIMIT + 1)]


def test_a_file_longer_than_it_said_is_dropped(site: Site, desk: Desk) -> None:
    with FakeClient(site.ws()) as client:
        client.wait(lambda c: c.element("Open"))
        client.upload("Open", "liar.npy", bytes(3 * CHUNK), announced=2 * MIN_PART)
        client.upload("Open", "after.npy", b"fits")
        assert desk.files.get(timeout=5) == ("after.npy", b"fits")
        assert held(desk.clients.get(timeout=5)) == 0


def test_an_element_that_takes_no_files_gets_none(site: Site, desk: Desk) -> None:
    with FakeClient(site.ws()) as client:
        slider = client.wait(lambda c: c.element("Gain"))
        client.send(
            "FileTransferStartUpload",
            source_component_uuid=slider.uuid,
            transfer_uuid="t",
            filename="x",
            mime_type="",
            part_count=1,
            size_bytes=4,
        )
        client.wait(lambda c: c.uploaded("t") == 4)
        client.set_gui("Gain", 0.7)
        assert desk.values.get(timeout=5) == 0.7
    assert [name for _, name, _ in site.refused] == ["x"]


@pytest.mark.parametrize("updates", [{"update_cb": []}, {"removed": True}, {"value": 0.9, "update_cb": []}])
def test_a_tab_cannot_reach_into_an_element(site: Site, desk: Desk, updates: dict[str, Any]) -> None:
    with FakeClient(site.ws()) as client:
        slider = client.wait(lambda c: c.element("Gain"))
        client.send("GuiUpdateMessage", uuid=slider.uuid, updates=updates)
        client.set_gui("Gain", 0.3)
        assert desk.values.get(timeout=5) == 0.3


def test_shared_elements_are_guarded_too(site: Site) -> None:
    values: queue.Queue[float] = queue.Queue()
    slider = site.server.gui.add_slider("Shared", 0.0, 1.0, 0.1, 0.5)

    @slider.on_update
    async def _(_: Any) -> None:
        values.put(slider.value)

    with FakeClient(site.ws()) as client:
        element = client.wait(lambda c: c.element("Shared"))
        client.send("GuiUpdateMessage", uuid=element.uuid, updates={"update_cb": []})
        client.set_gui("Shared", 0.2)
        assert values.get(timeout=5) == 0.2


def announce(size: int, parts: int = 1, transfer: str = "t", files: bool = True) -> Announcement:
    return Announcement(transfer, "name", size, parts, files)


def test_all_open_uploads_of_a_tab_together_keep_to_the_limit() -> None:
    ledger = UploadLedger(LIMIT)
    assert ledger.start(announce(LIMIT // 2 + 1, transfer="a"))
    assert not ledger.start(announce(LIMIT // 2, transfer="b"))
    ledger.close("a")
    assert ledger.start(announce(LIMIT // 2, transfer="b"))


def test_only_so_many_uploads_are_open_at_a_time() -> None:
    ledger = UploadLedger(LIMIT)
    began = [ledger.start(announce(1, transfer=str(i))) for i in range(MAX_AT_ONCE + 1)]
    assert began == [True] * MAX_AT_ONCE + [False]


@pytest.mark.parametrize(
    "wrong",
    [
        announce(-1),
        announce(10, parts=0),
        announce(10, parts=-1),
        announce(0, parts=1),
        announce(LIMIT, parts=LIMIT),
        announce(10, files=False),
        announce(LIMIT + 1),
    ],
)
def test_an_announcement_that_makes_no_sense_is_refused(wrong: Announcement) -> None:
    ledger = UploadLedger(LIMIT)
    assert not ledger.start(wrong)
    assert ledger.announced == 0


def test_a_transfer_cannot_be_begun_twice() -> None:
    ledger = UploadLedger(LIMIT)
    assert ledger.start(announce(10))
    assert not ledger.start(announce(10))


def test_parts_are_taken_up_to_what_was_announced() -> None:
    ledger = UploadLedger(LIMIT)
    ledger.start(announce(10))
    assert [ledger.take("t", 6), ledger.take("t", 5), ledger.take("t", 4)] == [True, False, True]
    assert ledger.finished("t")
    assert not ledger.take("unknown", 1)
