"""Offline log, for replay and export: a station's folder, its log alone, or files of that.

It may be on a read-only medium, or of a station whose accounts are unknown here.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

from base_station.app.factories import project_actions, project_whole_log
from base_station.app.pipeline_factory import past_pipeline
from base_station.archive.archived_logs import ArchivedLogs
from base_station.archive.partly_archived import opened_copy
from base_station.engine.log_feed import FolderFeed, LogFeed
from base_station.radio.radio_log import RadioLog
from base_station.replay.incident_file import read_incident_file
from base_station.replay.playback import Archive
from base_station.replay.version_check import DIFFERS, decisions_differ
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.copying import copy_database
from base_station.storage.db.database import Database
from base_station.storage.db.opening import open_database
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.salvage import damage_of
from base_station.storage.db.server_address import noted_server
from base_station.storage.db.store import Store
from base_station.storage.imports import ImportFolder
from base_station.storage.log_defects import LogDefects, open_segment_info
from base_station.storage.segment_index import known_segments_of
from shared.clock import SystemClock
from shared.coded_text import coded
from shared.errors import DatabaseAwayError, LogError, UserError
from shared.folder_lock import FolderLock
from shared.mcap_log import (
    SegmentInfo,
    SegmentReader,
    enclosures_of,
    own_segments,
    read_attached,
    segment_number,
    segment_path,
    segment_paths,
    segments_of_one_log,
)

Report = Callable[[str], None]
Progress = Callable[[float], None]
OpenedLog = tuple[LogFeed, LogDefects]


@dataclass(frozen=True)
class OfflineLog:
    """Nothing is written to ``folder`` but to its database, where ``keeps_result``."""

    folder: DataFolder
    store: Database
    database: Path  # the file of ``store``; or beside it the note on the server that has it
    keeps_result: bool  # in the database; else results are gone with the command
    scratch: Path
    log: LogFeed
    defects: LogDefects
    report: Report
    imports: ImportFolder  # files that were brought in
    radio: RadioLog
    log_of: Callable[[str], OpenedLog]  # by incident: its copy in an archive, or the folder's
    lacks_tables: bool = False  # ``store`` has what operators did, and no positions and alarms

    def of_incident(self, incident_id: str) -> OfflineLog:
        """With the log that has this incident.

        Raises ArchiveError where the archive does not answer, LogError where there is no log.
        """
        log, defects = self.log_of(incident_id)
        is_copy = not isinstance(log, FolderFeed)  # states in it are of this incident alone
        scratch = self.scratch / incident_id if is_copy else self.scratch
        return replace(self, log=log, defects=defects, scratch=scratch)

    def archive(self, *, recompute: bool = False) -> Archive:
        """``recompute``: decisions are made again, instead of playing the recorded pictures.

        Uses the station's checkpoints where there are any that fit this program; new ones are
        saved elsewhere, so that a jump back need not step an hour again.
        """
        own = Checkpoints(self.scratch / "checkpoints", self.report)
        saved = self.folder.checkpoints
        theirs = Checkpoints(saved) if saved.is_dir() else own
        log = self.log
        defects = self.defects
        return Archive(
            log.records,
            theirs,
            past_pipeline,
            log.watch,
            own,
            flaws=defects,
            check_next_chunk=defects.check_next_chunk,
            note=defects.note,
            console=None if recompute else log.everything,
        )


def open_offline_log(
    path: Path,
    incident_id: str,
    closing: ExitStack,
    report: Report,
    on_progress: Progress,
    *,
    in_place: bool,
    decides_again: bool = True,
    tables_later: bool = False,
) -> OfflineLog:
    """``in_place``: with the database that is there, where it can be written; else with a copy.
    ``decides_again``: it is looked whether this version decides otherwise than the station did.

    A database that is missing, or older than the incident, is made of the log; with
    ``tables_later`` the caller does that (``lacks_tables``).  ``report`` receives sentences about
    that and about unreadable parts, ``on_progress`` the fraction done.
    """
    scratch = Path(closing.enter_context(TemporaryDirectory(prefix="muster-past-")))
    folder, left_out = _folder_with_log(path, scratch)
    server = noted_server(folder.database)
    damage = "" if server is not None else damage_of(folder.database)

    def opened(store: Database, database: Path, *, keeps_result: bool) -> OfflineLog:
        @cache
        def own_log() -> OpenedLog:
            return _open_log(
                folder, store, incident_id, left_out, report, decides_again=decides_again
            )

        @cache
        def log_of(incident_id: str) -> OpenedLog:
            return _archived_log(folder, store, incident_id, report) or own_log()

        log, defects = log_of(incident_id or _oldest_closed(store))
        return OfflineLog(
            folder,
            store,
            database,
            keeps_result=keeps_result,
            scratch=scratch,
            log=log,
            defects=defects,
            report=report,
            imports=ImportFolder(folder.imports),
            radio=RadioLog(folder.radio),
            log_of=log_of,
        )

    if damage:
        report(f"the database is damaged ({damage}); the log is read instead")
    elif server is not None or (in_place and _is_writable(folder)):
        there = _opened(folder, closing, report)
        if there is not None and not _lacks_incident(there, folder, incident_id):
            return opened(there, folder.database, keeps_result=True)
    copy = scratch / "station.sqlite"
    if not damage and server is None:
        copy_database(folder.database, copy)
    store = closing.enter_context(Store(copy))
    offline_log = opened(store, copy, keeps_result=False)
    if _lacks_incident(store, folder, incident_id):
        report("the database does not have this incident; the log is read instead")
        if tables_later:
            project_actions(store, folder.log)
            offline_log = replace(offline_log, lacks_tables=True)
        else:
            project_whole_log(store, folder.log, on_progress)
    if path.is_file() and (incident := read_incident_file(path)) is not None:
        Roster(store, SystemClock()).add_unknown_people(incident.people)
        _take_enclosed(path, incident.incident_id, folder)
    return offline_log


def _take_enclosed(file: Path, incident_id: str, folder: DataFolder) -> None:
    """Lay out what a file that stands alone has beside its log: files that were brought in, and the
    audio of the radio channels.
    """
    imports = ImportFolder(folder.imports)
    for name, attached in enclosures_of(file).attachments.items():
        imports.take_from(incident_id, name, read_attached(file, attached))
    with SegmentReader(file) as reader:
        RadioLog(folder.radio).take_from(reader)


def _opened(folder: DataFolder, closing: ExitStack, report: Report) -> Database | None:
    """None where the server that has it does not answer: the log knows the incident, too."""
    try:
        return closing.enter_context(open_database(folder.database))
    except DatabaseAwayError as error:
        report(f"{error}; the log is read instead")
        return None


def _archived_log(
    folder: DataFolder, store: Database, incident_id: str, report: Report
) -> OpenedLog | None:
    """The copy of an incident whose log is not here any more; None: it is, or there is no copy.

    Raises ArchiveError where the archive does not answer.
    """
    records = Records(store, SystemClock())
    incident = records.incident(incident_id)
    if incident is None:
        return None
    archived = ArchivedLogs(
        ArchivedCopies(store),
        records,
        segments=lambda: map(open_segment_info, own_segments(folder.log)[0]),
        known=lambda: known_segments_of(records),
    ).instead_of_log(incident)
    if archived is None:
        return None
    report(f"the log of {incident_id} is not here any more: it is read in {archived.location}")
    defects = LogDefects(Path(incident_id), on_defect=report)
    return opened_copy(archived, defects), defects


def _oldest_closed(store: Database) -> str:
    """Empty: no incident is known to be closed."""
    incidents = Records(store, SystemClock()).incidents()
    closed = [one for one in incidents if one.closed_ns is not None]
    return min(closed, key=lambda one: one.opened_ns).incident_id if closed else ""


def _open_log(
    folder: DataFolder,
    store: Database,
    incident_id: str,
    left_out: Mapping[Path, str],
    report: Report,
    *,
    decides_again: bool,
) -> OpenedLog:
    """Opens the log with its known defects, which are reported.  Raises LogError where the folder
    has none any more, UserError where it never had the incident either.
    """
    records = Records(store, SystemClock())
    if not segment_paths(folder.log):
        if incident_id:
            records.require_incident(incident_id)
        raise LogError(
            f"the log in {folder.path} is gone, and no archive is known that has "
            f"{incident_id or 'its incidents'}: bring the segments back, or give a file of the "
            "incident (muster base archive fetch ARCHIVE INCIDENT incident.mcap)"
        )
    known = known_segments_of(records)
    defects = LogDefects(
        folder.log, known, is_written=FolderLock.is_held(folder.path), on_defect=report
    )
    for path, reason in left_out.items():
        defects.note_foreign(path, reason)
    defects.check_files()
    log = FolderFeed(folder.log, on_damage=defects.note_damage)
    if decides_again and not defects() and decisions_differ(log.records(), past_pipeline(None)):
        defects.note(DIFFERS)
    return log, defects


def _folder_with_log(path: Path, scratch: Path) -> tuple[DataFolder, Mapping[Path, str]]:
    """Files of a log, whatever they are called now, are put in order beside each other; with those
    that are left out, and why.
    """
    folder = DataFolder(path)
    if segment_paths(folder.log):
        return folder, {}
    if folder.log.is_dir() and not [*folder.log.glob("*.mcap")] and folder.has_database():
        return folder, {}  # its incidents may be in an archive
    source = folder.log if folder.log.is_dir() else path
    files = [path] if path.is_file() else sorted(source.glob("*.mcap"))
    if not files:
        raise LogError(
            f"there is no station's log in {path}; give the station's folder, its log/ or .mcap "
            "files of that with --data"
        )
    readable = {one.path: one for one in _readable_segments(files)}
    empty = coded("foreign-empty", "nothing in it can be read")
    left_out: dict[Path, str] = {file: empty for file in files if file not in readable}
    in_time = sorted(readable, key=lambda file: readable[file].start_ns)
    segments = [readable[file] for file in segments_of_one_log(in_time, left_out)]
    if not segments:
        names = ", ".join(file.name for file in files)
        raise LogError(
            f"nothing in {names} can be read as a station's log: no MCAP file, one of another "
            "program, or empty"
        )
    for one, following in pairwise(segments):
        if following.start_ns < one.end_ns:
            raise LogError(
                f"{one.path.name} and {following.path.name} are of the same time, and so not of "
                "one log: give only files of one station's log, each once"
            )
    log_folder = DataFolder(scratch / "given")
    log_folder.log.mkdir(parents=True)
    are_named = all(segment_number(one.path) for one in segments)
    for number, one in enumerate(segments, 1):
        name = one.path.name if are_named else segment_path(Path(), number, one.start_ns).name
        (log_folder.log / name).symlink_to(one.path.absolute())
    return log_folder, left_out


def _readable_segments(files: Iterable[Path]) -> Iterator[SegmentInfo]:
    for file in files:
        with SegmentReader(file) as reader:
            info = reader.info()
        if info.messages:
            yield info


def _is_writable(folder: DataFolder) -> bool:
    """SQLite makes files beside a database, too."""
    return os.access(folder.database, os.W_OK) and os.access(folder.path, os.W_OK)


def _lacks_incident(store: Database, folder: DataFolder, incident_id: str) -> bool:
    """True where the log may have an incident that the database does not have."""
    records = Records(store, SystemClock())
    if records.incident(incident_id) is not None:
        return False
    known = {segment.name for segment in records.segments()}
    return any(path.name not in known for path in own_segments(folder.log)[0])


def named_incident(incident: str, data: Path) -> tuple[str, Path]:
    """The incident's id and its place, from an argument of a command line: an id in ``data``, or a
    file that has one incident (``muster base export``, MCAP).

    Raises UserError where a file is no such one.
    """
    path = Path(incident)
    if not path.is_file():
        return incident, data
    found = read_incident_file(path)
    if found is None:
        raise UserError(
            f"{path} is no incident that stands alone, or is not complete; of a part of a log give "
            f"the incident's id: muster base replay ? --data {path}"
        )
    return found.incident_id, path
