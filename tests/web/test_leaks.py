"""Two hundred people come and go: the process stays as large as it was."""

from __future__ import annotations

import gc
import os
import threading
import time
from pathlib import Path

import pytest

from app import server as serving
from app.server import Options, Server, first_document
from tests.app.site import library_in, tab

N_SESSIONS = 200
WARM_UP = 20
LARGEST_GROWTH = 60.0
"""[MB]"""


def megabytes() -> float:
    """Resident memory of this process."""
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def emptied(server: Server) -> None:
    """Wait until nobody's session is kept any more."""
    deadline = time.monotonic() + 30.0
    while server._sessions and time.monotonic() < deadline:
        threading.Event().wait(0.02)
    assert not server._sessions


@pytest.mark.soak
@pytest.mark.timeout(1800)
def test_sessions_that_come_and_go_leave_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(serving, "FORGOTTEN_AFTER", 0.0)
    monkeypatch.setattr(serving, "_SWEEP", 0.02)
    server = Server(Options("127.0.0.1", 0, library_in(tmp_path)), first_document(()))
    try:
        before = 0.0
        for number in range(WARM_UP + N_SESSIONS):
            if number == WARM_UP:
                before = megabytes()
            with tab(server, f"somebody-{number:04}"):
                pass
            emptied(server)
        grown = megabytes() - before
    finally:
        server.close()

    assert grown < LARGEST_GROWTH
