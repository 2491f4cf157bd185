"""Copies of closed incidents that the station makes by itself.

A process of its own does the work, and reads back what it has written.  Due incidents are in the
database, so that a restart loses none.  While the archive cannot be reached, the work is tried
again after pauses that grow.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from threading import Lock

from base_station.archive.copying import closed_until_ns
from base_station.archive.store import open_store
from base_station.config import ArchiveConfig
from base_station.replay.processes import frame_channel, jobs, wire
from base_station.storage.db.archived import ArchivedCopies
from base_station.views.text_code import text_code_view_or_none
from base_station.views.wire import ArchiveView
from shared.clock import NS_PER_MS, NS_PER_S, Clock
from shared.coded_text import code_of_text, coded, text_of_error, with_code
from shared.errors import ArchiveError, StoreError
from shared.worker import Worker

POLL_INTERVAL_S = 10.0
LONGEST_PAUSE_S = 600.0
_CLOSE_WITHIN_S = 5.0
_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class ArchivingContext:
    """Parts of the station on which the work depends."""

    start: Callable[[jobs.ArchiveJob], frame_channel.FrameChannel]  # a process for it
    log: str
    database: str
    prepare: Callable[[], object]  # brings the data to be copied to the disk
    note_damage: Callable[[str], None]  # of the log
    leads: Callable[[], bool]  # of two stations one copies


class AutomaticArchive:
    """Worker that runs while it is entered; any thread may ask for its state."""

    def __init__(
        self,
        config: ArchiveConfig,
        place: ArchivingContext,
        copies: ArchivedCopies,
        clock: Clock,
        poll_interval_s: float = POLL_INTERVAL_S,
    ) -> None:
        """Raises ConfigError if the archive needs a library that is missing."""
        self._config, self._place = config, place
        self._address = open_store(config.location).address
        self._copies, self._clock = copies, clock
        self._poll_interval_s = self._pause_s = poll_interval_s
        self._lock = Lock()  # guards the fields below
        self._line: frame_channel.FrameChannel | None = None  # to the process that is at work
        self._closed = False
        self._waiting = 0
        self._copied = 0
        self._archived_ns: int | None = None
        self._away_since_ns: int | None = None  # by the monotonic clock
        self._reason = ""
        self._worker = Worker("archiving", self._step, "closed incidents are not archived")

    def __enter__(self) -> AutomaticArchive:
        self._worker.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._worker.stop()
        with self._lock:
            self._closed = True
            if self._line is not None:
                self._line.hang_up()
        self._worker.join(_CLOSE_WITHIN_S)

    def view(self) -> ArchiveView:
        with self._lock:
            working = "copying" if self._line is not None else "waiting"
            return ArchiveView(
                location=self._address,
                state="away" if self._reason else working,
                waiting=self._waiting,
                copied=self._copied,
                archived_ms=None if self._archived_ns is None else self._archived_ns // NS_PER_MS,
                text=str(self._reason),
                text_code=text_code_view_or_none(code_of_text(self._reason)),
            )

    def problems(self) -> Iterable[str]:
        """Sentence for a person if copying has failed for long."""
        with self._lock:
            since_ns, waiting, reason = self._away_since_ns, self._waiting, self._reason
        if since_ns is None:
            return ()
        away_s = (self._clock.monotonic_ns() - since_ns) / NS_PER_S
        if away_s < self._config.alarm_after_s:
            return ()
        text = coded(
            "archive-away",
            "Closed incidents are not archived since {minutes:.0f} min, {waiting} wait: {reason}",
            minutes=away_s / 60.0,
            waiting=waiting,
            reason=reason,
        )
        return (text,)

    def keeps_audio_since_ns(self) -> int | None:
        """Station time from which on audio must not be deleted, because the archive does not have
        it yet; None if all may be deleted.  Raises StoreError.
        """
        return self._copies.oldest_waiting_ns(self._address) if self._config.radio else None

    # ---- in the thread

    def _step(self) -> float:
        """Copy the due incidents, and return the pause after them."""
        if not self._place.leads():
            return self._poll_interval_s
        try:
            waiting = self._copies.waiting(self._address, closed_until_ns(self._clock))
            self._note_waiting(len(waiting))
            if waiting:
                self._copy()
        except (ArchiveError, StoreError) as error:
            return self._note_failure(text_of_error(error))
        self._note_success()
        return self._poll_interval_s

    def _copy(self) -> None:
        """Copy one incident.  Raises ArchiveError or StoreError if that fails."""
        self._place.prepare()
        line = self._begin()
        try:
            self._follow(line)
        finally:
            with self._lock:
                self._line = None
            line.hang_up()
            line.close()

    def _begin(self) -> frame_channel.FrameChannel:
        job = jobs.ArchiveJob(
            log=self._place.log,
            database=self._place.database,
            location=self._config.location,
            has_radio=self._config.radio,
        )
        with self._lock:
            if self._closed:
                raise StoreError("the station is stopping")
            self._line = self._place.start(job)
            return self._line

    def _follow(self, line: frame_channel.FrameChannel) -> None:
        while (encoded := line.receive()) is not None:
            match wire.read_archive_report(encoded):
                case wire.CopyFrame(incident_id, damage):
                    self._note_copied(incident_id, damage)
                case wire.CopiesDone():
                    return
                case wire.Failure() as failure:
                    raise ArchiveError(with_code(failure.reason, failure.code))
                case wire.Damage(what):
                    self._place.note_damage(what)
        raise StoreError(
            coded("archive-process-ended", "the process that copies incidents has ended")
        )

    # ---- status

    def _note_waiting(self, waiting: int) -> None:
        with self._lock:
            self._waiting = waiting

    def _note_copied(self, incident_id: str, damage: tuple[str, ...]) -> None:
        _log.info("incident %s is in the archive %s", incident_id, self._address)
        for words in damage:
            _log.warning("%s is archived without what cannot be read: %s", incident_id, words)
        with self._lock:
            self._waiting = max(self._waiting - 1, 0)
            self._copied += 1
            self._archived_ns = self._clock.utc_ns()

    def _note_success(self) -> None:
        with self._lock:
            if self._reason:
                _log.info("the archive %s takes incidents again", self._address)
            self._reason, self._away_since_ns = "", None
        self._pause_s = self._poll_interval_s

    def _note_failure(self, reason: str) -> float:
        with self._lock:
            if self._closed:
                return 0.0
            if reason != self._reason:
                _log.warning("closed incidents are not archived: %s; it is tried again", reason)
            self._reason = reason
            if self._away_since_ns is None:
                self._away_since_ns = self._clock.monotonic_ns()
        pause_s, self._pause_s = self._pause_s, min(2.0 * self._pause_s, LONGEST_PAUSE_S)
        return pause_s
