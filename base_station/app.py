"""The composition root: puts a station together from its parts, runs it, and takes it apart."""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import msgspec

from base_station import collector
from base_station.alarms import ALARMS
from base_station.api.app import create_app
from base_station.api.hub import Hub
from base_station.api.replays import Replays, StartReplay
from base_station.api.services import Services
from base_station.backfill import Backfill, Report
from base_station.checkpoints import Checkpoints
from base_station.clock_server import ClockServer
from base_station.config import StationConfig, host_and_port
from base_station.data_folder import DataFolder
from base_station.db.accounts import Accounts
from base_station.db.kept import KeptTables
from base_station.db.models import Incident
from base_station.db.projecting import project_into
from base_station.db.projection import SqlProjection
from base_station.db.records import Records
from base_station.db.roster import Roster
from base_station.db.smoothed import SmoothedTracks
from base_station.db.store import Store, copy_database
from base_station.downlink import Downlink
from base_station.drive import StationDrive
from base_station.feed import LiveFeed, LogFeed, SteadyClock
from base_station.first_login import USERNAME, ensure_administrator
from base_station.forgetting import ClosedLog, Forgetter, Forgotten
from base_station.fusion import FUSERS
from base_station.fusion.smoother import SMOOTHERS
from base_station.hindsight import Hindsight
from base_station.live_state import StationState
from base_station.pipeline import Checkpoint, StationPipeline
from base_station.pki.expiry import ExpiryWatch
from base_station.pki.folder import PkiFolder
from base_station.pki.members import EnrolledUnits
from base_station.playback import Archive
from base_station.read_only import ReadOnlyGate
from base_station.rebuild import project_log
from base_station.recorder import Recorder
from base_station.recordings.desk import RecordingDesk
from base_station.recordings.fetch import ask_over
from base_station.recovering import Watch, recovering
from base_station.replay import ReplaySession, Window
from base_station.router import station_endpoint
from base_station.router_process import RouterProcess
from base_station.segment_index import SegmentIndex
from base_station.server import ConsoleServer, bind, serve_until_stopped
from base_station.sinks import Projection
from base_station.standby.places import Place
from base_station.standby.setting_aside import set_aside
from base_station.standby.side import OneOfTwo, OnlyStation, Parts, Side
from base_station.surroundings import Surroundings
from base_station.views import StationFacts
from shared.bus_zenoh import ZenohBus
from shared.channels import ROOT, clock_key
from shared.clock import Clock, SystemClock
from shared.envelope import Stamper
from shared.errors import StoreError, UserError
from shared.mcap_log import SegmentPolicy, SegmentReader, recover_log, segment_paths
from shared.messages import STATION_ID

Announce = Callable[[str], None]
_BY_COMMAND = "muster base forget"  # in the audit
_BY_OTHER_STATION = "the other station"
_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class LookBack:
    """What commands about a past incident work with."""

    hindsight: Hindsight
    records: Records
    incident: Incident


class _Again(NamedTuple):
    """The station is to start anew, as the standby of another one."""

    cut: Place | None  # behind which the log goes its own way


def run_station(config: StationConfig, announce: Announce) -> None:
    """The live station, until SIGINT or SIGTERM.  ``announce`` hears what a person must know."""
    collector.relax()
    while (again := _run_once(config, announce)) is not None:
        if again.cut is not None:
            announce("what the other station does not have is set aside, and handed to it")
            _set_aside(config.data, again.cut)


def _run_once(config: StationConfig, announce: Announce) -> _Again | None:
    joining = station_endpoint(config.data, config.bus.listen)  # refuses before anything is made
    clock = SystemClock()
    with ExitStack() as closing:
        folder = DataFolder(config.data)
        recorder = Recorder(
            folder.path, clock, SegmentPolicy(config.log.segment_s, config.log.flush_every_s)
        )
        closing.callback(recorder.close)
        listening = closing.enter_context(bind(*host_and_port(config.http.listen)))
        store = _open_store(folder, recorder, announce, closing)
        accounts, records = Accounts(store, clock), Records(store, clock)
        roster, hub = Roster(store, clock), Hub()
        projection = SqlProjection(store)
        closing.callback(projection.close)
        steady = SteadyClock(clock, max((one.end_ns for one in recorder.segments()), default=0))
        feed = LiveFeed(steady)
        router = RouterProcess(folder.path, config.bus.listen, config.standby.peer)
        closing.callback(router.close)
        bus = ZenohBus(joining)
        closing.callback(bus.close)
        again: list[_Again] = []

        def start_again(cut: Place | None) -> None:
            again.append(_Again(cut))
            server.stop()

        pki = PkiFolder(folder.path)
        side = _side(
            config,
            Parts(
                data=folder.path,
                bus=bus,
                log=recorder,
                disk=LogFeed(folder.log, recorder.flush),
                live=feed,
                clock=steady,
                tables=KeptTables(store),
                records=records,
                pki=pki,
                on_people=roster.read_again,
                on_lead=lambda: _announce_first_login(accounts, folder.first_login, announce),
                start_again=start_again,
                forget=lambda what: _forget_too(
                    Forgetter(recorder, store, checkpoints, records, steady), what
                ),
            ),
        )
        hearing = bus.subscribe(f"{ROOT}/**", side.feed.offer)
        recordings = _beside_messages(bus, folder, steady, side, closing)
        backfill = Backfill(bus, feed.deliver, clock, side.may_forget)
        downlink = Downlink(bus, Stamper(STATION_ID, secrets.randbits(63), steady), steady)

        def report(held: Report) -> None:
            side.note_report()
            backfill.report(held)

        checkpoints = Checkpoints(folder.checkpoints)
        expiry = ExpiryWatch(pki, clock)
        drive = _start_drive(
            LogFeed(folder.log, recorder.flush),
            Surroundings(
                feed=side.feed,
                log=side.log,
                live=hub,
                projection=projection,
                checkpoints=checkpoints,
                photo_urls=roster.photo_url,
                facts=lambda: msgspec.structs.replace(
                    _facts(config, recorder, feed, router, expiry, side),
                    recordings=recordings.views(),
                ),
                clock=steady,
                boot_id=secrets.randbits(63),
                report=report,
                say=lambda orders: downlink.report(orders if side.leads else ()),
            ),
            side.begin,
            recovering(recorder.segments(), listening, config.http, announce),
        )
        gate = side.gate_to(drive)
        beside = closing.enter_context(ExitStack())  # ends behind the drive: the other gets all
        closing.callback(drive.stop)
        closing.callback(hearing.close)  # first: what still comes is stepped before the end
        backfill.start()
        closing.callback(backfill.close)
        downlink.start()
        closing.callback(downlink.close)
        closing.callback(side.feed.close)
        archive = Archive(LogFeed(folder.log, recorder.flush).records, checkpoints, _pipeline)
        services = Services(
            accounts=accounts,
            roster=roster,
            records=records,
            hub=hub,
            gate=gate,
            settle=projection.flush,
            replays=Replays(_replay_starter(archive, roster, steady)),
            forgetter=Forgetter(recorder, store, checkpoints, records, steady, drive.submit),
            clock=steady,
            secure=config.http.certificate is not None,
            standing=side.standing,
            recordings=recordings,
            hindsight=Hindsight(archive, SMOOTHERS[0], SmoothedTracks(store), steady),
            accountability=config.accountability,
        )
        app = create_app(services, started=lambda loop: hub.connect(loop, drive))
        keep_house = _housekeeping(
            recorder, services, EnrolledUnits(pki, gate, roster.registered_units), side
        )
        server = ConsoleServer(app, listening, config.http.certificate, config.http.private_key)
        side.start(gate, beside)
        asyncio.run(serve_until_stopped(server, announce, keep_house))
        return again[0] if again else None


def run_replay_station(
    config: StationConfig, incident_id: str, speed: float, announce: Announce
) -> None:
    """A station that shows one past incident, and writes nothing to the folder.

    A live station may be running on it: the database is copied first.
    """
    clock = SystemClock()
    folder = DataFolder(config.data)
    folder.require()
    with ExitStack() as closing:
        scratch = Path(closing.enter_context(TemporaryDirectory(prefix="muster-replay-")))
        listening = closing.enter_context(bind(*host_and_port(config.http.listen)))
        copy_database(folder.database, scratch / "station.sqlite")
        store = closing.enter_context(Store(scratch / "station.sqlite"))
        accounts, records = Accounts(store, clock), Records(store, clock)
        roster, hub = Roster(store, clock), Hub()
        if not records.incidents():
            announce("the folder has no database; it is made from the log for this replay")
            _project_log(store, folder.log, lambda _: None)
        incident = _incident_or_refuse(records, incident_id)
        _announce_first_login(accounts, scratch / "first-login.txt", announce)

        saved = folder.checkpoints if folder.checkpoints.is_dir() else scratch / "checkpoints"
        archive = Archive(LogFeed(folder.log).records, Checkpoints(saved), _pipeline)
        replays = Replays(_replay_starter(archive, roster, clock))
        services = Services(
            accounts=accounts,
            roster=roster,
            records=records,
            hub=hub,
            gate=ReadOnlyGate(),
            settle=lambda: None,
            replays=replays,
            forgetter=None,
            clock=clock,
            secure=config.http.certificate is not None,
            hindsight=Hindsight(archive, SMOOTHERS[0], SmoothedTracks(store), clock),
        )
        app = create_app(
            services, started=lambda loop: _ignore(replays.open(incident, speed, loop, hub))
        )
        server = ConsoleServer(app, listening, config.http.certificate, config.http.private_key)
        asyncio.run(serve_until_stopped(server, announce))


def rebuild(data: Path, on_progress: Callable[[float], None]) -> int:
    """Make the projections of a folder again; no station may be running on it.

    ``on_progress`` hears the fraction done.  Gives the number of log records.
    """
    folder = DataFolder(data)
    folder.require()
    lock = folder.lock()
    try:
        with Store(folder.database) as store:
            Records(store, SystemClock()).forget_projections()
            return _project_log(store, folder.log, on_progress)
    finally:
        lock.close()


def forget(
    data: Path, what: str, confirm: Callable[[str], None], on_progress: Callable[[float], None]
) -> Forgotten:
    """Forget a person (id or name) or an incident (id) in a folder that no station runs on.

    ``confirm`` gets what it will be about and may raise.
    """
    folder = DataFolder(data)
    folder.require()
    lock = folder.lock()
    try:
        recover_log(folder.log)
        with Store(folder.database) as store:
            clock = SystemClock()
            records, roster = Records(store, clock), Roster(store, clock)
            forgetter = Forgetter(
                ClosedLog(folder.log), store, Checkpoints(folder.checkpoints), records, clock
            )
            incident = records.incident(what)
            if incident is not None:
                confirm(f"incident {incident.name!r} of {what}")
                return forgetter.incident(_BY_COMMAND, what, on_progress)
            named = [one.person_id for one in roster.people() if what in (one.name, one.person_id)]
            if len(named) > 1:
                raise UserError(f"{len(named)} people are called {what}: give one of {named}")
            person_id = named[0] if named else what
            confirm(f"person {what}")
            return forgetter.person(_BY_COMMAND, person_id, on_progress)
    finally:
        lock.close()


def look_back(data: Path, incident_id: str, closing: ExitStack) -> LookBack:
    """A past incident, beside a running station or without one."""
    folder = DataFolder(data)
    folder.require()
    store = closing.enter_context(Store(folder.database))
    clock = SystemClock()
    records = Records(store, clock)
    incident = _incident_or_refuse(records, incident_id)
    archive = Archive(LogFeed(folder.log).records, Checkpoints(folder.checkpoints), _pipeline)
    hindsight = Hindsight(archive, SMOOTHERS[0], SmoothedTracks(store), clock)
    return LookBack(hindsight, records, incident)


def open_accounts(data: Path, closing: ExitStack) -> Accounts:
    """The accounts of a folder's database, beside a running station or without one."""
    database = DataFolder(data).database
    if not database.exists():
        raise StoreError(
            f"there is no station's database in {data}; give the folder with --data, or start the "
            "station there once"
        )
    store = closing.enter_context(Store(database))
    return Accounts(store, SystemClock())


def _open_store(
    folder: DataFolder, recorder: Recorder, announce: Announce, closing: ExitStack
) -> Store:
    is_new = not folder.database.exists()
    store = closing.enter_context(Store(folder.database))
    if is_new and recorder.segments():
        announce("the database is new; it is made again from the log")
        _project_log(store, folder.log, lambda _: None)
    return store


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
            hindsight.catch_up(records.incidents())

    return keep_house


def _start_drive(
    log: LogFeed,
    surroundings: Surroundings,
    begin: Callable[[tuple[int, int], StationState], None],
    recovery: AbstractContextManager[Watch],
) -> StationDrive:
    """A drive whose live state is what the log says; ``begin`` hears it before it runs."""
    saved = surroundings.checkpoints.latest()
    pipeline = _pipeline(saved.pipeline if saved else None)
    drive = StationDrive(pipeline, surroundings)
    place = (saved.t_ns, saved.events_at_t) if saved else (0, 0)
    with recovery as watched:
        stepped = drive.rebuild(watched(log.records(place[0])), place)
    _log.info("live state from the log: %d events after the checkpoint", stepped)
    begin(drive.place, pipeline.state)
    drive.start()
    return drive


def _forget_too(forgetter: Forgetter, what: str) -> None:
    """The active station has forgotten this, and its log is this one's.  What is to go from memory
    comes as actions of that log.
    """
    kind, _, one = what.partition(" ")
    try:
        (forgetter.person if kind == "person" else forgetter.incident)(_BY_OTHER_STATION, one)
    except UserError as error:
        _log.info("nothing to forget here: %s", error)


def _side(config: StationConfig, parts: Parts) -> Side:
    return OneOfTwo(config.standby, parts) if config.standby.name else OnlyStation(parts)


def _set_aside(data: Path, place: Place) -> None:
    """What is queried must not know either of what is cut from the log."""
    folder = DataFolder(data)
    lock = folder.lock()
    try:
        set_aside(folder, place)
    finally:
        lock.close()
    rebuild(data, _ignore)


def _pipeline(checkpoint: Checkpoint | None) -> StationPipeline:
    return StationPipeline(ALARMS, FUSERS[0], checkpoint)


def _replay_starter(archive: Archive, roster: Roster, clock: Clock) -> StartReplay:
    def start(incident: Incident, speed: float, hub: Hub) -> ReplaySession:
        end_ns = incident.closed_ns or clock.utc_ns()
        window = Window(incident.incident_id, incident.opened_ns, end_ns)
        return ReplaySession(archive, window, speed, hub, roster.photo_url, clock)

    return start


def _beside_messages(
    bus: ZenohBus, folder: DataFolder, clock: Clock, side: Side, closing: ExitStack
) -> RecordingDesk:
    """What units ask for, and are asked for, beside their messages and journals."""
    clock_server = ClockServer(clock, lambda: side.leads)
    closing.callback(bus.serve(clock_key("*"), clock_server.replies).close)
    return closing.enter_context(RecordingDesk(ask_over(bus), folder.recordings, clock))


def _facts(
    config: StationConfig,
    recorder: Recorder,
    feed: LiveFeed,
    router: RouterProcess,
    expiry: ExpiryWatch,
    side: Side,
) -> StationFacts:
    problems = [*config.standing_problems(), *expiry.problems(), *side.problems()]
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
    )


def _announce_first_login(accounts: Accounts, note: Path, announce: Announce) -> None:
    password = ensure_administrator(accounts, note)
    if password is not None:
        announce(f"first login: {USERNAME}  password: {password}  (also in {note})")


def _incident_or_refuse(records: Records, incident_id: str) -> Incident:
    incident = records.incident(incident_id)
    if incident is None:
        known = ", ".join(f"{one.incident_id} ({one.name})" for one in records.incidents())
        raise UserError(f"there is no incident {incident_id}; known are: {known or 'none'}")
    return incident


def _project_log(store: Store, log: Path, on_progress: Callable[[float], None]) -> int:
    segments = []
    for path in segment_paths(log):
        with SegmentReader(path) as reader:
            segments.append(reader.info())
    start_ns = min((one.start_ns for one in segments if one.messages), default=0)
    span_ns = max(max((one.end_ns for one in segments), default=0) - start_ns, 1)

    def write(projection: Projection) -> None:
        with store.write() as session:
            project_into(session, (projection,))

    count = project_log(
        LogFeed(log).records(),
        _pipeline(None),
        write,
        lambda t_ns: on_progress(min(max((t_ns - start_ns) / span_ns, 0.0), 1.0)),
    )
    SegmentIndex(Records(store, SystemClock()), {}).update(segments)
    return count


def _ignore(_: object) -> None:
    return None
