"""Reading after writing: a read of tables includes all that was decided before its request.

An action is answered when it is decided and in the log; the database has it later.  So reads wait
for it, without a thread, which would delay other requests, and not for ever.
"""

from __future__ import annotations

import asyncio
import time
from typing import Annotated

from fastapi import Depends

from base_station.api.authentication import Viewer
from base_station.api.services import Services, Station

MAX_WAIT_S = 5.0  # then the tables are read as they are: most of the data is there
_LOOK_S = 0.01


async def _current_station(station: Station, _: Viewer) -> Services:
    is_over = station.projection.flush_soon()
    end_s = time.monotonic() + MAX_WAIT_S
    while not is_over() and time.monotonic() < end_s:
        await asyncio.sleep(_LOOK_S)
    return station


CurrentStation = Annotated[Services, Depends(_current_station)]
"""``Station`` of a route that reads tables into which the engine's decisions are projected."""
