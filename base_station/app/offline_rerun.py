"""A re-run of an incident on a given folder, a backup, or a log alone."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

from base_station.app.offline_log import OfflineLog, open_offline_log
from base_station.app.retracking import Retracker, Retracking, RetrackSettings
from base_station.replay.rerun.black_boxes import BlackBoxBoot, Run, boots_below, boots_in_files
from base_station.replay.rerun.comparison import (
    RaisedAlarm,
    RerunReport,
    compare_alarms,
    compare_trail,
)
from base_station.replay.rerun.recorded_runs import RecordedRun, read_runs, wanted_keys
from base_station.replay.rerun.rerun import RerunResult, fuse_again
from base_station.replay.rerun.retracked_run import RetrackedRun
from base_station.site.plan import Plan, salvage_plan
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.records import Records, TrackSample
from base_station.storage.db.roster import Roster
from base_station.storage.db.window import Window
from shared.channels import POSITION, STATUS
from shared.clock import SystemClock
from shared.errors import RecordingError, UserError
from shared.mcap_log import read_log

Progress = Callable[[float], None]


class OpenedRerun(NamedTuple):
    log: OfflineLog
    records: Records
    roster: Roster
    incident: IncidentRow
    from_ns: int
    until_ns: int
    boots: Sequence[BlackBoxBoot]  # those that belong to the incident
    runs: Mapping[Run, RecordedRun]
    notes: Sequence[str]

    @property
    def plan(self) -> Plan | None:
        geojson = self.records.plan(self.until_ns + 1, self.incident.site_id)
        return None if geojson is None else salvage_plan(geojson)


class Rerun(NamedTuple):
    report: RerunReport
    shown: Mapping[str, Sequence[TrackSample]]
    rerun: Mapping[str, Sequence[TrackSample]]


def open_rerun(
    data: Path,
    incident_id: str,
    given: Iterable[Path],
    closing: ExitStack,
    report: Callable[[str], None],
    on_progress: Progress,
) -> OpenedRerun:
    """``given``: raw recordings beside those that the station has pulled.

    Raises UserError where there is no such incident, where a given recording does not belong to
    it, or where there is none.
    """
    carried = list(boots_in_files(given))
    log = open_offline_log(data, incident_id, closing, report, on_progress, in_place=True)
    records = Records(log.store, SystemClock())
    incident = records.require_incident(incident_id)
    from_ns = incident.opened_ns
    until_ns = incident.closed_ns or max(log.folder.recorded_until_ns(), from_ns)
    pulled = list(boots_below(log.folder.recordings)) if log.folder.recordings.is_dir() else []
    units = {one.unit_id for one in (*pulled, *carried)}
    runs = read_runs(
        log.log.records(from_ns, until_ns + 1, wanted_keys(units, (POSITION, STATUS))),
        lambda t_ns: on_progress((t_ns - from_ns) / max(until_ns - from_ns, 1)),
    )
    on_progress(1.0)
    for boot in carried:
        if boot.run not in runs:
            raise UserError(
                f"{boot.path} is of unit {boot.unit_id}, boot {boot.boot_id:x}, of which "
                f"{incident_id} has no position: it does not belong to this incident"
            )
    boots = {boot.run: boot for boot in (*pulled, *carried) if boot.run in runs}
    if not boots:
        raise UserError(
            f"there is no raw recording of {incident_id}: pull one with `muster base "
            f"fetch-recording UNIT --incident {incident_id}`, or give a unit's black box with "
            "--recording"
        )
    tracked = records.track_units(Window(from_ns, until_ns + 1))
    without = sorted(set(tracked) - {unit_id for unit_id, _ in boots})
    notes = [
        f"{unit_id} has no raw recording: its positions are as it sent them" for unit_id in without
    ]
    return OpenedRerun(
        log,
        records,
        Roster(log.store, SystemClock()),
        incident,
        from_ns,
        until_ns,
        list(boots.values()),
        runs,
        notes,
    )


def rerun(
    opened: OpenedRerun,
    settings: RetrackSettings,
    out: Path,
    on_tracking: Progress,
    on_fusing: Progress,
) -> Rerun:
    """Track and fuse again, and compare with the live result.  ``out``: folder for the logs of
    the tracker, from which an interrupted re-run goes on.
    """
    retracker = Retracker(out / "retracked", settings)
    wanted = [Retracking(boot, opened.runs[boot.run].rate_hz) for boot in opened.boots]
    runs = {}
    for boot, path in retracker.track(wanted, on_tracking):
        try:
            runs[boot.run] = RetrackedRun(read_log(path), opened.runs[boot.run])
        except RecordingError as error:
            raise UserError(f"the recording {boot.path} cannot be used: {error}") from error
    result = fuse_again(opened.log.archive(), runs, opened.from_ns, opened.until_ns, on_fusing)
    shown = opened.records.tracks_of(opened.incident)
    report = _report(opened, settings, runs, result, shown)
    return Rerun(report, shown, result.trails)


def _report(
    opened: OpenedRerun,
    settings: RetrackSettings,
    runs: Mapping[Run, RetrackedRun],
    result: RerunResult,
    shown: Mapping[str, Sequence[TrackSample]],
) -> RerunReport:
    trackers = {
        unit_id: run.description.tracker if run.description else ""
        for (unit_id, _), run in runs.items()
    }
    trails = tuple(
        compare_trail(
            unit_id,
            trackers.get(unit_id, ""),
            result.counts.get(unit_id, (0, 0)),
            shown.get(unit_id, ()),
            result.trails.get(unit_id, ()),
        )
        for unit_id in sorted({*shown, *result.trails})
    )
    raised = [
        RaisedAlarm(one.rule, one.unit_id, one.raised_ns)
        for one in opened.records.alarms(Window(opened.from_ns, opened.until_ns + 1))
    ]
    aligned = [
        f"{unit_id}: the new path is laid over the recorded one by its first metres"
        for (unit_id, _), run in runs.items()
        if run.has_own_frame
    ]
    return RerunReport(
        incident_id=opened.incident.incident_id,
        tracker=settings.tracker,
        calibration="" if settings.calibration is None else settings.calibration.name,
        settings=settings.settings,
        version=version("muster"),
        trails=trails,
        alarms=compare_alarms(raised, result.alarms),
        notes=(*opened.notes, *sorted(aligned), *map(str, opened.log.defects())),
    )
