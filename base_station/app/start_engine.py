"""Reads the log up to its end into the live state, and lets time pass from there."""

from __future__ import annotations

import logging
from collections.abc import Callable
from contextlib import AbstractContextManager

from base_station.app.pipeline_factory import new_pipeline
from base_station.app.startup_console import Watch
from base_station.core.state import StationState
from base_station.engine.engine import StationEngine
from base_station.engine.log_feed import LogFeed
from base_station.engine.ports import EnginePorts
from base_station.site.plan_reader import PlanReader
from base_station.storage.checkpoints import SavedState

_log = logging.getLogger(__name__)


def start_engine(
    log: LogFeed,
    saved: SavedState | None,
    ports: EnginePorts,
    begin: Callable[[tuple[int, int], StationState], None],
    recovery: AbstractContextManager[Watch],
    plans: PlanReader,
) -> StationEngine:
    """Return an engine with the live state of the log; ``begin`` receives that state before the
    engine runs.
    """
    pipeline = new_pipeline(saved.pipeline if saved else None, plans)
    drive = StationEngine(pipeline, ports)
    log_position = (saved.t_ns, saved.events_at_t) if saved else (0, 0)
    with recovery as watched:
        stepped = drive.rebuild(watched(log.records(log_position[0])), log_position)
    _log.info("live state from the log: %d events after the checkpoint", stepped)
    begin(drive.log_position, pipeline.state)
    drive.start()
    return drive
