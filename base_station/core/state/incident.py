"""An incident, as the pipeline keeps it."""

from __future__ import annotations

import msgspec

from base_station.core.work_limits import PAR_INTERVAL_S, WORK_LIMIT_S


class Incident(msgspec.Struct, frozen=True):
    incident_id: str
    name: str
    opened_ns: int
    closed_ns: int | None = None
    par_interval_s: float = PAR_INTERVAL_S  # everybody is to be heard from this often
    work_limit_s: float = WORK_LIMIT_S  # of work, after which somebody should rest
