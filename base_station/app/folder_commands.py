"""Commands on a station's folder, beside a running station or without one."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from base_station.app.factories import project_whole_log
from base_station.app.logged_action import log_action
from base_station.app.offline_log import named_incident, open_offline_log
from base_station.core.log_position import LogPosition
from base_station.engine.log_feed import LogFeed
from base_station.fusion.smoothing import SMOOTHERS
from base_station.privacy.erasure_progress import ErasureResult
from base_station.privacy.erasure_queue import erase_now, request_again
from base_station.privacy.erasure_service import BY_OTHER_STATION, ErasureService
from base_station.privacy.log_files import ClosedLog
from base_station.privacy.requests import request_erasure
from base_station.radio.radio_log import RadioLog
from base_station.replay.assessment.wearers import wearers
from base_station.replay.post_processing import PostProcessor
from base_station.replay.solved_tracks import Tracks
from base_station.replay.trail_kind import TrailKind
from base_station.standby.cut_erasures import orders_behind
from base_station.standby.log_truncation import set_aside
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.database import Database
from base_station.storage.db.erasure import ids_of
from base_station.storage.db.imports import ImportCatalogue
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.opening import open_database
from base_station.storage.db.records import Records
from base_station.storage.db.replicated_tables import ReplicatedTables
from base_station.storage.db.roster import Roster
from base_station.storage.db.salvage import salvage_if_damaged
from base_station.storage.db.server_address import noted_server
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.storage.db.window import FOREVER_NS
from base_station.storage.imports import ImportFolder
from base_station.storage.projection_mark import ProjectionMark
from base_station.unit_sync.recordings.transfer_queue import TransferQueue
from shared.clock import SystemClock
from shared.errors import UserError
from shared.folder_lock import FolderLock
from shared.mcap_log import recover_log
from shared.messages.station import Unassign

_log = logging.getLogger(__name__)
FORGET_COMMAND = "muster base forget"  # in the audit


@dataclass(frozen=True)
class IncidentCommandContext:
    """Inputs of commands about a closed incident."""

    post_processor: PostProcessor
    records: Records
    roster: Roster
    incident: IncidentRow
    people: Mapping[str, Sequence[str]]  # wearers of each unit
    keeps_result: bool  # in the database; else results are gone with the command
    log: LogFeed
    folder: DataFolder  # that has all but the database
    imports: ImportCatalogue

    def tracks(self, kind: TrailKind) -> Tracks:
        if kind is TrailKind.SMOOTHED:
            return self.post_processor.smoothed(self.incident).tracks
        if kind is TrailKind.RAW:
            return self.post_processor.raw(self.incident)
        return self.records.tracks_of(self.incident)


def rebuild(
    data: Path, on_progress: Callable[[float], None], report: Callable[[str], None] = _log.warning
) -> int:
    """Make the projections of a folder again, and return the number of log records; no station may
    be running on the folder.

    ``on_progress`` receives the fraction done, ``report`` what a damaged database has lost.
    """
    folder = DataFolder(data)
    folder.require()
    lock = folder.lock()
    try:
        is_file = noted_server(folder.database) is None
        salvage = salvage_if_damaged(folder.database, math.inf) if is_file else None
        if salvage is not None:
            report(salvage.described(alone=False))
        with open_database(folder.database) as store:
            if salvage is not None:
                ReplicatedTables(store).note_lost(salvage.lost)
            count = project_whole_log(store, folder.log, on_progress)
            ProjectionMark(folder.tables_behind).clear()
            return count
    finally:
        lock.close()


def cut_log(data: Path, place: LogPosition, on_progress: Callable[[float], None]) -> None:
    """Set aside the log after a position, and make the projections again without it."""
    folder = DataFolder(data)
    lock = folder.lock()
    try:
        for by, order in orders_behind(folder.log, place):
            if (
                by == BY_OTHER_STATION
            ):  # a finished request of the other station, which is not repeated
                request_again(folder.erasure_jobs, order.kind, order.subject_id)
        # It must not have events of the cut part, however this ends.
        with open_database(folder.database) as store:
            Records(store, SystemClock()).forget_projections()
        set_aside(folder, place)
    finally:
        lock.close()
    rebuild(data, on_progress)


def forget(
    data: Path,
    subject_name: str,
    confirm: Callable[[str], None],
    on_progress: Callable[[float], None],
) -> ErasureResult:
    """Erase a person (id or name) or an incident (id). A station that runs on the folder does it
    itself.  Units of the person are unassigned first.

    ``confirm`` is called with the subject and may raise.  If the erasure is interrupted, the
    station continues it when it starts.
    """
    folder = DataFolder(data)
    folder.require()
    if FolderLock.is_held(data):
        with open_database(folder.require_database()) as store:
            subject = _subject(subject_name, store)
        confirm(subject.description)
        return request_erasure(folder, subject.kind, subject.subject_id, on_progress)
    lock = folder.lock()
    try:
        recover_log(folder.log)
        with open_database(folder.database) as store:
            subject = _subject(subject_name, store)
            service = _erasure_service(folder, store)
            if subject.kind == "person":
                service.require_person(subject.subject_id)
            confirm(subject.description)
            for unit_id in subject.worn:
                log_action(folder, store, FORGET_COMMAND, Unassign(unit_id))
            return erase_now(
                service,
                folder.erasure_jobs,
                FORGET_COMMAND,
                subject.kind,
                subject.subject_id,
                on_progress,
            )
    finally:
        lock.close()


def _erasure_service(folder: DataFolder, store: Database) -> ErasureService:
    clock = SystemClock()
    return ErasureService(
        ClosedLog(folder.log),
        store,
        Checkpoints(folder.checkpoints),
        Records(store, clock),
        clock,
        TransferQueue(_no_query, folder.recordings, clock),
        erase_audio=RadioLog(folder.radio).erase,
    )


@dataclass(frozen=True)
class _Subject:
    """Person or incident to erase."""

    kind: str
    subject_id: str
    description: str  # as a sentence
    worn: Sequence[str] = ()  # units that the person wears


def _subject(subject_name: str, store: Database) -> _Subject:
    """Find the subject.  UserError if it is not exactly one person, or an incident that is open."""
    records, roster = Records(store, SystemClock()), Roster(store, SystemClock())
    _require_no_open_incident(records, roster)
    incident = records.incident(subject_name)
    if incident is not None:
        name = roster.shown(incident.name)
        others = [roster.shown(one.name) for one in _open_beside(incident, records)]
        beside = f", and nothing of {', '.join(others)}, which was open beside it"
        description = f"incident {name!r} of {subject_name}{beside if others else ''}"
        return _Subject("incident", subject_name, description)
    person_id = _person_id(subject_name, store)
    worn = roster.worn_by(person_id)
    wears = f", who wears {', '.join(worn)} and is unassigned first" if worn else ""
    return _Subject("person", person_id, f"person {subject_name}{wears}", worn)


def _open_beside(incident: IncidentRow, records: Records) -> list[IncidentRow]:
    """Other incidents that were open at the same time."""
    others = (one for one in records.incidents() if one.incident_id != incident.incident_id)
    return [
        one
        for one in others
        if one.opened_ns < (incident.closed_ns or FOREVER_NS)
        and incident.opened_ns < (one.closed_ns or FOREVER_NS)
    ]


def _person_id(subject_name: str, store: Database) -> str:
    """Id of the person, who need not be on the roster any more."""
    with store.read() as session:
        named = sorted(ids_of(session, subject_name))
    if len(named) > 1:
        raise UserError(
            f"{len(named)} people are or were called {subject_name}: give one of {named}"
        )
    return named[0] if named else subject_name


def _require_no_open_incident(records: Records, roster: Roster) -> None:
    for incident in records.incidents():
        if incident.closed_ns is None:
            name = roster.shown(incident.name)
            raise UserError(f"the incident {name} is open; close it first")


def _no_query(_unit_id: str, _question: str) -> None:
    return None


def open_post_processing(
    data: Path,
    incident_id: str,
    closing: ExitStack,
    report: Callable[[str], None],
    on_progress: Callable[[float], None],
) -> IncidentCommandContext:
    """Open a past incident, beside a running station or without one.  In place of an id it may be a
    file that has one incident.

    ``report`` receives a sentence about each part that cannot be read, ``on_progress`` the fraction
    done if the log must be read first.
    """
    incident_id, data = named_incident(incident_id, data)
    offline_log = open_offline_log(data, incident_id, closing, report, on_progress, in_place=True)
    clock = SystemClock()
    records = Records(offline_log.store, clock)
    incident = records.require_incident(incident_id)
    post_processor = PostProcessor(
        offline_log.archive(), SMOOTHERS[0], SmoothedTracks(offline_log.store), clock
    )
    roster = Roster(offline_log.store, clock)
    people = wearers(roster, incident, records.members_of(incident))
    return IncidentCommandContext(
        post_processor,
        records,
        roster,
        incident,
        people,
        offline_log.keeps_result,
        offline_log.log,
        offline_log.folder,
        ImportCatalogue(offline_log.store, ImportFolder(offline_log.folder.imports)),
    )


def open_accounts(data: Path, closing: ExitStack) -> tuple[Accounts, Records]:
    """Open accounts and audit of a folder's database, beside a running station or without one."""
    store = closing.enter_context(open_database(DataFolder(data).require_database()))
    return Accounts(store, SystemClock()), Records(store, SystemClock())
