"""A rehearsal over one incident, in a process of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from base_station.core.alarms.thresholds import Thresholds
from base_station.replay.processes import jobs, wire
from base_station.replay.processes.log_process import LogProcess
from base_station.replay.rehearsal.report import RehearsalReport
from base_station.storage.db.models import IncidentRow


@dataclass(frozen=True)
class RehearsalProcess:
    """From any thread."""

    log_process: LogProcess
    checkpoints: str  # their folder

    def rehearse(
        self, incident: IncidentRow, points: Sequence[Thresholds], swept: str
    ) -> RehearsalReport:
        """As ``Rehearser.rehearse``.  Raises StoreError with the reason where the log cannot be
        read, ArchiveError where it is in an archive that does not answer.
        """
        job = jobs.RehearsalJob(
            log=self.log_process.log,
            checkpoints=self.checkpoints,
            database=self.log_process.database,
            incident_id=incident.incident_id,
            opened_ns=incident.opened_ns,
            closed_ns=incident.closed_ns,
            points=tuple(points),
            swept=swept,
            known_segments=tuple(self.log_process.known_segments()),
            archived=self.log_process.instead_of_log(incident),
        )
        return self.log_process.ask(job, wire.read_rehearsal_result).report
