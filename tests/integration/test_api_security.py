"""Rights of users, and origins of requests."""

from __future__ import annotations

import dataclasses
import sqlite3
from pathlib import Path

import httpx
import pytest

from base_station.accounts.principals import Role
from base_station.api.app import create_app
from base_station.api.authentication import COOKIE
from base_station.storage.db.accounts import SESSION_S
from base_station.storage.db.window import EVER
from shared.clock import ManualClock
from tests.rig.in_process_station import ORIGIN, PASSWORD, InProcessStation


def shown(secret: str) -> dict[str, str]:
    """As the browser shows a cookie."""
    return {"cookie": f"{COOKIE}={secret}"}


# What each role may do at least; everything else of the API is in the OpenAPI test.
ROLES = [
    ("GET", "/people", None, Role.VIEWER),
    ("GET", "/health", None, Role.VIEWER),
    ("POST", "/people", {"name": "Ada"}, Role.COMMANDER),
    ("POST", "/units", {"unit_id": "FF-01"}, Role.COMMANDER),
    ("POST", "/incidents", {"name": "Kitchen"}, Role.COMMANDER),
    ("PUT", "/site/anchor", {"lat_deg": 1.0, "lon_deg": 2.0}, Role.COMMANDER),
    ("GET", "/users", None, Role.ADMINISTRATOR),
    ("GET", "/audit", None, Role.ADMINISTRATOR),
    (
        "POST",
        "/users",
        {"username": "mia", "password": PASSWORD, "role": "viewer"},
        Role.ADMINISTRATOR,
    ),
]


@pytest.mark.parametrize(("method", "path", "body", "least"), ROLES)
async def test_a_role_is_enforced(
    station: InProcessStation, method: str, path: str, body: dict[str, object] | None, least: Role
) -> None:
    for role in (None, *Role):
        async with station.client(role) as client:
            answer = await client.request(method, path, json=body)
        if role is None:
            assert answer.status_code == 401
        elif role < least:
            assert answer.status_code == 403
        else:
            assert answer.status_code not in (401, 403)


async def test_every_route_except_the_login_requires_a_login(station: InProcessStation) -> None:
    async with station.client() as client:
        document = (await client.get("/openapi.json")).json()
        open_paths = set()
        for path, operations in document["paths"].items():
            for method in operations:
                concrete = path.removeprefix("/api/v1")
                for name in ("person_id", "unit_id", "incident_id", "alarm_id", "replay_id"):
                    concrete = concrete.replace(f"{{{name}}}", "x")
                concrete = concrete.replace("{token_id}", "x").replace("{username}", "x")
                concrete = concrete.replace("{format_name}", "csv")
                answer = await client.request(method, concrete)
                if answer.status_code != 401:
                    open_paths.add((method, path, answer.status_code))
    assert open_paths == {
        ("post", "/api/v1/login", 422),
        ("post", "/api/v1/login/hand-over", 422),
        ("post", "/api/v1/logout", 204),
        ("get", "/api/v1/standby/leads", 200),  # asked by the other station's console
    }


async def test_cookie_is_restricted_to_the_station(station: InProcessStation) -> None:
    async with station.client() as client:
        answer = await client.post(
            "/login", json={"username": "viewer", "password": PASSWORD}, headers={"origin": ORIGIN}
        )
    cookie = answer.headers["set-cookie"].lower()
    assert "httponly" in cookie
    assert "samesite=strict" in cookie
    assert "secure" not in cookie
    station.app.state.services = dataclasses.replace(station.services, secure=True)
    async with station.client() as client:
        credentials = {"username": "viewer", "password": PASSWORD}
        answer = await client.post("/login", json=credentials)
    assert "secure" in answer.headers["set-cookie"].lower()


async def test_logins_and_refusals_are_in_the_audit_with_the_address(
    station: InProcessStation,
) -> None:
    async with station.client() as client:
        for password in ("guess", PASSWORD):
            await client.post("/login", json={"username": "viewer", "password": password})
    entries = station.services.records.audit_entries(EVER)
    assert [(one.by, one.action, one.detail) for one in entries] == [
        ("viewer", "LoggedIn", "127.0.0.1"), ("viewer", "LoginRefused", "127.0.0.1"),
    ]  # fmt: skip


async def test_request_of_another_origin_changes_nothing(browser: httpx.AsyncClient) -> None:
    for origin in ("http://evil.example", "null", "http://station.evil.example"):
        answer = await browser.post("/incidents", json={"name": "x"}, headers={"origin": origin})
        assert answer.status_code == 403
    del browser.headers["origin"]
    assert (await browser.post("/incidents", json={"name": "x"})).status_code == 403
    assert (await browser.get("/incidents")).json() == []


async def test_cookie_without_an_origin_changes_nothing_unless_with_a_token(
    station: InProcessStation, browser: httpx.AsyncClient
) -> None:
    made = (await browser.post("/tokens", json={"name": "t", "role": "viewer"})).json()
    del browser.headers["origin"]
    browser.headers["authorization"] = "Basic eDp4"  # which the cookie goes before
    assert (await browser.get("/me")).json()["role"] == "commander"
    assert (await browser.post("/logout")).status_code == 403
    browser.headers["authorization"] = f"Bearer {made['token']}"
    assert (await browser.get("/me")).json()["role"] == "viewer"
    renamed = await browser.post("/people", json={"name": "Ada"})
    assert "needs the role commander" in renamed.json()["detail"]
    assert (await browser.delete(f"/tokens/{made['token_id']}")).status_code == 204
    assert (await browser.get("/me")).status_code == 401  # and the cookie is good


async def test_session_expires(browser: httpx.AsyncClient, clock: ManualClock) -> None:
    me = (await browser.get("/me")).json()
    assert me == {"username": "commander", "role": "commander", "must_change_password": False}
    clock.advance(SESSION_S - 1.0)
    assert (await browser.get("/me")).status_code == 200
    clock.advance(1.0)
    assert (await browser.get("/me")).status_code == 401


async def test_logging_out_ends_the_session_at_the_station(browser: httpx.AsyncClient) -> None:
    secret = browser.cookies[COOKIE]
    assert (await browser.get("/me", headers=shown(secret))).status_code == 200
    assert (await browser.post("/logout")).status_code == 204
    assert (await browser.get("/me", headers=shown(secret))).status_code == 401


async def test_secrets_are_not_in_the_database(browser: httpx.AsyncClient, tmp_path: Path) -> None:
    made = (await browser.post("/tokens", json={"name": "t", "role": "viewer"})).json()
    secrets = (browser.cookies[COOKIE], made["token"], PASSWORD)
    connection = sqlite3.connect(tmp_path / "station.sqlite")
    dump = "\n".join(connection.iterdump())
    connection.close()
    assert "argon2id" in dump
    assert not any(secret in dump for secret in secrets)


async def test_expired_sessions_and_tickets_are_deleted(
    station: InProcessStation, browser: httpx.AsyncClient, clock: ManualClock, tmp_path: Path
) -> None:
    def kept() -> list[int]:
        connection = sqlite3.connect(tmp_path / "station.sqlite")
        tables = ("sessions", "hand_overs")
        counts = [connection.execute(f"SELECT count(*) FROM {one}").fetchone()[0] for one in tables]
        connection.close()
        return counts

    await browser.post("/hand-over")
    clock.advance(601.0)
    await browser.post("/hand-over")
    assert kept() == [1, 1]
    clock.advance(SESSION_S)
    assert station.services.accounts.log_in("viewer", PASSWORD) is not None
    assert kept() == [1, 0]


async def test_security_headers_are_on_every_answer(station: InProcessStation) -> None:
    async with station.client() as client:
        for path in ("/me", "/nothing", f"{ORIGIN}/", f"{ORIGIN}/nothing"):
            headers = (await client.get(path)).headers
            assert headers["content-security-policy"].startswith("default-src 'self'")
            assert "frame-ancestors 'none'" in headers["content-security-policy"]
            assert headers["x-content-type-options"] == "nosniff"
            assert headers["x-frame-options"] == "DENY"
            assert headers["cross-origin-resource-policy"] == "same-origin"
            assert headers["referrer-policy"] == "no-referrer"
            assert "strict-transport-security" not in headers
        assert (await client.get("/me")).headers["cache-control"] == "no-store"


async def test_tls_answers_have_strict_transport_security(station: InProcessStation) -> None:
    services = dataclasses.replace(station.services, secure=True)
    app = create_app(services, started=lambda _: None)
    transport = httpx.ASGITransport(app)
    async with httpx.AsyncClient(transport=transport, base_url=ORIGIN) as client:
        answer = await client.get("/api/v1/me")
    assert answer.headers["strict-transport-security"] == "max-age=31536000"


async def test_login_ends_the_previous_session_of_the_browser(
    browser: httpx.AsyncClient,
) -> None:
    before = browser.cookies[COOKIE]
    credentials = {"username": "viewer", "password": PASSWORD}
    assert (await browser.post("/login", json=credentials)).status_code == 200
    after = browser.cookies[COOKIE]
    assert after != before  # nobody chooses another's session
    browser.cookies.clear()
    assert (await browser.get("/me", headers=shown(after))).json()["role"] == "viewer"
    assert (await browser.get("/me", headers=shown(before))).status_code == 401


async def test_page_of_a_plain_origin_changes_nothing_over_tls(
    station: InProcessStation, browser: httpx.AsyncClient
) -> None:
    station.app.state.services = dataclasses.replace(station.services, secure=True)
    assert (await browser.post("/logout")).status_code == 403
    ours = {"origin": ORIGIN.replace("http:", "https:")}
    assert (await browser.post("/logout", headers=ours)).status_code == 204


async def test_own_page_behind_a_tls_proxy_is_accepted(
    browser: httpx.AsyncClient,
) -> None:
    ours = {"origin": ORIGIN.replace("http:", "https:")}
    assert (await browser.post("/logout", headers=ours)).status_code == 204


async def test_login_is_transferred_to_the_other_station_by_a_single_use_ticket(
    station: InProcessStation, browser: httpx.AsyncClient
) -> None:
    ticket = (await browser.post("/hand-over")).json()["ticket"]
    async with station.client() as there:
        there.headers["origin"] = ORIGIN
        shown = {"ticket": ticket}
        answer = await there.post("/login/hand-over", json=shown, headers={"origin": "http://x"})
        assert answer.status_code == 403
        assert (await there.post("/login/hand-over", json=shown)).json()["username"] == "commander"
        assert (await there.get("/me")).json()["role"] == "commander"
        assert (await there.post("/login/hand-over", json=shown)).status_code == 401
    async with station.client(Role.COMMANDER) as program:  # its token is known there anyhow
        assert (await program.post("/hand-over")).status_code == 403


async def test_a_login_lasts_half_a_day_and_a_ticket_ten_minutes(
    browser: httpx.AsyncClient, station: InProcessStation, clock: ManualClock
) -> None:
    accounts = station.services.accounts
    answer = await browser.post("/login", json={"username": "viewer", "password": PASSWORD})
    assert "max-age=43200" in answer.headers["set-cookie"].lower()
    late, in_time = [(await browser.post("/hand-over")).json() for _ in range(2)]
    assert late["lasts_s"] == 600
    clock.advance(599.0)
    assert accounts.redeem_login_ticket(in_time["ticket"]) is not None
    clock.advance(1.0)
    assert accounts.redeem_login_ticket(late["ticket"]) is None
    clock.advance(43_199.0 - 600.0)
    assert (await browser.get("/me")).status_code == 200
    clock.advance(1.0)
    assert (await browser.get("/me")).status_code == 401
