"""A station as a process, in a folder and on a port of its own, and a unit that speaks to it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from base_station.bench.station import free_port
from tests.station_command import Command, Unit


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
