"""The timeline of a unit over the API, from a log and a database in a folder."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import pytest_asyncio

from base_station.accounts.principals import Role
from base_station.app import folder_commands
from base_station.engine.log_feed import FolderFeed
from base_station.replay.processes.log_process import LogProcess
from base_station.replay.processes.server import ReplayProcesses
from base_station.replay.processes.timeline_process import TimelineProcess
from base_station.replay.timelines.unit_timeline import TimelineRequest, read_timeline
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.db.window import Window
from shared.clock import NS_PER_MS, NS_PER_S, ManualClock, SystemClock
from shared.errors import StoreError
from shared.mcap_log import segment_paths
from tests.rig.in_process_station import InProcessStation
from tests.rig.reported_incident import (
    HOT_DEGC,
    HOT_FROM_S,
    HOT_UNTIL_S,
    SILENT_FROM_S,
    SILENT_UNTIL_S,
    incident_records,
    write_log,
)
from tests.rig.station_script import START_NS

START_MS = START_NS // NS_PER_MS
SPAN = {"from_ms": START_MS, "until_ms": START_MS + 300_000, "buckets": 100}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> DataFolder:
    """With the log of five minutes, and the database made of it."""
    path = tmp_path_factory.mktemp("recorded")
    write_log(path, incident_records())
    folder_commands.rebuild(path, lambda _: None)
    return DataFolder(path)


@pytest.fixture(scope="module")
def store(folder: DataFolder) -> Iterator[Store]:
    with Store(folder.database) as store:
        yield store


@pytest_asyncio.fixture
async def station(
    tmp_path: Path, folder: DataFolder, store: Store
) -> AsyncIterator[InProcessStation]:
    clock = ManualClock(utc_ns=START_NS + 400 * NS_PER_S)
    station = InProcessStation(tmp_path, clock)
    station.hub.connect(asyncio.get_running_loop(), station.drive)
    station.app.state.services = replace(
        station.services,
        roster=Roster(store, clock),
        read_timeline=partial(read_timeline, Records(store, clock), FolderFeed(folder.log)),
    )
    yield station
    station.close()


async def timeline(station: InProcessStation, unit_id: str, **span: int) -> dict[str, Any]:
    async with station.client(Role.VIEWER) as viewer:
        response = await viewer.get(f"/units/{unit_id}/timeline", params=SPAN | span)
    assert response.status_code == 200, response.text
    answer: dict[str, Any] = response.json()
    return answer


async def refusal(station: InProcessStation, unit_id: str, **span: int) -> tuple[int, str]:
    async with station.client(Role.VIEWER) as viewer:
        response = await viewer.get(f"/units/{unit_id}/timeline", params=SPAN | span)
    return response.status_code, response.json()["detail"]


def points(column: dict[str, Any]) -> list[tuple[float, float | None]]:
    """Seconds since the beginning of the script, and values."""
    seconds = [(t_ms - START_MS) / 1000 for t_ms in column["t_ms"]]
    return list(zip(seconds, column["values"], strict=True))


@pytest.mark.asyncio
async def test_columns_contain_measured_and_reported_values(station: InProcessStation) -> None:
    answer = await timeline(station, "FF-03")
    hot = [t_s for t_s, degc in points(answer["temperature_degc"]) if degc == HOT_DEGC]
    assert HOT_FROM_S <= hot[0] <= HOT_FROM_S + 4
    assert HOT_UNTIL_S - 4 <= hot[-1] <= HOT_UNTIL_S
    heights = [height_m for _, height_m in points(answer["height_m"]) if height_m is not None]
    assert (min(heights), max(heights)) == pytest.approx((0.0, 3.0), abs=0.5)
    assert set(answer["floor"]["values"]) == {0, 1}
    assert all(error_m > 0.0 for error_m in answer["position_error_m"]["values"])
    names = {answer["activity_names"][round(one)] for one in answer["activity"]["values"]}
    assert names <= {"walking", "still"}
    assert names
    assert all(0.0 <= one <= 1.0 for one in answer["battery"]["values"])
    assert max(answer["silence_s"]["values"]) < 10.0
    for name in ("temperature_degc", "height_m", "battery", "silence_s"):
        assert 50 <= len(answer[name]["values"]) <= 220, name


@pytest.mark.asyncio
async def test_a_radio_gap_is_a_gap_of_the_columns(station: InProcessStation) -> None:
    answer = await timeline(station, "FF-02")
    (gap,) = answer["radio_gaps_ms"]
    assert [(t_ms - START_MS) / 1000 for t_ms in gap] == pytest.approx(
        [SILENT_FROM_S, SILENT_UNTIL_S], abs=2.0
    )
    for name in ("temperature_degc", "activity"):
        (broken_s,) = [t_s for t_s, value in points(answer[name]) if value is None]
        assert broken_s == pytest.approx(SILENT_FROM_S, abs=2.0)
    assert max(answer["silence_s"]["values"]) == pytest.approx(
        SILENT_UNTIL_S - SILENT_FROM_S, abs=2.0
    )


@pytest.mark.asyncio
async def test_timeline_refuses_unknown_units_and_limits_its_span(
    station: InProcessStation,
) -> None:
    status, detail = await refusal(station, "FF-99")
    assert (status, "no unit FF-99" in detail) == (404, True)
    longest = await timeline(station, "FF-01", from_ms=0)
    assert longest["until_ms"] - longest["from_ms"] == 24 * 3_600_000
    assert (await refusal(station, "FF-01", buckets=5))[0] == 422
    for until_ms in (START_MS, START_MS - 60_000):
        empty = await timeline(station, "FF-01", until_ms=until_ms)
        assert (empty["temperature_degc"]["t_ms"], empty["radio_gaps_ms"]) == ([], [])
    ahead = await timeline(station, "FF-01", until_ms=START_MS + 9_000_000)
    assert ahead["until_ms"] == START_MS + 400_000, "nothing is known of later than now"
    assert ahead["radio_gaps_ms"][-1][1] == ahead["until_ms"]


def test_separate_process_reads_the_same_timeline(
    folder: DataFolder, store: Store, tmp_path: Path
) -> None:
    request = TimelineRequest("FF-02", Window(START_NS, START_NS + 300 * NS_PER_S), 100)
    here = read_timeline(Records(store, SystemClock()), FolderFeed(folder.log), request)
    damage: list[str] = []
    with ReplayProcesses() as processes:
        log_process = LogProcess(
            processes, str(folder.log), str(folder.database), lambda: None, damage.append, tuple
        )
        reader = TimelineProcess(log_process)
        assert reader.read(request) == here
        hasty = replace(reader, timeout_s=0.0)
        with pytest.raises(StoreError, match="shorter span"):
            hasty.read(request)
        write_log(tmp_path, incident_records())
        damaged = segment_paths(tmp_path / "log")[2]
        content = bytearray(damaged.read_bytes())
        third = len(content) // 3
        content[third : third + 1000] = bytes(1000)  # more than lies between two chunks
        damaged.write_bytes(content)
        reported = TimelineProcess(replace(log_process, log=str(tmp_path / "log"))).read(request)
    assert any(damaged.name in one for one in reported.defects)
    assert any(damaged.name in one for one in damage)
