"""The roll call over the API: members on duty, overdue ones, and rights to confirm."""

from __future__ import annotations

import dataclasses

import pytest
from httpx import AsyncClient

from base_station.accounts.principals import Role
from base_station.config import AccountabilityConfig
from shared.clock import ManualClock
from shared.messages import STATION_ID, Header, Heartbeat, Tick
from tests.rig.in_process_station import InProcessStation


def pass_time(station: InProcessStation, clock: ManualClock, time_s: float) -> None:
    clock.advance(time_s)
    station.drive.receive(Tick(Header(STATION_ID, 1, 1, 0), clock.utc_ns()))


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


async def test_accountability_goes_from_green_to_overdue_and_confirmed(
    station: InProcessStation, clock: ManualClock
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        incident_id = await open_incident(commander)
        assert await states(commander) == {"FF-01": "not_confirmed", "FF-02": "not_confirmed"}
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
        assert one["confirmed"] == "radio"
        rest = {"resting": True}
        assert (await commander.put("/units/FF-01/rest", json=rest)).status_code == 204
        assert (await commander.put("/units/FF-01/rest", json=rest)).status_code == 409
        await commander.post(f"/incidents/{incident_id}/close")
        assert await states(commander) == {}
        assert (await commander.put(path, json=times)).status_code == 404
        assert (await commander.post("/check-ins", json=everyone)).status_code == 409


async def test_assignment_of_a_unit_confirms_no_member(
    station: InProcessStation, clock: ManualClock
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        await open_incident(commander)
        one, other = (await commander.get("/accountability")).json()
        for member in (one, other):
            assert (member["confirmed"], member["checked_in_ms"], member["checked_in_by"]) == (
                "not_yet", None, ""
            )  # fmt: skip
            assert not member["located"]
        clock.advance(1.0)
        station.drive.receive(Heartbeat(Header("FF-01", 7, 1, 0), 0, 0))
        listed = (await commander.get("/accountability")).json()
        assert {one["unit_id"]: one["located"] for one in listed} == {
            "FF-01": True, "FF-02": False
        }  # fmt: skip


async def test_a_check_in_is_undone_by_its_id(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as commander:
        await open_incident(commander)
        everyone = {"target": {"everyone": True}}
        mine = everyone | {"check_in_id": "mine"}
        assert (await commander.post("/check-ins", json=mine)).status_code == 204
        again = await commander.post("/check-ins", json=mine)
        assert (again.status_code, "id of its own" in again.json()["detail"]) == (409, True)
        bad = await commander.post("/check-ins", json=everyone | {"check_in_id": "a b"})
        assert (bad.status_code, "check_in_id" in bad.json()["detail"]) == (422, True)
        entries = {one["entry_id"] for one in (await commander.get("/accountability")).json()}
        assert entries == {"mine"}
        one = {"unit_id": "FF-01"}
        assert (await commander.post("/check-ins/mine/undo", json=one)).status_code == 204
        assert await states(commander) == {"FF-01": "not_confirmed", "FF-02": "green"}
        assert (await commander.post("/check-ins/mine/undo", json=one)).status_code == 409
        assert (await commander.post("/check-ins/mine/undo")).status_code == 204
        assert await states(commander) == {"FF-01": "not_confirmed", "FF-02": "not_confirmed"}
        await commander.post("/check-ins", json=everyone)
        (entry, *_) = (await commander.get("/accountability")).json()
        assert (await commander.post(f"/check-ins/{entry['entry_id']}/undo")).status_code == 204
    async with station.client(Role.ADMINISTRATOR) as administrator:
        entries = (await administrator.get("/audit")).json()
    assert [entry["action"] for entry in entries].count("UndoConfirmation") == 3


async def test_an_answer_by_radio_to_a_par_request_is_undone(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as commander:
        await open_incident(commander)
        request = {"kind": "par_request", "target": {"everyone": True}}
        command = (await commander.post("/commands", json=request)).json()
        path, one = f"/commands/{command['command_id']}", {"unit_id": "FF-01"}
        await commander.post(f"{path}/confirm", json=one)
        (first, _) = (await commander.get(path)).json()["units"]
        assert (first["state"], first["acknowledged_via"]) == ("acknowledged", "radio")
        assert (await states(commander))["FF-01"] == "green"
        assert (await commander.post(f"{path}/confirm/undo", json=one)).status_code == 204
        (first, _) = (await commander.get(path)).json()["units"]
        assert (first["state"], first["acknowledged_via"]) == ("queued", "")
        assert "green" not in (await states(commander)).values()
        assert (await commander.post(f"{path}/confirm/undo", json=one)).status_code == 409
        none = await commander.post("/commands/none/confirm/undo", json=one)
        assert none.status_code == 404


async def test_incident_starts_with_the_times_of_the_station(station: InProcessStation) -> None:
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
        ("POST", "/check-ins/k1/undo", {}),
        ("POST", "/commands/c1/confirm/undo", {"unit_id": "FF-01"}),
        ("PUT", "/units/FF-01/rest", {"resting": True}),
        ("PUT", "/incidents/i/accountability", {"par_interval_s": 600, "work_limit_s": 600}),
    ],
)
async def test_check_in_by_a_viewer_is_refused(
    station: InProcessStation, method: str, path: str, body: dict[str, object]
) -> None:
    async with station.client(Role.VIEWER) as viewer:
        assert (await viewer.request(method, path, json=body)).status_code == 403


async def test_a_check_in_is_in_the_audit(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as commander:
        await open_incident(commander)
        await commander.post("/check-ins", json={"target": {"everyone": True}})
    async with station.client(Role.ADMINISTRATOR) as administrator:
        entries = (await administrator.get("/audit")).json()
    assert "CheckIn" in {entry["action"] for entry in entries}
