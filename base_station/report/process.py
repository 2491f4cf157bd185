"""Making of a report in a process of its own."""

from __future__ import annotations

from dataclasses import dataclass

from base_station.replay.processes import jobs, wire
from base_station.replay.processes.log_process import LogProcess
from base_station.storage.db.models import IncidentRow


@dataclass(frozen=True)
class ReportProcess:
    """Maker of reports.  Thread-safe."""

    log_process: LogProcess

    def make(self, incident: IncidentRow, *, as_pdf: bool) -> bytes:
        """Make a report as HTML or PDF. Raises StoreError with the reason if it cannot be made,
        ArchiveError if the log is in an archive that does not answer.
        """
        job = jobs.ReportJob(
            log=self.log_process.log,
            database=self.log_process.database,
            incident_id=incident.incident_id,
            opened_ns=incident.opened_ns,
            closed_ns=incident.closed_ns,
            as_pdf=as_pdf,
            known_segments=tuple(self.log_process.known_segments()),
            archived=self.log_process.instead_of_log(incident),
        )
        return self.log_process.ask(job, wire.read_report_result).content
