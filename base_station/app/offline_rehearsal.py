"""A rehearsal outside a station: on a folder, a log alone, or files of one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from base_station.app.offline_log import open_offline_log
from base_station.fusion import FUSERS
from base_station.replay.playback import Archive
from base_station.replay.rehearsal.rehearse import Progress, Rehearser
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.records import Records
from shared.clock import SystemClock
from shared.errors import UserError


@dataclass(frozen=True)
class OpenedRehearsal:
    rehearser: Rehearser
    incidents: Sequence[IncidentRow]  # oldest first


def open_rehearsal(
    data: Path,
    incident_ids: Sequence[str],
    closing: ExitStack,
    report: Callable[[str], None],
    on_progress: Progress,
) -> OpenedRehearsal:
    """As ``folder_commands.open_post_processing``; without ids, every closed incident.

    Raises UserError where there is no such incident, or none.
    """
    first = incident_ids[0] if incident_ids else ""
    offline_log = open_offline_log(data, first, closing, report, on_progress, in_place=True)
    records = Records(offline_log.store, SystemClock())
    if incident_ids:
        incidents = [records.require_incident(one) for one in dict.fromkeys(incident_ids)]
    else:
        incidents = [one for one in records.incidents() if one.closed_ns is not None]
    if not incidents:
        raise UserError("no incident was closed in this log; name an open one with --incident")

    def archive_of(incident: IncidentRow) -> Archive:
        return offline_log.of_incident(incident.incident_id).archive()

    rehearser = Rehearser(archive_of, FUSERS[0], records, offline_log.folder.recorded_until_ns)
    return OpenedRehearsal(rehearser, sorted(incidents, key=lambda one: one.opened_ns))
