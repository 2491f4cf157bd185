"""Recorder of the log: all messages and decisions of the station are written here first.  A thread
of its own writes, so that a slow disk does not delay the live picture.  Only urgent records
(alarms, actions, alerts) wait for the disk.
"""

from __future__ import annotations

import logging
import shutil
import sys
from collections.abc import Mapping
from contextlib import ExitStack, suppress
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from threading import Condition, Lock, RLock

from base_station.storage.segment_list import SegmentHandler, SegmentList, ignore_segment
from shared.channels import OPERATOR, Qos, parse_key
from shared.clock import NS_PER_S, Clock
from shared.coded_text import Measure, coded, join_texts
from shared.errors import LogError, UnknownChannelError
from shared.folder_lock import FolderLock
from shared.mcap_log import (
    LogRecord,
    Recovery,
    SegmentInfo,
    SegmentPolicy,
    SegmentWriter,
)
from shared.worker import Worker

logger = logging.getLogger(__name__)

LOG_FOLDER = "log"
_TURN_S = 0.05
_LONGEST_WAIT_S = 2.0  # for the disk, by the writer of an urgent record
_HUNG_WAIT_S = 0.2  # while it hangs: enough for a disk that answers again
_DISK_CHECK_INTERVAL_NS = 5 * NS_PER_S
_STUCK_NS = NS_PER_S  # a longer round of the thread: the disk is slow, or hangs
_HANGS_NS = 5 * NS_PER_S  # a longer round: it hangs
_LITTLE_FREE_BYTES = 1_000_000_000
_RECORD_BYTES = 200  # that a record takes in memory beside the bytes of its key and payload
_ALERTS_SHARE = 1.25  # of the bytes that may wait for the disk, until alerts are refused
_ACTIONS_SHARE = 1.5  # and until actions are refused


def _share_of(key: str) -> float:
    try:
        channel = parse_key(key)[1]
    except UnknownChannelError:
        return 1.0
    if channel is OPERATOR:
        return _ACTIONS_SHARE
    return _ALERTS_SHARE if channel.qos is Qos.ALERT else 1.0


def _clock_time(t_ns: int) -> Measure:
    t_s = t_ns // NS_PER_S
    return Measure(t_s, f"{datetime.fromtimestamp(t_s, UTC):%H:%M:%S}")


class Recorder:
    """Recorder of one data folder, which it locks until ``close``: one station a folder.

    ``write`` and ``flush`` may be called from any thread; records are kept in the order of the
    calls.  Neither raises for the disk: ``problem`` describes it, records wait in
    memory meanwhile, and what memory cannot hold is refused and counted in ``lost``.
    """

    def __init__(
        self,
        data: Path,
        clock: Clock,
        policy: SegmentPolicy | None = None,
        on_segment: SegmentHandler = ignore_segment,
    ) -> None:
        """Lock the folder, recover torn segments, and begin to record.

        ``on_segment`` is called with every segment of the log before this returns, and with
        each further one when it is complete, then in the recorder's thread.  Raises
        DataFolderInUseError, or LogError when the folder cannot be used.
        """
        self._clock = clock
        self.rewriting = Lock()  # held while a complete segment is exchanged
        policy = policy or SegmentPolicy()
        self._waiting_max = policy.waiting_bytes_max
        self.folder = data / LOG_FOLDER
        self._lock = FolderLock(data)
        with ExitStack() as undo:
            undo.callback(self._lock.close)
            self._list = SegmentList(self.folder, on_segment)
            # Taken records are kept: this recorder refuses, so that the writer never has to.
            patient = replace(policy, waiting_bytes_max=sys.maxsize)
            self._writer = SegmentWriter(self.folder, patient, self._list.add)
            undo.pop_all()
        self._taking = RLock()
        self._news = Condition(self._taking)
        self._queue: list[LogRecord] = []
        self._queued_bytes = 0
        self._unwritten_bytes = 0  # that were taken from the queue, and the disk has not taken
        self._written = 0
        self._on_disk = 0
        self._flushes_asked = 0
        self._flushes_done = 0
        self._ending = False  # behind the records in the queue the segment is complete
        self._refused = 0
        self._refused_from_ns = self._refused_until_ns = 0
        self._failure: str = ""
        self._turned_ns = self._received_ns = self._disk_checked_ns = clock.monotonic_ns()
        self._last_t_ns = 0  # log time of the last record
        self._taken = 0
        self._disk_free_bytes = shutil.disk_usage(self.folder).free
        self._worker = Worker("recorder", self._step, "nothing is logged", at_end=self._end)
        self._worker.start()

    # ---- from any thread

    def write(self, t_ns: int, key: str, payload: bytes, *, urgent: bool = False) -> bool:
        """Keep a record with station time ``t_ns``; False: it is refused, and not in the log.

        Returns at once, or, where it is urgent, when it is on the disk; a disk that hangs is not
        waited for longer than two seconds, and hardly at all once it is known to.
        """
        with self._taking:  # the condition's own lock, without the cost of a condition
            if self.refuses and not self._has_room_for(key):
                self._note_refused(t_ns)
                return False
            self._queue.append((t_ns, key, payload))
            self._queued_bytes += len(payload) + len(key) + _RECORD_BYTES
            self._written += 1
        if urgent:
            self.flush()
        return True

    def flush(self) -> bool:
        """Flush all records so far to the disk; True if they are there now."""
        with self._news:
            self._flushes_asked += 1
            mine = self._flushes_asked
            self._worker.wake()
            done = self._news.wait_for(
                lambda: self._flushes_done >= mine or bool(self._failure),
                _HUNG_WAIT_S if self.hangs else _LONGEST_WAIT_S,
            )
        return done and not self._failure and not self._writer.problem

    def continue_log(self, number: int, log_id: str) -> None:
        """Continue a log that had a segment of this number; ``log_id``: for where no segment is
        left that has the log's id.
        """
        self._writer.continue_log(number, log_id)

    def complete_segments(self) -> tuple[Path, ...]:
        """End the open segment and begin another; returns the complete ones, in order.

        Raises LogError where the disk does not take what is left.
        """
        with self._news:
            self._ending = True  # behind the records in the queue now
        if not self.flush():
            raise LogError(
                coded(
                    "log-not-on-disk",
                    "the log cannot be brought to the disk: {reason}",
                    reason=self.problem,
                )
            )
        return tuple(segment.path for segment in self._list.segments)

    def note_rewritten(self, path: Path) -> None:
        """Read the description of a complete segment again, which was rewritten."""
        self._list.note_rewritten(path)

    @property
    def recoveries(self) -> tuple[Recovery, ...]:
        """Segments that a crash left torn, and that were recovered at the start."""
        return self._list.recoveries

    @property
    def foreign(self) -> Mapping[Path, str]:
        """MCAP files in the folder that are not of the log, each with the reason in words."""
        return self._list.foreign

    @property
    def problem(self) -> str:
        """Problem of the log, as a sentence for a person; empty: none."""
        if self._failure:
            return self._failure
        missing = ""
        if self.lost:  # reported until the station starts anew
            missing = coded(
                "log-records-missing",
                "the disk did not keep up: {lost} records are missing in the log, from "
                "{from_utc_s} to {until_utc_s} UTC",
                lost=self.lost,
                from_utc_s=_clock_time(self._refused_from_ns),
                until_utc_s=_clock_time(self._refused_until_ns),
            )
        hangs = coded(
            "log-disk-hangs",
            "{folder} cannot be written: its disk does not answer; check it",
            folder=str(self.folder),
        )
        return join_texts((missing, hangs if self.hangs else self._writer.problem))

    @property
    def low_disk_space(self) -> str:
        """Warning that the disk is nearly full, as a sentence for a person; empty: it is not."""
        if self._disk_free_bytes >= _LITTLE_FREE_BYTES:
            return ""
        return coded(
            "log-little-room",
            "only {free_mb:.0f} MB are free for the log in {folder}: free the disk",
            free_mb=self._disk_free_bytes / 1e6,
            folder=str(self.folder),
        )

    @property
    def is_behind(self) -> bool:
        """True if records from a second ago may not be on the disk yet."""
        stuck = self._turn_ns > _STUCK_NS
        return stuck or bool(self._failure or self._writer.problem)

    @property
    def hangs(self) -> bool:
        """True if the disk does not answer at all: records wait in memory for it."""
        return self._turn_ns > _HANGS_NS and not self._failure

    @property
    def unsaved_loss(self) -> str:
        """Loss if the station ended now, as a sentence for a person; empty: the disk answers, and
        has everything soon.
        """
        if not self.hangs:
            return ""
        return (
            f"{self._written - self._on_disk} records are not safely in the log {self.folder}, "
            f"which has not been written for {self._turn_ns / NS_PER_S:.0f} s; messages of "
            "units come again from their journals, actions of people meanwhile may be lost"
        )

    @property
    def refuses(self) -> bool:
        """True if the memory for waiting records is full.  Alerts and actions, of which there is no
        other copy, still have some room then.
        """
        return bool(self._failure) or self._waiting_bytes > self._waiting_max

    @property
    def lost(self) -> int:
        return self._refused

    @property
    def written(self) -> int:
        """Records that were taken so far."""
        return self._written

    @property
    def on_disk(self) -> int:
        """Number of the first of these that are safe from a power cut."""
        return self._on_disk

    @property
    def disk_free_bytes(self) -> int:
        """Free bytes of the disk, at most some seconds old."""
        return self._disk_free_bytes

    @property
    def log_bytes(self) -> int:
        return sum(segment.size_bytes for segment in self.segments())

    def segments(self) -> tuple[SegmentInfo, ...]:
        """Segments of the log, in order; the last one may be open."""
        current = self._writer.current()
        return (*self._list.segments, *([] if current is None else [current]))

    def close(self) -> None:
        """Write the rest, end the segment, and unlock the folder."""
        self._worker.close()
        self._lock.close()

    @property
    def _waiting_bytes(self) -> int:
        return self._queued_bytes + self._unwritten_bytes

    def _note_refused(self, t_ns: int) -> None:
        if not self._refused:
            self._refused_from_ns = t_ns
        self._refused += 1
        self._refused_until_ns = max(t_ns, self._refused_until_ns)

    def _has_room_for(self, key: str) -> bool:
        """True if this kind of record may use the reserved memory."""
        share = _share_of(key)
        return not self._failure and self._waiting_bytes <= share * self._waiting_max

    @property
    def _turn_ns(self) -> int:
        """Duration so far of the thread's present round."""
        return self._clock.monotonic_ns() - self._turned_ns

    # ---- in the thread

    def _step(self) -> float:
        """Run one round.  A recorder that failed stops: records behind a gap would be wrong."""
        try:
            self._record()
        except Exception as error:
            logger.exception("the recorder stopped")
            self._failure = coded(
                "recorder-stopped",
                "the recorder stopped and nothing is logged ({error}): restart it",
                error=repr(error),
            )
            self._worker.stop()
            with self._news:
                self._news.notify_all()
        return 0.0 if self._flushes_asked > self._flushes_done else _TURN_S

    def _end(self) -> None:
        """Write what came since the last turn, and close the log."""
        if not self._failure:
            self._step()
        if not self._failure:
            self._writer.close()

    def _record(self) -> None:
        records, flushes, ending = self._take()
        now_ns = self._turned_ns = self._clock.monotonic_ns()
        for t_ns, key, payload in records:
            self._writer.add(t_ns, key, payload)
            self._last_t_ns, self._received_ns = t_ns, now_ns
        self._taken += len(records)
        if ending:
            self._writer.end_segment()
            self._note_flushed(flushes)
        elif flushes > self._flushes_done:
            self._writer.flush()
            self._note_flushed(flushes)
        else:  # log time advances without records
            self._writer.advance(self._last_t_ns + now_ns - self._received_ns)
        self._unwritten_bytes = self._writer.waiting_bytes if self._writer.problem else 0
        if self._writer.is_on_disk:
            self._on_disk = self._taken
        if now_ns - self._disk_checked_ns >= _DISK_CHECK_INTERVAL_NS:
            self._disk_checked_ns = now_ns
            with suppress(OSError):  # a failing disk is reported by the writer
                self._disk_free_bytes = shutil.disk_usage(self.folder).free

    def _take(self) -> tuple[list[LogRecord], int, bool]:
        """Return the queued records, the number of the last requested flush, and True where the
        segment ends behind these records.
        """
        with self._news:
            records, self._queue = self._queue, []
            self._unwritten_bytes += self._queued_bytes
            self._queued_bytes = 0
            ending, self._ending = self._ending, False
            return records, self._flushes_asked, ending

    def _note_flushed(self, flushes: int) -> None:
        with self._news:
            self._flushes_done = flushes
            self._news.notify_all()
