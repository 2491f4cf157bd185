"""Puts the live station together from its parts, runs it, and takes it apart."""

from __future__ import annotations

import asyncio
import logging
import os
import secrets
from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack
from pathlib import Path
from typing import NamedTuple

from base_station import collector
from base_station.api.app import create_app
from base_station.api.hub import Hub
from base_station.api.replays import Replays
from base_station.api.services import Services
from base_station.app.disk import Disk, open_disk
from base_station.app.early import early_console
from base_station.app.folder import rebuild
from base_station.app.parts import (
    Announce,
    announce_first_login,
    new_pipeline,
    replay_starter,
)
from base_station.clock_server import ClockServer
from base_station.commands.downlink import Downlink
from base_station.config import StationConfig, host_and_port
from base_station.data_folder import DataFolder
from base_station.db.base_maps import BaseMaps
from base_station.db.kept import KeptTables
from base_station.drive import StationDrive
from base_station.feed import LiveFeed, LogFeed
from base_station.forgetting.desk import ForgettingDesk
from base_station.forgetting.forgetter import BY_OTHER_STATION
from base_station.journals.backfill import Backfill, Report
from base_station.live.recovering import Watch, recovering
from base_station.live.sinks import OperatorGate
from base_station.live.surroundings import Surroundings
from base_station.live_state import StationState
from base_station.pki.expiry import ExpiryWatch
from base_station.pki.folder import PkiFolder
from base_station.pki.members import EnrolledUnits
from base_station.recorder import Recorder
from base_station.recordings.desk import RecordingDesk
from base_station.recordings.fetch import ask_over
from base_station.router.process import RouterProcess
from base_station.router.router import station_endpoint
from base_station.segment_index import SegmentIndex
from base_station.server import ConsoleServer, allow_many_files, bind, serve_until_stopped
from base_station.standby.places import Place
from base_station.standby.setting_aside import set_aside
from base_station.standby.side import OneOfTwo, OnlyStation, Parts, Side
from base_station.views import StationFacts
from shared.bus_zenoh import ZenohBus
from shared.channels import ROOT, clock_key
from shared.clock import SystemClock
from shared.envelope import Stamper
from shared.mcap_log import SegmentPolicy
from shared.messages import STATION_ID
from shared.service_manager import ServiceManager

_log = logging.getLogger(__name__)


class _Again(NamedTuple):
    """The station is to start anew, as the standby of another one."""

    cut: Place | None  # behind which the log goes its own way


def run_station(config: StationConfig, announce: Announce) -> None:
    """The live station, until SIGINT or SIGTERM.  ``announce`` hears what a person must know."""
    collector.relax()
    allow_many_files()
    manager = ServiceManager(os.environ)

    def tell(line: str) -> None:
        announce(line)
        manager.working()

    while (again := _run_once(config, tell, manager)) is not None:
        if again.cut is not None:
            tell("what the other station does not have is set aside, and handed to it")
            _set_aside(config.data, again.cut, manager)


def _run_once(config: StationConfig, announce: Announce, manager: ServiceManager) -> _Again | None:
    joining = station_endpoint(config.data, config.bus.listen)  # refuses before anything is made
    clock = SystemClock()
    with ExitStack() as closing:
        folder = DataFolder(config.data)
        recorder = Recorder(
            folder.path, clock, SegmentPolicy(config.log.segment_s, config.log.flush_every_s)
        )
        closing.callback(recorder.close)
        listening = closing.enter_context(bind(*host_and_port(config.http.listen)))
        disk = open_disk(folder, recorder, clock, announce, closing)
        steady, hub, feed = disk.clock, Hub(), LiveFeed(disk.clock)
        router = RouterProcess(folder.path, config.bus.listen, config.standby.peer)
        closing.callback(router.close)
        bus = ZenohBus(joining)
        closing.callback(bus.close)
        again: list[_Again] = []

        def start_again(cut: Place | None) -> None:
            again.append(_Again(cut))
            server.stop()

        pki = PkiFolder(folder.path)
        recordings = RecordingDesk(ask_over(bus), folder.recordings, steady)
        closing.enter_context(recordings)
        parts = _parts(
            disk, bus, feed, pki, announce, start_again, lambda what: _forget(forgettings, what)
        )
        side = _side(config, parts)
        hearing = bus.subscribe(f"{ROOT}/**", side.feed.offer)
        clock_server = ClockServer(steady, lambda: side.leads)
        closing.callback(bus.serve(clock_key("*"), clock_server.replies).close)

        def may_forget() -> bool:
            return side.may_forget() and not feed.late_waits

        backfill = Backfill(bus, feed.deliver, clock, may_forget)
        downlink = Downlink(bus, Stamper(STATION_ID, secrets.randbits(63), steady), steady)

        def report(held: Report) -> None:
            side.note_report()
            backfill.report(held, recorder.lost)

        expiry = ExpiryWatch(pki, clock)

        def save_soon() -> None:
            drive.save_soon()

        forgettings = disk.forgetting_desk(
            recordings,
            # A standby does what stands in the other's log.
            lambda by, action: drive.submit(by, action) if side.leads else None,
            save_soon,
            lambda: side.leads,
        )
        drive = _start_drive(
            disk.log,
            Surroundings(
                feed=side.feed,
                log=side.log,
                live=hub,
                projection=disk.projection,
                checkpoints=disk.checkpoints,
                photo_urls=disk.roster.photo_url,
                facts=_asked(
                    lambda: _facts(
                        config, recorder, feed, router, expiry, side, recordings, forgettings
                    ),
                    manager,
                ),
                clock=steady,
                boot_id=secrets.randbits(63),
                report=report,
                say=lambda orders: downlink.report(orders if side.leads else ()),
            ),
            side.begin,
            recovering(
                recorder.segments(),
                listening,
                config.http,
                lambda: early_console(config, disk),
                announce,
            ),
        )
        gate = side.gate_to(drive)
        beside = closing.enter_context(ExitStack())  # ends behind the drive: the other gets all
        closing.callback(drive.stop)
        closing.callback(hearing.close)  # first: what still comes is stepped before the end
        closing.enter_context(forgettings)
        for thread in (backfill, downlink):
            thread.start()
            closing.callback(thread.close)
        closing.callback(side.feed.close)
        services = _services(config, disk, hub, gate, side, recordings, forgettings)
        app = create_app(services, started=lambda loop: hub.connect(loop, drive))
        keep_house = _housekeeping(
            recorder, services, EnrolledUnits(pki, gate, disk.roster.registered_units), side
        )
        server = ConsoleServer(app, listening, config.http.certificate, config.http.private_key)
        side.start(gate, beside)
        asyncio.run(serve_until_stopped(server, _telling(announce, manager), keep_house))
        return again[0] if again else None


def _parts(
    disk: Disk,
    bus: ZenohBus,
    feed: LiveFeed,
    pki: PkiFolder,
    announce: Announce,
    start_again: Callable[[Place | None], None],
    forget: Callable[[str], None],
) -> Parts:
    """What a station has, however it stands to another one."""
    return Parts(
        data=disk.folder.path,
        bus=bus,
        log=disk.recorder,
        disk=disk.log,
        live=feed,
        clock=disk.clock,
        tables=KeptTables(disk.store),
        records=disk.records,
        pki=pki,
        on_people=disk.roster.read_again,
        on_lead=lambda: announce_first_login(disk.accounts, disk.folder.first_login, announce),
        start_again=start_again,
        forget=forget,
    )


def _services(
    config: StationConfig,
    disk: Disk,
    hub: Hub,
    gate: OperatorGate,
    side: Side,
    recordings: RecordingDesk,
    forgettings: ForgettingDesk,
) -> Services:
    return Services(
        accounts=disk.accounts,
        roster=disk.roster,
        records=disk.records,
        base_maps=BaseMaps(disk.store),
        hub=hub,
        gate=gate,
        settle=disk.projection.flush,
        replays=Replays(replay_starter(disk.archive, disk.roster, disk.clock)),
        forgettings=forgettings,
        clock=disk.clock,
        secure=config.http.certificate is not None,
        standing=side.standing,
        recordings=recordings,
        hindsight=disk.hindsight(),
        accountability=config.accountability,
    )


def _housekeeping(
    recorder: Recorder, services: Services, enrolled: EnrolledUnits, side: Side
) -> Callable[[], None]:
    records, hindsight = services.records, services.hindsight
    index = SegmentIndex(records, {one.path: str(one) for one in recorder.recoveries})

    def keep_house() -> None:
        index.update(recorder.segments())
        if side.leads:
            enrolled.update()
        if hindsight is not None:
            hindsight.catch_up(records.incidents(), records.tracks_of)

    return keep_house


def _start_drive(
    log: LogFeed,
    surroundings: Surroundings,
    begin: Callable[[tuple[int, int], StationState], None],
    recovery: AbstractContextManager[Watch],
) -> StationDrive:
    """A drive whose live state is what the log says; ``begin`` hears it before it runs."""
    saved = surroundings.checkpoints.latest()
    pipeline = new_pipeline(saved.pipeline if saved else None)
    drive = StationDrive(pipeline, surroundings)
    place = (saved.t_ns, saved.events_at_t) if saved else (0, 0)
    with recovery as watched:
        stepped = drive.rebuild(watched(log.records(place[0])), place)
    _log.info("live state from the log: %d events after the checkpoint", stepped)
    begin(drive.place, pipeline.state)
    drive.start()
    return drive


def _asked(
    facts: Callable[[], StationFacts], manager: ServiceManager
) -> Callable[[], StationFacts]:
    """The drive asks once a second, with a full disk and at a standby too; hanging, it does not."""

    def asked() -> StationFacts:
        manager.working()
        return facts()

    return asked


def _telling(announce: Announce, manager: ServiceManager) -> Announce:
    """What announces that consoles can connect, and tells the manager too."""

    def ready(line: str) -> None:
        announce(line)
        manager.ready()

    return ready


def _forget(desk: ForgettingDesk, what: str) -> None:
    """The other station has forgotten this, and of who it is this one's log tells, too."""
    kind, _, one = what.partition(" ")
    desk.add(BY_OTHER_STATION, kind, one, told=True)


def _side(config: StationConfig, parts: Parts) -> Side:
    return OneOfTwo(config.standby, parts) if config.standby.name else OnlyStation(parts)


def _set_aside(data: Path, place: Place, manager: ServiceManager) -> None:
    """What is queried must not know either of what is cut from the log."""
    folder = DataFolder(data)
    lock = folder.lock()
    try:
        set_aside(folder, place)
    finally:
        lock.close()
    rebuild(data, lambda _: manager.working())


def _facts(
    config: StationConfig,
    recorder: Recorder,
    feed: LiveFeed,
    router: RouterProcess,
    expiry: ExpiryWatch,
    side: Side,
    recordings: RecordingDesk,
    forgettings: ForgettingDesk,
) -> StationFacts:
    problems = [*config.standing_problems(), *expiry.problems(), *side.problems()]
    problems += forgettings.problems()
    if not router.is_open:
        problems.append("The bus's router is away and is started again; no unit is linked")
    if feed.overflowed:
        problems.append(f"{feed.overflowed} messages came faster than this machine can take them")
    return StationFacts(
        problems=tuple(problems),
        log_bytes=recorder.log_bytes,
        disk_free_bytes=recorder.disk_free_bytes,
        insecure=bool(config.plain_endpoints()),
        standby=None if side.standing is None else side.standing.view(),
        recordings=recordings.views(),
    )
