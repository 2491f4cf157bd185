"""The buses that keep one contract."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from tests.rig.bus_ends import Ends, Fabric, MemoryFabric, ZenohFabric


@pytest.fixture(params=["memory", "zenoh"])
def ends(request: pytest.FixtureRequest) -> Iterator[Ends]:
    with ExitStack() as stack:
        fabric: Fabric = MemoryFabric() if request.param == "memory" else ZenohFabric(stack)
        station = fabric.station()
        yield Ends(station, fabric.unit(), fabric)
