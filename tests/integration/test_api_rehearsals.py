"""Rehearsal of thresholds over the API: in a process of its own, on the folder of a station."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import pytest_asyncio

from base_station.accounts.principals import Role
from base_station.app import folder_commands
from base_station.replay.processes.log_process import LogProcess
from base_station.replay.processes.rehearsal_process import RehearsalProcess
from base_station.replay.processes.server import ReplayProcesses
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from shared.clock import NS_PER_S, ManualClock
from shared.mcap_log import segment_paths
from shared.messages.station import OpenIncident
from tests.rig.in_process_station import InProcessStation
from tests.rig.reported_incident import write_log
from tests.rig.resting_person import DURATION_S, resting_person
from tests.rig.station_script import START_NS


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> DataFolder:
    """With a closed incident, and an open one behind it."""
    path = tmp_path_factory.mktemp("recorded")
    script = resting_person(30.0)
    script.act(OpenIncident("i2", "Harbour"))
    write_log(path, script.records)
    folder_commands.rebuild(path, lambda _: None)
    return DataFolder(path)


@pytest.fixture(scope="module")
def rehearsals(folder: DataFolder) -> Iterator[RehearsalProcess]:
    with ReplayProcesses() as processes:
        log_process = LogProcess(
            processes, str(folder.log), str(folder.database), lambda: None, lambda _: None, tuple
        )
        yield RehearsalProcess(log_process, str(folder.checkpoints))


@pytest_asyncio.fixture
async def station(
    tmp_path: Path, folder: DataFolder, rehearsals: RehearsalProcess
) -> AsyncIterator[InProcessStation]:
    clock = ManualClock(utc_ns=START_NS + 400 * NS_PER_S)
    station = InProcessStation(tmp_path, clock)
    station.hub.connect(asyncio.get_running_loop(), station.drive)
    with Store(folder.database) as store:
        station.app.state.services = replace(
            station.services,
            roster=Roster(store, clock),
            records=Records(store, clock),
            rehearse=rehearsals.rehearse,
        )
        yield station
    station.close()


async def answer(station: InProcessStation, path: str, **query: Any) -> tuple[int, Any]:
    async with station.client(Role.VIEWER) as viewer:
        response = await viewer.get(f"/incidents/{path}", params=query)
    return response.status_code, response.json()


@pytest.mark.asyncio
async def test_thresholds_have_the_values_of_the_incident(station: InProcessStation) -> None:
    _, thresholds = await answer(station, "i1/thresholds")
    of_no_motion = [one for one in thresholds if one["rule"] == "no-motion"]
    assert of_no_motion == [
        {
            "rule": "no-motion",
            "threshold": name,
            "value": value,
            "lowest": 5.0,
            "highest": 300.0,
        }
        for name, value in (("pre_alert_s", 10.0), ("alarm_s", 30.0))
    ], "20 s are the default of the pre-alert; rearm_after_s cannot be rehearsed"


@pytest.mark.asyncio
async def test_rehearsal_counts_what_other_thresholds_would_have_raised(
    station: InProcessStation,
) -> None:
    _, found = await answer(station, "i1/rehearsal", change="no-motion.alarm_s=20")
    alarm = found["points"][0]["levels"][1]
    assert (alarm["recorded"], alarm["rehearsed"]) == (1, 3)
    assert (alarm["earlier"], alarm["added"], alarm["missed"]) == (1, 2, 0)
    assert found["worn_h"] == pytest.approx(DURATION_S / 3600.0, rel=0.02)
    assert found["wearers"] == {"FF-01": ["Anna Vos"]}
    outcomes = [one["outcome"] for one in found["points"][0]["changes"] if one["level"] == "alarm"]
    assert sorted(outcomes) == ["added", "added", "earlier"]
    _, sweep = await answer(station, "i1/rehearsal", sweep="no-motion.alarm_s=5:65:20")
    assert sweep["swept"] == "no-motion.alarm_s"
    assert [bool(one["problem"]) for one in sweep["points"]] == [True, False, False, False]
    assert [one["levels"][1]["rehearsed"] for one in sweep["points"][1:]] == [2, 1, 0]


@pytest.mark.asyncio
@pytest.mark.parametrize(
    ("incident", "query", "status", "code"),
    [
        ("i2", {"change": "no-motion.alarm_s=20"}, 409, "rehearsal-open"),
        ("i9", {"change": "no-motion.alarm_s=20"}, 404, "incident-unknown"),
        ("i1", {}, 422, "rehearsal-wrong"),
        ("i1", {"change": "no-motion.alarm_s=2"}, 422, "rehearsal-wrong"),
        ("i1", {"change": "mayday.alarm_s=20"}, 422, "rehearsal-wrong"),
        ("i1", {"change": "rubbish"}, 422, "rehearsal-wrong"),
        ("i1", {"sweep": "no-motion.alarm_s=60:20:5"}, 422, "rehearsal-wrong"),
        ("i1", {"sweep": "no-motion.alarm_s=20:60:0.001"}, 422, "rehearsal-wrong"),
    ],
)
async def test_what_cannot_be_rehearsed_is_refused(
    station: InProcessStation, incident: str, query: dict[str, str], status: int, code: str
) -> None:
    answered, problem = await answer(station, f"{incident}/rehearsal", **query)
    assert (answered, problem["code"]) == (status, code), problem


@pytest.mark.asyncio
async def test_damaged_log_is_rehearsed_as_far_as_it_is_readable(
    station: InProcessStation, rehearsals: RehearsalProcess, folder: DataFolder, tmp_path: Path
) -> None:
    write_log(tmp_path, resting_person(30.0).records)
    damaged = segment_paths(tmp_path / "log")[0]
    content = bytearray(damaged.read_bytes())
    third = len(content) // 3
    content[third : third + 1000] = bytes(1000)  # more than lies between two chunks
    damaged.write_bytes(content)
    elsewhere = replace(rehearsals.log_process, log=str(tmp_path / "log"))
    station.app.state.services = replace(
        station.app.state.services, rehearse=replace(rehearsals, log_process=elsewhere).rehearse
    )
    status, found = await answer(station, "i1/rehearsal", change="no-motion.alarm_s=20")
    assert status == 200, found
    coded = dict(zip(found["flaws"], found["flaw_codes"], strict=True))
    parts = [one for flaw, one in coded.items() if damaged.name in flaw]
    assert parts
    for one in parts:
        assert (one["code"], one["texts"]["part:file"]) == ("log-part-unreadable", damaged.name)
