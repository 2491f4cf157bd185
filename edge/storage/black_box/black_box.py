"""Recorder of the unit's raw sensor stream, one folder of segments for each boot.

A thread of its own writes: a disk that takes its time does not hold up the tracker.  At
most a second is lost to a ``kill -9``.
"""

from __future__ import annotations

import errno
import logging
import shutil
from collections.abc import Callable
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from queue import Empty, SimpleQueue

from edge.storage.black_box.station_time import (
    read_clock_offset,
    remove_if_empty,
    write_clock_offset,
)
from edge.storage.disk_watchdog import HANGS_S, DiskWatchdog
from shared.channels import channel_of
from shared.clock import NS_PER_S, Clock
from shared.codec import encode
from shared.coded_text import coded
from shared.errors import LogError
from shared.mcap_log import SegmentPolicy, SegmentWriter, segment_began_ns, segment_paths
from shared.messages import Message, UnitDescription
from shared.worker import Worker

logger = logging.getLogger(__name__)

_DESCRIBE_EVERY_NS = 60 * NS_PER_S  # so that any segment can be replayed by itself
_POLL_S = 0.2
_WAITING_MAX = 10_000  # batches, some minutes of samples, for a disk that hangs
_REFUSAL = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EIO)  # of a disk, for now
_SPARE_BYTES = 64_000_000  # left on the disk for the journal, which is worth more; on a small disk
_SPARE_SHARE = 0.05  # as much of it
_SPACE_CHECK_NS = NS_PER_S
_POLICY = SegmentPolicy(segment_s=120.0)  # a station fetches whole segments of a window

Raw = tuple[Message, ...]


class BlackBox:
    """Recorder; ``write`` never waits and never raises; ``fault`` reports what the disk does not
    do.
    """

    def __init__(
        self,
        folder: Path,
        description: UnitDescription,
        limit_bytes: int,
        clock: Clock,
        utc_std_s: Callable[[], float] = lambda: 0.0,
    ) -> None:
        """``utc_std_s``: how well the clock knows station time, 0 where it does not.

        Where the disk is full, or has failed and can only be read, the recording begins as soon as
        it has room.  Raises LogError where the folder is no use at all.
        """
        self._folder = folder
        self._description = description
        self._limit_bytes = limit_bytes
        self._clock = clock
        self._utc_std_s = utc_std_s
        self._clock_offset_ns: int | None = None  # of station time, as noted beside the recording
        self._utc_offset_ns = clock.utc_ns() - clock.monotonic_ns()
        began = datetime.fromtimestamp(clock.utc_ns() // NS_PER_S, UTC)
        self._boot_name = f"{began:%Y%m%dT%H%M%SZ}-{description.header.boot_id:016x}"
        self._described_ns = -_DESCRIBE_EVERY_NS
        self._waiting: SimpleQueue[Raw | None] = SimpleQueue()
        self._dropped = 0  # batches that came while the disk hung
        self._disk = DiskWatchdog()
        self._problem: str | None = None
        self._writer: SegmentWriter | None = None
        self._retry_ns = 0
        self._next_space_check_ns = 0
        self._begin()
        self._worker = Worker("black-box", self._step, "samples are not kept", retry_s=0.0)
        self._worker.start()

    @property
    def fault(self) -> str | None:
        """Reason that samples are not kept; None while they are."""
        if not self._worker.is_alive:
            return coded("black-box-stopped", "the black box has stopped")
        if self._worker.fault:
            return coded(
                "black-box-fails", "the black box fails: {error}", error=self._worker.fault
            )
        if self._disk.hangs:
            return coded(
                "black-box-hangs",
                "the black box hangs: the disk has not answered for {silent_s:.0f} s",
                silent_s=HANGS_S,
            )
        return self._problem

    def write(self, raw: Raw) -> None:
        self._waiting.put(raw)
        if self._waiting.qsize() > _WAITING_MAX and self._disk.hangs:
            self._waiting.get()
            self._dropped += 1

    def close(self) -> None:
        """Write everything that was given, unless the disk hangs to the end."""
        self._waiting.put(None)
        if not self._disk.join(self._worker):
            logger.error("the black box hangs: the samples that wait are not kept")

    def _step(self) -> float:
        """Take one batch from the queue, or the end."""
        try:
            raw = self._waiting.get(timeout=_POLL_S)
        except Empty:
            raw = ()
        with self._disk.request():
            if raw is not None:
                self._take(raw)
                return 0.0
            self._worker.stop()
            if self._writer is not None:
                self._writer.close()
        return 0.0

    def _take(self, raw: Raw) -> None:
        """Write one batch, or none where nothing has come for a while."""
        self._check_free_space()
        if self._writer is None and raw and self._now_ns() >= self._retry_ns:
            self._begin()
        if self._writer is None:
            return
        if raw:
            self._write(self._writer, raw)
        else:
            self._writer.advance(self._now_ns())
        self._set_problem(self._writer.problem)
        dropped, self._dropped = self._dropped, 0
        if dropped:
            logger.warning("the disk hung: %d batches of samples are not kept", dropped)

    def _begin(self) -> None:
        """Make this boot's folder, where the disk lets it be made."""
        self._try_remove_oldest()
        try:
            self._writer = SegmentWriter(
                self._folder / self._boot_name, _POLICY, lambda _: self._try_remove_oldest()
            )
        except LogError as error:
            cause = error.__cause__
            if not isinstance(cause, OSError) or cause.errno not in _REFUSAL:
                raise
            self._retry_ns = self._now_ns() + NS_PER_S
            self._set_problem(str(error))

    def _write(self, writer: SegmentWriter, raw: Raw) -> None:
        """Write messages.  Log time is UTC as it was at the start, and never jumps."""
        now_ns = self._now_ns()
        if now_ns - self._described_ns >= _DESCRIBE_EVERY_NS:
            self._described_ns = now_ns
            raw = (self._description, *raw)
        self._record_clock_offset(now_ns)
        for message in raw:
            key = channel_of(message).key(self._description.header.unit_id)
            writer.write(now_ns, key, encode(message))

    def _record_clock_offset(self, now_ns: int) -> None:
        """Write the clock offset; where that fails, the next time may do."""
        if self._utc_std_s() == 0.0:
            return
        ahead_ns = now_ns - self._clock.utc_ns()
        if self._clock_offset_ns is None or abs(ahead_ns - self._clock_offset_ns) > NS_PER_S:
            with suppress(OSError):
                write_clock_offset(self._folder / self._boot_name, ahead_ns)
                self._clock_offset_ns = ahead_ns

    def _set_problem(self, problem: str) -> None:
        if problem and self._problem is None:
            logger.error("%s", problem)
        self._problem = problem or None

    def _now_ns(self) -> int:
        return self._clock.monotonic_ns() + self._utc_offset_ns

    def _check_free_space(self) -> None:
        """Check the free space: other programs may fill the disk, too."""
        now_ns = self._now_ns()
        if now_ns >= self._next_space_check_ns:
            self._next_space_check_ns = now_ns + _SPACE_CHECK_NS
            if self._lacking_bytes() > 0:
                self._try_remove_oldest()

    def _lacking_bytes(self) -> float:
        """Return how much more is to be free on the disk."""
        try:
            disk = shutil.disk_usage(self._folder)
        except OSError:  # no folder yet, or the disk fails: the writer reports that
            return 0
        return min(_SPARE_BYTES, _SPARE_SHARE * disk.total) - disk.free

    def _try_remove_oldest(self) -> None:
        try:
            self._remove_oldest()
        except OSError as error:
            logger.error("old recordings cannot be removed: %s", error)

    def _remove_oldest(self) -> None:
        """Remove the oldest segments beyond the limit, or for which the disk has no room, and
        folders that are left empty.

        This boot's are the newest, whatever date a clock that was never set has given them.
        """
        found = {boot: segment_paths(boot) for boot in self._folder.glob("*/")}

        def began_ns(boot: Path) -> int:
            return segment_began_ns(found[boot][0]) - (read_clock_offset(boot) or 0)

        boots = sorted(
            (boot for boot in found if found[boot]),
            key=lambda boot: (boot.name == self._boot_name, began_ns(boot)),
        )
        segments = [segment for boot in boots for segment in found[boot]]
        sizes = [segment.stat().st_size for segment in segments]
        excess_bytes = max(sum(sizes) - self._limit_bytes, self._lacking_bytes())
        for segment, size in zip(segments[:-1], sizes, strict=False):
            if excess_bytes <= 0:
                return
            segment.unlink()
            excess_bytes -= size
            remove_if_empty(segment.parent)
