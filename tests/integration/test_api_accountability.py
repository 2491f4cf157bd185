"""The roll call by way of the API: who is on duty, who is overdue, and who may tick off."""

from __future__ import annotations

import dataclasses

import pytest
from httpx import AsyncClient

from base_station.accounts.principals import Role
from base_station.config import AccountabilityConfig
from shared.clock import ManualClock
from shared.messages import STATION_ID, Header, Tick
from tests.station import DeskStation

pytestmark = pytest.mark.usefixtures("consoles")


def pass_time(station: DeskStation, clock: ManualClock, time_s: float) -> None:
    clock.advance(time_s)
    station.drive.hear(Tick(Header(STATION_ID, 1, 1, 0), clock.utc_ns()))


async def open_incident(commander: AsyncClient) -> str:
    for unit_id, crew in (("FF-01", "A"), ("FF-02", "B")):
        person = (await commander.post("/people", json={"name": unit_id, "crew": crew})).json()
        await commander.post("/units", json={"unit_id": unit_id})
        worn = {"unit_id": unit_id, "person_id": person["person_id"]}
        assert (await commander.post("/assignments", json=worn)).status_code == 204
    new = {"name": "Kitchen", "par_interval_s": 600}
    return str((await commander.post("/incidents", json=new)).json()["incident_id"])


async def states(client: AsyncClient) -> dict[str, str]:
    return {one["unit_id"]: one["state"] for one in (await client.get("/accountability")).json()}


async def test_green_warning_overdue_and_ticked_off(
    station: DeskStation, clock: ManualClock
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        incident_id = await open_incident(commander)
        assert await states(commander) == {"FF-01": "green", "FF-02": "green"}
        pass_time(station, clock, 500.0)
        crew = {"target": {"crew": "A"}}
        assert (await commander.post("/check-ins", json=crew)).status_code == 204
        assert await states(commander) == {"FF-02": "warning", "FF-01": "green"}
        pass_time(station, clock, 101.0)
        times = {"par_interval_s": 650, "work_limit_s": 2400}
        path = f"/incidents/{incident_id}/accountability"
        assert await states(commander) == {"FF-02": "overdue", "FF-01": "green"}
        assert (await commander.put(path, json=times)).status_code == 204
        assert await states(commander) == {"FF-02": "warning", "FF-01": "green"}
        everyone = {"target": {"everyone": True}}
        assert (await commander.post("/check-ins", json=everyone)).status_code == 204
        (one, _) = (await commander.get("/accountability")).json()
        assert (one["state"], one["checked_in_by"], one["left_s"]) == ("green", "commander", 650.0)
        rest = {"resting": True}
        assert (await commander.put("/units/FF-01/rest", json=rest)).status_code == 204
        assert (await commander.put("/units/FF-01/rest", json=rest)).status_code == 409
        await commander.post(f"/incidents/{incident_id}/close")
        assert await states(commander) == {}
        assert (await commander.put(path, json=times)).status_code == 404
        assert (await commander.post("/check-ins", json=everyone)).status_code == 409


async def test_an_incident_begins_with_the_times_of_the_station(station: DeskStation) -> None:
    usual = {"par_interval_s": 900.0, "work_limit_s": 1500.0}
    station.app.state.services = dataclasses.replace(
        station.services, accountability=AccountabilityConfig(**usual)
    )
    async with station.client(Role.COMMANDER) as commander:
        assert (await commander.get("/accountability/usual")).json() == usual
        opened = await commander.post("/incidents", json={"name": "Kitchen", "work_limit_s": 60.0})
    assert opened.status_code == 201
    incident = station.drive.picture().incident
    assert incident is not None
    assert (incident.par_interval_s, incident.work_limit_s) == (900.0, 60.0)


@pytest.mark.parametrize(
    ("method", "path", "body"),
    [
        ("POST", "/check-ins", {"target": {"everyone": True}}),
        ("PUT", "/units/FF-01/rest", {"resting": True}),
        ("PUT", "/incidents/i/accountability", {"par_interval_s": 600, "work_limit_s": 600}),
    ],
)
async def test_a_viewer_vouches_for_nobody(
    station: DeskStation, method: str, path: str, body: dict[str, object]
) -> None:
    async with station.client(Role.VIEWER) as viewer:
        assert (await viewer.request(method, path, json=body)).status_code == 403


async def test_a_check_in_is_in_the_audit(station: DeskStation) -> None:
    async with station.client(Role.COMMANDER) as commander:
        await open_incident(commander)
        await commander.post("/check-ins", json={"target": {"everyone": True}})
    async with station.client(Role.ADMINISTRATOR) as administrator:
        entries = (await administrator.get("/audit")).json()
    assert "CheckIn" in {entry["action"] for entry in entries}
