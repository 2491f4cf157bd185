"""Storage of a live station: the log, the database, and data derived from both."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path

from base_station.app.factories import Announce, project_whole_log
from base_station.app.pipeline_factory import past_pipeline
from base_station.archive.archived_logs import ArchivedLogs
from base_station.engine.log_feed import FolderFeed, LogFeed
from base_station.engine.station_clock import SteadyClock
from base_station.fusion.smoothing import SMOOTHERS
from base_station.privacy.erasure_queue import ErasureJob, ErasureQueue
from base_station.privacy.erasure_service import Act, EraseAudio, ErasureService, RecordingTransfers
from base_station.replay.playback import Archive
from base_station.replay.processes.post_processing_process import (
    PostProcessingContext,
    PostProcessingProcess,
)
from base_station.replay.processes.server import ReplayProcesses
from base_station.storage.checkpoints import Checkpoints, SavedState
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.database import Database
from base_station.storage.db.opening import open_live_server, require_noted_server
from base_station.storage.db.projection import SqlProjection
from base_station.storage.db.records import Records
from base_station.storage.db.replicated_tables import ReplicatedTables
from base_station.storage.db.roster import Roster
from base_station.storage.db.salvage import ONLY_HERE, Salvage, gone, open_live
from base_station.storage.db.server_address import ServerAddress, note_server
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.storage.integrity_checker import IntegrityChecker
from base_station.storage.missing_segments import KnownSegment, log_gaps
from base_station.storage.projection_mark import ProjectionMark
from base_station.storage.recorder import Recorder
from base_station.storage.segment_index import known_segments_of
from base_station.unit_sync.log_gap_detector import LogGapDetector, Lost
from shared.clock import Clock
from shared.coded_text import Term
from shared.errors import StoreError
from shared.mcap_log import segment_number
from shared.messages import STATION_ID

_RESTORE = Term(
    "restore",
    "Messages of units are fetched again from their journals; for the rest, restore the file from "
    "a backup",
)
REPAIR_RETENTION = 12  # attempts of an erasure: two minutes for a job of some seconds
_MENDED_FROM_THE_OTHER = Term(
    "other_station", "What is missing is fetched from the other station when that is reachable"
)


@dataclass(frozen=True)
class StationStorage:
    folder: DataFolder
    recorder: Recorder
    store: Database
    accounts: Accounts
    records: Records
    roster: Roster
    projection: SqlProjection
    checkpoints: Checkpoints
    clock: SteadyClock  # station time, behind all that is in the log
    check: IntegrityChecker

    @property
    def log(self) -> LogFeed:
        """Feed of the records that were written until it is read."""
        return FolderFeed(self.folder.log, self.recorder.flush, self.check.recheck)

    @property
    def archive(self) -> Archive:
        return Archive(self.log.records, self.checkpoints, past_pipeline, self.log.watch)

    @property
    def archived_logs(self) -> ArchivedLogs:
        """Copies of incidents whose log is not here any more."""
        copies = ArchivedCopies(self.store)
        return ArchivedLogs(copies, self.records, self.recorder.segments, self.known_segments)

    def latest_state(self) -> SavedState | None:
        """Newest checkpoint to continue from.  It may be one whose position in the log has been
        lost since: it has the actions and messages until then, so that the lost ones are known to
        be missing.
        """
        return replace(self.archive, has_lost=self.check.has_lost).latest()

    def lost_from_log(self, take_back: Callable[[Lost], None]) -> LogGapDetector:
        return LogGapDetector(
            lambda: (*self.check.damaged, *self.check.missing),
            lambda after_ns: self.archive.latest(after_ns=after_ns),
            self.log.records,
            self.clock,
            take_back,
        )

    def known_segments(self) -> Collection[KnownSegment]:
        try:
            return known_segments_of(self.records)
        except StoreError:  # a hanging disk stops no replay; most is found in the files
            return ()

    def note_restored_rows(self, what: str) -> None:
        """Note that rows which the database had lost with its file are restored."""
        self.store.loss = ""
        self.records.audit(STATION_ID, "TookBackAccounts", what)

    def post_processor(self, processes: ReplayProcesses) -> PostProcessingProcess:
        place = PostProcessingContext(
            processes=processes,
            log=str(self.folder.log),
            checkpoints=str(self.folder.checkpoints),
            database=str(self.folder.database),
            prepare=self.recorder.flush,
            note_damage=self.check.recheck,
            known_segments=self.known_segments,
            instead_of_log=self.archived_logs.instead_of_log,
        )
        kept = SmoothedTracks(self.store)
        return PostProcessingProcess(place, self.archive, SMOOTHERS[0], kept, self.clock)

    def erasure_queue(
        self,
        transfers: RecordingTransfers,
        act: Act,
        save_soon: Callable[[], None],
        leads: Callable[[], bool],
        has_peer: Callable[[], bool],
        erase_audio: EraseAudio,
    ) -> ErasureQueue:
        """Make the queue of erasures.  ``act`` makes the running station erase its memory;
        ``save_soon`` makes it save its state, which the erasure has deleted.  ``has_peer``: the
        other one of two stations can be reached.  ``erase_audio``: as in ``ErasureService``.
        """

        def record_result(done: ErasureJob) -> None:
            if done.kind == "person":
                self.roster.forget(done.subject_id)  # it may have been done before this start
            save_soon()

        def obstacle(job: ErasureJob) -> str:
            if not job.from_peer and not leads():
                return "this station does not lead; the one that leads erases it first"
            if self.projection.is_behind:  # records read from the log may be of the person
                return "the database is brought up to date from the log; it is done after that"
            # One may have opened since the request; a follower's leader has checked its own.
            is_open = leads() and any(one.closed_ns is None for one in self.records.incidents())
            return "an incident is open; it is done when that is closed" if is_open else ""

        waited: Counter[Path] = Counter()

        def is_repair_pending(path: Path, damage: str) -> bool:
            waited[path] += 1
            if not has_peer() or waited[path] > REPAIR_RETENTION:
                return False
            self.check.note_damaged(path, damage)
            return True

        service = ErasureService(
            self.recorder, self.store, self.checkpoints, self.records, self.clock, transfers, act,
            is_repair_pending, self.roster.forget, erase_audio,
        )  # fmt: skip
        return ErasureQueue(service, self.folder.erasure_jobs, obstacle, record_result)


def open_storage(
    folder: DataFolder,
    recorder: Recorder,
    clock: Clock,
    announce: Announce,
    closing: ExitStack,
    server: ServerAddress | None = None,
    *,
    alone: bool = True,
) -> StationStorage:
    """Open the storage.  The database is made from the log if it is damaged or lacks what the log
    has.  ``server`` has the tables; None if they are in a file.  ``alone``: no other station has a
    copy of them.

    Raises StoreError if the database cannot be used, or belongs to another log.
    """
    store, salvage = _open_database(folder.database, recorder, server, announce)
    closing.enter_context(store)
    lost = () if salvage is None else salvage.lost
    known = known_segments_of(Records(store, clock))
    if _lacks_records(store, recorder, known):
        announce("the database lacks what the log knows: it is made again from the log")
        project_whole_log(store, folder.log, lambda _: None)
        if salvage is None and not Accounts(store, clock).users():
            store.loss, lost = gone(alone=alone), tuple(ONLY_HERE)
    if salvage is not None:
        store.loss = salvage.described(alone=alone)
    if store.loss:
        announce(store.loss)
        Records(store, clock).audit(STATION_ID, "MadeDatabaseAgain", store.loss)
        ReplicatedTables(store).note_lost(lost)
    mark = None if server is None else ProjectionMark(folder.tables_behind)
    projection = SqlProjection(store, mark)
    closing.callback(projection.close)
    check = IntegrityChecker(_RESTORE if alone else _MENDED_FROM_THE_OTHER)
    newest = max((one.path for one in recorder.segments()), default=None)
    for recovery in recorder.recoveries:
        # A kill may lose the last half second of the newest one, but no acknowledged record.
        if recovery.damage or (recovery.bytes_lost and recovery.path != newest):
            check.note_damaged(recovery.path, str(recovery), is_cut=True)
    check.note_foreign(recorder.foreign)
    check.note_lacks(folder.log, log_gaps(recorder.segments(), known))
    last_number = max(_numbers(one.name for one in known), default=0)
    recorder.continue_log(last_number, max((one.log_id for one in known), default=""))
    ends_ns = [one.end_ns for one in recorder.segments()] + [one.last_ns for one in known]
    steady = SteadyClock(clock, max(ends_ns, default=0))
    return StationStorage(
        folder=folder,
        recorder=recorder,
        store=store,
        accounts=Accounts(store, steady),
        records=Records(store, steady),
        roster=Roster(store, steady),
        projection=projection,
        checkpoints=Checkpoints(folder.checkpoints),
        clock=steady,
        check=check,
    )


def _open_database(
    path: Path, recorder: Recorder, server: ServerAddress | None, announce: Announce
) -> tuple[Database, Salvage | None]:
    """Open the database.  Raises StoreError."""
    require_noted_server(path, server)
    if server is None:
        return open_live(path, lambda: recorder.hangs)
    store, is_copied = open_live_server(server, path)
    if is_copied:
        announce(f"users, people and the audit were copied from {path} to {store.name}")
    try:
        note_server(path, server)
    except StoreError:
        store.close()
        raise
    return store, None


def _numbers(names: Iterable[str]) -> list[int]:
    return sorted(segment_number(Path(name)) for name in names)


def _lacks_records(store: Database, recorder: Recorder, segments: Sequence[KnownSegment]) -> bool:
    """True if the database is new, or was not made from the log to its end.  Raises StoreError if
    it belongs to another log, as two incidents would become one.  A log that continues after one
    that is gone begins with a higher number.
    """
    logged = {one.path.name for one in recorder.segments() if one.messages}
    known = {one.name for one in segments}
    goes_on = _numbers(logged)[:1] > _numbers(known)[-1:]
    if known and logged and not known & logged and not goes_on:
        raise StoreError(
            f"the database {store.name} is of another log than the one beside it "
            f"(it knows {max(known)}, here is {max(logged)}); put the right one there, or move it "
            "away: what the log knows is then made again, and people and users are not"
        )
    return bool(logged) and not known
