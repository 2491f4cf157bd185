"""Tokens of programs: scopes, expiry, and owner."""

from __future__ import annotations

import httpx
import pytest

from base_station.accounts.principals import Role
from base_station.api.authentication import Scope
from base_station.api.routes import ROUTERS
from base_station.storage.db.accounts import MOST_TOKENS
from shared.clock import NS_PER_S, ManualClock
from shared.errors import UserError
from tests.rig.in_process_station import InProcessStation


async def test_token_has_no_more_rights_than_its_maker(
    station: InProcessStation, browser: httpx.AsyncClient
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


async def test_token_is_listed_and_removed_by_its_owner_only(
    station: InProcessStation, browser: httpx.AsyncClient
) -> None:
    made = (await browser.post("/tokens", json={"name": "t", "role": "viewer"})).json()
    async with station.client(Role.ADMINISTRATOR) as other:
        assert made["token_id"] not in {
            one["token_id"] for one in (await other.get("/tokens")).json()
        }
        assert (await other.delete(f"/tokens/{made['token_id']}")).status_code == 404
    assert [one["token_id"] for one in (await browser.get("/tokens")).json()] == [made["token_id"]]


def test_tokens_of_a_user_are_limited_and_expired_ones_removed(
    station: InProcessStation, clock: ManualClock
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


async def test_token_is_limited_to_its_scope(
    station: InProcessStation, browser: httpx.AsyncClient
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


async def test_token_creates_none_that_outlasts_it(
    station: InProcessStation, browser: httpx.AsyncClient, clock: ManualClock
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
