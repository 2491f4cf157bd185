"""Keeps the table of log segments like the log."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping
from pathlib import Path

from base_station.db.models import LogSegment
from base_station.db.records import Records
from base_station.program.recurring_trouble import RecurringTrouble
from shared.mcap_log import SegmentInfo

_log = logging.getLogger(__name__)


class SegmentIndex:
    def __init__(self, records: Records, notes: Mapping[Path, str]) -> None:
        """``notes``: what recovery had to say of segments."""
        self._records = records
        self._notes = notes
        self._trouble = RecurringTrouble(_log, "the list of log segments is not up to date")
        self._written: dict[Path, SegmentInfo] = {}

    def update(self, segments: Iterable[SegmentInfo]) -> None:
        """Write what has changed; where the store does not take it, next time again."""
        changed = [one for one in segments if self._written.get(one.path) != one]
        if not changed:
            return
        with self._trouble:
            self._records.put_segments(map(self._row, changed))
            self._written |= {one.path: one for one in changed}

    def _row(self, segment: SegmentInfo) -> LogSegment:
        return LogSegment(
            name=segment.path.name,
            first_ns=segment.start_ns,
            last_ns=segment.end_ns,
            messages=segment.messages,
            size_bytes=segment.size_bytes,
            note=self._notes.get(segment.path, ""),
        )
