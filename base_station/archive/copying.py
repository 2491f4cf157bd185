"""Copies of incidents into an archive: of those that it lacks, and of those with newer data."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory

import msgspec

from base_station.archive.catalogue import (
    CONSOLE_NAME,
    ENTRY_NAME,
    LOG_NAME,
    RADIO_NAME,
    VERSION,
    CatalogueEntry,
    archived_ids,
    encoded_entry,
    name_in_archive,
    obsolete_files,
    read_entry,
    stored_apart,
)
from base_station.archive.checking import defect_of
from base_station.archive.copying_errors import (
    LogGoneError,
    as_one,
    copy_gone,
    copy_older,
    copy_stays,
    has_no_copy,
    not_kept,
    of_another_station,
)
from base_station.archive.redacted_copy import (
    CopyIncompleteError,
    ErasedSubjects,
    erased_in,
    redacted_log,
)
from base_station.archive.store import ArchiveStore
from base_station.core.state import ERASED_TEXT
from base_station.engine.log_feed import FolderFeed
from base_station.radio.radio_log import RadioLog
from base_station.replay.incident_file import AFTER_NS, IncidentFileSource, incident_file
from base_station.storage.db.archived import ArchivedCopies, ArchivedFile
from base_station.storage.db.database import Database
from base_station.storage.db.erasures_done import erasures_done
from base_station.storage.db.imports import ImportCatalogue
from base_station.storage.db.incident_rows import rows_of_incident
from base_station.storage.db.incident_search import IncidentSearch
from base_station.storage.db.known_people import KnownPerson
from base_station.storage.db.models import OUTDATED_NS, IncidentRow
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.search_index import ALARM, PERSON
from base_station.storage.db.window import FOREVER_NS
from base_station.storage.imports import ImportFolder
from base_station.storage.missing_segments import names_between
from base_station.storage.segment_index import known_segments_of
from shared.clock import NS_PER_S, Clock
from shared.coded_text import code_of_text, text_of_error
from shared.errors import ArchiveError
from shared.mcap_log import (
    Segment,
    SegmentIdentity,
    SegmentReader,
    byte_ranges_of,
    channel_of_audio,
    enclosures_of,
    is_console,
)

_FLUSHED_NS = 10 * NS_PER_S  # until a station's records are on its disk
_CONSOLE_CHUNK_BYTES = 1 << 20
_READ_BYTES = 4 << 20
_WAITING_BYTES = 1 << 20


def closed_until_ns(clock: Clock) -> int:
    """Station time before which an incident must have been closed to be copied."""
    return clock.utc_ns() - AFTER_NS - _FLUSHED_NS


@dataclass(frozen=True)
class CopyResult:
    incident_id: str
    size_bytes: int  # that were sent; 0: the archive had it already
    damage: tuple[str, ...]  # unreadable parts of the station's log


@dataclass(frozen=True)
class _CopySource:
    """Sources of a copy."""

    log: FolderFeed
    radio: RadioLog | None  # None: the log has the audio, or there is none
    known_ns: int  # station time of the newest that is known
    has_radio: bool
    damage: tuple[str, ...] = ()  # that is known of it


class ArchiveCopier:
    def __init__(
        self,
        archive: ArchiveStore,
        store: Database,
        log: FolderFeed,
        clock: Clock,
        imports: ImportFolder,
        radio: RadioLog | None = None,
    ) -> None:
        """``radio``: None to copy without the audio of the radio channels."""
        self._imports, self._radio = ImportCatalogue(store, imports), radio
        self._archive = archive
        self._store = store
        self._log = log
        self._clock = clock
        self._copies = ArchivedCopies(store)

    def copy_due(self, on_progress: Callable[[float], None]) -> Iterator[CopyResult]:
        """Copy due incidents, oldest first; each is in the catalogue when its result is yielded.
        An incident that was closed a minute ago waits, as the log still receives records of it.

        A copy that is not in the archive any more is made again.

        Raises ArchiveError: finished copies are there, and the rest is still due.
        """
        kept = list(self._note_lost_copies())
        due = self._copies.due(self._archive.address, closed_until_ns(self._clock))
        for number, (incident, known_ns) in enumerate(due):
            try:
                yield self._copy(incident, known_ns)
            except LogGoneError as error:
                kept.append(text_of_error(error))
            on_progress((number + 1) / len(due))
        if kept:
            raise ArchiveError(as_one(kept))

    def _note_lost_copies(self) -> Iterator[str]:
        """Make copies due again that were written and are not there any more; return a sentence for
        each that cannot be made again.  Raises ArchiveError if not one is left: it may be another
        disk, and the notes of the copies on the right one must stay.
        """
        noted = self._copies.copied_to(self._archive.address)
        there = set(archived_ids(self._archive)) if noted else set()
        lost = [one for one in noted if one not in there]
        if lost and not there:
            raise has_no_copy(self._archive.address, len(lost))
        records = Records(self._store, self._clock)
        for incident_id in lost:
            incident = records.incident(incident_id)
            if incident is not None and self._has_log(incident):
                self._copies.forget(incident_id)
            else:
                yield copy_gone(self._archive.address, incident_id)

    def _copy(self, incident: IncidentRow, known_ns: int) -> CopyResult:
        """Copy an incident.  ``known_ns``: station time of the newest data known of it."""
        erased = erasures_done(self._store)  # before anything is read that they change
        there = read_entry(self._archive, incident.incident_id)
        own_id = self._log.log_id  # empty where all segments are gone
        if there is not None and own_id and there.log_id not in ("", own_id):
            raise of_another_station(self._archive.address, incident.incident_id)
        if there is not None and self._is_current(there, incident, known_ns):
            return self._keep(there)
        with TemporaryDirectory(prefix="muster-archive-") as scratch:
            source = _CopySource(
                self._log, self._radio, known_ns, has_radio=self._radio is not None
            )
            if there is not None and not self._has_log(incident):
                subjects = erased_in(self._archive, there, self._store)
                if not subjects and self._copies.is_outdated_by_erasure(incident.incident_id):
                    return self._keep(there)  # no erased person is in it
                if not subjects:
                    raise copy_older(self._archive.address, incident.incident_id)
                source = self._redacted(there, subjects, Path(scratch))
            entry = self._pack(incident, source, Path(scratch))
            if source.log is not self._log and (lost := {*entry.damage} - {*source.damage}):
                reasons = [one for one in entry.damage_texts() if one in lost]
                raise copy_stays(self._archive.address, incident.incident_id, reasons)
            if there is not None:
                entry = stored_apart(entry)
            self._send(entry, Path(scratch))
        self._remove_leftovers(entry)
        if erasures_done(self._store) == erased:
            self._note(entry)
        else:
            self._note(msgspec.structs.replace(entry, known_ns=OUTDATED_NS))
        size_bytes = sum(one.size_bytes for one in entry.files)
        return CopyResult(incident.incident_id, size_bytes, entry.damage)

    def _keep(self, there: CatalogueEntry) -> CopyResult:
        self._remove_leftovers(there)
        self._note(there)
        return CopyResult(there.incident_id, 0, there.damage)

    def _redacted(
        self, there: CatalogueEntry, subjects: ErasedSubjects, scratch: Path
    ) -> _CopySource:
        """The archived copy without erased people, and without data that came after it was made."""
        try:
            log = redacted_log(self._archive, there, subjects, scratch / "redacted")
        except CopyIncompleteError as error:
            raise LogGoneError(text_of_error(error)) from error
        has_radio = any(one.name == RADIO_NAME for one in there.files)
        return _CopySource(
            log, None, there.known_ns, has_radio=has_radio, damage=there.damage_texts()
        )

    def _remove_leftovers(self, entry: CatalogueEntry) -> None:
        """Remove the files of the copy that this one has replaced."""
        for name in obsolete_files(self._archive, entry):
            self._archive.remove(name)

    def _is_current(self, entry: CatalogueEntry, incident: IncidentRow, known_ns: int) -> bool:
        """True for a current copy that this database does not know of; not for one from before an
        erasure.
        """
        here = self._mentioned(incident)
        return (
            entry.known_ns == known_ns
            and (self._radio is None or RADIO_NAME in {one.name for one in entry.files})
            and entry.people == here
            and not erased_in(self._archive, entry, self._store)
            and (self._is_noted(entry) or not self._has_defects(entry))
        )

    def _is_noted(self, entry: CatalogueEntry) -> bool:
        """True if these files were read back when they were written, and only an erasure has made
        them outdated.
        """
        if not self._copies.is_outdated_by_erasure(entry.incident_id):
            return False
        noted = self._copies.files(entry.incident_id).values()
        return {(one.name, one.sha256) for one in noted} == {
            (one.name, one.sha256) for one in entry.files
        }

    def _has_defects(self, entry: CatalogueEntry) -> bool:
        return any(defect_of(self._archive, entry, one) for one in entry.files)

    def _has_log(self, incident: IncidentRow) -> bool:
        """True if all segments of its time are here; if the database knows of none, if there is a
        record.
        """
        from_ns, until_ns = incident.opened_ns, incident.closed_ns or FOREVER_NS
        known = known_segments_of(Records(self._store, self._clock))
        if there_were := names_between(known, from_ns, until_ns):
            return there_were <= self._log.segment_names
        return any(True for _ in self._log.records(from_ns, until_ns))

    def _note(self, entry: CatalogueEntry) -> None:
        self._copies.note(
            entry.incident_id,
            self._archive.address,
            entry.archived_ns,
            entry.known_ns,
            entry.files,
        )

    def _send(self, entry: CatalogueEntry, scratch: Path) -> None:
        """Write the files and read them back, then the entry: an interrupted copy has none."""
        for one in entry.files:
            name = name_in_archive(entry.incident_id, one.stored_name)
            self._archive.put(name, scratch / one.name)
        for one in entry.files:
            if defect := defect_of(self._archive, entry, one):
                raise not_kept(self._archive.address, entry.incident_id, defect)
        (scratch / ENTRY_NAME).write_bytes(encoded_entry(entry))
        self._archive.put(name_in_archive(entry.incident_id, ENTRY_NAME), scratch / ENTRY_NAME)

    def _pack(self, incident: IncidentRow, source: _CopySource, scratch: Path) -> CatalogueEntry:
        """Make the files of a copy, and its entry."""
        damage = list(source.damage)
        records, roster = Records(self._store, self._clock), Roster(self._store, self._clock)
        people = self._mentioned(incident)
        closed_ns = incident.closed_ns or 0
        contents = IncidentFileSource(
            log=source.log,
            incident=incident,
            name=roster.shown(incident.name),
            people=roster.known_people(),
            plan=records.plan(closed_ns, incident.site_id),
            until_ns=closed_ns,
            imports=self._imports.attachments(incident.incident_id),
            radio=source.radio,
            report=damage.append,
        )
        with (scratch / LOG_NAME).open("wb") as file:
            file.writelines(incident_file(contents))
        names = [CONSOLE_NAME, LOG_NAME]
        write_topics(scratch / LOG_NAME, scratch / CONSOLE_NAME, source.log.log_id, is_console)
        if source.has_radio:
            write_topics(scratch / LOG_NAME, scratch / RADIO_NAME, source.log.log_id, _is_audio)
            names.append(RADIO_NAME)
        dispatch = records.dispatch(incident.dispatch_number) if incident.dispatch_number else None
        terms = IncidentSearch(self._store).terms(incident.incident_id)
        return CatalogueEntry(
            version=VERSION,
            muster_version=version("muster"),
            incident_id=incident.incident_id,
            name=roster.shown(incident.name),
            opened_ns=incident.opened_ns,
            closed_ns=closed_ns,
            known_ns=source.known_ns,
            archived_ns=self._clock.utc_ns(),
            log_id=source.log.log_id,
            address="" if dispatch is None else dispatch.address,
            people=people,
            alarm_rules=tuple(sorted(terms.get(ALARM, ()))),
            files=tuple(archived_file(scratch / one) for one in names),
            attached={
                name: (one.begin, one.end)
                for name, one in enclosures_of(scratch / LOG_NAME).attachments.items()
            },
            tables=rows_of_incident(self._store, incident),
            damage=tuple(map(str, damage)),
            damage_codes=tuple(map(code_of_text, damage)),
        )

    def _mentioned(self, incident: IncidentRow) -> dict[str, KnownPerson]:
        known = Roster(self._store, self._clock).known_people()
        ids = IncidentSearch(self._store).terms(incident.incident_id).get(PERSON, set())
        return {
            one: msgspec.structs.replace(known[one], photo_url=None)
            for one in sorted(ids & set(known))
            if known[one].name != ERASED_TEXT
        }


def write_topics(log: Path, target: Path, log_id: str, is_wanted: Callable[[str], bool]) -> None:
    """Write some topics as a segment of its own.  Their chunks lie side by side, so that one
    request returns all of them for a span of time.
    """
    topics: Mapping[str, int]
    with SegmentReader(log) as reader:
        topics = reader.topic_counts or {}
        segment = Segment(target, _CONSOLE_CHUNK_BYTES, SegmentIdentity(log_id))
        wanted = frozenset(filter(is_wanted, topics))
        for record in reader.records(keys=wanted, derived=True):
            segment.add(*record)
            if segment.file.waiting_bytes > _WAITING_BYTES:
                segment.file.sync()
    segment.finish()
    segment.file.sync()
    segment.file.close()


def _is_audio(topic: str) -> bool:
    return channel_of_audio(topic) is not None


def archived_file(path: Path) -> ArchivedFile:
    ranges = byte_ranges_of(path)
    with SegmentReader(path) as reader:
        topics = tuple(sorted(reader.topic_counts or ()))
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while part := file.read(_READ_BYTES):
            digest.update(part)
    return ArchivedFile(
        path.name,
        ranges.size,
        digest.hexdigest(),
        ranges.summary_offset,
        topics,
        tuple((one.from_ns, one.until_ns, one.offset, one.end) for one in ranges.chunks),
    )
