"""Commands over the API: rights and errors."""

from __future__ import annotations

import msgspec
import pytest

from base_station.accounts.principals import Role
from edge.simulation.building import plan_path
from shared.clock import ManualClock
from shared.messages import CommandReply, CommandState, Header
from tests.rig import message_factory
from tests.rig.in_process_station import InProcessStation

EVACUATE = {"kind": "evacuate", "target": {"everyone": True}, "expires_s": 60}


async def test_command_to_a_crew_is_sent_and_its_answers_are_shown(
    station: InProcessStation, clock: ManualClock
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        for unit_id, crew in (("FF-01", "A"), ("FF-02", "A"), ("FF-03", "B")):
            person = (await commander.post("/people", json={"name": unit_id, "crew": crew})).json()
            await commander.post("/units", json={"unit_id": unit_id})
            worn = {"unit_id": unit_id, "person_id": person["person_id"]}
            assert (await commander.post("/assignments", json=worn)).status_code == 204
        order = {"kind": "text", "target": {"crew": "A"}, "text": "come out", "expires_s": 60}
        answer = await commander.post("/commands", json=order)
        assert answer.status_code == 201, answer.text
        command = answer.json()
        assert (command["kind"], command["text"], command["issued_by"]) == (
            "text", "come out", "commander"
        )  # fmt: skip
        assert command["expires_ms"] - command["issued_ms"] == 60_000
        assert [unit["state"] for unit in command["units"]] == ["queued", "queued"]
        clock.advance(1.0)
        station.drive.receive(
            CommandReply(Header("FF-01", 7, 1, 0), command["command_id"], CommandState.ACKNOWLEDGED)
        )
        path = f"/commands/{command['command_id']}"
        confirmed = await commander.post(f"{path}/confirm", json={"unit_id": "FF-02"})
        assert confirmed.status_code == 204, confirmed.text
        (listed,) = (await commander.get("/commands")).json()
        assert listed == (await commander.get(path)).json()
        assert not listed["open"]
        assert [(unit["state"], unit["acknowledged_by"]) for unit in listed["units"]] == [
            ("acknowledged", "FF-01"), ("acknowledged", "commander")
        ]  # fmt: skip
        again = await commander.post(f"{path}/confirm", json={"unit_id": "FF-02"})
        assert again.status_code == 409
    async with station.client(Role.ADMINISTRATOR) as administrator:
        entries = (await administrator.get("/audit")).json()
    assert {"SendCommand", "ConfirmCommand"} <= {entry["action"] for entry in entries}


async def test_command_to_a_floor_includes_units_with_unknown_floor(
    station: InProcessStation, clock: ManualClock
) -> None:
    """A plan of two floors; FF-01 is on the upper one, of FF-03 no position has come."""
    async with station.client(Role.COMMANDER) as commander:
        plan = msgspec.json.decode(plan_path().read_bytes())
        laid = await commander.put("/site/plan", json=plan)
        assert laid.status_code == 204, laid.text
        for number, down_m in ((1, -3.2), (2, 0.0), (3, None)):
            unit_id = f"FF-0{number}"
            person = (await commander.post("/people", json={"name": unit_id})).json()
            await commander.post("/units", json={"unit_id": unit_id})
            worn = {"unit_id": unit_id, "person_id": person["person_id"]}
            await commander.post("/assignments", json=worn)
            if down_m is not None:
                start = {"north_m": 7.0, "east_m": 9.0, "down_m": down_m}
                await commander.put(f"/units/{unit_id}/start", json=start)
                clock.advance(1.0)
                header = Header(unit_id, 7, 1, 1)
                station.drive.receive(message_factory.position(header))
        floors = {
            one.unit_id: one.position.floor
            for one in station.drive.picture().units
            if one.position is not None
        }
        assert floors == {"FF-01": 1, "FF-02": 0}
        order = {"kind": "evacuate", "target": {"floor": 1}}
        reported = (await commander.post("/commands", json=order)).json()["units"]
        assert [unit["unit_id"] for unit in reported] == ["FF-01", "FF-03"]


async def test_command_shows_whether_units_can_notify_and_have_notified(
    station: InProcessStation, clock: ManualClock
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        for unit_id, outputs in (("FF-01", ("led",)), ("FF-02", ())):
            await commander.post("/units", json={"unit_id": unit_id})
            header = Header(unit_id, 7, 1, 0)
            station.drive.receive(message_factory.description(header, outputs=outputs))
        order = {"kind": "locate", "target": {"everyone": True}, "expires_s": 60}
        command = (await commander.post("/commands", json=order)).json()
        assert command["notifies_wearer"]
        assert [unit["can_be_notified"] for unit in command["units"]] == [True, False]
        clock.advance(1.0)
        station.drive.receive(
            CommandReply(Header("FF-01", 7, 2, 0), command["command_id"], CommandState.NOTIFIED)
        )
        first, second = (await commander.get(f"/commands/{command['command_id']}")).json()["units"]
    assert first["state"] == "notified"
    assert first["notified_ms"] == first["received_ms"] == command["issued_ms"] + 1000
    assert (second["state"], second["notified_ms"]) == ("queued", None)


async def test_viewer_reads_commands_and_sends_none(station: InProcessStation) -> None:
    async with station.client(Role.VIEWER) as viewer:
        assert (await viewer.post("/commands", json=EVACUATE)).status_code == 403
        refused = await viewer.post("/commands/c1/confirm", json={"unit_id": "FF-01"})
        assert refused.status_code == 403
        assert (await viewer.get("/commands")).json() == []
        assert (await viewer.get("/commands/none")).status_code == 404


@pytest.mark.parametrize(
    ("change", "status", "word"),
    [
        ({"target": {}}, 422, "one of"),
        ({"target": {"everyone": True, "crew": "A"}}, 422, "one of"),
        ({"target": {"crew": ""}}, 422, "crew"),
        ({"target": {"unit_id": "FF-09"}}, 409, "FF-09"),
        ({}, 409, "everyone"),  # nobody is there
        ({"kind": "reset_alarm"}, 422, "kind"),
        ({"expires_s": 0}, 422, "expires_s"),
        ({"expires_s": "soon"}, 422, "expires_s"),
        ({"position_rate_hz": 1000}, 422, "position_rate_hz"),
        ({"text": "line\nbreak"}, 422, "text"),
        ({"more": 1}, 422, "more"),
    ],
)
async def test_invalid_command_is_refused(
    station: InProcessStation, change: dict[str, object], status: int, word: str
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        answer = await commander.post("/commands", json=EVACUATE | change)
        assert answer.status_code == status, answer.text
        assert word in answer.json()["detail"]
        assert (await commander.get("/commands")).json() == []
