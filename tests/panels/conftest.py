"""Panels on a real viser server, used through a client without a browser."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import viser

from app.panels import Panels
from tests.panels.desk import SKILLS, Bench, Notes
from tests.support.fake_client import FakeClient


@pytest.fixture(scope="module")
def server() -> Iterator[viser.ViserServer]:
    made = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield made
    made.stop()


@pytest.fixture
def bench(server: viser.ViserServer) -> Iterator[Bench]:
    notes = Notes()
    panels = Panels(server.gui, notes, SKILLS)
    with FakeClient(f"ws://127.0.0.1:{server.get_port()}") as client:
        client.wait(lambda c: c.element("Skill", "Text"))
        yield Bench(panels, notes, client, server.scene.add_frame("/drawn", visible=False))
    server.gui.reset()
