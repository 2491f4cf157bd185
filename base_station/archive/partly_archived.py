"""Log of a station of which some parts are only in an archive: each part is read where it is."""

from __future__ import annotations

from collections.abc import Collection, Container, Iterator, Sequence
from dataclasses import dataclass

from base_station.archive.catalogue import decoded_entry
from base_station.archive.feed import ArchivedFeed
from base_station.archive.store import open_store
from base_station.engine.log_feed import RecordSource
from base_station.replay.processes.jobs import ArchivedLog, ArchivedPart
from base_station.storage.db.window import FOREVER_NS
from base_station.storage.log_defects import LogDefects
from base_station.storage.missing_segments import KnownSegment
from shared.mcap_log import LogRecord


@dataclass(frozen=True)
class OpenedPart:
    """Archived part of a log, between station times; ``until_ns`` is excluded."""

    from_ns: int
    until_ns: int
    log: RecordSource


class PartlyArchivedFeed:
    """Feed of all parts.  Reading raises ArchiveError if the archive does not answer."""

    def __init__(self, own: RecordSource, parts: Sequence[OpenedPart]) -> None:
        """``parts``: in time order; where two overlap, the first is read."""
        self._own, self._parts = own, parts

    def records(
        self,
        start_ns: int | None = None,
        end_ns: int | None = None,
        keys: Container[str] | None = None,
    ) -> Iterator[LogRecord]:
        at_ns, last_ns = start_ns or 0, FOREVER_NS if end_ns is None else end_ns
        for part in self._parts:
            from_ns, until_ns = max(part.from_ns, at_ns), min(part.until_ns, last_ns)
            if from_ns < until_ns:
                if at_ns < from_ns:
                    yield from self._own.records(at_ns, from_ns, keys)
                yield from part.log.records(from_ns, until_ns, keys)
                at_ns = until_ns
        if at_ns < last_ns:
            yield from self._own.records(at_ns, end_ns, keys)


def opened_copy(archived: ArchivedLog, flaws: LogDefects | None = None) -> ArchivedFeed:
    """Open a copy.  ``flaws`` receives unreadable parts.  Raises ArchiveError."""
    entry, store = decoded_entry(archived.entry, archived.location), open_store(archived.location)
    files = {one.name: one for one in entry.files}
    if flaws is None:
        return ArchivedFeed(store, entry.incident_id, files, entry.log_id)
    for words in entry.damage_texts():
        flaws.note(words)
    return ArchivedFeed(store, entry.incident_id, files, entry.log_id, flaws.note_damage)


def partly_archived(
    own: RecordSource, parts: Sequence[ArchivedPart], flaws: LogDefects | None = None
) -> PartlyArchivedFeed:
    opened = [OpenedPart(one.from_ns, one.until_ns, opened_copy(one.log, flaws)) for one in parts]
    return PartlyArchivedFeed(own, opened)


def without_archived(
    known: Collection[KnownSegment], parts: Sequence[ArchivedPart]
) -> tuple[KnownSegment, ...]:
    """Segments except those whose incident is read from an archive."""
    return tuple(
        segment
        for segment in known
        if not any(
            segment.first_ns < part.until_ns and segment.last_ns >= part.from_ns for part in parts
        )
    )
