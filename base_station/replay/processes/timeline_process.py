"""Reads the timeline of a unit in a process of its own: what is live does not wait for it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from base_station.replay.processes import wire
from base_station.replay.processes.server import ReplayProcesses
from base_station.replay.timelines.unit_timeline import TimelineRequest, UnitTimeline
from base_station.storage.missing_segments import KnownSegment
from shared.errors import StoreError

TIMEOUT_S = 60.0  # a day of a hundred units is longer on a small machine: nobody waits so long


@dataclass(frozen=True)
class TimelineProcess:
    """From any thread."""

    processes: ReplayProcesses
    log: str
    database: str
    prepare: Callable[[], object]  # what was recorded is on the disk then
    note_damage: Callable[[str], None]  # of the log
    known_segments: Callable[[], Iterable[KnownSegment]]  # of the log, by the database
    timeout_s: float = TIMEOUT_S

    def read(self, request: TimelineRequest) -> UnitTimeline:
        """Raises StoreError with the reason where it cannot be read."""
        self.prepare()
        line = self.processes.start(
            wire.TimelineJob(
                log=self.log,
                database=self.database,
                unit_id=request.unit_id,
                from_ns=request.window.from_ns,
                until_ns=request.window.until_ns,
                buckets=request.buckets,
                known_segments=tuple(self.known_segments()),
            )
        )
        try:
            return self._result(line)
        finally:
            line.hang_up()
            line.close()

    def _result(self, line: wire.FrameChannel) -> UnitTimeline:
        while line.has_message(self.timeout_s):
            encoded = line.receive()
            if encoded is None:
                raise StoreError("the process that read the log has ended; ask again")
            match wire.read_timeline_result(encoded):
                case wire.TimelineFrame(timeline):
                    return timeline
                case wire.Damage(what):
                    self.note_damage(what)
                case wire.Failure(reason):
                    raise StoreError(reason)
        raise StoreError(
            f"the log was not read within {self.timeout_s:.0f} s; ask for a shorter span"
        )
