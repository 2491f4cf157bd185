"""Report of the messages that the station has, for the journals of the units."""

from __future__ import annotations

from collections.abc import Collection

from base_station.core.state import StationState
from base_station.unit_sync.backfill import Report
from base_station.unit_sync.journal_client import Held


def message_report(state: StationState, linked: Collection[str]) -> Report:
    """Report the messages of units that are linked or have sent something recently."""
    return {
        sender.unit_id: tuple(Held(boot.boot_id, tuple(boot.seen.runs())) for boot in sender.boots)
        for unit in state.units.values()
        if unit.registered
        for sender in (unit, unit.tracker)
        if sender is not None
        if sender.unit_id in linked or sender.link_at(state.t_ns) == "live"
    }
