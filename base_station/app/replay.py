"""Composition of a station that shows one past incident and writes nothing."""

from __future__ import annotations

import asyncio
from contextlib import ExitStack
from functools import partial

from base_station.api.app import create_app
from base_station.api.hub import Hub
from base_station.api.replays import Replays
from base_station.api.server import bind, console_server, serve_until_stopped
from base_station.api.services import Services
from base_station.app.archive_sources import open_archived_log
from base_station.app.factories import (
    Announce,
    replay_starter,
)
from base_station.app.first_login import add_own_login
from base_station.app.offline_log import OfflineLog, named_incident, open_offline_log
from base_station.app.tables_from_log import TablesFromLog
from base_station.archive.store import open_store
from base_station.config import StationConfig, host_and_port
from base_station.fusion.smoothing import SMOOTHERS
from base_station.replay.playback import Archive
from base_station.replay.post_processing import PostProcessor
from base_station.replay.read_only_gate import ReadOnlyGate
from base_station.replay.timelines.unit_timeline import read_timeline
from base_station.report.alarm_explanation import AlarmExplainer
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.base_maps import BaseMaps
from base_station.storage.db.imports import ImportCatalogue
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.storage.projection import FinishedTables, ProjectedTables
from shared.clock import SystemClock


def run_replay_station(
    config: StationConfig,
    incident_id: str,
    speed: float,
    announce: Announce,
    *,
    recompute: bool = False,
    archive: str | None = None,
) -> None:
    """Run a station that shows one past incident and writes nothing to the folder.

    It plays what the log has recorded of consoles; with ``recompute``, or if the log has no such
    recording, all decisions are made again.

    With ``archive`` the incident is read from there and the folder is not used.  ``incident_id``
    may be a file that has one incident.  A live station may be running on the folder: the database
    is copied first.  If the database does not have the incident, its tables are made from the log
    while the replay runs.
    """
    clock = SystemClock()
    with ExitStack() as closing:
        listening = closing.enter_context(bind(*host_and_port(config.http.listen)))
        if archive is not None:
            offline_log = open_archived_log(open_store(archive), incident_id, closing, announce)
        else:
            incident_id, data = named_incident(incident_id, config.data)
            offline_log = open_offline_log(
                data,
                incident_id,
                closing,
                announce,
                _ignore,  # the whole log is not read here
                in_place=False,
                decides_again=recompute,
                tables_later=True,
            )
        folder, store = offline_log.folder, offline_log.store
        roster, hub = Roster(store, clock), Hub()
        incident = Records(store, clock).require_incident(incident_id)
        username, password = add_own_login(Accounts(store, clock))
        announce(f"login for this replay: {username}  password: {password}")

        past = offline_log.archive(recompute=recompute)
        replays = Replays(replay_starter(past, roster, clock, folder.recorded_until_ns))
        tables: ProjectedTables = FinishedTables()
        if offline_log.lacks_tables:
            tables = closing.enter_context(TablesFromLog(offline_log, announce))
        services = _services(config, offline_log, past, roster, replays, hub, tables)
        app = create_app(
            services, started=lambda loop: _ignore(replays.open(incident, speed, loop, "", hub))
        )
        server = console_server(app, listening, config.http)
        asyncio.run(serve_until_stopped(server, announce))


def _services(
    config: StationConfig,
    offline_log: OfflineLog,
    past: Archive,
    roster: Roster,
    replays: Replays,
    hub: Hub,
    tables: ProjectedTables,
) -> Services:
    """Services of a console that shows one closed incident."""
    clock, store = SystemClock(), offline_log.store
    records = Records(store, clock)
    return Services(
        accounts=Accounts(store, clock),
        roster=roster,
        records=records,
        base_maps=BaseMaps(store),
        hub=hub,
        gate=ReadOnlyGate(),
        projection=tables,
        replays=replays,
        erasures=None,
        clock=clock,
        secure=config.http.certificate is not None,
        is_replay_only=True,
        post_processor=PostProcessor(past, SMOOTHERS[0], SmoothedTracks(store), clock),
        read_timeline=partial(read_timeline, records, offline_log.log),
        log_of=lambda _: offline_log.log,
        radio=offline_log.radio,
        alarm_explainer=AlarmExplainer(records, offline_log.log.records),
        archived=ArchivedCopies(store),
        imports=ImportCatalogue(store, offline_log.imports),
    )


def _ignore(_: object) -> None:
    return None
