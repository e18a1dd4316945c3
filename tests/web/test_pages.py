"""What the HTTP side answers."""

from __future__ import annotations

import gzip
import json
from http.client import HTTPConnection, RemoteDisconnected

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.pages import COOKIE, code_in_path, fresh_code, is_local, opened_codes, same_origin, valid_code
from tests.web.site import CODE, Site


def test_the_root_leads_to_a_fresh_session_each_time(site: Site) -> None:
    places = {site.get("/")[0].getheader("Location") for _ in range(5)}

    assert len(places) == 5
    assert all(code_in_path(f"/{place}") for place in places)
    assert site.get("/")[0].status == 302


def test_a_session_address_gives_the_page_under_our_name(site: Site) -> None:
    response, body = site.get(f"/s/{CODE}")

    assert response.status == 200
    assert response.getheader("Content-Type") == "text/html; charset=utf-8"
    assert b"<title>gc-teach</title>" in body
    assert b"<title>Viser</title>" not in body
    assert b"Viser client" not in body
    assert b"%231F3FA8" in body


def test_our_styles_are_in_the_page_in_the_order_of_their_names(site: Site) -> None:
    page = site.get(f"/s/{CODE}")[1].decode()

    assert 0 < page.index(".first { color: blue }") < page.index(".second { color: red }")


def test_the_page_is_packed_for_who_can_unpack_it(site: Site) -> None:
    plain = site.get(f"/s/{CODE}")[1]
    response, packed = site.get(f"/s/{CODE}", **{"Accept-Encoding": "gzip, br"})

    assert response.getheader("Content-Encoding") == "gzip"
    assert len(packed) < len(plain)
    assert gzip.decompress(packed) == plain


@pytest.mark.parametrize("path", ["/", f"/s/{CODE}", "/static/hello.txt", "/healthz", "/nothing"])
def test_every_reply_carries_the_safety_headers(site: Site, path: str) -> None:
    response = site.get(path)[0]

    assert response.getheader("X-Content-Type-Options") == "nosniff"
    assert response.getheader("Referrer-Policy") == "no-referrer"
    assert response.getheader("Cache-Control") == "no-cache"


def test_health_is_json_and_says_what_the_app_says(site: Site) -> None:
    response, body = site.get("/healthz")

    assert response.status == 200
    assert json.loads(body) == {"ok": True, "sessions": 3}


def test_a_static_file_is_served_with_its_type(site: Site) -> None:
    response, body = site.get("/static/style/a.css")

    assert (response.status, body) == (200, b".first { color: blue }")
    assert response.getheader("Content-Type") == "text/css; charset=utf-8"


@pytest.mark.parametrize(
    "path",
    [
        "/static/../secret.txt",
        "/static/%2e%2e/secret.txt",
        "/static/..%2fsecret.txt",
        "/static/%2e%2e%2fsecret.txt",
        "/static/style/../../secret.txt",
        "/static/..\\secret.txt",
        "/static/..%5csecret.txt",
        "/static//etc/passwd",
        "/static/%2fetc%2fpasswd",
        "/static/hello.txt%00",
        "/static/link.txt",
        "/static/.hidden",
        "/static/style",
        "/static/",
        "/static",
        f"/static/{'a' * 5000}",
        "/s/short",
        "/s/" + "a" * 65,
        f"/s/{CODE}/more",
        "/s/..%2f..%2fsecret",
        "/index.js",
    ],
)
def test_what_is_not_there_is_not_found_whatever_the_spelling(site: Site, path: str) -> None:
    response, body = site.get(path)

    assert response.status == 404
    assert b"secret" not in body


def test_a_code_that_cannot_be_one_is_a_page_that_says_what_to_do(site: Site) -> None:
    response, body = site.get("/s/short")

    assert response.status == 404
    assert b"There is no skill at this address" in body
    assert b'<a href="../">' in body


def test_a_browser_remembers_the_codes_that_it_opened_the_last_first(site: Site) -> None:
    first = site.get(f"/s/{CODE}")[0].getheader("Set-Cookie")
    second = site.get("/s/another-code-1", Cookie=f"x=1; {first.partition(';')[0]}")[0].getheader(
        "Set-Cookie"
    )

    assert opened_codes(second) == ("another-code-1", CODE)
    assert "HttpOnly; SameSite=Lax" in second
    assert site.get("/static/hello.txt")[0].getheader("Set-Cookie") is None


@pytest.mark.parametrize("cookies", ["", "x=1", f"{COOKIE}=", f"{COOKIE}=<script>.short.{'a' * 65}", "=;;="])
def test_a_cookie_that_was_tampered_with_names_no_codes(cookies: str) -> None:
    assert opened_codes(cookies) == ()


@pytest.mark.parametrize(
    ("host", "peer", "local"),
    [
        ("localhost:8080", "127.0.0.1", True),
        ("127.0.0.1", "127.0.0.1", True),
        ("[::1]:80", "::1", True),
        ("lab.example:8080", "127.0.0.1", False),
        ("localhost:8080", "192.168.0.7", False),
        ("localhost:8080", "", False),
        ("", "127.0.0.1", False),
    ],
)
def test_only_who_sits_at_the_server_sees_all_skills(host: str, peer: str, local: bool) -> None:
    assert is_local(host, peer) is local


def test_another_method_than_get_loses_its_connection_and_nothing_else(site: Site) -> None:
    connection = HTTPConnection("127.0.0.1", site.port, timeout=10)
    connection.request("POST", "/", body=b"x=1")

    with pytest.raises(RemoteDisconnected):
        connection.getresponse()
    assert site.alive()


def test_fresh_codes_are_valid_and_differ() -> None:
    codes = {fresh_code() for _ in range(1000)}

    assert len(codes) == 1000
    assert all(valid_code(code) for code in codes)


@given(st.text(max_size=80))
def test_a_code_has_only_characters_that_need_no_quoting(text: str) -> None:
    if valid_code(text):
        assert 10 <= len(text) <= 64
        assert text.isascii()
        assert all(c.isalnum() or c in "-_" for c in text)
        assert code_in_path(f"/s/{text}") == text


@pytest.mark.parametrize(
    ("origin", "host", "allowed"),
    [
        (None, "127.0.0.1:8080", True),
        ("http://127.0.0.1:8080", "127.0.0.1:8080", True),
        ("https://lab.example", "lab.example", True),
        ("http://LAB.example", "lab.example", True),
        ("http://evil.example", "127.0.0.1:8080", False),
        ("http://127.0.0.1:9999", "127.0.0.1:8080", False),
        ("null", "127.0.0.1:8080", False),
        ("", "127.0.0.1:8080", False),
        ("http://[", "127.0.0.1:8080", False),
        ("http://127.0.0.1:8080", None, False),
        ("null", "", False),
    ],
)
def test_a_websocket_may_come_only_from_the_servers_own_pages(
    origin: str | None, host: str | None, allowed: bool
) -> None:
    assert same_origin(origin, host) is allowed
