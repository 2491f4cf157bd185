"""The report on an incident, made in a process of its own: what is live does not wait for it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from base_station.replay.processes import wire
from base_station.replay.processes.server import ReplayProcesses
from base_station.storage.db.models import IncidentRow
from base_station.storage.missing_segments import KnownSegment
from shared.errors import StoreError


@dataclass(frozen=True)
class ReportProcess:
    """From any thread."""

    processes: ReplayProcesses
    log: str
    database: str
    prepare: Callable[[], object]  # what was recorded is on the disk then
    note_damage: Callable[[str], None]  # of the log
    known_segments: Callable[[], Iterable[KnownSegment]]  # of the log, by the database

    def make(self, incident: IncidentRow, *, as_pdf: bool) -> bytes:
        """HTML, or PDF.  Raises StoreError with the reason where it cannot be made."""
        self.prepare()
        line = self.processes.start(
            wire.ReportJob(
                log=self.log,
                database=self.database,
                incident_id=incident.incident_id,
                opened_ns=incident.opened_ns,
                closed_ns=incident.closed_ns,
                as_pdf=as_pdf,
                known_segments=tuple(self.known_segments()),
            )
        )
        try:
            return self._content(line)
        finally:
            line.hang_up()
            line.close()

    def _content(self, line: wire.FrameChannel) -> bytes:
        while (encoded := line.receive()) is not None:
            match wire.read_report_result(encoded):
                case wire.ReportFrame(content):
                    return content
                case wire.Damage(what):
                    self.note_damage(what)
                case wire.Failure(reason):
                    raise StoreError(reason)
        raise StoreError("the process that made the report has ended; ask again")
