"""Pins and beacons over the API: set, moved, removed, refused, and rights."""

from __future__ import annotations

import json

import httpx
import msgspec
import pytest

from base_station.accounts.principals import Role
from base_station.storage.db.window import EVER
from shared.clock import NS_PER_MS, NS_PER_S, ManualClock
from shared.messages import Header, Position
from tests.rig.in_process_station import InProcessStation


async def walk(
    station: InProcessStation,
    clock: ManualClock,
    commander: httpx.AsyncClient,
    make_position: object,
) -> None:
    """Two registered units walk 60 m north side by side."""
    for unit_id in ("FF-01", "FF-02"):
        assert (await commander.post("/units", json={"unit_id": unit_id})).status_code == 201
        start = {"north_m": 0.0, "east_m": 0.0, "heading_std_rad": 0.1}
        await commander.put(f"/units/{unit_id}/start", json=start)
    for second in range(60):
        clock.advance(1.0)
        for unit_id in ("FF-01", "FF-02"):
            position = make_position()  # type: ignore[operator]  # a fixture's function
            assert isinstance(position, Position)
            header = Header(unit_id, 7, second + 1, second * NS_PER_S)
            station.drive.receive(
                msgspec.structs.replace(
                    position, header=header, north_m=1.0 * second, east_m=0.0, down_m=0.0
                )
            )


async def test_a_pin_is_set_moved_and_removed(
    station: InProcessStation, clock: ManualClock, make_position: object
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        await walk(station, clock, commander, make_position)
        body = {"unit_id": "FF-01", "north_m": 58.0, "east_m": 1.5, "note": "stair head"}
        answer = await commander.post("/pins", json=body)
        assert answer.status_code == 201, answer.text
        pin = answer.json()
        assert (pin["kind"], pin["state"], pin["by"]) == ("place", "used", "commander")
        assert pin["residual_m"] < 2.0
        position = station.drive.picture().units[0].position
        assert position is not None
        assert position.east_m > 0.3

        moved = await commander.put(f"/pins/{pin['pin_id']}", json=body | {"east_m": -1.5})
        assert moved.status_code == 200, moved.text
        assert moved.json()["t_ms"] == pin["t_ms"]
        position = station.drive.picture().units[0].position
        assert position is not None
        assert position.east_m < -0.3
        assert len((await commander.get("/pins")).json()) == 1

        assert (await commander.delete(f"/pins/{pin['pin_id']}")).status_code == 204
        assert (await commander.get("/pins")).json() == []
        assert (await commander.delete(f"/pins/{pin['pin_id']}")).status_code == 404
        position = station.drive.picture().units[0].position
        assert position is not None
        assert position.east_m == pytest.approx(0.0, abs=0.1)


async def test_audit_names_the_units_of_a_removed_pin(
    station: InProcessStation, clock: ManualClock, make_position: object
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        await walk(station, clock, commander, make_position)
        met = {"unit_id": "FF-01", "other_unit_id": "FF-02"}
        pin = (await commander.post("/pins/meeting", json=met)).json()
        await commander.delete(f"/pins/{pin['pin_id']}")
        start = {"unit_ids": ["FF-01", "FF-02"], "north_m": 0.0, "east_m": 0.0}
        both = (await commander.post("/pins/start", json=start)).json()
        group, _, _ = both[0]["pin_id"].partition(":")
        await commander.delete(f"/pins/{group}:FF-02")
        await commander.delete(f"/pins/{group}")
        beacon = {"label": "door", "north_m": 1.0, "east_m": 2.0}
        await commander.put("/beacons/door-3", json=beacon)
        await commander.delete("/beacons/door-3")
    station.projection.flush()
    entries = station.services.records.audit_entries(EVER)
    removed = [json.loads(one.detail) for one in entries if one.action.startswith("Remove")]
    assert removed == [
        {"beacon_id": "door-3"},
        {"pin_id": group, "unit_ids": ["FF-01", "FF-02"]},
        {"pin_id": f"{group}:FF-02", "unit_id": "FF-02"},
        {"pin_id": pin["pin_id"], **met},
    ]


async def test_moved_pin_keeps_its_omitted_fields(
    station: InProcessStation, clock: ManualClock, make_position: object
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        await walk(station, clock, commander, make_position)
        reported = {
            "std_m": 3.0,
            "floor": 2,
            "heading_rad": 1.0,
            "heading_std_rad": 0.1,
            "note": "A",
        }
        here = {"unit_id": "FF-01", "north_m": 5.0, "east_m": 0.0}
        pin = (await commander.post("/pins", json=here | reported)).json()
        clock.advance(5.0)
        path = f"/pins/{pin['pin_id']}"
        moved = (await commander.put(path, json=here | {"north_m": 6.0})).json()
        assert moved["north_m"] == 6.0
        kept = ("t_ms", *reported)
        assert {name: moved[name] for name in kept} == {name: pin[name] for name in kept}
        unsaid = {"floor": None, "heading_rad": None, "note": "", "t_ms": None}
        again = (await commander.put(path, json=here | unsaid)).json()
        assert (again["floor"], again["heading_rad"], again["note"]) == (None, None, "")
        assert again["t_ms"] == clock.utc_ns() // NS_PER_MS, "null is now, as where a pin is set"
        assert again["std_m"] == 3.0


async def test_units_start_together_and_meet(
    station: InProcessStation, clock: ManualClock, make_position: object
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        await walk(station, clock, commander, make_position)
        start = {"unit_ids": ["FF-01", "FF-02"], "north_m": 1.0, "east_m": 1.0, "heading_rad": 0.0}
        answer = await commander.post("/pins/start", json=start)
        assert answer.status_code == 201, answer.text
        pins = answer.json()
        assert [pin["unit_id"] for pin in pins] == ["FF-01", "FF-02"]
        meeting = {"unit_id": "FF-01", "other_unit_id": "FF-02"}
        met = await commander.post("/pins/meeting", json=meeting)
        assert met.status_code == 201, met.text
        assert met.json()["state"] == "used"
        assert met.json()["north_m"] is None
        moved = await commander.put(f"/pins/{met.json()['pin_id']}", json=start | {
            "unit_id": "FF-01"})  # fmt: skip
        assert moved.status_code == 422
        group = pins[0]["pin_id"].split(":")[0]
        assert (await commander.delete(f"/pins/{group}")).status_code == 204
        assert [pin["kind"] for pin in (await commander.get("/pins")).json()] == ["meeting"]


async def test_beacons_are_placed_moved_and_removed(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as commander:
        placed = await commander.put("/beacons/door-3", json={"north_m": 3.0, "east_m": 4.0})
        assert placed.status_code == 200, placed.text
        assert placed.json()["reach_m"] == 3.0
        reported = {"label": "D3", "floor": 1, "std_m": 0.2, "reach_m": 5.0}
        for body in (reported | {"north_m": 5.0, "east_m": 4.0}, {"north_m": 6.0, "east_m": 4.0}):
            await commander.put("/beacons/door-3", json=body)
        (beacon,) = (await commander.get("/beacons")).json()
        assert beacon["north_m"] == 6.0
        assert {name: beacon[name] for name in reported} == reported, "what a move leaves out stays"
        assert (await commander.delete("/beacons/door-3")).status_code == 204
        assert (await commander.delete("/beacons/door-3")).status_code == 404


@pytest.mark.parametrize(
    ("changes", "status", "sentence"),
    [
        ({"unit_id": "nobody"}, 409, "no registered unit"),
        ({"std_m": 0.0}, 422, "std_m"),
        ({"t_ms": 4_000_000_000_000}, 409, "in the future"),
        ({"floor": 300}, 409, "no building has a floor 300"),
        ({"unknown": 1}, 422, "unknown"),
    ],
)
async def test_invalid_pin_is_refused_with_a_reason(
    station: InProcessStation,
    clock: ManualClock,
    make_position: object,
    changes: dict[str, object],
    status: int,
    sentence: str,
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        await walk(station, clock, commander, make_position)
        body = {"unit_id": "FF-01", "north_m": 58.0, "east_m": 1.5} | changes
        answer = await commander.post("/pins", json=body)
        assert answer.status_code == status
        assert sentence in answer.json()["detail"]
        assert (await commander.get("/pins")).json() == []


async def test_viewer_reads_pins_and_sets_none(station: InProcessStation) -> None:
    async with station.client(Role.VIEWER) as viewer:
        assert (await viewer.get("/pins")).status_code == 200
        body = {"unit_id": "FF-01", "north_m": 0.0, "east_m": 0.0}
        assert (await viewer.post("/pins", json=body)).status_code == 403
