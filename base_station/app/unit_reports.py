"""Reports to units of the messages that the station has.  Their journals are backfilled and
acknowledged by these.
"""

from __future__ import annotations

from base_station.app.resources import Resources
from base_station.standby.mode import HaMode
from base_station.unit_sync.backfill import Backfill, Report
from base_station.unit_sync.durable_ack import DurableAckGate


class UnitReports:
    """Reports of the engine; any other thread may count and ask."""

    def __init__(self, resources: Resources, ha_mode: HaMode) -> None:
        self._ha_mode = ha_mode
        self._recorder = resources.recorder
        self._durable = DurableAckGate(resources.recorder)
        self._missing_count = 0  # times that the log was found to have messages no more
        self.backfill = Backfill(
            resources.bus, resources.feed.deliver, resources.clock, self._may_acknowledge
        )

    def report(self, held: Report, in_memory: bool) -> None:
        """Pass on the engine's report of received messages of units."""
        self._ha_mode.note_report()
        self._durable.note_report_received()
        refused = self._recorder.lost + self._missing_count
        self.backfill.report(held, refused, alerts_only=in_memory)

    def count_missing(self) -> None:
        """Note that the log has lost messages, which are then queried again."""
        self._missing_count += 1

    def _may_acknowledge(self) -> bool:
        return self._ha_mode.may_forget() and self._durable.previous_report_is_durable()
