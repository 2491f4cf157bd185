"""Finds the copy of an incident whose log the station has no more."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from base_station.archive.entry import ENTRY_NAME, decoded_entry, name_in_archive
from base_station.archive.store import open_store
from base_station.replay.processes.wire import ArchivedLog
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.models import IncidentRow
from base_station.storage.missing_segments import KnownSegment
from shared.errors import ArchiveError
from shared.mcap_log import SegmentInfo


@dataclass(frozen=True)
class ArchivedLogs:
    """From any thread."""

    copies: ArchivedCopies
    segments: Callable[[], Iterable[SegmentInfo]]  # that are here
    known: Callable[[], Iterable[KnownSegment]]  # that there were, by the database

    def instead_of_log(self, incident: IncidentRow) -> ArchivedLog | None:
        """None: the log is here, or no archive has a copy.

        Raises ArchiveError where the archive does not answer.
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
                f"the log of {incident_id} is not here any more, and the archive {location} has "
                "no complete copy of it: see whether it was moved"
            )
        decoded_entry(encoded, f"{location}: {name}")
        return ArchivedLog(location, encoded)

    def _is_here(self, from_ns: int, until_ns: int) -> bool:
        """All segments that have something of the time, of which there is one at least."""
        here = {
            one.path.name
            for one in self.segments()
            if one.start_ns <= until_ns and one.end_ns >= from_ns
        }
        there_were = {
            one.name
            for one in self.known()
            if one.messages and one.first_ns <= until_ns and one.last_ns >= from_ns
        }
        return bool(here) and there_were <= here
