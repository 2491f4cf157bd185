"""The unit's own recording of its raw sensor stream, one folder of segments for each boot.

A thread of its own writes: a disk that takes its time does not hold up the tracker.  At
most a second is lost to a ``kill -9``.
"""

from __future__ import annotations

import logging
from datetime import UTC, datetime
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread

from shared.channels import channel_of
from shared.clock import NS_PER_S, Clock
from shared.codec import encode
from shared.errors import ConfigError
from shared.mcap_log import SegmentPolicy, SegmentWriter, segment_paths
from shared.messages import Message, UnitDescription

logger = logging.getLogger(__name__)

_DESCRIBE_EVERY_NS = 60 * NS_PER_S  # so that any segment can be replayed by itself
_LOOK_EVERY_S = 0.2
_POLICY = SegmentPolicy(segment_s=120.0)  # a station fetches whole segments of a window

Raw = tuple[Message, ...]


class BlackBox:
    """``write`` never waits and never raises; ``fault`` says what the disk does not do."""

    def __init__(
        self, folder: Path, description: UnitDescription, limit_bytes: int, clock: Clock
    ) -> None:
        """Raises ConfigError where nothing can be written at all."""
        self._folder = folder
        self._description = description
        self._limit_bytes = limit_bytes
        self._clock = clock
        self._utc_offset_ns = clock.utc_ns() - clock.monotonic_ns()
        began = datetime.fromtimestamp(clock.utc_ns() // NS_PER_S, UTC)
        self._boot_name = f"{began:%Y%m%dT%H%M%SZ}-{description.header.boot_id:016x}"
        self._described_ns = -_DESCRIBE_EVERY_NS
        self._waiting: SimpleQueue[Raw | None] = SimpleQueue()
        self._problem: str | None = None
        try:
            self._make_room()
            self._writer = SegmentWriter(
                folder / self._boot_name, _POLICY, lambda _: self._try_to_make_room()
            )
        except OSError as error:
            raise ConfigError(f"the black box cannot be written: {error}") from error
        self._thread = Thread(target=self._run, name="black-box", daemon=True)
        self._thread.start()

    @property
    def fault(self) -> str | None:
        """Why samples are not kept; None while they are."""
        return self._problem if self._thread.is_alive() else "the black box has stopped"

    def write(self, raw: Raw) -> None:
        self._waiting.put(raw)

    def close(self) -> None:
        """Everything that was given is written."""
        self._waiting.put(None)
        self._thread.join()

    def _run(self) -> None:
        while True:
            try:
                raw = self._waiting.get(timeout=_LOOK_EVERY_S)
            except Empty:
                self._writer.advance(self._now_ns())
                continue
            if raw is None:
                self._writer.close()
                return
            self._write(raw)
            self._note_problem(self._writer.problem)

    def _write(self, raw: Raw) -> None:
        """Log time is UTC as it was at the start, and never jumps."""
        now_ns = self._now_ns()
        if now_ns - self._described_ns >= _DESCRIBE_EVERY_NS:
            self._described_ns = now_ns
            raw = (self._description, *raw)
        for message in raw:
            key = channel_of(message).key(self._description.header.unit_id)
            self._writer.write(now_ns, key, encode(message))

    def _note_problem(self, problem: str) -> None:
        if problem and self._problem is None:
            logger.error("%s", problem)
        self._problem = problem or None

    def _now_ns(self) -> int:
        return self._clock.monotonic_ns() + self._utc_offset_ns

    def _try_to_make_room(self) -> None:
        try:
            self._make_room()
        except OSError as error:
            logger.error("old recordings cannot be removed: %s", error)

    def _make_room(self) -> None:
        """Remove the oldest segments beyond the limit, and folders that are left empty.

        This boot's are the newest, whatever date a clock that was never set has given them.
        """
        boots = sorted(
            (path for path in self._folder.glob("*") if path.is_dir()),
            key=lambda boot: (boot.name == self._boot_name, boot.name),
        )
        segments = [segment for boot in boots for segment in segment_paths(boot)]
        sizes = [segment.stat().st_size for segment in segments]
        excess_bytes = sum(sizes) - self._limit_bytes
        for segment, size in zip(segments[:-1], sizes, strict=False):
            if excess_bytes <= 0:
                return
            segment.unlink()
            excess_bytes -= size
            if not any(segment.parent.iterdir()):
                segment.parent.rmdir()
