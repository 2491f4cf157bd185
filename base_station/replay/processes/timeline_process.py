"""The timeline of a unit, read in a process of its own."""

from __future__ import annotations

from dataclasses import dataclass

from base_station.replay.processes import jobs, wire
from base_station.replay.processes.log_process import LogProcess
from base_station.replay.timelines.unit_timeline import TimelineRequest, UnitTimeline

TIMEOUT_S = 60.0  # a day of a hundred units takes longer on a small machine: too long for a user


@dataclass(frozen=True)
class TimelineProcess:
    """From any thread."""

    log_process: LogProcess
    timeout_s: float = TIMEOUT_S

    def read(self, request: TimelineRequest) -> UnitTimeline:
        """Raises StoreError with the reason where it cannot be read, ArchiveError where a part of
        it is in an archive that does not answer.
        """
        window = request.window
        job = jobs.TimelineJob(
            log=self.log_process.log,
            database=self.log_process.database,
            unit_id=request.unit_id,
            from_ns=window.from_ns,
            until_ns=window.until_ns,
            buckets=request.buckets,
            known_segments=tuple(self.log_process.known_segments()),
            archived=self.log_process.archived_parts(window.from_ns, window.until_ns),
        )
        return self.log_process.ask(job, wire.read_timeline_result, self.timeout_s).timeline
