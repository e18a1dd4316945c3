"""The page itself: viser's workshop is out of sight, ours works."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import viser

from app.resources import static_folder
from app.web import code_of, open_server
from tests.support.chromium import ViserPage

pytestmark = pytest.mark.browser


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    made = open_server(port=0, health=dict, static=static_folder())
    yield made
    made.stop()


def visible(page: ViserPage, selector: str) -> int:
    return page.page.locator(f"{selector}:visible").count()


def mounted(page: ViserPage, selector: str) -> int:
    return page.page.locator(selector).count()


def test_what_is_visers_own_is_out_of_sight(
    server: viser.ViserServer, open_page: Callable[..., ViserPage]
) -> None:
    page = open_page(f"http://127.0.0.1:{server.get_port()}/", 960, 540)
    page.wait_drawn()
    # The raw panel stands here as long as there is nothing of ours.
    assert mounted(page, "svg.tabler-icon-photo") == 1
    assert visible(page, "svg.tabler-icon-photo") == 0
    page.wait_until(lambda: mounted(page, "#webgl-software-rendering"))
    assert visible(page, "#webgl-software-rendering") == 0

    server.gui.add_button("Ours")
    page.wait_until(lambda: page.shows("Ours"))

    assert mounted(page, "svg.tabler-icon-adjustments") == 1
    assert visible(page, "svg.tabler-icon-adjustments") == 0
    assert visible(page, "svg.tabler-icon-share") == 0
    assert visible(page, 'a[title="About Viser"]') == 0
    assert page.page.title() == "gc-teach"
    assert page.faults == []


def test_a_reload_comes_back_to_the_same_session(
    server: viser.ViserServer, open_page: Callable[..., ViserPage]
) -> None:
    codes: list[str] = []

    @server.on_client_connect
    async def _(client: viser.ClientHandle) -> None:
        codes.append(code_of(client))

    page = open_page(f"http://127.0.0.1:{server.get_port()}/", 960, 540)
    page.wait_until(lambda: len(codes) == 1)
    page.page.reload()
    page.wait_until(lambda: len(codes) == 2)

    assert codes[0] == codes[1]
    assert re.search(r"/s/([\w-]+)", page.page.url)[1] == codes[0]


def test_a_file_too_large_leaves_the_button_usable(
    open_page: Callable[..., ViserPage], tmp_path: Path
) -> None:
    refused: list[str] = []
    server = open_server(
        port=0,
        health=dict,
        static=static_folder(),
        upload_limit=1000,
        on_refused=lambda _, name, __: refused.append(name),
    )

    @server.on_client_connect
    async def _(client: viser.ClientHandle) -> None:
        client.gui.add_upload_button("Open a file")

    large = tmp_path / "large.csv"
    large.write_bytes(bytes(3_000_000))
    page = open_page(f"http://127.0.0.1:{server.get_port()}/", 960, 540)
    page.wait_until(lambda: page.shows("Open a file"))
    page.page.locator('input[name="file"]').set_input_files(str(large))

    page.wait_until(lambda: refused == ["large.csv"])
    button = page.page.locator('button:has-text("Open a file")')
    page.wait_until(button.is_enabled)
    page.wait_until(lambda: not page.shows("Uploading"))
    server.stop()
