"""viser 1.1.1, made fit to be served to people.

viser accepts every origin, takes the next port when one is busy, opens a public tunnel for any client that
asks, and buffers uploads without limit. This module and `app.guard` are the only ones that touch what viser
keeps private; each such name has a test in tests/web, and pyproject pins the version.
"""

# pyright: reportPrivateUsage=false
# That is this module's purpose: viser has no public way to do any of it.

import contextlib
import errno
import logging
import socket
import sys
import threading
from collections.abc import Awaitable, Callable, Generator
from http import HTTPStatus
from pathlib import Path
from typing import Any, Final

import rich
import viser
import websockets.asyncio.server as websocket_server
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from app.guard import OnRefused, guard
from app.pages import (
    FORWARDED,
    Reply,
    Site,
    answer,
    code_in_path,
    fresh_code,
    gather_style,
    is_local,
    make_page,
    opened_codes,
    same_origin,
    valid_code,
)
from gc_core.errors import GcError

__all__ = [
    "BusyPortError",
    "CannotListenError",
    "code_of",
    "fresh_code",
    "known_codes",
    "low_latency",
    "open_server",
    "valid_code",
]

MESSAGE_LIMIT: Final = 2 << 20
"""Largest websocket message taken [bytes]; viser's page sends an upload in parts of 512 kB."""
UPLOAD_LIMIT: Final = 64 << 20
"""Default for what one tab may be sending [bytes]."""
UNSENT_LIMIT: Final = 64 << 10
"""What the kernel may hold back for a slow tab [bytes], so that it drops pictures instead of lagging."""

_building = threading.Lock()


class CannotListenError(GcError):
    """The address for the server cannot be used."""

    def __init__(self, host: str, port: int, reason: str) -> None:
        super().__init__(
            f"Cannot listen on {host}, port {port}: {reason}. Choose another with --host or --port."
        )
        self.host = host
        self.port = port


class BusyPortError(CannotListenError):
    """Another program listens on that port."""

    def __init__(self, host: str, port: int) -> None:
        super().__init__(host, port, "another program uses that port, perhaps another gc-teach")


def open_server(
    *,
    host: str = "127.0.0.1",
    port: int = 8080,
    health: Callable[[], dict[str, object]],
    static: Path,
    new_code: Callable[[], str] = fresh_code,
    upload_limit: int = UPLOAD_LIMIT,
    on_refused: OnRefused | None = None,
) -> viser.ViserServer:
    """Start a viser server with sessions in its addresses and without its open doors.

    Parameters
    ----------
    host, port
        Where to listen; port 0 takes a free one (``server.get_port()`` tells which).
    health
        What ``/healthz`` says; ``{"ok": False}`` in it makes the status 503. Runs on the event loop.
    static
        Folder served under ``/static/``; its ``style/*.css`` go into the page.
    new_code
        Makes the code of a fresh session, which must be a `valid_code`.
    upload_limit
        Most bytes that one tab may be sending at a time; more is refused at its announcement.
    on_refused
        Told of each refused upload, so that a person can be told.

    Raises
    ------
    BusyPortError
        If another program listens there.
    CannotListenError
        If the address cannot be used for another reason.
    """
    index = Path(viser.__file__).parent / "client" / "build" / "index.html"
    page = make_page(index.read_text(encoding="utf-8"), gather_style(static))
    site = Site(page=page, static=static.resolve(), health=health, new_code=new_code)
    # The banner and other remarks that viser prints would spoil the output of our own commands.
    rich.reconfigure(quiet=True)
    listener = _listen(host, port)
    try:
        with _serving(listener, site):
            server = viser.ViserServer(host=host, port=port, verbose=False)
    except BaseException:
        listener.close()
        raise
    server.gui.configure_theme(show_logo=False, show_share_button=False)
    guard(server, upload_limit, on_refused)
    return server


def code_of(client: viser.ClientHandle) -> str:
    """The session code in the address of a connected tab.

    Raises
    ------
    LookupError
        If the tab has gone, or came by an address without a code (`open_server` lets none in).
    """
    connection = _connection(client)
    request = None if connection is None else connection.request
    code = None if request is None else code_in_path(request.path)
    if code is None:
        raise LookupError(f"client {client.client_id} has gone or has no session code in its address")
    return code


def known_codes(client: viser.ClientHandle) -> frozenset[str] | None:
    """The codes that a connected tab's browser has opened; None, all, on the server's own machine.

    Who claims to sit there must also connect from there, and not by a proxy.
    """
    connection = _connection(client)
    request = None if connection is None else connection.request
    if connection is None or request is None:
        return frozenset()
    forwarded = any(name in request.headers for name in FORWARDED)
    peer = "" if forwarded or not connection.remote_address else str(connection.remote_address[0])
    if is_local(_header(request, "Host") or "", peer):
        return None
    return frozenset(opened_codes(_header(request, "Cookie") or ""))


def low_latency(client: viser.ClientHandle) -> None:
    """Let a tab on a slow line skip pictures rather than show old ones.

    Measured on a line of 2 MB/s with a 200x64 tube at 30 Hz: pictures 0.24 s old instead of 1.7 s. Does
    nothing where the system has no such option, or when the tab has gone.
    """
    connection = _connection(client)
    if connection is None or not sys.platform.startswith("linux"):
        return
    not_sent_low_water = 25  # TCP_NOTSENT_LOWAT, which Python 3.11 does not name
    with contextlib.suppress(OSError):
        raw: socket.socket = connection.transport.get_extra_info("socket")
        raw.setsockopt(socket.IPPROTO_TCP, not_sent_low_water, UNSENT_LIMIT)


def _connection(client: viser.ClientHandle) -> ServerConnection | None:
    return client._viser_server._websock_server._live_connections.get(client.client_id)


def _listen(host: str, port: int) -> socket.socket:
    """Bind before viser does, since viser would silently take another port."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host, port), family=family, backlog=128)
    except (OSError, OverflowError) as error:
        if isinstance(error, OSError) and error.errno == errno.EADDRINUSE:
            raise BusyPortError(host, port) from error
        reason = (error.strerror if isinstance(error, OSError) else None) or str(error)
        raise CannotListenError(host, port, reason) from error


@contextlib.contextmanager
def _serving(listener: socket.socket, site: Site) -> Generator[None]:
    """While viser builds its server, hand it our socket, our limits and our answers."""
    original = websocket_server.serve

    def serve(handler: Callable[[ServerConnection], Awaitable[None]], *_: object, **options: Any) -> Any:
        options.update(max_size=MESSAGE_LIMIT, process_request=_request_handler(site), logger=_quiet_logger())
        return original(handler, sock=listener, **options)

    with _building:
        websocket_server.serve = serve
        try:
            yield
        finally:
            websocket_server.serve = original


def _request_handler(site: Site) -> Callable[[ServerConnection, Request], Response | None]:
    def handle(_: ServerConnection, request: Request) -> Response | None:
        if (_header(request, "Upgrade") or "").lower() != "websocket":
            cookies = _header(request, "Cookie") or ""
            return _response(answer(site, request.path, cookies), request)
        if not same_origin(_header(request, "Origin"), _header(request, "Host")):
            return _response(Reply(HTTPStatus.FORBIDDEN, b"This page may not connect here.\n"), request)
        if code_in_path(request.path) is None:
            return _response(Reply(HTTPStatus.NOT_FOUND, b"Connect to /s/<code>.\n"), request)
        return None

    return handle


def _header(request: Request, name: str) -> str | None:
    """The one value of a header; several count as an empty one, which matches nothing."""
    values = request.headers.get_all(name)
    return None if not values else (values[0] if len(values) == 1 else "")


def _response(reply: Reply, request: Request) -> Response:
    headers, body = reply.headers(_header(request, "Accept-Encoding") or "")
    return Response(reply.status, reply.status.phrase, Headers(headers), body)


def _quiet_logger() -> logging.Logger:
    """What strangers send is their fault: one line for it, no traceback."""
    logger = logging.getLogger(f"{__name__}.connections")
    logger.setLevel(logging.WARNING)
    if not logger.filters:
        logger.addFilter(_without_traceback)
    return logger


def _without_traceback(record: logging.LogRecord) -> bool:
    if record.getMessage() in ("opening handshake failed", "connection handler failed"):
        error = record.exc_info[1] if record.exc_info else None
        record.msg = f"{record.msg}: {type(error).__name__}: {error}"
        record.exc_info = None
        record.levelno, record.levelname = logging.WARNING, "WARNING"
    return True
