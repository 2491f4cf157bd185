"""Routes to a member by way of the API."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable

import httpx
import msgspec
import pytest
import pytest_asyncio

from base_station.accounts.principals import Role
from base_station.api import route_finder
from shared.clock import NS_PER_S, ManualClock
from shared.messages import EventKind, Header, Position, UnitEvent
from tests.rig.in_process_station import InProcessStation

pytestmark = pytest.mark.asyncio
UNITS = ("FF-01", "FF-02", "FF-03", "FF-04", "FF-05")


@pytest_asyncio.fixture
async def commander(
    station: InProcessStation, clock: ManualClock, make_position: Callable[..., Position]
) -> AsyncIterator[httpx.AsyncClient]:
    """Five members came in at one place and walked north, each ten metres less; FF-01 is the
    farthest.
    """
    async with station.client(Role.COMMANDER) as commander:
        for unit_id in UNITS:
            await commander.post("/units", json={"unit_id": unit_id})
            person = await commander.post("/people", json={"name": unit_id, "crew": "", "role": ""})
            worn = {"unit_id": unit_id, "person_id": person.json()["person_id"]}
            await commander.post("/assignments", json=worn)
        await commander.post("/incidents", json={"name": "Mill Lane"})
        start = {"north_m": 0.0, "east_m": 0.0, "heading_std_rad": 0.1}
        for unit_id in UNITS:
            await commander.put(f"/units/{unit_id}/start", json=start)
        for second in range(1, 60):
            clock.advance(1.0)
            for number, unit_id in enumerate(UNITS):
                north_m = float(min(second, 50 - 10 * number))
                station.drive.receive(
                    msgspec.structs.replace(
                        make_position(),
                        header=Header(unit_id, 7, second, second * NS_PER_S),
                        north_m=north_m,
                        east_m=0.0,
                    )
                )
        yield commander


async def test_routes_are_of_the_three_nearest_and_any_named_rescuer(
    commander: httpx.AsyncClient,
) -> None:
    nearest = (await commander.get("/units/FF-01/routes")).json()
    assert [route["unit_id"] for route in nearest] == ["FF-02", "FF-03", "FF-04"]
    assert [route["known"] for route in nearest] == [True] * 3
    assert [route["distance_m"] for route in nearest] == pytest.approx([10, 20, 30], abs=2)
    first = nearest[0]
    assert first["text"].endswith("10 m")
    assert first["places"][0]["north_m"] == pytest.approx(40.0, abs=1.0)
    assert first["places"][-1]["north_m"] == pytest.approx(50.0, abs=1.0)
    assert 0.0 < first["uncertainty_m"] < 60.0
    named = (await commander.get("/units/FF-01/routes?rescuer_id=FF-05")).json()
    assert [route["unit_id"] for route in named] == ["FF-05"]
    assert named[0]["distance_m"] == pytest.approx(40, abs=2)


async def test_endangered_member_is_no_rescuer(
    commander: httpx.AsyncClient, station: InProcessStation, clock: ManualClock
) -> None:
    clock.advance(1.0)
    header = Header("FF-02", 7, 90, 70 * NS_PER_S)
    station.drive.receive(UnitEvent(header, EventKind.MAYDAY))
    nearest = (await commander.get("/units/FF-01/routes")).json()
    assert [route["unit_id"] for route in nearest] == ["FF-03", "FF-04", "FF-05"]


async def test_route_without_a_known_way_is_marked_as_a_straight_line(
    commander: httpx.AsyncClient,
    station: InProcessStation,
    clock: ManualClock,
    make_position: Callable[..., Position],
) -> None:
    """FF-03 stood still for a minute without contact, and is elsewhere."""
    clock.advance(60.0)
    station.drive.receive(
        msgspec.structs.replace(
            make_position(),
            header=Header("FF-03", 7, 200, 130 * NS_PER_S),
            north_m=30.0,
            east_m=400.0,
        )
    )
    (answer,) = (await commander.get("/units/FF-01/routes?rescuer_id=FF-03")).json()
    assert answer["text"].startswith("no known way; ")
    assert not answer["known"]
    assert answer["legs"] == []


async def test_unknown_unit_and_unit_without_position_are_refused(
    commander: httpx.AsyncClient,
) -> None:
    assert (await commander.get("/units/FF-09/routes")).status_code == 404
    assert (await commander.get("/units/FF-01/routes?rescuer_id=FF-09")).status_code == 404
    await commander.post("/units", json={"unit_id": "FF-08"})
    itself = await commander.get("/units/FF-01/routes?rescuer_id=FF-01")
    assert itself.status_code == 409
    assert "name another rescuer" in itself.json()["detail"]
    nowhere = await commander.get("/units/FF-08/routes")
    assert nowhere.status_code == 409
    assert "no position" in nowhere.json()["detail"]
    assert (await commander.get("/units/FF-01/routes?rescuer_id=FF-08")).status_code == 409


async def test_legs_of_the_route_are_sent_as_the_rescuer_advances(
    commander: httpx.AsyncClient,
    station: InProcessStation,
    clock: ManualClock,
    make_position: Callable[..., Position],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """FF-02 turns off the way; the next piece says to turn back; the end is told, too."""
    begun = await commander.post("/units/FF-01/guides", json={"rescuer_id": "FF-02"})
    assert begun.status_code == 201, begun.text
    assert begun.json()["text"].startswith("Way to FF-01: ")

    async def pieces() -> list[str]:
        commands = (await commander.get("/commands")).json()
        assert {unit["unit_id"] for one in commands for unit in one["units"]} == {"FF-02"}
        return [command["text"] for command in commands]

    guidance = station.app.state.guidance
    for _ in range(3):
        guidance.step(station.services)
    assert len(await pieces()) == 1, "nothing has changed"
    for second in range(61, 73):
        clock.advance(1.0)
        header = Header("FF-02", 7, second, second * NS_PER_S)
        east_m = float(second - 60)
        station.drive.receive(
            msgspec.structs.replace(make_position(), header=header, north_m=40.0, east_m=east_m)
        )
    monkeypatch.setattr(route_finder, "KEPT_S", 0.0)
    for _ in range(3):
        guidance.step(station.services)
    first, then = await pieces()
    assert "m in all" not in first
    assert then.endswith("m in all")
    assert (await commander.delete("/guides/FF-02")).status_code == 204
    assert (await pieces())[-1] == "Way to FF-01: ended"
    assert (await commander.delete("/guides/FF-02")).status_code == 404


async def test_guidance_ends_with_the_alarms_of_the_member(
    commander: httpx.AsyncClient, station: InProcessStation, clock: ManualClock
) -> None:
    clock.advance(1.0)
    header = Header("FF-01", 7, 90, 70 * NS_PER_S)
    station.drive.receive(UnitEvent(header, EventKind.MAYDAY))
    await commander.post("/units/FF-01/guides", json={"rescuer_id": "FF-02"})
    guidance = station.app.state.guidance
    guidance.step(station.services)
    assert [one["rescuer_id"] for one in (await commander.get("/guides")).json()] == ["FF-02"]
    (alarm,) = station.drive.picture().alarms
    seen = {"last_raised_ms": alarm.last_raised_ms}
    await commander.post(f"/alarms/{alarm.alarm_id}/resolve", json=seen)
    guidance.step(station.services)
    assert (await commander.get("/guides")).json() == []
