"""Users: valid accounts, and sessions that end with a new password or role."""

from __future__ import annotations

from urllib.parse import quote

import httpx
import pytest

from base_station.accounts.principals import Role
from base_station.storage.db.window import EVER
from shared.errors import UserError
from tests.rig.in_process_station import ORIGIN, PASSWORD, InProcessStation


@pytest.mark.parametrize("username", ["Zoë O'Neil", "a#b?c%2Fd&e", "x" * 80, "50 %"])
async def test_every_user_that_can_be_made_can_log_in_and_be_removed(
    station: InProcessStation, username: str
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
def test_user_name_unusable_for_login_or_address_is_refused(
    station: InProcessStation, username: str
) -> None:
    accounts = station.services.accounts
    with pytest.raises(UserError, match="user's name is"):
        accounts.add_user(username, PASSWORD, Role.VIEWER)


def test_password_unusable_for_login_is_refused(station: InProcessStation) -> None:
    accounts = station.services.accounts
    accounts.change_user("viewer", "x" * 256, None)
    assert accounts.log_in("viewer", "x" * 256) is not None
    for password, problem in (("x" * 257, "at most 256"), ("x" * 9, "at least 10")):
        with pytest.raises(UserError, match=problem):
            accounts.change_user("viewer", password, None)


async def test_an_administrator_ends_sessions(
    station: InProcessStation, browser: httpx.AsyncClient
) -> None:
    async with station.client(Role.ADMINISTRATOR) as administrator:
        users = {user["username"]: user for user in (await administrator.get("/users")).json()}
        assert users["commander"]["sessions"] == 1
        assert (await administrator.delete("/users/commander/sessions")).status_code == 204
        assert (await administrator.delete("/users/nobody/sessions")).status_code == 409
    assert (await browser.get("/me")).status_code == 401


async def test_only_administrator_cannot_be_removed(station: InProcessStation) -> None:
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


async def test_new_password_ends_other_sessions(
    station: InProcessStation, browser: httpx.AsyncClient
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


async def test_new_password_ends_the_tokens_and_a_new_role_does_not(
    station: InProcessStation,
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


async def test_new_role_ends_sessions_and_limits_tokens(
    station: InProcessStation, browser: httpx.AsyncClient
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
