"""The composition root of the agent: the only place that chooses what it is made of."""

from __future__ import annotations

import importlib.metadata
import logging
import os
import secrets
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Timer

from edge.calibration import Calibration, identity
from edge.calibration.in_use import calibration_in_use
from edge.clocks.station import StationClock
from edge.clocks.timeline import Follower, Timekeeper
from edge.commands import CommandDesk
from edge.config import EdgeConfig
from edge.data_folder import DataFolder
from edge.journal.previous_boot import answers_before, mayday_before, position_rate_before
from edge.journal.server import JournalServer
from edge.journal.spool import Spool, open_spool
from edge.journal.writer import JournalWriter
from edge.link import Link, OtherEnd
from edge.membership import Membership, membership
from edge.outbox import Outbox
from edge.pipeline import TrackerPipeline, UnitIdentity
from edge.raw.listener import UnitListener
from edge.raw.stream import RawStream, sensor_of
from edge.raw.uplink import RawUplink
from edge.reachability_probe import ReachabilityProbe
from edge.receivers import open_receiver
from edge.recording.black_box import BlackBox
from edge.recording.server import RecordingServer
from edge.runtime import Agent, Parts
from edge.samples import SensorDescription
from edge.source_reader import SourceReader
from edge.sources import open_source
from edge.sources.bus import BusSource
from edge.sources.port import Beside, Source
from edge.sources.sighting_reader import SightingReader
from edge.tracker import make_tracker
from edge.tracker.none import NoTracker
from shared.bus import Bus
from shared.channels import NO_TRACKER, tracked_unit, tracker_id
from shared.clock import SystemClock
from shared.envelope import Stamper
from shared.errors import BusError, ConfigError
from shared.messages import EventKind, UnitDescription, UnitEvent
from shared.service_manager import ServiceManager

logger = logging.getLogger(__name__)

_PATIENCE_S = 2.0  # with a router that is not there; then it is tried again


def run_agent(config: EdgeConfig, stop: Event, *, for_s: float | None, paced: bool) -> None:
    """Run one agent until it is told to stop, its source ends or ``for_s`` is over.

    Raises MusterError where the settings cannot work; nothing has been sent then.
    """
    member = membership(config)
    station = ZenohStation(member)
    if member.identity is None:
        logger.warning("the link is not secured: anyone on this network can listen and forge")
    source = open_source(config.source)
    if isinstance(source, BusSource):
        if config.tracker == NO_TRACKER:
            raise ConfigError(f"{config.source} is there to be tracked; choose a tracker")
        if config.sightings or config.gps:
            raise ConfigError(
                f"nothing is read beside {config.source}: sightings and gps are the unit's own"
            )
        listener = UnitListener(source.unit_id, station.open_listening_bus)
        with closing(listener):
            _track_for(config, source, listener, station, stop, for_s)
        return
    speed = config.speed if paced else None
    beside = _beside(config)
    _run_once(config, member.unit_id, source, station, stop, for_s, speed, beside)


def _beside(config: EdgeConfig) -> tuple[Beside, ...]:
    beside: list[Beside] = []
    if config.sightings:
        beside.append(SightingReader(config.sightings, SystemClock()))
    if config.gps:
        beside.append(open_receiver(config.gps, SystemClock()))
    return tuple(beside)


@contextmanager
def opened_source(config: EdgeConfig) -> Iterator[Source]:
    """The source that is set, ready to be read; one on the bus is waited for until it speaks."""
    source = open_source(config.source)
    with ExitStack() as held:
        held.callback(source.close)
        if isinstance(source, BusSource):
            station = ZenohStation(membership(config))
            listener = UnitListener(source.unit_id, station.open_listening_bus)
            held.callback(listener.close)
            never = Event()
            listener.open(never)
            source.follow(listener, never)
        yield source


def _track_for(
    config: EdgeConfig,
    source: BusSource,
    listener: UnitListener,
    station: ZenohStation,
    stop: Event,
    for_s: float | None,
) -> None:
    """Each time the unit starts, its path begins anew, and so does everything here."""
    if for_s is not None:
        timer = Timer(for_s, stop.set)
        timer.daemon = True
        timer.start()
    if not listener.open(stop):
        return
    while source.follow(listener, stop):
        _run_once(config, tracker_id(source.unit_id), source, station, stop, None, None)
        if stop.is_set():
            return
        source = BusSource(source.unit_id)


def _run_once(
    config: EdgeConfig,
    unit_id: str,
    source: Source,
    station: ZenohStation,
    stop: Event,
    for_s: float | None,
    speed: float | None,
    beside: tuple[Beside, ...] = (),
) -> None:
    with ExitStack() as held:
        held.callback(source.close)
        folder = DataFolder(config.data / unit_id)
        held.callback(folder.close)
        agent = compose_agent(config, unit_id, folder, source, station, speed, beside)
        agent.run(stop, for_s=for_s)


def compose_agent(
    config: EdgeConfig,
    unit_id: str,
    folder: DataFolder,
    source: Source,
    station: OtherEnd,
    speed: float | None,
    beside: tuple[Beside, ...] = (),
) -> Agent:
    """The agent and its threads; ``speed`` None plays a recording without waiting."""
    clock = StationClock(SystemClock())
    with ExitStack() as in_trouble:
        spool, damaged = open_spool(
            folder.journal, _new_boot_id, clock.utc_ns(), round(config.storage.journal_mb * 1e6)
        )
        in_trouble.callback(spool.close)
        raw = RawStream(unit_id, spool.boot_id)
        stamper = Stamper(unit_id, spool.boot_id, clock, clock.utc_std_s)
        worn = tracked_unit(unit_id) or unit_id
        calibration = calibration_in_use(config, worn, source.description, folder.calibrations)
        description = _description(config, raw, source, calibration, clock)
        pipeline = _pipeline(config, sensor_of(description), calibration, stamper, spool, clock)
        black_box = BlackBox(
            folder.black_box,
            description,
            round(config.storage.black_box_mb * 1e6),
            clock,
            clock.utc_std_s,
        )
        in_trouble.callback(black_box.close)
        commands: SimpleQueue[bytes] = SimpleQueue()
        link = _link(unit_id, station, commands, spool, RecordingServer(unit_id, folder, clock))
        in_trouble.callback(link.close)
        journal = JournalWriter(spool)
        in_trouble.callback(journal.close)
        outbox = Outbox(unit_id, journal, link.publish)
        in_trouble.callback(outbox.close)
        for detail in _set_aside(folder, damaged):
            outbox.put((UnitEvent(stamper.header(), EventKind.STORAGE_FAULT, detail),))
        agent = Agent(
            Parts(
                source=source,
                reader=SourceReader(source, clock, speed, beside, _timekeeper(source)),
                raw=raw,
                pipeline=pipeline,
                desk=CommandDesk(
                    stamper,
                    pipeline.set_position_rate if config.tracker != NO_TRACKER else None,
                    answers_before(spool),
                ),
                stamper=stamper,
                clock=clock,
                black_box=black_box,
                spool=spool,
                journal=journal,
                outbox=outbox,
                link=link,
                commands=commands,
                manager=ServiceManager(os.environ),
            )
        )
        in_trouble.pop_all()  # the agent closes it at its end
    return agent


def _timekeeper(source: Source) -> Timekeeper | None:
    return Follower() if isinstance(source, BusSource) else None


def _set_aside(folder: DataFolder, damaged: Path | None) -> Iterator[str]:
    """What was found in the unit's folder and is of no use to it, in words for a person."""
    if damaged is not None:
        yield f"the journal was damaged and is set aside as {damaged.name}"
    if folder.set_aside is not None:
        yield (
            "the folder held the journal of another unit, as if copied; it is set aside as "
            f"{folder.set_aside.name}"
        )


def _description(
    config: EdgeConfig,
    raw: RawStream,
    source: Source,
    calibration: Calibration | None,
    clock: StationClock,
) -> UnitDescription:
    return raw.description(
        clock.monotonic_ns(),
        _as_set(source.description, config),
        source=config.source,
        tracker=config.tracker,
        calibration="" if calibration is None else identity(calibration),
    )


def _link(
    unit_id: str,
    station: OtherEnd,
    commands: SimpleQueue[bytes],
    spool: Spool,
    recordings: RecordingServer,
) -> Link:
    """Over which commands come, and the station asks for what it lacks."""
    servers = JournalServer(unit_id, spool), recordings
    return Link(
        unit_id,
        station,
        lambda _key, payload: commands.put(payload),
        [(server.key_expression, server.replies) for server in servers],
    )


def _pipeline(
    config: EdgeConfig,
    sensor: SensorDescription,
    calibration: Calibration | None,
    stamper: Stamper,
    spool: Spool,
    clock: StationClock,
) -> TrackerPipeline:
    if calibration is not None:
        sensor = calibration.described(sensor)
    tracks = config.tracker != NO_TRACKER
    return TrackerPipeline(
        UnitIdentity(_version(), config.source, config.tracker, sensor, calibration, config.place),
        make_tracker(config.tracker, sensor, (NO_TRACKER,)) if tracks else NoTracker(),
        stamper,
        position_rate_before(spool, clock.monotonic_ns()) or config.position_rate_hz,
        mayday=mayday_before(spool),
        raw_uplink=None if tracks else RawUplink(stamper),
    )


class ZenohStation:
    """The station as a unit reaches it over Zenoh, which is loaded when it is needed."""

    def __init__(self, member: Membership) -> None:
        self._member = member
        self._connect = member.connect  # which is tried first changes
        self._probe = ReachabilityProbe(member.connect)

    def open_bus(self) -> Bus:
        from shared.bus_zenoh import UnitEndpoint, ZenohBus  # noqa: PLC0415  # slow to load

        if len(self._member.connect) > 1:  # linked with one of the stations, else it hears double
            return self.open_listening_bus()
        return ZenohBus(UnitEndpoint(self._member.connect, self._member.identity))

    def open_listening_bus(self) -> Bus:
        """Linked with one router: hears other units, which an endpoint for speaking does not.

        While it opens, Zenoh tries the first router again and again, and no other.
        """
        from shared.bus_zenoh import ClientEndpoint, ZenohBus  # noqa: PLC0415  # slow to load

        try:
            return ZenohBus(ClientEndpoint(self._connect, self._member.identity, _PATIENCE_S))
        except BusError:
            self._connect = (*self._connect[1:], self._connect[0])
            raise

    def is_reachable(self, timeout_s: float) -> bool:
        return self._probe.wait(timeout_s)

    def why_no_link(self) -> str:
        from shared.link_diagnosis import why_no_link  # noqa: PLC0415  # slow to load

        return why_no_link(self._member.connect, self._member.identity, datetime.now(UTC))


def _as_set(sensor: SensorDescription, config: EdgeConfig) -> SensorDescription:
    """What the settings say of a sensor goes before what its source does."""
    return sensor if config.gain_std is None else replace(sensor, gain_std=config.gain_std)


def _new_boot_id() -> int:
    """Never 0, and within what SQLite calls an integer."""
    return secrets.randbits(63) or 1


def _version() -> str:
    try:
        return importlib.metadata.version("muster")
    except importlib.metadata.PackageNotFoundError:  # run from the sources, not installed
        return "unknown"
