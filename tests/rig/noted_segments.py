"""Segments of a log in the list of the database."""

from __future__ import annotations

from pathlib import Path

from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.segment_index import segment_row
from shared.clock import SystemClock
from shared.mcap_log import SegmentReader, segment_paths


def note_segments(store: Store, log: Path) -> None:
    """As a station does when it begins a segment."""
    rows = []
    for path in segment_paths(log):
        with SegmentReader(path) as segment:
            rows.append(segment_row(segment.info()))
    Records(store, SystemClock()).put_segments(rows)
