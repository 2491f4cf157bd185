"""Finds the copies of incidents whose log is not at the station any more."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import msgspec

from base_station.archive.catalogue import ENTRY_NAME, decoded_entry, name_in_archive
from base_station.archive.partly_archived import opened_copy, partly_archived
from base_station.archive.store import open_store
from base_station.engine.log_feed import LogFeed, RecordSource
from base_station.replay.incident_file import AFTER_NS
from base_station.replay.processes.jobs import ArchivedLog, ArchivedPart
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.records import Records
from base_station.storage.db.window import FOREVER_NS
from base_station.storage.missing_segments import KnownSegment, names_between
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.errors import ArchiveError
from shared.mcap_log import SegmentInfo

LATE_NS = 3600 * NS_PER_S  # a timeline includes backfilled data until this time after the closing


@dataclass(frozen=True)
class ArchivedLogs:
    """Finder of copies.  Thread-safe."""

    copies: ArchivedCopies
    records: Records
    segments: Callable[[], Iterable[SegmentInfo]]  # that are here
    known: Callable[[], Iterable[KnownSegment]]  # that there were, by the database

    def instead_of_log(self, incident: IncidentRow) -> ArchivedLog | None:
        """Copy to use in place of the log; None if the log is here, or no archive has a copy.

        Raises ArchiveError if the archive does not answer.
        """
        if incident.closed_ns is None or self._is_here(incident.opened_ns, incident.closed_ns):
            return None
        incident_id = incident.incident_id
        location = self.copies.archives([incident_id]).get(incident_id)
        if location is None:
            return None
        store = open_store(location)
        name = name_in_archive(incident_id, ENTRY_NAME)
        encoded = store.read_all(name)
        if encoded is None:
            raise ArchiveError(
                coded(
                    "archive-log-nowhere",
                    "the log of {incident} is not here any more, and the archive {archive} has no "
                    "complete copy of it: see whether it was moved",
                    incident=incident_id,
                    archive=location,
                )
            )
        decoded_entry(encoded, f"{location}: {name}")
        return ArchivedLog(location, encoded)

    def feed_of(self, incident: IncidentRow) -> LogFeed | None:
        """Feed of an incident's copy; None if the log is here, or no archive has a copy.  Raises
        ArchiveError.
        """
        archived = self.instead_of_log(incident)
        return None if archived is None else opened_copy(archived)

    def feed(self, own: LogFeed, from_ns: int, until_ns: int) -> RecordSource:
        """Feed of the station's log between two times, wherever it is kept.  Raises
        ArchiveError.
        """
        parts = self.parts(from_ns, until_ns)
        return partly_archived(own, parts) if parts else own

    def parts(self, from_ns: int, until_ns: int) -> tuple[ArchivedPart, ...]:
        """Copies of incidents between two station times whose log is not here, oldest first; with
        what journals delivered later, if that is not here either.

        Raises ArchiveError if the archive does not answer.
        """
        if self._is_here(from_ns, until_ns):
            return ()
        found = list[ArchivedPart]()
        closed = [one for one in self.records.incidents() if one.closed_ns is not None]
        for incident in sorted(closed, key=lambda one: one.opened_ns):
            closed_ns = incident.closed_ns or 0
            if incident.opened_ns >= until_ns or closed_ns + LATE_NS <= from_ns:
                continue
            archived = self.instead_of_log(incident)
            if archived is not None:
                end_ns = closed_ns + AFTER_NS
                if not self._is_here(end_ns, closed_ns + LATE_NS):
                    end_ns = closed_ns + LATE_NS
                found.append(ArchivedPart(incident.opened_ns, end_ns, archived))
        following_ns = [one.from_ns for one in found[1:]]
        return tuple(
            msgspec.structs.replace(one, until_ns=min(one.until_ns, next_ns))
            for one, next_ns in zip(found, [*following_ns, FOREVER_NS], strict=True)
        )

    def _is_here(self, from_ns: int, until_ns: int) -> bool:
        """True if all segments with records of the time are here; if the database knows of none,
        one is enough.
        """
        here = {one.path.name: one for one in self.segments()}
        there_were = names_between(self.known(), from_ns, until_ns)
        if there_were:
            return there_were <= here.keys()
        return any(one.start_ns <= until_ns and one.end_ns >= from_ns for one in here.values())
