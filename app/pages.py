"""What the HTTP side answers: a pure function from a request to a reply, without viser and without sockets.

``/`` leads to a fresh session, ``/s/<code>`` is the page of a session, ``/static/…`` are files, ``/healthz``
tells how the server is. A session's code is the only key to it, so it never leaves in a Referer.
"""

import gzip
import html
import json
import mimetypes
import re
import secrets
from collections.abc import Callable
from dataclasses import dataclass, replace
from http import HTTPStatus
from pathlib import Path
from types import MappingProxyType
from typing import Final
from urllib.parse import unquote, urlsplit

TITLE: Final = "gc-teach"
ICON: Final = (
    "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 32 32'%3E"
    "%3Cpath d='M3 24C10 24 10 9 29 8' fill='none' stroke='%23c9ced6' stroke-width='11'/%3E"
    "%3Cpath d='M3 24C10 24 10 9 29 8' fill='none' stroke='%231F3FA8' stroke-width='3'/%3E%3C/svg%3E"
)
PACKED_TYPES: Final = ("text/", "application/json", "application/javascript", "image/svg+xml")
SAFE: Final = MappingProxyType(
    {
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "no-referrer",
        "Content-Security-Policy": "frame-ancestors 'self'",
        "Cache-Control": "no-cache",
    }
)
COOKIE: Final = "gc_teach_opened"
REMEMBERED: Final = 365 * 24 * 3600
"""So long a browser remembers the codes that it opened [s]."""
MOST_OPENED: Final = 40
LOCAL: Final = ("localhost", "127.0.0.1", "[::1]")
LOOPBACK: Final = ("127.0.0.1", "::1")
FORWARDED: Final = ("Forwarded", "X-Forwarded-For", "X-Real-IP")
"""By one of these a proxy says that somebody else is behind it."""
NO_CODE: Final = """<!doctype html><html lang="en"><meta charset="utf-8"><title>{title}</title>
<meta name="viewport" content="width=device-width"><meta name="color-scheme" content="light dark">
<body style="font:1.1rem/1.5 system-ui,sans-serif;max-width:34rem;margin:15vh auto;padding:0 1rem">
<h1 style="font-size:1.4rem">There is no skill at this address</h1>
<p>What follows <b>/s/</b> cannot be the code of a skill: codes have 10 to 64 letters, digits,
hyphens and underscores. Part of the link was probably lost on the way; copy all of it.</p>
<p><a href="{up}">Begin with a new skill</a></p>
"""
_CODE = re.compile(r"[A-Za-z0-9_-]{10,64}")
_TYPES = MappingProxyType(
    {".js": "application/javascript", ".md": "text/markdown", ".glb": "model/gltf-binary"}
)


@dataclass(frozen=True)
class Reply:
    """One HTTP answer."""

    status: HTTPStatus
    body: bytes
    content_type: str = "text/plain; charset=utf-8"
    location: str | None = None
    packed: bytes | None = None
    """The body by gzip, when that was made beforehand."""
    opened: tuple[str, ...] = ()
    """Codes that the browser shall remember, the last opened first."""

    def headers(self, accept_encoding: str) -> tuple[dict[str, str], bytes]:
        """Headers and body for a client that accepts these encodings."""
        body, extra = self.body, dict(SAFE)
        if self.content_type.startswith(PACKED_TYPES) and len(body) > 500 and "gzip" in accept_encoding:
            body = gzip.compress(body) if self.packed is None else self.packed
            extra["Content-Encoding"] = "gzip"
        if self.location is not None:
            extra["Location"] = self.location
        if self.opened:
            value = ".".join(self.opened)
            extra["Set-Cookie"] = f"{COOKIE}={value}; Path=/; Max-Age={REMEMBERED}; HttpOnly; SameSite=Lax"
        known = {"Content-Type": self.content_type, "Content-Length": str(len(body))}
        return {**known, "Vary": "Accept-Encoding", **extra}, body


@dataclass(frozen=True)
class Site:
    """All that the HTTP side knows."""

    page: Reply
    static: Path
    """Folder of the files under ``/static/``, resolved."""
    health: Callable[[], dict[str, object]]
    new_code: Callable[[], str]


def fresh_code() -> str:
    """A new session code: 16 URL-safe characters, 96 random bits, so that none can be guessed."""
    return secrets.token_urlsafe(12)


def valid_code(text: str) -> bool:
    """Whether this could be a session's code: 10 to 64 of ``A-Z a-z 0-9 _ -``."""
    return _CODE.fullmatch(text) is not None


def code_in_path(path: str) -> str | None:
    """The session code in ``/s/<code>`` (a query is ignored), or None."""
    top, _, rest = urlsplit(path).path.lstrip("/").partition("/")
    code = rest.removesuffix("/")
    return code if top == "s" and valid_code(code) else None


def opened_codes(cookies: str) -> tuple[str, ...]:
    """The codes that a browser has opened, the last first, from its ``Cookie`` header."""
    for one in cookies.split(";"):
        name, _, value = one.strip().partition("=")
        if name == COOKIE:
            return tuple(code for code in value.split(".")[:MOST_OPENED] if valid_code(code))
    return ()


def is_local(host: str, peer: str) -> bool:
    """Whether a browser runs on the server's own machine.

    Parameters
    ----------
    host
        What its address bar shows, which another program can claim.
    peer
        Where its connection comes from, which is here for everybody behind a proxy.
    """
    return peer in LOOPBACK and (host.rpartition(":")[0] in LOCAL or host in LOCAL)


def same_origin(origin: str | None, host: str | None) -> bool:
    """Whether a websocket may be opened: its page came from this very host, or there is no page.

    A browser always sends the origin; another program need not, and could send what it likes anyway.
    """
    if origin is None:
        return True
    try:
        return host is not None and urlsplit(origin).netloc.lower() == host.lower() != ""
    except ValueError:
        return False


def make_page(index: str, style: str) -> Reply:
    """Make viser's page ours in name, icon and style.

    Parameters
    ----------
    index
        viser's index.html.
    style
        CSS; goes into the head.
    """
    head = f'<title>{html.escape(TITLE)}</title>\n    <style id="gc-teach">\n{style}\n</style>'
    titled = index.replace("<title>Viser</title>", head, 1)
    described = titled.replace('content="Viser client"', 'content="Teach a robot arm a motion"', 1)
    own_icon = re.sub(r'(<link\s+rel="icon"\s+href=")[^"]*"', lambda m: m[1] + ICON + '"', described, count=1)
    page = Reply(HTTPStatus.OK, own_icon.encode(), "text/html; charset=utf-8")
    return replace(page, packed=gzip.compress(page.body))


def gather_style(static: Path) -> str:
    """All of ``static/style/*.css`` in the order of their names."""
    return "\n".join(path.read_text(encoding="utf-8") for path in sorted((static / "style").glob("*.css")))


def answer(site: Site, target: str, cookies: str = "") -> Reply:
    """Answer one GET.

    Parameters
    ----------
    site
        What there is.
    target
        The request's path as it came, with its query.
    cookies
        Its ``Cookie`` header.
    """
    path = target.partition("?")[0]
    if path in ("/", "/index.html"):
        # Relative, so that it also holds behind a proxy that strips a prefix.
        return Reply(HTTPStatus.FOUND, b"", location=f"s/{site.new_code()}")
    if path == "/healthz":
        state = site.health()
        status = HTTPStatus.SERVICE_UNAVAILABLE if state.get("ok") is False else HTTPStatus.OK
        return Reply(status, json.dumps(state, default=str).encode(), "application/json")
    code = code_in_path(path)
    if code is not None:
        others = (one for one in opened_codes(cookies) if one != code)
        return replace(site.page, opened=(code, *others)[:MOST_OPENED])
    if path.startswith("/s/"):
        return _no_code(path.removeprefix("/s/"))
    if path.startswith("/static/"):
        return _file(site.static, unquote(path.removeprefix("/static/"), errors="replace"))
    return _not_found()


def _file(root: Path, relative: str) -> Reply:
    """A file under `root`; anything that could lead elsewhere is simply not there."""
    parts = relative.split("/")
    if any(not part or part.startswith(".") or "\\" in part or "\0" in part for part in parts):
        return _not_found()
    try:
        path = root.joinpath(*parts).resolve()
        if not path.is_relative_to(root) or not path.is_file():
            return _not_found()
        return Reply(HTTPStatus.OK, path.read_bytes(), _content_type(path))
    except OSError:  # e.g. a name longer than the file system allows
        return _not_found()


def _content_type(path: Path) -> str:
    kind = _TYPES.get(path.suffix) or mimetypes.guess_type(path.name)[0] or "application/octet-stream"
    return f"{kind}; charset=utf-8" if kind.startswith("text/") else kind


def _no_code(text: str) -> Reply:
    """Say that this cannot be a skill's address, and what to do."""
    body = NO_CODE.format(title=TITLE, up="../" * (text.count("/") + 1))
    return Reply(HTTPStatus.NOT_FOUND, body.encode(), "text/html; charset=utf-8")


def _not_found() -> Reply:
    return Reply(HTTPStatus.NOT_FOUND, b"There is nothing at this address. Start at /\n")
