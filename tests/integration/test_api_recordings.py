"""Pulls of recordings over the API: rights and progress."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from dataclasses import replace
from pathlib import Path

import httpx
import pytest
import pytest_asyncio

from base_station.accounts.principals import Role
from base_station.unit_sync.recordings.transfer_queue import TransferQueue
from shared.clock import ManualClock
from shared.messages.station import RegisterUnit
from tests.rig.in_process_station import InProcessStation

WINDOW = {"unit_id": "FF-01", "from_ms": 1_000, "to_ms": 2_000}


@pytest_asyncio.fixture
async def station(tmp_path: Path, clock: ManualClock) -> AsyncIterator[InProcessStation]:
    station = InProcessStation(tmp_path, clock)
    station.hub.connect(asyncio.get_running_loop(), station.drive)
    station.services.perform("chief", RegisterUnit("FF-01", "one"))
    with TransferQueue(lambda *_: None, tmp_path / "recordings", clock) as desk:
        station.app.state.services = replace(station.services, recordings=desk)
        yield station
    station.close()


async def pulls(client: httpx.AsyncClient) -> list[dict[str, object]]:
    answer = await client.get("/recordings")
    assert answer.status_code == 200
    listed: list[dict[str, object]] = answer.json()
    return listed


async def test_commander_starts_reads_and_stops_a_transfer(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as client:
        asked = await client.post("/recordings", json=WINDOW)
        assert asked.status_code == 202
        (pull,) = await pulls(client)
        assert (pull["unit_id"], pull["state"], pull["by"]) == ("FF-01", "waiting", "commander")
        assert (pull["from_ms"], pull["to_ms"]) == (1_000, 2_000)
        stopped = await client.delete(f"/recordings/{pull['fetch_id']}")
        assert stopped.status_code == 204
        (pull,) = await pulls(client)
        assert (pull["state"], pull["problem"]) == ("failed", "stopped by a person")
        assert (await client.delete(f"/recordings/{pull['fetch_id']}")).status_code == 404
    async with station.client(Role.ADMINISTRATOR) as client:
        audit = (await client.get("/audit")).json()
    done = [(one["by"], one["action"]) for one in audit]
    assert ("commander", "FetchedRecording") in done
    assert ("commander", "StoppedRecording") in done


async def test_viewer_reads_transfers_and_starts_none(station: InProcessStation) -> None:
    async with station.client(Role.VIEWER) as client:
        assert await pulls(client) == []
        assert (await client.post("/recordings", json=WINDOW)).status_code == 403
        assert (await client.delete("/recordings/x")).status_code == 403


@pytest.mark.parametrize(
    ("form", "code", "reported"),
    [
        (WINDOW | {"unit_id": "FF-99"}, 404, "no unit FF-99"),
        ({"unit_id": "FF-01"}, 422, "which window"),
        ({"unit_id": "FF-01", "incident_id": "none"}, 404, "incident"),
        (WINDOW | {"incident_id": "i1"}, 422, "which window"),
        (WINDOW | {"from_ms": 3_000}, 409, "before it begins"),
        (WINDOW | {"unit_id": "../x"}, 422, ""),
    ],
)
async def test_invalid_request_is_refused_with_a_reason(
    station: InProcessStation, form: dict[str, object], code: int, reported: str
) -> None:
    async with station.client(Role.COMMANDER) as client:
        answer = await client.post("/recordings", json=form)
    assert answer.status_code == code
    assert reported in answer.text


async def test_second_transfer_of_a_unit_is_refused(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as client:
        assert (await client.post("/recordings", json=WINDOW)).status_code == 202
        again = await client.post("/recordings", json=WINDOW)
    assert again.status_code == 409
    assert "already" in again.json()["detail"]
