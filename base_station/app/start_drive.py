"""Brings the live state to where the log ends, and lets time pass from there."""

from __future__ import annotations

import logging
from collections.abc import Callable
from contextlib import AbstractContextManager

from base_station.app.parts import new_pipeline
from base_station.drive import StationDrive
from base_station.feed import LogFeed
from base_station.live.drive_ports import DrivePorts
from base_station.live.recovering import Watch
from base_station.live_state import StationState
from base_station.past.checkpoints import SavedState

_log = logging.getLogger(__name__)


def start_drive(
    log: LogFeed,
    saved: SavedState | None,
    ports: DrivePorts,
    begin: Callable[[tuple[int, int], StationState], None],
    recovery: AbstractContextManager[Watch],
) -> StationDrive:
    """A drive whose live state is what the log says; ``begin`` hears it before it runs."""
    pipeline = new_pipeline(saved.pipeline if saved else None)
    drive = StationDrive(pipeline, ports)
    place = (saved.t_ns, saved.events_at_t) if saved else (0, 0)
    with recovery as watched:
        stepped = drive.rebuild(watched(log.records(place[0])), place)
    _log.info("live state from the log: %d events after the checkpoint", stepped)
    begin(drive.place, pipeline.state)
    drive.start()
    return drive
