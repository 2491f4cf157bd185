"""API and console of a live station: services, application and server."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable

from base_station.api.app import create_app
from base_station.api.replays import Replays
from base_station.api.server import ConsoleServer, console_server
from base_station.api.services import Services
from base_station.app.factories import replay_process_starter
from base_station.app.live_parts import LiveParts
from base_station.app.pipeline_factory import past_pipeline
from base_station.app.station_storage import StationStorage
from base_station.dispatch.alert_intake import AlertIntake
from base_station.engine.log_feed import LogFeed
from base_station.engine.sample_intake import SampleIntake
from base_station.radio.radio_log import RadioLog
from base_station.replay.processes.log_process import LogProcess
from base_station.replay.processes.rehearsal_process import RehearsalProcess
from base_station.replay.processes.replay_process import ReplayContext
from base_station.replay.processes.timeline_process import TimelineProcess
from base_station.report.alarm_explanation import AlarmExplainer, ReadLog
from base_station.report.process import ReportProcess
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.base_maps import BaseMaps
from base_station.storage.db.imports import ImportCatalogue
from base_station.storage.db.models import IncidentRow
from base_station.storage.imports import ImportFolder
from shared.mcap_log import LogRecord


def new_services(parts: LiveParts) -> Services:
    """Create the services of the API."""
    resources, disk = parts.resources, parts.resources.disk
    log_process = _log_process(parts)
    return Services(
        accounts=disk.accounts,
        roster=disk.roster,
        records=disk.records,
        base_maps=BaseMaps(disk.store),
        hub=resources.hub,
        gate=parts.gate,
        projection=disk.projection,
        replays=Replays(
            replay_process_starter(
                _replay_context(parts),
                disk.clock.utc_ns,
                disk.archived_logs.instead_of_log,
            )
        ),
        archived=ArchivedCopies(disk.store),
        erasures=parts.erasures,
        clock=disk.clock,
        secure=resources.config.http.certificate is not None,
        ha_status=parts.ha_mode.ha_status,
        recordings=resources.recordings,
        post_processor=parts.post_processor,
        reports=ReportProcess(log_process),
        rehearse=RehearsalProcess(log_process, str(disk.folder.checkpoints)).rehearse,
        read_timeline=TimelineProcess(log_process).read,
        log_of=_log_of_incident(disk),
        alarm_explainer=AlarmExplainer(disk.records, _past_log(disk)),
        plans=parts.plans,
        pki=resources.pki,
        intake=SampleIntake(parts.gate.deliver, resources.bus, disk.clock),
        alerts=AlertIntake(parts.engine.note_external),
        radio=RadioLog(disk.folder.radio),
        imports=ImportCatalogue(disk.store, ImportFolder(disk.folder.imports)),
        dispatch=resources.config.dispatch,
        accountability=resources.config.accountability,
        retention=resources.config.retention,
    )


def new_server(parts: LiveParts, services: Services, on_stop: Callable[[], None]) -> ConsoleServer:
    """Create the server of consoles and API. ``on_stop`` is called when it begins to stop."""
    hub, http = parts.resources.hub, parts.resources.config.http
    app = create_app(services, started=lambda loop: hub.connect(loop, parts.engine))
    return console_server(app, parts.resources.listening, http, on_stop)


def _log_process(parts: LiveParts) -> LogProcess:
    disk = parts.resources.disk
    return LogProcess(
        processes=parts.replays,
        log=str(disk.folder.log),
        database=str(disk.folder.database),
        prepare=disk.recorder.flush,
        note_damage=disk.check.recheck,
        known_segments=disk.known_segments,
        instead_of_log=disk.archived_logs.instead_of_log,
        archived_parts=disk.archived_logs.parts,
    )


def _past_log(disk: StationStorage) -> ReadLog:
    """Log of a span of time, wherever it is kept."""

    def read(from_ns: int, until_ns: int, keys: Collection[str]) -> Iterable[LogRecord]:
        return disk.archived_logs.feed(disk.log, from_ns, until_ns).records(from_ns, until_ns, keys)

    return read


def _log_of_incident(disk: StationStorage) -> Callable[[IncidentRow], LogFeed]:
    """Log of an incident, wherever it is kept."""
    return lambda incident: disk.archived_logs.feed_of(incident) or disk.log


def _replay_context(parts: LiveParts) -> ReplayContext:
    disk = parts.resources.disk
    return ReplayContext(
        processes=parts.replays,
        log=str(disk.folder.log),
        checkpoints=str(disk.folder.checkpoints),
        prepare=disk.recorder.flush,
        note_damage=disk.check.recheck,
        people=disk.roster.known_people,
        empty_pipeline=lambda: past_pipeline(None),
        known_segments=disk.known_segments,
    )
