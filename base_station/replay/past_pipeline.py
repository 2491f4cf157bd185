"""Steps the log of a station that went on, whatever happened to it."""

from __future__ import annotations

import logging

from base_station.core.events import Output, StationEvent
from base_station.core.pipeline import StationPipeline

_log = logging.getLogger(__name__)


class ReplayPipeline(StationPipeline):
    """A bug of the program costs one event, as it did live: later ones are stepped."""

    def step(self, event: StationEvent) -> list[Output]:
        try:
            return super().step(event)
        except Exception:  # noqa: BLE001  # logged, and the past goes on
            _log.exception("an event of the log, at %d ns, cannot be stepped", event.t_ns)
            return []
