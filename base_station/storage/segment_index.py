"""Table of log segments, kept equal to the log's files."""

from __future__ import annotations

import logging
from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import Path

from base_station.storage.db.models import LogSegment
from base_station.storage.db.records import Records
from base_station.storage.missing_segments import KnownSegment
from shared.log_on_change import LogOnChange
from shared.mcap_log import SegmentInfo

_log = logging.getLogger(__name__)


class SegmentIndex:
    def __init__(
        self,
        records: Records,
        notes: Mapping[Path, str],
        lacking: Callable[[], Collection[str]] = tuple,
    ) -> None:
        """``notes`` of the recovery of segments.  ``lacking`` names those with losses: the table
        keeps their former content.
        """
        self._records = records
        self._notes = notes
        self._lacking = lacking
        self._trouble = LogOnChange(_log, "the list of log segments is not up to date")
        self._written: dict[Path, SegmentInfo] = {}

    def update(self, segments: Iterable[SegmentInfo]) -> None:
        """Write changes; where the database does not take them, the next call tries again."""
        lacking = self._lacking()
        changed = [
            one
            for one in segments
            if one.path.name not in lacking and self._written.get(one.path) != one
        ]
        if not changed:
            return
        with self._trouble:
            self._records.put_segments(
                segment_row(one, self._notes.get(one.path, "")) for one in changed
            )
            self._written |= {one.path: one for one in changed}


def segment_row(segment: SegmentInfo, note: str = "") -> LogSegment:
    return LogSegment(
        name=segment.path.name,
        first_ns=segment.start_ns,
        last_ns=segment.end_ns,
        messages=segment.messages,
        size_bytes=segment.size_bytes,
        note=note,
        log_id=segment.log_id,
    )


def known_segments_of(records: Records) -> list[KnownSegment]:
    return [
        KnownSegment(one.name, one.first_ns, one.last_ns, one.messages, one.log_id)
        for one in records.segments()
    ]
