"""Composition root of a department."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack

from base_station.api.server import bind, console_server, serve_until_stopped
from base_station.app.console_presence import ConsolePresence
from base_station.app.factories import announce_first_login
from base_station.app.health_facts import ReportsProblems
from base_station.config import host_and_port
from base_station.department.api import DepartmentServices, create_department_app
from base_station.department.archive_replays import ArchiveReplays
from base_station.department.config import DepartmentServerConfig
from base_station.department.intake import ReportIntake
from base_station.department.live_picture import LivePicture
from base_station.department.standing import StandingReports
from base_station.department.views import DepartmentViews
from base_station.security.pki.expiry import ExpiryWatch
from base_station.security.pki.folder import PkiFolder
from base_station.security.router.process import RouterProcess
from base_station.security.router.router import station_endpoint
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.database import Database
from base_station.storage.db.department_tables import DepartmentTables
from base_station.storage.db.opening import open_live_server, require_noted_server
from base_station.storage.db.records import Records
from base_station.storage.db.server_address import note_server
from base_station.storage.db.store import Store
from shared.bus_zenoh import ZenohBus
from shared.clock import SystemClock
from shared.enrolment import Holder
from shared.errors import ConfigError, MusterError
from shared.own_files import make_folder
from shared.service_manager import ServiceManager

_FOLDER_MODE = 0o700


def run_department(config: DepartmentServerConfig, announce: Callable[[str], None]) -> None:
    """Serve until SIGINT or SIGTERM.  Raises MusterError where the settings cannot work."""
    if config.bus.announce:
        raise ConfigError("stations know a department from their enrolments: leave announce out")
    pki, clock, manager = PkiFolder(config.data), SystemClock(), ServiceManager(os.environ)
    if station_endpoint(config.data, config.bus.listen).tls is not None:
        pki.require_valid_station()
    folder = DataFolder(config.data)
    with ExitStack() as closing:
        make_folder(folder.path, _FOLDER_MODE)
        closing.callback(folder.lock().close)
        listening = closing.enter_context(bind(*host_and_port(config.http.listen)))
        store = closing.enter_context(_open_database(config, folder))
        accounts, records = Accounts(store, clock), Records(store, clock)
        tables, picture = DepartmentTables(store), LivePicture()
        standing = StandingReports(tables)
        standing.start()
        closing.callback(standing.close)
        intake = ReportIntake(tables, picture, clock, standing.wake)
        router = RouterProcess(folder.path, config.bus.listen)
        closing.callback(router.close)
        router.wait_open()
        bus = ZenohBus(router.endpoint)
        closing.callback(bus.close)
        intake.open(bus, closing)
        watched = (
            router,
            ExpiryWatch(pki, clock),
            closing.enter_context(ConsolePresence(config.http)),
        )
        views = DepartmentViews(
            picture,
            tables,
            standing,
            intake,
            clock,
            lambda: _enrolled(pki),
            lambda: _problems(config, store, watched),
            has_archive=config.archive.location != "",
        )
        replays = ArchiveReplays(config.archive, config.http)
        closing.callback(replays.close)
        services = DepartmentServices(
            accounts=accounts,
            records=records,
            secure=config.http.certificate is not None,
            views=views,
            replays=replays,
        )
        server = console_server(create_department_app(services), listening, config.http)

        def on_ready(line: str) -> None:
            announce(line)
            manager.ready()

        def keep_summaries() -> None:
            manager.working()
            intake.keep_summaries()

        announce_first_login(accounts, folder.first_login, announce)
        asyncio.run(serve_until_stopped(server, on_ready, keep_summaries))
        intake.keep_summaries()


def _problems(
    config: DepartmentServerConfig, store: Database, watched: tuple[ReportsProblems, ...]
) -> Iterator[str]:
    """Yield problems for an administrator, as sentences."""
    yield from config.configuration_problems()
    if store.problem:
        yield store.problem
    for part in watched:
        yield from part.problems()


def _open_database(config: DepartmentServerConfig, folder: DataFolder) -> Database:
    """Open the database.  Raises StoreError."""
    server = config.database_server
    require_noted_server(folder.database, server)
    if server is None:
        return Store(folder.database)
    store, _ = open_live_server(server, folder.database)
    note_server(folder.database, server)
    return store


def _enrolled(pki: PkiFolder) -> list[str]:
    """Stations that may report; none are known if the bus is not secured."""
    try:
        entries = pki.registry().entries
    except MusterError:
        return []
    return [
        one.name
        for one in entries
        if one.holder is Holder.DEPARTMENT_STATION and one.revoked is None
    ]
