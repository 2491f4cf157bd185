"""What a live station keeps on its disk: the log, the database, and what is made from both."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from base_station.app.parts import Announce, past_pipeline, project_whole_log
from base_station.clocks.steady import SteadyClock
from base_station.db.accounts import Accounts
from base_station.db.projection import SqlProjection
from base_station.db.records import Records
from base_station.db.roster import Roster
from base_station.db.smoothed import SmoothedTracks
from base_station.db.store import Store
from base_station.feed import LogFeed
from base_station.forgetting.desk import Forgetting, ForgettingDesk
from base_station.forgetting.forgetter import Act, Forgetter, Pulls
from base_station.fusion.smoother import SMOOTHERS
from base_station.journals.lost_from_log import Lost, LostFromLog
from base_station.past.checkpoints import Checkpoints
from base_station.past.hindsight import Hindsight
from base_station.past.playback import Archive
from base_station.storage.data_folder import DataFolder
from base_station.storage.log_check import LogCheck
from base_station.storage.recorder import Recorder
from shared.clock import Clock, SystemClock
from shared.errors import StoreError

_RESTORE = (
    "What units said is fetched again from their journals; for the rest, restore the file from a "
    "backup"
)
MENDED_WITHIN = 12  # tries to forget: two minutes for what takes some seconds
_MENDED_FROM_THE_OTHER = "What is missing is fetched from the other station when that is heard"


@dataclass(frozen=True)
class Disk:
    folder: DataFolder
    recorder: Recorder
    store: Store
    accounts: Accounts
    records: Records
    roster: Roster
    projection: SqlProjection
    checkpoints: Checkpoints
    clock: SteadyClock  # station time, behind all that is in the log
    check: LogCheck

    @property
    def log(self) -> LogFeed:
        """What is written up to the moment of reading."""
        return LogFeed(self.folder.log, self.recorder.flush, self.check.suspect)

    @property
    def archive(self) -> Archive:
        return Archive(self.log.records, self.checkpoints, past_pipeline, self.log.watch)

    def lost_from_log(self, take_back: Callable[[Lost], None]) -> LostFromLog:
        return LostFromLog(
            lambda: (*self.check.damaged, *self.check.missing),
            lambda after_ns: self.archive.latest(after_ns=after_ns),
            self.log.records,
            self.clock,
            take_back,
        )

    def hindsight(self) -> Hindsight:
        return Hindsight(self.archive, SMOOTHERS[0], SmoothedTracks(self.store), self.clock)

    def forgetting_desk(
        self,
        pulls: Pulls,
        act: Act,
        save_soon: Callable[[], None],
        leads: Callable[[], bool],
        other_there: Callable[[], bool],
    ) -> ForgettingDesk:
        """``act`` has the running station forget what it holds in memory, ``save_soon`` save its
        state, which forgetting has removed.  ``other_there``: the other one of two is heard.
        """

        def note_done(done: Forgetting) -> None:
            if done.kind == "person":
                self.roster.forget_photo(done.subject_id)
            save_soon()

        def obstacle(job: Forgetting) -> str:
            if not job.told and not leads():
                return "this station is the standby; ask the one that leads"
            # One may have opened since it was wished; of what it follows, the other one has asked.
            is_open = leads() and any(one.closed_ns is None for one in self.records.incidents())
            return "an incident is open; it is done when that is closed" if is_open else ""

        waited: Counter[Path] = Counter()

        def mended_first(path: Path, damage: str) -> bool:
            waited[path] += 1
            if not other_there() or waited[path] > MENDED_WITHIN:
                return False
            self.check.note_damaged(path, damage)
            return True

        forgetter = Forgetter(
            self.recorder, self.store, self.checkpoints, self.records, self.clock, pulls, act,
            mended_first,
        )  # fmt: skip
        return ForgettingDesk(forgetter, self.folder.forgettings, obstacle, note_done)


def open_disk(
    folder: DataFolder,
    recorder: Recorder,
    clock: Clock,
    announce: Announce,
    closing: ExitStack,
    *,
    alone: bool = True,
) -> Disk:
    """The database is made from the log where it lacks what that knows.  ``alone``: no other
    station has a copy of that.

    Raises StoreError where the database cannot be used, or is of another log.
    """
    store = closing.enter_context(Store(folder.database, lambda: recorder.hangs))
    if _lacks_log(store, recorder):
        announce("the database lacks what the log knows: it is made again from the log")
        project_whole_log(store, folder.log, lambda _: None)
    projection = SqlProjection(store)
    closing.callback(projection.close)
    check = LogCheck(_RESTORE if alone else _MENDED_FROM_THE_OTHER)
    for recovery in recorder.recoveries:
        if recovery.damage:
            check.note_damaged(recovery.path, "; ".join(recovery.damage), is_cut=True)
    steady = SteadyClock(clock, max((one.end_ns for one in recorder.segments()), default=0))
    return Disk(
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


def _lacks_log(store: Store, recorder: Recorder) -> bool:
    """Whether it is new, or what made it from the log did not come to its end.  Raises StoreError
    where it has another log's: two incidents would be one.
    """
    logged = {one.path.name for one in recorder.segments() if one.messages}
    known = {one.name for one in Records(store, SystemClock()).segments()}
    if known and logged and not known & logged:
        raise StoreError(
            f"the database {store.engine.url.database} is of another log than the one beside it "
            f"(it knows {max(known)}, here is {max(logged)}); put the right one there, or move it "
            "away: what the log knows is then made again, and people and users are not"
        )
    return bool(logged) and not known
