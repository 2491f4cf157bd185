"""Puts together what is shown while a station reads its log: what was last stored."""

from __future__ import annotations

import asyncio

from starlette.types import ASGIApp

from base_station.api.app import create_app
from base_station.api.hub import Hub
from base_station.api.replays import ReplayPlayer, Replays
from base_station.api.services import Services
from base_station.app.disk import Disk
from base_station.config import StationConfig
from base_station.db.base_maps import BaseMaps
from base_station.db.models import Incident
from base_station.live.last_known import LastKnown
from base_station.live.recovering import Tell
from shared.errors import UserError


def early_console(config: StationConfig, disk: Disk) -> tuple[ASGIApp, Tell]:
    """The application, and what hears how much of the log is read."""
    hub = Hub()
    known = LastKnown(disk.roster, disk.records, disk.clock, hub)
    services = Services(
        accounts=disk.accounts,
        roster=disk.roster,
        records=disk.records,
        base_maps=BaseMaps(disk.store),
        hub=hub,
        gate=known,
        settle=lambda: None,
        replays=Replays(_no_replay),
        forgettings=None,
        clock=disk.clock,
        secure=config.http.certificate is not None,
        standing=known,
        accountability=config.accountability,
    )

    def started(loop: asyncio.AbstractEventLoop) -> None:
        hub.connect(loop, known)

    return create_app(services, started), known.tell


def _no_replay(_incident: Incident, _speed: float, _hub: Hub) -> ReplayPlayer:
    raise UserError("the station is reading its log; replay when it is done")
