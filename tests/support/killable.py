"""A server in a process of its own, which can be killed at any moment and is there again at once."""

from __future__ import annotations

import multiprocessing as mp
import time
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess

from tests.app.site import serving

_context = mp.get_context("forkserver")
# What takes a second is loaded once; each server is then a fork of that.
_context.set_forkserver_preload(["tests.support.killable"])


class Killable:
    """A server with the tiny arm on a library, until it is killed."""

    def __init__(self, library: str) -> None:
        """Start it and wait until it listens."""
        mine, theirs = _context.Pipe()
        self._process: BaseProcess = _context.Process(target=_serve, args=(library, theirs), daemon=True)
        self._process.start()
        if not mine.poll(60.0):
            raise TimeoutError("the server did not start")
        self.port: int = mine.recv()

    def kill(self) -> None:
        """End it as if its power were cut: SIGKILL, which nothing can catch."""
        self._process.kill()
        self._process.join()


def _serve(library: str, report: Connection) -> None:
    with serving(library) as server:
        report.send(server.port)
        while True:
            time.sleep(3600.0)
