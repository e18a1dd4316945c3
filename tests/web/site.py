"""The hardened server under test, and how to talk to it."""

from __future__ import annotations

from dataclasses import dataclass, field
from http.client import HTTPConnection, HTTPResponse
from pathlib import Path

import viser

from tests.support.fake_client import FakeClient

ROOT = Path(__file__).resolve().parents[2]
CODE = "abcdefghij_-"


@dataclass
class Site:
    """A server with nothing on it but what a test puts there."""

    server: viser.ViserServer
    refused: list[tuple[int, str, int]] = field(default_factory=list)

    @property
    def port(self) -> int:
        return self.server.get_port()

    def ws(self, code: str = CODE) -> str:
        return f"ws://127.0.0.1:{self.port}/s/{code}"

    def get(self, path: str, **headers: str) -> tuple[HTTPResponse, bytes]:
        connection = HTTPConnection("127.0.0.1", self.port, timeout=10)
        connection.request("GET", path, headers=headers)
        response = connection.getresponse()
        body = response.read()
        connection.close()
        return response, body

    def alive(self) -> bool:
        """Whether a newcomer is still served in full."""
        self.server.scene.add_frame("/alive")
        with FakeClient(self.ws()) as client:
            client.wait_nodes("/alive")
        return self.get("/healthz")[0].status == 200
