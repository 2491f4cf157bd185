"""Thirty photographs of 50 megapixels at once, and pictures that are larger than they look."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from tests.rig.loaded_program import launch_loaded
from tests.rig.picture_flood import bomb, photograph, photographs_at_once, put_picture
from tests.rig.processes import peak_memory_mb
from tests.rig.station_process import StationProcess, free_port, station_process

PHOTOGRAPHS = 30
GROWN_MB = 160.0  # the bodies of four, each twice while it is put together, and one picture
GROWN_BY_MAP_MB = 220.0
MAP = "/site/base-map?" + "&".join(f"world={value}" for value in (1e-6, 0, 0, -1e-6, 13.0, 52.0))


@pytest.fixture
def station(tmp_path_factory: pytest.TempPathFactory) -> Iterator[StationProcess]:
    with ExitStack() as stack:
        folder, address = tmp_path_factory.mktemp("station"), f"tcp/127.0.0.1:{free_port()}"
        yield stack.enter_context(station_process(folder, address, launch=launch_loaded))


def test_thirty_photographs_at_once_are_taken_a_few_at_a_time(station: StationProcess) -> None:
    before_mb = peak_memory_mb(station.pid)
    with photographs_at_once(station.api, PHOTOGRAPHS) as answered:
        for number in range(50):
            station.api.post("/units", {"unit_id": f"FF-{number}"})
    assert answered == {204: PHOTOGRAPHS}
    assert peak_memory_mb(station.pid) < before_mb + GROWN_MB


def test_a_map_of_50_megapixels_is_decoded_at_a_part_of_its_size(station: StationProcess) -> None:
    before_mb = peak_memory_mb(station.pid)
    assert put_picture(station.api, MAP, photograph()) == 200
    assert peak_memory_mb(station.pid) < before_mb + GROWN_BY_MAP_MB


def test_a_picture_that_is_larger_than_it_looks_is_refused(station: StationProcess) -> None:
    person_id = station.api.post("/people", {"name": "Mallory"})["person_id"]
    before_mb = peak_memory_mb(station.pid)
    for path in (f"/people/{person_id}/photo", MAP):
        assert put_picture(station.api, path, bomb()) == 422
    assert peak_memory_mb(station.pid) < before_mb + GROWN_MB
