"""Reading after writing: a read of tables includes all that was decided before its request.

An action is answered when it is decided and in the log; the database has it later.  So reads wait
for it, without a thread, which would delay other requests, and not for ever.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Annotated

from fastapi import Depends

from base_station.api.authentication import Viewer
from base_station.api.services import Services, Station

MAX_WAIT_S = 5.0  # then the tables are read as they are: most of the data is there
_LOOK_S = 0.01


async def _current_station(station: Station, _: Viewer) -> Services:
    await _wait_until(station.projection.flush_soon())
    return station


async def _station_with_actions(station: Station, _: Viewer) -> Services:
    await _wait_until(station.projection.flush_actions_soon())
    return station


async def _wait_until(is_over: Callable[[], bool]) -> None:
    end_s = time.monotonic() + MAX_WAIT_S
    while not is_over() and time.monotonic() < end_s:
        await asyncio.sleep(_LOOK_S)


CurrentStation = Annotated[Services, Depends(_current_station)]
"""``Station`` of a route that reads tables into which the engine's decisions are projected."""

StationWithActions = Annotated[Services, Depends(_station_with_actions)]
"""``Station`` of a route that reads only what operators' actions have put into those tables."""
