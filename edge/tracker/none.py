"""For a unit too weak to track: no rows.  No entry of ``TRACKERS``, as it keeps none of their
promises; its tracking agent computes the positions.
"""

from __future__ import annotations

from edge.samples import ImuBatch
from edge.tracker.port import TrackBatch
from edge.tracker.rows import empty_rows
from shared.earth_field import EarthField


class NoTracker:
    def push(self, batch: ImuBatch) -> TrackBatch:
        del batch
        return empty_rows()

    def learn_field(self, field: EarthField, t_ns: int) -> None:
        del field, t_ns

    def finish(self) -> TrackBatch:
        return empty_rows()
