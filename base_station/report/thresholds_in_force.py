"""Thresholds of the alarm rules as they were in force at some time."""

from __future__ import annotations

from base_station.core.alarms.thresholds import Thresholds
from base_station.report.orders import details_of
from base_station.storage.db.records import Records
from shared.messages.station import SetThresholds


def thresholds_in_force(records: Records, before_ns: int) -> Thresholds:
    """Thresholds that differ from the defaults; ``before_ns``: a station time."""
    last = records.last_audited(SetThresholds.__name__, before_ns)
    return {} if last is None else dict(details_of(last).get("thresholds", {}))
