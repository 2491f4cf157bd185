"""The generated first password allows only the choice of another one."""

from __future__ import annotations

import dataclasses

import httpx
import pytest

from base_station.accounts.principals import Role
from tests.rig.api_addresses import addresses
from tests.rig.in_process_station import ORIGIN, InProcessStation

GENERATED, OWN = "1a2b-3c4d-5e6f", "correct horse battery"
LOGIN = {"username": "first", "password": GENERATED}
STILL = {"POST /login", "POST /login/hand-over", "POST /logout", "POST /hand-over", "GET /me",
         "POST /me/password", "GET /standby/leads"}  # fmt: skip


@pytest.fixture
def first(station: InProcessStation) -> InProcessStation:
    accounts = station.services.accounts
    accounts.add_user("first", GENERATED, Role.ADMINISTRATOR, generated=True)
    return station


async def log_in(client: httpx.AsyncClient, password: str = GENERATED) -> bool:
    """Logs in; true if the password must be changed."""
    client.headers["origin"] = ORIGIN
    answer = await client.post("/login", json=LOGIN | {"password": password})
    assert answer.status_code == 200, answer.text
    return bool(answer.json()["must_change_password"])


async def test_requests_before_the_password_change_are_refused(first: InProcessStation) -> None:
    async with first.client() as client:
        assert await log_in(client)
        for method, path in addresses():
            if f"{method} {path}" in STILL:
                continue
            answer = await client.request(method, path)
            refused = answer.status_code == 403 and "Change your password" in answer.text
            assert refused, (method, path, answer.text)
        assert (await client.get("/me")).json()["must_change_password"] is True


async def test_session_continues_after_the_password_change(first: InProcessStation) -> None:
    async with first.client() as client:
        assert await log_in(client)
        same = {"old_password": GENERATED, "new_password": GENERATED}
        assert (await client.post("/me/password", json=same)).status_code == 422
        change = {"old_password": GENERATED, "new_password": OWN}
        assert (await client.post("/me/password", json=change)).status_code == 204
        assert (await client.get("/me")).json()["must_change_password"] is False
        assert (await client.get("/users")).status_code == 200
        assert (await client.post("/login", json=LOGIN)).status_code == 401
    async with first.client() as other:
        assert not await log_in(other, OWN)


async def test_tokens_and_other_users_need_no_password_change(first: InProcessStation) -> None:
    async with first.client(Role.ADMINISTRATOR) as program:
        assert (await program.get("/users")).status_code == 200
    _, secret = first.services.accounts.add_token("first", "t", Role.ADMINISTRATOR, None)
    async with first.client() as program:
        program.headers["authorization"] = f"Bearer {secret}"
        assert (await program.get("/users")).status_code == 200


async def test_replay_station_requires_no_password_change(first: InProcessStation) -> None:
    """It could not keep it."""
    services = dataclasses.replace(first.services, is_replay_only=True)
    first.app.state.services = services
    async with first.client() as client:
        assert not await log_in(client)
        assert (await client.get("/replays")).status_code == 200
