"""Sources of a report outside a station: a folder, a log alone, or files of one."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from base_station.app.offline_log import named_incident, open_offline_log
from base_station.fusion.smoothing import SMOOTHERS
from base_station.replay.post_processing import PostProcessor
from base_station.report.data_collection import Progress, ReportSources
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.smoothed import SmoothedTracks
from shared.clock import SystemClock


@dataclass(frozen=True)
class OpenedReport:
    sources: ReportSources
    incident: IncidentRow
    post_processor: PostProcessor

    def assess(self, on_progress: Progress) -> None:
        """Judge the positions anew where that is not kept; an open incident's is never kept."""
        live = self.sources.records.tracks_of(self.incident)
        if self.sources.kept.report(self.incident.incident_id) is None:
            self.post_processor.post_process(self.incident, live, on_progress)


def open_report_sources(
    data: Path,
    incident_id: str,
    closing: ExitStack,
    report: Callable[[str], None],
    on_progress: Progress,
) -> OpenedReport:
    """As ``folder_commands.open_post_processing``."""
    incident_id, data = named_incident(incident_id, data)
    offline_log = open_offline_log(data, incident_id, closing, report, on_progress, in_place=True)
    clock, store = SystemClock(), offline_log.store
    records, kept = Records(store, clock), SmoothedTracks(store)
    incident = records.require_incident(incident_id)
    return OpenedReport(
        ReportSources(
            records=records,
            roster=Roster(store, clock),
            kept=kept,
            log=offline_log.log,
            imports=offline_log.imports,
            defects=offline_log.defects,
            recorded_until_ns=offline_log.folder.recorded_until_ns,
        ),
        incident,
        PostProcessor(offline_log.archive(), SMOOTHERS[0], kept, clock),
    )
