"""Index of incident copies in archives, down to ranges of bytes."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import msgspec
from sqlalchemy import ColumnElement, and_, delete, exists, func, or_, select

from base_station.storage.db.database import Database
from base_station.storage.db.incident_search import IncidentSearch
from base_station.storage.db.models import (
    OUTDATED_NS,
    ArchivedIncident,
    ArchivedObject,
    ArchivedRange,
    IncidentRow,
)
from base_station.storage.db.search_index import newest_known_ns
from base_station.storage.db.window import FOREVER_NS
from shared.mcap_log import ChunkRange, SegmentRanges


class ArchivedFile(msgspec.Struct, frozen=True):
    """File of a copy, with the byte ranges of its content."""

    name: str
    size_bytes: int
    sha256: str
    summary_offset: int
    topics: tuple[str, ...]
    ranges: tuple[tuple[int, int, int, int], ...]  # from, until (log time, ns), offset, end
    stored_as: str = ""  # name in the archive; empty: ``name``

    @property
    def stored_name(self) -> str:
        return self.stored_as or self.name

    @property
    def segment_ranges(self) -> SegmentRanges:
        chunks = tuple(ChunkRange(*one) for one in self.ranges)
        return SegmentRanges(chunks, self.summary_offset, self.size_bytes)


class ArchivedCopies:
    """Thread-safe; every method is one transaction."""

    def __init__(self, store: Database) -> None:
        self._store = store

    def due(self, archive: str, until_ns: int) -> Sequence[tuple[IncidentRow, int]]:
        """Incidents closed before ``until_ns`` of which the archive has no copy, or of which more
        is known since, each with the station time of the newest that is known; the oldest first.
        They are in the index of the search.
        """
        IncidentSearch(self._store).index_changes()
        wanted = select(IncidentRow, newest_known_ns()).where(*_is_due(archive, until_ns))
        with self._store.read() as session:
            found = session.execute(wanted.order_by(IncidentRow.opened_ns))
            return [(incident, known_ns) for incident, known_ns in found]

    def waiting(self, archive: str, until_ns: int) -> Sequence[str]:
        """Return the ids of waiting incidents, without updating the index."""
        wanted = select(IncidentRow.incident_id).where(*_is_due(archive, until_ns))
        with self._store.read() as session:
            return session.scalars(wanted.order_by(IncidentRow.opened_ns)).all()

    def copied_to(self, archive: str) -> Sequence[str]:
        """Return the ids of incidents of which a copy was written to the archive."""
        wanted = select(ArchivedIncident.incident_id).where(ArchivedIncident.archive == archive)
        with self._store.read() as session:
            return session.scalars(wanted.order_by(ArchivedIncident.incident_id)).all()

    def forget(self, incident_id: str) -> None:
        """The copy is gone: the incident is due again."""
        with self._store.write() as session:
            session.execute(
                delete(ArchivedIncident).where(ArchivedIncident.incident_id == incident_id)
            )

    def note(
        self,
        incident_id: str,
        archive: str,
        archived_ns: int,
        known_ns: int,
        files: Sequence[ArchivedFile],
    ) -> None:
        with self._store.write() as session:
            for table in (ArchivedObject, ArchivedRange):
                session.execute(delete(table).where(table.incident_id == incident_id))
            session.merge(
                ArchivedIncident(
                    incident_id=incident_id,
                    archive=archive,
                    archived_ns=archived_ns,
                    known_ns=known_ns,
                )
            )
            for file in files:
                session.add_all(_rows(incident_id, file))

    def is_outdated_by_erasure(self, incident_id: str) -> bool:
        with self._store.read() as session:
            row = session.get(ArchivedIncident, incident_id)
            return row is not None and row.known_ns == OUTDATED_NS

    def outdated_by_erasure(self) -> dict[str, int]:
        """By the address of an archive, how many of its copies may have people who were erased."""
        wanted = (
            select(ArchivedIncident.archive, func.count().label("copies"))
            .where(ArchivedIncident.known_ns == OUTDATED_NS)
            .group_by(ArchivedIncident.archive)
        )
        with self._store.read() as session:
            return {one.archive: one.copies for one in session.execute(wanted)}

    def oldest_waiting_ns(self, archive: str) -> int | None:
        """Opening time of the oldest incident that is open, or of which the archive has no current
        copy; None: there is none.
        """
        is_waiting = or_(IncidentRow.closed_ns.is_(None), and_(*_is_due(archive, FOREVER_NS)))
        with self._store.read() as session:
            return session.scalar(select(func.min(IncidentRow.opened_ns)).where(is_waiting))

    def times_ns(self, incident_ids: Collection[str]) -> dict[str, int]:
        """Station times at which copies were made, by incident."""
        of_these = ArchivedIncident.incident_id.in_(incident_ids)
        wanted = select(ArchivedIncident.incident_id, ArchivedIncident.archived_ns).where(of_these)
        with self._store.read() as session:
            return {one.incident_id: one.archived_ns for one in session.execute(wanted)}

    def archives(self, incident_ids: Collection[str]) -> dict[str, str]:
        """Addresses of the archives that have copies, by incident."""
        of_these = ArchivedIncident.incident_id.in_(incident_ids)
        wanted = select(ArchivedIncident.incident_id, ArchivedIncident.archive).where(of_these)
        with self._store.read() as session:
            return {one.incident_id: one.archive for one in session.execute(wanted)}

    def files(self, incident_id: str) -> dict[str, ArchivedFile]:
        """Files of a copy by name; none where there is no copy."""
        objects = select(ArchivedObject).where(ArchivedObject.incident_id == incident_id)
        with self._store.read() as session:
            return {
                one.name: ArchivedFile(
                    one.name,
                    one.size_bytes,
                    one.sha256,
                    one.summary_offset,
                    msgspec.json.decode(one.topics, type=tuple[str, ...]),
                    tuple(
                        (
                            chunk.from_ns,
                            chunk.until_ns,
                            chunk.offset,
                            chunk.offset + chunk.size_bytes,
                        )
                        for chunk in session.scalars(
                            select(ArchivedRange)
                            .where(
                                ArchivedRange.incident_id == incident_id,
                                ArchivedRange.name == one.name,
                            )
                            .order_by(ArchivedRange.offset)
                        )
                    ),
                )
                for one in session.scalars(objects)
            }


def _is_due(archive: str, until_ns: int) -> tuple[ColumnElement[bool], ...]:
    is_copied = exists().where(
        ArchivedIncident.incident_id == IncidentRow.incident_id,
        ArchivedIncident.archive == archive,
        ArchivedIncident.known_ns == newest_known_ns(),
    )
    return IncidentRow.closed_ns < until_ns, ~is_copied


def _rows(incident_id: str, file: ArchivedFile) -> Sequence[ArchivedObject | ArchivedRange]:
    ranges = [
        ArchivedRange(
            incident_id=incident_id,
            name=file.name,
            offset=offset,
            size_bytes=end - offset,
            from_ns=from_ns,
            until_ns=until_ns,
        )
        for from_ns, until_ns, offset, end in file.ranges
    ]
    topics = msgspec.json.encode(file.topics).decode()
    stored = ArchivedObject(
        incident_id=incident_id,
        name=file.name,
        size_bytes=file.size_bytes,
        sha256=file.sha256,
        summary_offset=file.summary_offset,
        topics=topics,
    )
    return [stored, *ranges]
