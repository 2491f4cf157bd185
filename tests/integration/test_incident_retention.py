"""A station erases an incident that is older than its settings keep incidents."""

from __future__ import annotations

import dataclasses
import tarfile
from collections.abc import Callable
from pathlib import Path

import httpx

from base_station.config import RetentionConfig
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER
from shared.clock import SystemClock
from shared.mcap_log import read_log
from tests.rig.in_process_station import InProcessStation
from tests.rig.older_data_folder import ARCHIVE
from tests.rig.station_command import Command
from tests.rig.waiting import until


def test_station_erases_incident_over_its_retention(
    serve: Callable[..., Command], data: Path, tmp_path: Path
) -> None:
    with tarfile.open(ARCHIVE) as archive:
        archive.extractall(data, filter="data")
    (settings := tmp_path / "station.toml").write_text("[retention]\nincident_days = 1.0\n")
    serve("--config", str(settings)).wait_ready()
    with Store(data / "station.sqlite") as store:
        records = Records(store, SystemClock())
        incident = records.require_incident("i1")
        assert records.tracks_of(incident) != {}
        assert positions_in(data, incident) != []

        def erasures() -> list[str]:
            entries = records.audit_entries(EVER)
            return [one.by for one in entries if one.action == "ForgotIncident"]

        until(lambda: erasures() == ["retention"], "the erasure")
        assert records.require_incident("i1").name == "Mill Lane"
        assert records.tracks_of(incident) == {}
    assert positions_in(data, incident) == []


async def test_closed_incident_has_the_time_of_its_erasure(
    station: InProcessStation, browser: httpx.AsyncClient
) -> None:
    station.app.state.services = dataclasses.replace(
        station.services, retention=RetentionConfig(30.0)
    )
    opened = (await browser.post("/incidents", json={"name": "Mill Lane"})).json()
    assert opened["erased_at_ms"] is None
    address = f"/incidents/{opened['incident_id']}"
    await browser.post(f"{address}/close")
    closed = (await browser.get(address)).json()
    assert closed["erased_at_ms"] == closed["closed_ms"] + 30 * 86_400_000
    station.app.state.services = station.services
    assert (await browser.get(address)).json()["erased_at_ms"] is None


def positions_in(data: Path, incident: IncidentRow) -> list[str]:
    """Keys of the positions in the log that came while the incident was open."""
    assert incident.closed_ns is not None
    return [
        key
        for t_ns, key, _ in read_log(data / "log")
        if incident.opened_ns <= t_ns < incident.closed_ns and key.endswith("/up/position")
    ]
