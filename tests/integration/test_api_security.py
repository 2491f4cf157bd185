"""Who may do what, and from where."""

from __future__ import annotations

import dataclasses
import sqlite3
from collections.abc import AsyncIterator
from pathlib import Path
from urllib.parse import quote

import httpx
import pytest
import pytest_asyncio

from base_station.accounts.principals import Role
from base_station.api.app import create_app
from base_station.api.routes import ROUTERS
from base_station.api.security import COOKIE, Scope
from base_station.db.accounts import MOST_TOKENS, SESSION_S
from base_station.db.records import EVER
from shared.clock import NS_PER_S, ManualClock
from shared.errors import UserError
from tests.station import ORIGIN, PASSWORD, DeskStation


@pytest_asyncio.fixture
async def browser(station: DeskStation) -> AsyncIterator[httpx.AsyncClient]:
    """Logged in as the commander with a cookie."""
    async with station.client() as client:
        client.headers["origin"] = ORIGIN
        credentials = {"username": "commander", "password": PASSWORD}
        answer = await client.post("/login", json=credentials)
        assert answer.status_code == 200, answer.text
        yield client


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
    station: DeskStation, method: str, path: str, body: dict[str, object] | None, least: Role
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


async def test_every_route_but_the_login_wants_a_login(station: DeskStation) -> None:
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


async def test_the_cookie_is_for_the_station_alone(station: DeskStation) -> None:
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


async def test_who_logs_in_and_who_is_refused_is_in_the_audit_with_the_place(
    station: DeskStation,
) -> None:
    async with station.client() as client:
        for password in ("guess", PASSWORD):
            await client.post("/login", json={"username": "viewer", "password": password})
    entries = station.services.records.audit_entries(EVER)
    assert [(one.by, one.action, one.detail) for one in entries] == [
        ("viewer", "LoggedIn", "127.0.0.1"), ("viewer", "LoginRefused", "127.0.0.1"),
    ]  # fmt: skip


async def test_another_site_changes_nothing(browser: httpx.AsyncClient) -> None:
    for origin in ("http://evil.example", "null", "http://station.evil.example"):
        answer = await browser.post("/incidents", json={"name": "x"}, headers={"origin": origin})
        assert answer.status_code == 403
    del browser.headers["origin"]
    assert (await browser.post("/incidents", json={"name": "x"})).status_code == 403
    assert (await browser.get("/incidents")).json() == []


async def test_a_cookie_changes_nothing_without_an_origin_but_beside_a_token(
    station: DeskStation, browser: httpx.AsyncClient
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


async def test_a_session_ends(browser: httpx.AsyncClient, clock: ManualClock) -> None:
    assert (await browser.get("/me")).json() == {"username": "commander", "role": "commander"}
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


async def test_a_token_may_do_no_more_than_its_maker(
    station: DeskStation, browser: httpx.AsyncClient
) -> None:
    higher = {"name": "t", "role": "administrator"}
    assert (await browser.post("/tokens", json=higher)).status_code == 403
    made = (await browser.post("/tokens", json={"name": "t", "role": "viewer", "days": 1})).json()
    async with station.client() as program:
        program.headers["authorization"] = f"Bearer {made['token']}"
        assert (await program.get("/me")).json()["role"] == "viewer"
        assert (await program.post("/people", json={"name": "Ada"})).status_code == 403
        assert (await browser.delete(f"/tokens/{made['token_id']}")).status_code == 204
        assert (await program.get("/me")).status_code == 401


async def test_a_token_is_its_owners_to_see_and_to_remove(
    station: DeskStation, browser: httpx.AsyncClient
) -> None:
    made = (await browser.post("/tokens", json={"name": "t", "role": "viewer"})).json()
    async with station.client(Role.ADMINISTRATOR) as other:
        assert made["token_id"] not in {
            one["token_id"] for one in (await other.get("/tokens")).json()
        }
        assert (await other.delete(f"/tokens/{made['token_id']}")).status_code == 404
    assert [one["token_id"] for one in (await browser.get("/tokens")).json()] == [made["token_id"]]


def test_a_user_has_only_so_many_tokens_and_those_that_have_ended_go(
    station: DeskStation, clock: ManualClock
) -> None:
    accounts = station.services.accounts
    soon_ns = clock.utc_ns() + NS_PER_S
    for number in range(MOST_TOKENS):
        accounts.add_token("viewer", f"t{number}", Role.VIEWER, soon_ns if number == 7 else None)
    with pytest.raises(UserError, match="100 tokens"):
        accounts.add_token("viewer", "one more", Role.VIEWER, None)
    accounts.add_token("commander", "another's", Role.VIEWER, None)
    clock.advance(1.0)
    accounts.add_token("viewer", "one more", Role.VIEWER, None)
    names = [token.name for token in accounts.tokens("viewer")]
    assert len(names) == MOST_TOKENS
    assert "t7" not in names


async def test_what_is_over_is_not_kept(
    station: DeskStation, browser: httpx.AsyncClient, clock: ManualClock, tmp_path: Path
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


async def test_security_headers_are_on_every_answer(station: DeskStation) -> None:
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


async def test_over_tls_browsers_are_told_to_stay_with_it(station: DeskStation) -> None:
    services = dataclasses.replace(station.services, secure=True)
    app = create_app(services, started=lambda _: None)
    transport = httpx.ASGITransport(app)
    async with httpx.AsyncClient(transport=transport, base_url=ORIGIN) as client:
        answer = await client.get("/api/v1/me")
    assert answer.headers["strict-transport-security"] == "max-age=31536000"


async def test_a_login_ends_the_one_before_it_in_the_same_browser(
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


async def test_a_new_password_ends_the_logins_elsewhere(
    station: DeskStation, browser: httpx.AsyncClient
) -> None:
    async with station.client() as elsewhere:
        credentials = {"username": "commander", "password": PASSWORD}
        assert (await elsewhere.post("/login", json=credentials)).status_code == 200
        changed = {"old_password": "wrong", "new_password": f"{PASSWORD} 2"}
        assert (await browser.post("/me/password", json=changed)).status_code == 403
        tried = station.services.records.audit_entries(EVER)[0]
        assert (tried.by, tried.action) == ("commander", "PasswordRefused")
        assert (await elsewhere.get("/me")).status_code == 200
        changed["old_password"] = PASSWORD
        assert (await browser.post("/me/password", json=changed)).status_code == 204
        assert (await elsewhere.get("/me")).status_code == 401
        assert (await browser.get("/me")).status_code == 401


async def test_over_tls_a_page_that_came_in_the_clear_changes_nothing(
    station: DeskStation, browser: httpx.AsyncClient
) -> None:
    station.app.state.services = dataclasses.replace(station.services, secure=True)
    assert (await browser.post("/logout")).status_code == 403
    ours = {"origin": ORIGIN.replace("http:", "https:")}
    assert (await browser.post("/logout", headers=ours)).status_code == 204


async def test_behind_a_proxy_that_serves_tls_the_stations_own_page_changes_things(
    browser: httpx.AsyncClient,
) -> None:
    ours = {"origin": ORIGIN.replace("http:", "https:")}
    assert (await browser.post("/logout", headers=ours)).status_code == 204


async def test_a_login_goes_on_at_the_other_station_with_a_ticket_and_once(
    station: DeskStation, browser: httpx.AsyncClient
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


async def test_a_token_reaches_only_what_it_is_for(
    station: DeskStation, browser: httpx.AsyncClient
) -> None:
    wanted = {"name": "dispatch", "role": "commander", "scopes": ["incidents", "tokens"]}
    made = (await browser.post("/tokens", json=wanted)).json()
    async with station.client() as program:
        program.headers["authorization"] = f"Bearer {made['token']}"
        assert (await program.get("/me")).status_code == 200
        assert (await program.get("/incidents")).status_code == 200
        refused = await program.get("/people")
        assert refused.status_code == 403
        assert "incidents" in refused.json()["detail"]
        wider = {"name": "more", "role": "viewer"}
        assert (await program.post("/tokens", json=wider)).status_code == 403
        wider["scopes"] = "people"
        assert (await program.post("/tokens", json=wider)).status_code == 422
        narrower = {"name": "less", "role": "viewer", "scopes": ["incidents"]}
        assert (await program.post("/tokens", json=narrower)).status_code == 201


async def test_a_token_makes_none_that_outlasts_it(
    station: DeskStation, browser: httpx.AsyncClient, clock: ManualClock
) -> None:
    lent = {"name": "lent", "role": "viewer", "days": 2}
    made = (await browser.post("/tokens", json=lent)).json()
    async with station.client() as program:
        program.headers["authorization"] = f"Bearer {made['token']}"
        for days in (None, 3):
            wanted = {"name": "longer", "role": "viewer", "days": days}
            answer = await program.post("/tokens", json=wanted)
            assert answer.status_code == 403
            assert "outlasts" in answer.json()["detail"]
        clock.advance(86_400.0)
        wanted = {"name": "as long", "role": "viewer", "days": 1}
        heir = (await program.post("/tokens", json=wanted)).json()
        program.headers["authorization"] = f"Bearer {heir['token']}"
        clock.advance(86_399.0)
        assert (await program.get("/me")).status_code == 200
        clock.advance(1.0)
        assert (await program.get("/me")).status_code == 401


def test_a_token_can_be_for_every_part_of_the_api() -> None:
    tags = {tag for router in ROUTERS for tag in router.tags}
    assert tags - {"login"} <= {scope.value for scope in Scope}


@pytest.mark.parametrize("username", ["Zoë O'Neil", "a#b?c%2Fd&e", "x" * 80, "50 %"])
async def test_every_user_that_can_be_made_can_log_in_and_be_removed(
    station: DeskStation, username: str
) -> None:
    async with station.client(Role.ADMINISTRATOR) as administrator, station.client() as client:
        new = {"username": username, "password": PASSWORD, "role": "viewer"}
        assert (await administrator.post("/users", json=new)).status_code == 204
        credentials = {"username": username, "password": PASSWORD}
        answer = await client.post("/login", json=credentials, headers={"origin": ORIGIN})
        assert answer.status_code == 200
        path = f"/users/{quote(username, safe='')}"
        assert (await administrator.delete(f"{path}/sessions")).status_code == 204
        assert (await client.get("/me")).status_code == 401
        assert (await administrator.put(path, json={"role": "commander"})).status_code == 204
        assert (await administrator.delete(path)).status_code == 204


@pytest.mark.parametrize(
    "username", ["", " ", "day/night", ".", "..", "a\nb", "a\x7fb", "a\u202eb", "x" * 81, "\udcff"]
)
def test_nobody_is_made_whom_no_login_and_no_address_can_name(
    station: DeskStation, username: str
) -> None:
    accounts = station.services.accounts
    with pytest.raises(UserError, match="user's name is"):
        accounts.add_user(username, PASSWORD, Role.VIEWER)


def test_no_password_is_kept_that_no_login_takes(station: DeskStation) -> None:
    accounts = station.services.accounts
    accounts.change_user("viewer", "x" * 256, None)
    assert accounts.log_in("viewer", "x" * 256) is not None
    for password, problem in (("x" * 257, "at most 256"), ("x" * 9, "at least 10")):
        with pytest.raises(UserError, match=problem):
            accounts.change_user("viewer", password, None)


async def test_an_administrator_ends_sessions(
    station: DeskStation, browser: httpx.AsyncClient
) -> None:
    async with station.client(Role.ADMINISTRATOR) as administrator:
        users = {user["username"]: user for user in (await administrator.get("/users")).json()}
        assert users["commander"]["sessions"] == 1
        assert (await administrator.delete("/users/commander/sessions")).status_code == 204
        assert (await administrator.delete("/users/nobody/sessions")).status_code == 409
    assert (await browser.get("/me")).status_code == 401


async def test_the_only_administrator_stays_one(station: DeskStation) -> None:
    async with station.client(Role.ADMINISTRATOR) as administrator:
        path = "/users/administrator"
        lower = await administrator.put(path, json={"role": "commander"})
        for answer in (lower, await administrator.delete(path)):
            assert answer.status_code == 409
            assert "the only administrator" in answer.json()["detail"]
        same = {"role": "administrator"}
        assert (await administrator.put(path, json=same)).status_code == 204
        assert (await administrator.put("/users/viewer", json=same)).status_code == 204
        assert (await administrator.put(path, json={"role": "commander"})).status_code == 204
        assert (await administrator.get("/users")).status_code == 403
        users = {one.username: one.role for one in station.services.accounts.users()}
        assert users["administrator"] == "commander"


async def test_a_new_password_ends_the_tokens_and_another_role_does_not(
    station: DeskStation,
) -> None:
    async with (
        station.client(Role.ADMINISTRATOR) as administrator,
        station.client(Role.COMMANDER) as program,
        station.client(Role.VIEWER) as other,
    ):
        change = {"role": "viewer"}
        assert (await administrator.put("/users/commander", json=change)).status_code == 204
        assert (await program.get("/me")).status_code == 200
        change = {"password": f"{PASSWORD} 2"}
        assert (await administrator.put("/users/commander", json=change)).status_code == 204
        assert (await program.get("/me")).status_code == 401
        assert (await other.get("/me")).status_code == 200


async def test_a_login_lasts_half_a_day_and_a_ticket_ten_minutes(
    browser: httpx.AsyncClient, station: DeskStation, clock: ManualClock
) -> None:
    accounts = station.services.accounts
    answer = await browser.post("/login", json={"username": "viewer", "password": PASSWORD})
    assert "max-age=43200" in answer.headers["set-cookie"].lower()
    late, in_time = [(await browser.post("/hand-over")).json() for _ in range(2)]
    assert late["lasts_s"] == 600
    clock.advance(599.0)
    assert accounts.take_over(in_time["ticket"]) is not None
    clock.advance(1.0)
    assert accounts.take_over(late["ticket"]) is None
    clock.advance(43_199.0 - 600.0)
    assert (await browser.get("/me")).status_code == 200
    clock.advance(1.0)
    assert (await browser.get("/me")).status_code == 401


async def test_another_role_ends_the_logins_and_binds_the_tokens(
    station: DeskStation, browser: httpx.AsyncClient
) -> None:
    token = (await browser.post("/tokens", json={"name": "t", "role": "commander"})).json()["token"]
    async with (
        station.client(Role.ADMINISTRATOR) as administrator,
        station.client() as program,
    ):
        program.headers["authorization"] = f"Bearer {token}"
        same = {"role": "commander"}
        assert (await administrator.put("/users/commander", json=same)).status_code == 204
        assert (await browser.get("/me")).status_code == 200
        lower = {"role": "viewer"}
        assert (await administrator.put("/users/commander", json=lower)).status_code == 204
        assert (await browser.get("/me")).status_code == 401
        assert (await program.get("/me")).json()["role"] == "viewer"
        assert (await program.post("/people", json={"name": "Ada"})).status_code == 403
