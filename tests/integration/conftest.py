"""Stations: the API alone on a folder of its own, or a process with a port and a unit beside it."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable, Iterator
from pathlib import Path

import httpx
import pytest
import pytest_asyncio

from base_station.storage.data_folder import DataFolder
from base_station.storage.db.store import Store
from shared.clock import ManualClock
from tests.rig.erasure_folders import split_log
from tests.rig.erasure_scenario import ErasureScenario
from tests.rig.in_process_station import ORIGIN, PASSWORD, InProcessStation
from tests.rig.station_command import Command, Unit
from tests.rig.station_process import free_port
from tests.rig.table_side import TableSide


@pytest.fixture
def station(tmp_path: Path, clock: ManualClock) -> Iterator[InProcessStation]:
    station = InProcessStation(tmp_path, clock)
    yield station
    station.close()


@pytest_asyncio.fixture
async def browser(station: InProcessStation) -> AsyncIterator[httpx.AsyncClient]:
    """Logged in as the commander with a cookie."""
    async with station.client() as client:
        client.headers["origin"] = ORIGIN
        credentials = {"username": "commander", "password": PASSWORD}
        answer = await client.post("/login", json=credentials)
        assert answer.status_code == 200, answer.text
        yield client


@pytest.fixture
def sides(tmp_path: Path) -> Iterator[tuple[TableSide, TableSide]]:
    folders = [tmp_path / name for name in ("active", "standby")]
    for folder in folders:
        folder.mkdir()
    with Store(folders[0] / "s.sqlite") as one, Store(folders[1] / "s.sqlite") as other:
        yield TableSide(folders[0], one), TableSide(folders[1], other)


@pytest.fixture
def data(tmp_path: Path) -> Path:
    return tmp_path / "station"


@pytest.fixture
def port() -> int:
    return free_port()


@pytest.fixture
def serve(tmp_path: Path, data: Path, port: int) -> Iterator[Callable[..., Command]]:
    started: list[Command] = []

    def start(*flags: str) -> Command:
        started.append(
            Command(
                tmp_path / f"output-{len(started)}.txt",
                *("serve", "--data", str(data), "--listen", f"tcp/127.0.0.1:{port}"),
                *("--http", "127.0.0.1:0", *flags),
            )
        )
        return started[-1]

    yield start
    for command in started:
        command.kill()


@pytest.fixture
def unit(port: int) -> Iterator[Unit]:
    unit = Unit(port, "FF-01")
    yield unit
    unit.close()


@pytest.fixture(scope="module")
def reported(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A station's folder with people in it, and a log of several segments."""
    folder = ErasureScenario(tmp_path_factory.mktemp("told") / "station").folder
    split_log(DataFolder(folder).log, 4)
    return folder
