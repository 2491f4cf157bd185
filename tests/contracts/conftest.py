"""Fixtures of the contracts: each kind of bus and of database."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from base_station.storage.db.database import Database
from base_station.storage.db.server_store import ServerStore
from base_station.storage.db.store import Store
from tests.rig.bus_ends import BusEnds, Fabric, MemoryFabric, ZenohFabric
from tests.rig.database_server import DatabaseServer, database_server

DATABASE_KINDS = ("file", "server")
NewDatabase = Callable[[], Database]


@pytest.fixture(params=["memory", "zenoh"])
def ends(request: pytest.FixtureRequest) -> Iterator[BusEnds]:
    with ExitStack() as stack:
        fabric: Fabric = MemoryFabric() if request.param == "memory" else ZenohFabric(stack)
        station = fabric.station()
        yield BusEnds(station, fabric.unit(), fabric)


@pytest.fixture(scope="session")
def server() -> Iterator[DatabaseServer]:
    with database_server() as server:
        yield server


@pytest.fixture(params=DATABASE_KINDS)
def new(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[NewDatabase]:
    """A factory of empty databases of one kind."""
    with ExitStack() as closing:

        def made() -> Database:
            if request.param == "file":
                name = f"{len(list(tmp_path.iterdir()))}.sqlite"
                return closing.enter_context(Store(tmp_path / name))
            server: DatabaseServer = request.getfixturevalue("server")
            address = server.new_database(tmp_path)
            return closing.enter_context(ServerStore(address, is_station=True))

        yield made
