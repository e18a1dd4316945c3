"""A hardened server and a folder for it to serve."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.web import open_server
from tests.web.site import Site


@pytest.fixture
def static(tmp_path: Path) -> Path:
    """A folder to serve, beside a file that must stay private."""
    folder = tmp_path / "static"
    (folder / "style").mkdir(parents=True)
    (folder / "style" / "b.css").write_text(".second { color: red }")
    (folder / "style" / "a.css").write_text(".first { color: blue }")
    (folder / "hello.txt").write_text("hello")
    (folder / ".hidden").write_text("hidden")
    (tmp_path / "secret.txt").write_text("secret")
    (folder / "link.txt").symlink_to(tmp_path / "secret.txt")
    return folder


@pytest.fixture
def site(static: Path) -> Iterator[Site]:
    refused: list[tuple[int, str, int]] = []
    server = open_server(
        port=0,
        health=lambda: {"ok": True, "sessions": 3},
        static=static,
        upload_limit=1 << 20,
        on_refused=lambda client, name, size: refused.append((client, name, size)),
    )
    yield Site(server, refused)
    server.stop()
