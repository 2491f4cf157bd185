"""Failures of the station are reported to the client, and logged."""

from __future__ import annotations

import asyncio
import time
from concurrent.futures import Future

import pytest

from base_station.accounts.principals import Role
from base_station.api import services
from base_station.engine.ports import ActionResult
from base_station.exporters import EXPORTERS
from base_station.exporters.interface import Exporter
from base_station.storage.db.records import Records
from shared.errors import LogError, MusterError, StoreError
from tests.rig.in_process_station import InProcessStation


@pytest.mark.parametrize("error", [StoreError("the disk is full"), LogError("a segment is torn")])
async def test_a_failure_of_the_station_is_503_and_logged(
    station: InProcessStation,
    error: MusterError,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(Records, "incidents", fail)
    async with station.client(Role.VIEWER) as viewer:
        answer = await viewer.get("/incidents")
    assert answer.status_code == 503
    assert answer.json()["detail"] == str(error)
    assert f"GET /api/v1/incidents: {error}" in caplog.text


async def test_unhandled_error_is_answered_as_a_problem(
    station: InProcessStation, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def fail(*_: object) -> None:
        raise ValueError("of the program")

    monkeypatch.setattr(Records, "incidents", fail)
    async with station.client(Role.VIEWER) as viewer:
        answer = await viewer.get("/incidents")
    assert answer.status_code == 500
    assert answer.json()["detail"] == "The station has failed; see its log for the error."
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.headers["cache-control"] == "no-store"
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert "GET /api/v1/incidents failed" in caplog.text
    assert caplog.text.count("ValueError: of the program") == 1


async def test_timeout_states_that_the_action_may_still_be_done(
    station: InProcessStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A user who simply repeats the request could open two incidents."""
    waiting: Future[ActionResult] = Future()
    monkeypatch.setattr(services, "ACTION_TIMEOUT_S", 0.0)
    monkeypatch.setattr(station.drive, "submit", lambda *_: waiting)
    async with station.client(Role.COMMANDER) as commander:
        answer = await commander.post("/incidents", json={"name": "Kitchen"})
    assert answer.status_code == 503
    assert "it may still do it" in answer.json()["detail"]
    assert not waiting.cancelled()


async def test_missing_table_is_a_failure_of_the_station(station: InProcessStation) -> None:
    with station.store.write() as session:
        session.connection().exec_driver_sql("DROP TABLE incidents")
    async with station.client(Role.VIEWER) as viewer:
        answer = await viewer.get("/incidents")
    assert answer.status_code == 503
    assert "the database cannot be read" in answer.json()["detail"]


@pytest.mark.parametrize("exporter", EXPORTERS, ids=lambda one: one.name)
async def test_export_that_cannot_be_audited_is_refused(
    station: InProcessStation, exporter: Exporter, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        await commander.put("/site/anchor", json={"lat_deg": 50.0, "lon_deg": 8.0})
        opened = (await commander.post("/incidents", json={"name": "Kitchen"})).json()
        path = f"/incidents/{opened['incident_id']}/export/{exporter.name}"
        with monkeypatch.context() as patched:
            patched.setattr(Records, "audit", full)
            answer = await commander.get(path)
        assert answer.status_code == 503
        assert "the audit cannot say: the disk is full" in answer.json()["detail"]
        assert (await commander.get(path)).status_code == 200


async def test_complete_incidents_are_exported_one_at_a_time(
    station: InProcessStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    inside: list[int] = []
    most = 0

    def slow(*_: object) -> list[str]:
        nonlocal most
        inside.append(1)
        most = max(most, len(inside))
        time.sleep(0.05)
        inside.pop()
        return []

    monkeypatch.setattr(Records, "track_units", slow)
    async with station.client(Role.COMMANDER) as commander:
        opened = (await commander.post("/incidents", json={"name": "Kitchen"})).json()
        paths = [f"/incidents/{opened['incident_id']}/{one}" for one in ("export/csv", "tracks")]
        answers = await asyncio.gather(*(commander.get(path) for path in paths * 4))
    assert {answer.status_code for answer in answers} == {200}
    assert most == 1


def full(*_: object) -> None:
    raise StoreError("the disk is full")
