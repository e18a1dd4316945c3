"""What a watching tab is shown comes from another person."""

from __future__ import annotations

from dataclasses import replace

import viser

from app.panels.watch import WatchPanel
from tests.panels.desk import state_of, taught
from tests.support.fake_client import FakeClient


def test_a_title_is_shown_as_it_was_typed_and_not_as_markdown(server: viser.ViserServer) -> None:
    panel = WatchPanel(server.gui, lambda: None, lambda _: None)
    title = "![seen](http://elsewhere.example/seen.png)<b>"

    panel.draw(state_of(replace(taught(), title=title)))

    with FakeClient(f"ws://127.0.0.1:{server.get_port()}") as client:
        client.wait(lambda c: "seen.png)&lt;b&gt;" in c.text())
        shown = [e for e in client.gui if "seen.png" in str(e.props)]
        assert [e.kind for e in shown] == ["Html"]
    server.gui.reset()
