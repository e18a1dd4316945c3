"""A PostgreSQL of our own for the tests: in a folder of its own, on loopback only, gone afterwards."""

from __future__ import annotations

import contextlib
import os
import pwd
import shutil
import socket
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

SERVANT = "postgres"
"""PostgreSQL does not run as root; Debian's package brings this user."""


def programs() -> Path | None:
    """The folder of ``initdb`` and ``pg_ctl``, newest version; None where it is not installed."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"), key=lambda p: int(p.parts[-3]))
    if found:
        return found[-1].parent
    anywhere = shutil.which("initdb")
    return None if anywhere is None else Path(anywhere).parent


@contextlib.contextmanager
def running(folder: Path) -> Iterator[str]:
    """Start a fresh cluster with the programs of a folder; its address."""
    root = os.geteuid() == 0
    user = SERVANT if root else None
    place = Path(tempfile.mkdtemp(prefix="gc-teach-pg-"))
    if root:
        servant = pwd.getpwnam(SERVANT)
        os.chown(place, servant.pw_uid, servant.pw_gid)

    def call(*command: str) -> None:
        subprocess.run(
            command, check=True, user=user, cwd=place, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )

    data, port = str(place / "data"), free_port()
    quick = f"-p {port} -k {place} -c listen_addresses=127.0.0.1 -c fsync=off -c shared_buffers=16MB"
    try:
        call(str(folder / "initdb"), "-D", data, "-U", "teacher", "-A", "trust", "-E", "UTF8", "--no-sync")
        call(str(folder / "pg_ctl"), "-D", data, "-w", "-o", quick, "-l", str(place / "log"), "start")
        try:
            yield f"postgresql+pg8000://teacher@127.0.0.1:{port}/postgres"
        finally:
            call(str(folder / "pg_ctl"), "-D", data, "-m", "immediate", "stop")
    finally:
        shutil.rmtree(place, ignore_errors=True)


def free_port() -> int:
    """A port that nobody listens on."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return int(one.getsockname()[1])
