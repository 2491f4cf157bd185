"""A repeated request with its key is done once, and answered the same."""

from __future__ import annotations

from collections.abc import AsyncIterator
from concurrent.futures import Future

import httpx
import pytest
import pytest_asyncio

from base_station.accounts.principals import Role
from base_station.api import services
from base_station.engine.ports import ActionResult
from shared.clock import ManualClock
from shared.messages.station import ReportProblem
from tests.rig.in_process_station import InProcessStation

EVACUATE = {"kind": "evacuate", "target": {"everyone": True}, "expires_s": 60}
PIN = {"unit_id": "FF-01", "north_m": 1.0, "east_m": 2.0}
KEY = {"Idempotency-Key": '"8e03978e-40d5-43dd-bc93-6894a57f9324"'}


@pytest_asyncio.fixture
async def commander(
    station: InProcessStation, clock: ManualClock
) -> AsyncIterator[httpx.AsyncClient]:
    """With a unit that somebody wears."""
    async with station.client(Role.COMMANDER) as client:
        person = (await client.post("/people", json={"name": "Ada", "crew": "A"})).json()
        await client.post("/units", json={"unit_id": "FF-01"})
        worn = {"unit_id": "FF-01", "person_id": person["person_id"]}
        assert (await client.post("/assignments", json=worn)).status_code == 204
        clock.advance(1.0)
        yield client


@pytest.mark.parametrize(
    ("path", "body", "listed"),
    [
        ("/commands", EVACUATE, "/commands"),
        ("/pins", PIN, "/pins"),
        ("/pins/start", {"unit_ids": ["FF-01"], "north_m": 1.0, "east_m": 2.0}, "/pins"),
        ("/incidents", {"name": "Kitchen"}, "/incidents"),
    ],
)
async def test_repeated_request_with_its_key_is_done_once(
    commander: httpx.AsyncClient, clock: ManualClock, path: str, body: object, listed: str
) -> None:
    first = await commander.post(path, json=body, headers=KEY)
    clock.advance(30.0)
    again = await commander.post(path, json=body, headers=KEY)
    assert (first.status_code, again.status_code) == (201, 201), again.text
    assert again.json() == first.json()
    assert len((await commander.get(listed)).json()) == 1


async def test_refused_request_is_refused_again_with_the_same_answer(
    commander: httpx.AsyncClient, clock: ManualClock
) -> None:
    rest = {"resting": True}
    first = await commander.put("/units/FF-01/rest", json=rest, headers=KEY)
    await commander.post("/incidents", json={"name": "Kitchen"})
    clock.advance(1.0)
    again = await commander.put("/units/FF-01/rest", json=rest, headers=KEY)
    assert (first.status_code, again.status_code) == (409, 409)
    assert again.json() == first.json()
    assert first.json()["code"] == "not-on-duty"
    assert first.json()["parameters"] == {"name": "Ada"}
    other = await commander.put("/units/FF-01/rest", json={"resting": False}, headers=KEY)
    assert other.status_code == 422, "it is told of itself, not of what was refused"
    anew = await commander.put("/units/FF-01/rest", json=rest, headers={"Idempotency-Key": "b"})
    assert anew.status_code == 204
    assert (await commander.put("/units/FF-01/rest", json=rest)).status_code == 409
    same = await commander.put("/units/FF-01/rest", json=rest, headers={"Idempotency-Key": "b"})
    assert same.status_code == 204


@pytest.mark.parametrize(
    ("path", "body"),
    [("/commands", EVACUATE | {"expires_s": 61}), ("/check-ins", {"target": {"everyone": True}})],
    ids=["another body", "another path"],
)
async def test_key_of_another_request_is_refused(
    commander: httpx.AsyncClient, path: str, body: object
) -> None:
    await commander.post("/commands", json=EVACUATE, headers=KEY)
    other = await commander.post(path, json=body, headers=KEY)
    assert other.status_code == 422
    assert "was not done: give every request a key of its own" in other.json()["detail"]
    assert len((await commander.get("/commands")).json()) == 1


async def test_same_body_for_another_object_is_another_request(
    station: InProcessStation, commander: httpx.AsyncClient
) -> None:
    station.drive.submit("station", ReportProblem("log", "It fails"))
    station.projection.flush()
    (alarm,) = (await commander.get("/alarms")).json()
    seen = {"last_raised_ms": alarm["last_raised_ms"]}
    path = f"/alarms/{alarm['alarm_id']}"
    for what, status in (("acknowledge", 204), ("resolve", 422), ("acknowledge", 204)):
        answer = await commander.post(f"{path}/{what}", json=seen, headers=KEY)
        assert answer.status_code == status
    assert (await commander.get(path)).json()["state"] == "acknowledged"


async def test_a_person_is_added_once(
    station: InProcessStation, commander: httpx.AsyncClient
) -> None:
    mia = {"name": "Mia", "crew": "A"}
    first = await commander.post("/people", json=mia, headers=KEY)
    assert first.status_code == 201, first.text
    path = f"/people/{first.json()['person_id']}"
    await commander.put(path, json={"name": "Mia B.", "crew": "A"})
    again = await commander.post("/people", json=mia, headers=KEY)
    assert again.json() == first.json() | {"name": "Mia B."}
    other = await commander.post("/people", json={"name": "Noa"}, headers=KEY)
    assert other.status_code == 422
    assert [one["name"] for one in (await commander.get("/people")).json()] == ["Ada", "Mia B."]
    async with station.client(Role.ADMINISTRATOR) as administrator:
        entries = (await administrator.get("/audit")).json()
    assert [one["action"] for one in entries].count("AddedPerson") == 2


async def test_repeated_rename_keeps_state_and_roster_consistent(
    station: InProcessStation, commander: httpx.AsyncClient, clock: ManualClock
) -> None:
    """To change is to say how it is to be: again is no second time, and may be later."""
    (ada,) = (await commander.get("/people")).json()
    path = f"/people/{ada['person_id']}"
    for name, headers in (("Bea", KEY), ("Cem", {}), ("Bea", KEY)):
        clock.advance(1.0)
        assert (await commander.put(path, json={"name": name}, headers=headers)).is_success
    (unit,) = station.drive.picture().units
    assert unit.person is not None
    assert (await commander.get(path)).json()["name"] == unit.person.name == "Bea"


async def test_keys_of_different_users_are_independent(
    station: InProcessStation, commander: httpx.AsyncClient
) -> None:
    mine = (await commander.post("/commands", json=EVACUATE, headers=KEY)).json()
    async with station.client(Role.ADMINISTRATOR) as another:
        theirs = (await another.post("/commands", json=EVACUATE, headers=KEY)).json()
    assert theirs["command_id"] != mine["command_id"]


async def test_quotes_are_not_part_of_the_key(commander: httpx.AsyncClient) -> None:
    first = await commander.post("/commands", json=EVACUATE, headers=KEY)
    bare = {"Idempotency-Key": KEY["Idempotency-Key"].strip('"')}
    assert (await commander.post("/commands", json=EVACUATE, headers=bare)).json() == first.json()


@pytest.mark.parametrize("key", ["", '""', "a b", "x" * 129, '"x'])
async def test_invalid_key_is_refused_with_a_reason(commander: httpx.AsyncClient, key: str) -> None:
    refused = await commander.post("/commands", json=EVACUATE, headers={"Idempotency-Key": key})
    assert refused.status_code == 422
    assert refused.json()["detail"].startswith("Idempotency-Key must be 1 to 128 letters")
    assert (await commander.get("/commands")).json() == []


async def test_timeout_with_a_key_advises_to_repeat_the_request(
    station: InProcessStation, commander: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    waiting: Future[ActionResult] = Future()
    monkeypatch.setattr(services, "ACTION_TIMEOUT_S", 0.0)
    monkeypatch.setattr(station.drive, "submit", lambda *_: waiting)
    answer = await commander.post("/commands", json=EVACUATE, headers=KEY)
    assert answer.status_code == 503
    assert "with the same Idempotency-Key it is done once" in answer.json()["detail"]


async def test_schema_describes_the_key_for_every_action(
    commander: httpx.AsyncClient,
) -> None:
    paths = (await commander.get("/openapi.json")).json()["paths"]
    with_key = {
        path.removeprefix("/api/v1")
        for path, methods in paths.items()
        if any(
            parameter["name"] == "Idempotency-Key"
            for parameter in methods.get("post", {}).get("parameters", ())
        )
    }
    assert with_key >= {
        "/alarms/{alarm_id}/acknowledge",
        "/alarms/{alarm_id}/resolve",
        "/assignments",
        "/check-ins",
        "/check-ins/{check_in_id}/undo",
        "/commands",
        "/commands/{command_id}/all-clear",
        "/commands/{command_id}/confirm",
        "/commands/{command_id}/confirm/undo",
        "/commands/{command_id}/repeat",
        "/commands/{command_id}/stop",
        "/incidents",
        "/incidents/{incident_id}/close",
        "/people",
        "/pins",
        "/pins/meeting",
        "/pins/start",
        "/units",
    }


async def test_outcome_of_a_key_can_be_queried(
    station: InProcessStation, commander: httpx.AsyncClient, clock: ManualClock
) -> None:
    path = "/idempotency-keys/8e03978e-40d5-43dd-bc93-6894a57f9324"
    assert (await commander.get(path)).status_code == 404
    assert (await commander.post("/commands", json=EVACUATE, headers=KEY)).status_code == 201
    carried_out = (await commander.get(path)).json()
    assert carried_out["action"] == "SendCommand"
    assert carried_out["t_ms"] == clock.utc_ns() // 1_000_000
    async with station.client(Role.ADMINISTRATOR) as other:
        assert (await other.get(path)).status_code == 404, "a key counts for who sent it"


async def test_key_of_a_refused_request_has_no_outcome(
    commander: httpx.AsyncClient,
) -> None:
    added, refused = {"Idempotency-Key": "k-added"}, {"Idempotency-Key": "k-refused"}
    assert (await commander.post("/people", json={"name": "Bo"}, headers=added)).is_success
    assert (await commander.get("/idempotency-keys/k-added")).json()["action"] == "AddedPerson"
    nowhere = {"unit_id": "FF-99", "person_id": "nobody"}
    answer = await commander.post("/assignments", json=nowhere, headers=refused)
    assert not answer.is_success
    assert (await commander.get("/idempotency-keys/k-refused")).status_code == 404
    assert (await commander.get("/idempotency-keys/%25")).status_code in (404, 422)
