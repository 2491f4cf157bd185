"""Closing an incident with open alarms or people inside needs a confirmation."""

from __future__ import annotations

from typing import Any

import pytest
from httpx import AsyncClient

from base_station.accounts.principals import Role
from base_station.api.incident_closing import MAX_NAMED, ClosingObstacles
from base_station.api.problems import Problem
from base_station.views.wire import AlarmView
from shared.clock import ManualClock
from shared.messages import EventKind, Header, UnitEvent
from shared.messages.station import ReportProblem
from tests.rig import message_factory
from tests.rig.in_process_station import InProcessStation


async def open_incident(commander: AsyncClient, name: str = "Ana") -> str:
    """With one member, whose unit is FF-01."""
    person = (await commander.post("/people", json={"name": name})).json()
    await commander.post("/units", json={"unit_id": "FF-01"})
    worn = {"unit_id": "FF-01", "person_id": person["person_id"]}
    await commander.post("/assignments", json=worn)
    opened = await commander.post("/incidents", json={"name": "Mill Lane"})
    return f"/incidents/{opened.json()['incident_id']}"


def walk_in(station: InProcessStation) -> None:
    header = Header("FF-01", 7, 1, 5)
    station.drive.receive(message_factory.position(header, north_m=9.0, distance_m=9.0))


def mayday(station: InProcessStation, seq: int = 2) -> None:
    station.drive.receive(UnitEvent(Header("FF-01", 7, seq, 5 + seq), EventKind.MAYDAY))


def open_alarms(station: InProcessStation) -> list[AlarmView]:
    return [one for one in station.drive.picture().alarms if one.state != "resolved"]


async def audited(station: InProcessStation, action: str) -> list[dict[str, Any]]:
    async with station.client(Role.ADMINISTRATOR) as administrator:
        entries = (await administrator.get("/audit")).json()
    return [entry for entry in entries if entry["action"] == action]


async def test_closing_names_open_alarms_and_members_inside(
    station: InProcessStation, clock: ManualClock
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        path = await open_incident(commander)
        clock.advance(1.0)
        walk_in(station)
        mayday(station)
        refused = await commander.post(f"{path}/close")
        (alarm,) = open_alarms(station)
        assert refused.status_code == 409
        detail = refused.json()["detail"]
        assert "Open alarms: Mayday from Ana. Inside: Ana." in detail
        assert (await commander.get(path)).json()["closed_ms"] is None
        one = {"despite_alarm_ids": [alarm.alarm_id]}
        both = one | {"despite_unit_ids": ["FF-01"]}
        assert refused.json().items() >= both.items()
        still = await commander.post(f"{path}/close", json=one)
        assert (still.status_code, "Mayday" in still.json()["detail"]) == (409, False)
        assert (await commander.post(f"{path}/close", json=both)).status_code == 204
        assert (await commander.get(path)).json()["closed_ms"] is not None
        again = await commander.post(f"{path}/close")
        assert (again.status_code, "no open incident" in again.json()["detail"]) == (409, True)
    (entry,) = await audited(station, "CloseIncident")
    assert alarm.alarm_id in entry["detail"], "over what it was closed is in the record"
    assert open_alarms(station) == [alarm], "the alarm stays open"


async def test_closing_names_alarms_that_are_new_since(
    station: InProcessStation, clock: ManualClock
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        path = await open_incident(commander)
        clock.advance(1.0)
        walk_in(station)
        seen = {"despite_unit_ids": ["FF-01"]}
        mayday(station)
        refused = await commander.post(f"{path}/close", json=seen)
    assert refused.status_code == 409
    assert "Mayday from Ana" in refused.json()["detail"]


async def test_alarms_of_the_station_do_not_prevent_closing(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as commander:
        path = await open_incident(commander)
        station.drive.submit("station", ReportProblem("log", "It fails"))
        assert len(open_alarms(station)) == 1
        assert (await commander.post(f"{path}/close")).status_code == 204


@pytest.mark.parametrize(
    "body", [{"despite_alarm_ids": "all"}, {"despite_unit_ids": ["a b"]}, {"force": True}]
)
async def test_invalid_request_closes_nothing(
    station: InProcessStation, body: dict[str, object]
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        path = await open_incident(commander)
        assert (await commander.post(f"{path}/close", json=body)).status_code == 422
        assert (await commander.get(path)).json()["closed_ms"] is None


def test_long_list_of_obstacles_names_the_first() -> None:
    alarms = tuple(
        AlarmView(f"fall:{n}", "fall", f"FF-{n}", 1, "raised", "", f"fall {n}", "", 0, 0, 0)
        for n in range(MAX_NAMED + 3)
    )
    with pytest.raises(Problem, match="; 3 more") as refused:
        ClosingObstacles(alarms, ()).require_known((), ())
    assert f"fall {MAX_NAMED}" not in refused.value.detail
    assert refused.value.members["despite_alarm_ids"] == [one.alarm_id for one in alarms]
