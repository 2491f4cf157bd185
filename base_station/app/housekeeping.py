"""Housekeeping of a live station: periodic checks beside the engine."""

from __future__ import annotations

from functools import partial

from base_station.api.routes.forgetting import accept_from_command
from base_station.api.services import Services
from base_station.app.folder_commands import FORGET_COMMAND
from base_station.app.import_command import COMMAND as IMPORT_COMMAND
from base_station.app.live_parts import LiveParts
from base_station.app.older_assignments import OlderAssignments
from base_station.importers.requests import ImportAction, ImportRequests
from base_station.privacy.incident_retention import BY_RETENTION, IncidentRetention
from base_station.privacy.requests import ErasureRequests
from base_station.security.pki.enrolled_units import EnrolledUnits
from base_station.storage.segment_index import SegmentIndex
from base_station.unit_sync.log_gap_detector import Lost
from shared.errors import UserError
from shared.messages import STATION_ID
from shared.messages.station import SetFuser, SetThresholds


class Housekeeping:
    """Periodic checks.  Each round looks at everything once; only a leader acts."""

    def __init__(self, parts: LiveParts, services: Services) -> None:
        self._parts = parts
        disk, recorder = parts.resources.disk, parts.resources.recorder
        recoveries = {one.path: str(one) for one in recorder.recoveries}
        self._index = SegmentIndex(disk.records, recoveries, lambda: disk.check.lacking)
        self._enrolled = EnrolledUnits(
            parts.resources.pki, parts.gate, disk.roster.registered_units, disk.records
        )
        self._lost = disk.lost_from_log(self._mark_missing)
        self._older = OlderAssignments(disk.roster, parts.gate)
        self._services = services
        self._imports = ImportRequests(disk.folder, self._act_on_import)
        self._erasures = ErasureRequests(
            disk.folder, partial(accept_from_command, services, FORGET_COMMAND)
        )
        retention = parts.resources.config.retention
        self._retention = (
            None
            if retention is None
            else IncidentRetention(
                retention.incident_ns,
                disk.records,
                parts.erasures,
                partial(accept_from_command, services, BY_RETENTION, "incident"),
                disk.clock,
            )
        )

    def run(self) -> None:
        """One round."""
        parts, resources = self._parts, self._parts.resources
        self.list_segments()
        resources.disk.check.check_next_segment(resources.recorder.segments())
        if not resources.config.standby.name:  # else it comes from the other station
            self._lost.search_further()
        parts.outdated_copies.refresh()
        parts.restarts.restart_if_stale()
        self._erasures.answer_pending()
        self._imports.answer_pending()
        resources.presence.update()
        resources.console_presence.update()
        parts.replays.end_idle()
        if resources.renewal.is_due(in_incident=parts.live.is_in_incident()):
            parts.announce("the renewed certificate is taken up")
            parts.restarts.request(None)
        if parts.ha_mode.leads:
            self._submit_actions()

    def list_segments(self) -> None:
        """Write the list of segments: only by it is one that goes missing known by its name."""
        self._index.update(self._parts.resources.recorder.segments())

    def _submit_actions(self) -> None:
        """Submit the station's own changes of the live state."""
        parts, live = self._parts, self._parts.live
        self._enrolled.update()
        self._older.renew()
        if self._retention is not None:
            self._retention.request_next()
        if live.thresholds != live.configured_thresholds:
            parts.gate.submit(STATION_ID, SetThresholds(live.configured_thresholds))
        if live.fuser != live.configured_fuser:
            parts.gate.submit(STATION_ID, SetFuser(live.configured_fuser))
        monitors = (parts.limiter, parts.reports.backfill.share, parts.bans, parts.forwarders)
        for monitor in monitors:
            for report in monitor.changes(live.problems):
                parts.gate.submit(STATION_ID, report)

    def _act_on_import(self, action: ImportAction) -> None:
        ha_status = self._services.ha_status
        refusal = None if ha_status is None else ha_status.refusal()
        if refusal is not None:
            raise UserError(f"nothing was changed: {refusal}")
        self._services.perform(IMPORT_COMMAND, action)
        self._services.projection.flush()

    def _mark_missing(self, lost: Lost) -> None:
        self._parts.engine.mark_missing(lost)
        self._parts.reports.count_missing()
