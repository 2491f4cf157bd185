"""Erasures requested over the API: rights, names, and obstacles."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from pathlib import Path

import pytest

from base_station.accounts.principals import Role
from base_station.core.state import ERASED_TEXT
from shared.clock import ManualClock
from shared.messages import CommandKind
from shared.messages.station import (
    ConfirmCommand,
    RegisterUnit,
    SendCommand,
)
from tests.rig.erasure_scenario import ANA, BO
from tests.rig.in_process_station import InProcessStation


@pytest.fixture
def desk(tmp_path: Path, clock: ManualClock) -> Iterator[InProcessStation]:
    (tmp_path / "log").mkdir()
    desk = InProcessStation(tmp_path, clock)
    yield desk
    desk.close()


async def test_erasure_by_the_api_needs_the_name_and_an_administrator(
    desk: InProcessStation,
) -> None:
    desk.hub.connect(asyncio.get_running_loop(), desk.drive)
    async with desk.client(Role.COMMANDER) as commander:
        person = (await commander.post("/people", json={"name": ANA})).json()
        path = f"/people/{person['person_id']}/forget"
        assert (await commander.post(path, json={"name": ANA})).status_code == 403
    async with desk.client(Role.ADMINISTRATOR) as administrator:
        assert (await administrator.post(path, json={"name": BO})).status_code == 422
        asked = await administrator.post(path, json={"name": ANA})
        assert (asked.status_code, asked.json()["state"]) == (202, "waiting")
        while (one := (await administrator.get("/forgettings")).json()[-1])["state"] != "done":
            await asyncio.sleep(0.02)
        assert (one["kind"], one["subject_id"], one["share"]) == ("person", person["person_id"], 1)
        assert (await administrator.post(path, json={"name": ANA})).status_code == 404
        entries = (await administrator.get("/audit")).json()
    assert ("administrator", "ForgotPerson") in {(one["by"], one["action"]) for one in entries}
    assert not any(ANA in one["detail"] for one in entries)


async def test_erasure_with_an_undelivered_message_is_refused(
    desk: InProcessStation,
) -> None:
    desk.hub.connect(asyncio.get_running_loop(), desk.drive)
    message = SendCommand("c1", CommandKind.TEXT, "FF-01", "", False, "north door", 0.0, 600.0)
    for action in (RegisterUnit("FF-01", "one"), message):
        desk.drive.submit("chief", action)
    async with desk.client(Role.ADMINISTRATOR) as administrator:
        person = (await administrator.post("/people", json={"name": ANA})).json()
        path = f"/people/{person['person_id']}/forget"
        refused = await administrator.post(path, json={"name": ANA})
        assert refused.status_code == 409
        assert "message" in refused.json()["detail"]
        desk.drive.submit("chief", ConfirmCommand("c1", "FF-01"))
        assert (await administrator.post(path, json={"name": ANA})).status_code == 202


async def test_removed_person_can_be_erased(desk: InProcessStation, clock: ManualClock) -> None:
    """A commander may do that, and then everything but name and photo is still there."""
    desk.hub.connect(asyncio.get_running_loop(), desk.drive)
    desk.drive.submit("chief", RegisterUnit("FF-01", "one"))
    async with desk.client(Role.COMMANDER) as commander:
        person_id = (await commander.post("/people", json={"name": ANA})).json()["person_id"]
        worn = {"unit_id": "FF-01", "person_id": person_id}
        assert (await commander.post("/assignments", json=worn)).status_code < 300
        clock.advance(60.0)
        assert (await commander.delete("/assignments/FF-01")).status_code < 300
        assert (await commander.delete(f"/people/{person_id}")).status_code == 204
        (before,) = (await commander.get("/assignments")).json()
        assert before["person_name"] == ANA
    async with desk.client(Role.ADMINISTRATOR) as administrator:
        path = f"/people/{person_id}/forget"
        assert (await administrator.post(path, json={"name": BO})).status_code == 422
        assert (await administrator.post(path, json={"name": ANA})).status_code == 202
        while (await administrator.get("/forgettings")).json()[-1]["state"] != "done":
            await asyncio.sleep(0.02)
        (after,) = (await administrator.get("/assignments")).json()
        assert after["person_name"] == ERASED_TEXT
        assert ANA not in (await administrator.get("/audit")).text
        assert (await administrator.post(path, json={"name": ANA})).status_code == 404


async def test_wearer_is_erased_after_unassignment(
    desk: InProcessStation, clock: ManualClock
) -> None:
    desk.hub.connect(asyncio.get_running_loop(), desk.drive)
    desk.drive.submit("chief", RegisterUnit("FF-01", "one"))
    async with desk.client(Role.ADMINISTRATOR) as administrator:
        person_id = (await administrator.post("/people", json={"name": ANA})).json()["person_id"]
        worn = {"unit_id": "FF-01", "person_id": person_id}
        assert (await administrator.post("/assignments", json=worn)).status_code == 204
        clock.advance(60.0)
        path = f"/people/{person_id}/forget"
        refused = await administrator.post(path, json={"name": ANA})
        assert refused.status_code == 409
        assert "wears FF-01; unassign that first, or send unassign" in refused.json()["detail"]
        asked = await administrator.post(path, json={"name": ANA, "unassign": True})
        assert asked.status_code == 202, asked.text
        assert desk.services.roster.worn_by(person_id) == []
