"""Thirty photographs of 50 megapixels at once, decompression bombs, and slow uploads."""

from __future__ import annotations

import secrets
import time
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from tests.rig.console_client import Api
from tests.rig.loaded_program import launch_loaded
from tests.rig.picture_flood import (
    SlowUpload,
    bomb,
    photograph,
    photographs_at_once,
    put_file,
)
from tests.rig.processes import peak_memory_mb
from tests.rig.station_process import StationProcess, free_port, station_process

PHOTOGRAPHS = 30
GROWN_MB = 160.0  # the bodies of four, each twice while it is put together, and one picture
GROWN_BY_MAP_MB = 220.0
SLOW_BYTES_PER_S = 20_000  # twice of what a body has to bring at least
MAP = "/site/base-map?" + "&".join(f"world={value}" for value in (1e-6, 0, 0, -1e-6, 13.0, 52.0))


@pytest.fixture
def station(tmp_path_factory: pytest.TempPathFactory) -> Iterator[StationProcess]:
    with ExitStack() as stack:
        folder, address = tmp_path_factory.mktemp("station"), f"tcp/127.0.0.1:{free_port()}"
        yield stack.enter_context(station_process(folder, address, launch=launch_loaded))


def test_simultaneous_photographs_are_decoded_a_few_at_a_time(station: StationProcess) -> None:
    before_mb = peak_memory_mb(station.pid)
    with photographs_at_once(station.api, PHOTOGRAPHS) as answered:
        for number in range(50):
            station.api.post("/units", {"unit_id": f"FF-{number}"})
    assert answered == {204: PHOTOGRAPHS}
    assert peak_memory_mb(station.pid) < before_mb + GROWN_MB


def test_slow_uploads_delay_no_picture_of_other_users(station: StationProcess) -> None:
    """Four users with more uploads than are read at once, each as fast as no deadline is missed."""
    person_id = station.api.post("/people", {"name": "Ada"})["person_id"]
    path = f"/people/{person_id}/photo"
    picture = photograph()
    with ExitStack() as stack:
        slow = []
        for name in ("ann", "bob", "cy", "dan"):
            password = secrets.token_urlsafe()
            new = {"username": name, "password": password, "role": "commander"}
            station.api.post("/users", new)
            user = Api(station.api.origin, name, password)
            slow += [stack.enter_context(SlowUpload(user, path, SLOW_BYTES_PER_S)) for _ in "123"]
        time.sleep(2.0)  # until all are read that are read at once
        for _ in range(2):
            assert put_file(station.api, path, picture) == 204
        ended = [one.answer for one in slow if one.answer]
        assert ended
        assert all(b" 408 " in answer for answer in ended)
        assert station.api.get("/health")


def test_a_map_of_50_megapixels_is_decoded_at_a_part_of_its_size(station: StationProcess) -> None:
    before_mb = peak_memory_mb(station.pid)
    assert put_file(station.api, MAP, photograph()) == 200
    assert peak_memory_mb(station.pid) < before_mb + GROWN_BY_MAP_MB


def test_decompression_bomb_is_refused(station: StationProcess) -> None:
    person_id = station.api.post("/people", {"name": "Mallory"})["person_id"]
    before_mb = peak_memory_mb(station.pid)
    for path in (f"/people/{person_id}/photo", MAP):
        assert put_file(station.api, path, bomb()) == 422
    assert peak_memory_mb(station.pid) < before_mb + GROWN_MB
