"""Composition root of the agent: the only place that chooses what it is made of."""

from __future__ import annotations

import importlib.metadata
import os
import secrets
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from datetime import UTC, datetime
from pathlib import Path
from queue import SimpleQueue

from edge.agent.agent_parts import AgentParts
from edge.agent.command_handler import CommandHandler
from edge.agent.fitted_sensor import FittedSensor
from edge.agent.link import Link, StationConnector
from edge.agent.mayday_latch import MaydayLatch
from edge.agent.mayday_progress import MaydayProgress
from edge.agent.open_commands import OpenCommands
from edge.agent.outbox import Outbox
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.agent.restore_state import answers_before, mayday_before, position_rate_before
from edge.agent.runtime import Agent
from edge.agent.source_reader import SourceReader
from edge.agent.step_scale_keeper import StepScaleKeeper
from edge.agent.wearer_notifier import WearerNotifier
from edge.app.fitted_sensors import fitted_sensors
from edge.app.opened_sources import provided_quantities
from edge.app.tracking import Tracking, tracking_of
from edge.clocks.station import StationClock
from edge.clocks.timeline import Follower, Timekeeper
from edge.config import EdgeConfig
from edge.notifiers.outputs import Outputs
from edge.preflight.finding import CheckFinding
from edge.preflight.installation import (
    calibration_finding,
    certificate_finding,
    storage_findings,
)
from edge.preflight.start_check import StartCheck
from edge.sample_codec.codec import SampleEncoder
from edge.sample_codec.uplink import RawUplink
from edge.sources.bus import BusSource
from edge.sources.interface import AuxiliarySource, Source
from edge.storage.black_box.black_box import BlackBox
from edge.storage.black_box.server import RecordingServer
from edge.storage.data_folder import UnitDataFolder
from edge.storage.journal.journal import Journal, open_journal
from edge.storage.journal.server import JournalServer
from edge.storage.journal.writer import JournalWriter
from edge.storage.step_scales import StepScales
from shared.channels import NO_TRACKER, tracked_unit
from shared.clock import SystemClock
from shared.coded_text import coded
from shared.header_factory import HeaderFactory
from shared.messages import EventKind, UnitDescription, UnitEvent
from shared.service_manager import ServiceManager
from shared.tls import TlsIdentity


def compose_agent(
    config: EdgeConfig,
    unit_id: str,
    folder: UnitDataFolder,
    source: Source,
    station: StationConnector,
    speed: float | None,
    auxiliaries: tuple[AuxiliarySource, ...] = (),
    certificate: TlsIdentity | None = None,
) -> Agent:
    """Build the agent and its threads; ``speed`` None plays a recording without waiting."""
    clock = StationClock(SystemClock())
    with ExitStack() as on_error:
        outputs = Outputs(config.outputs)
        on_error.callback(outputs.close)
        journal, damaged = _open_journal(config, folder, clock)
        on_error.callback(journal.close)
        raw = SampleEncoder(unit_id, journal.boot_id)
        header_factory = HeaderFactory(unit_id, journal.boot_id, clock, clock.utc_std_s)
        worn = tracked_unit(unit_id) or unit_id
        sensors = fitted_sensors(config, source, worn, folder.calibrations)
        steps = StepScaleKeeper(StepScales(folder.step_scales, config.wearer.person))
        on_error.callback(steps.close)
        tracking = tracking_of(config, sensors, steps.start_scales)
        description = _described(config, raw, sensors, tracking, clock)
        latch = MaydayLatch(folder.mayday, clock)
        on_error.callback(latch.close)
        pipeline = _pipeline(
            config,
            tracking,
            sensors,
            header_factory,
            journal,
            latch,
            outputs,
            clock,
        )
        latch.set(is_active=pipeline.is_mayday_active)
        black_box = _black_box(config, folder, description, clock)
        on_error.callback(black_box.close)
        commands: SimpleQueue[bytes] = SimpleQueue()
        link = _link(unit_id, station, commands, journal, RecordingServer(unit_id, folder, clock))
        on_error.callback(link.close)
        journal_writer = JournalWriter(journal)
        on_error.callback(journal_writer.close)
        outbox = Outbox(unit_id, journal_writer, link.publish)
        on_error.callback(outbox.close)
        open_commands = OpenCommands(folder.open_commands)
        on_error.callback(open_commands.close)
        maydays = MaydayProgress()
        handler = _command_handler(config, header_factory, pipeline, journal, maydays, outputs)
        _report_quarantine(outbox, header_factory, folder, damaged)
        wearer = WearerNotifier(
            outputs, open_commands, handler, maydays, pipeline, link, journal, clock
        )
        agent = Agent(
            AgentParts(
                source=source,
                reader=SourceReader(source, clock, speed, auxiliaries, _timekeepers(source)),
                raw=raw,
                pipeline=pipeline,
                wearer=wearer,
                header_factory=header_factory,
                clock=clock,
                black_box=black_box,
                journal=journal,
                journal_writer=journal_writer,
                mayday_latch=latch,
                steps=steps,
                outbox=outbox,
                link=link,
                commands=commands,
                manager=ServiceManager(os.environ),
                start_check=_start_check(config, folder, source, speed, sensors, certificate),
            )
        )
        on_error.pop_all()  # the agent closes it at its end
    return agent


def _start_check(
    config: EdgeConfig,
    folder: UnitDataFolder,
    source: Source,
    speed: float | None,
    sensors: tuple[FittedSensor, ...],
    certificate: TlsIdentity | None,
) -> StartCheck | None:
    """Build the check at the start, for a unit with live sensors."""
    if speed is None or isinstance(source, BusSource):
        return None

    def installation() -> Iterator[CheckFinding]:
        now = datetime.now(UTC)
        yield certificate_finding(certificate, now)
        for one in sensors:
            yield calibration_finding(one.calibration, now, one.name)
        yield from storage_findings(folder, config.storage)

    described = {one.name: one.description for one in sensors}
    return StartCheck(config, described, provided_quantities(config), installation)


def _timekeepers(source: Source) -> Callable[[], Timekeeper] | None:
    return Follower if isinstance(source, BusSource) else None


def _open_journal(
    config: EdgeConfig, folder: UnitDataFolder, clock: StationClock
) -> tuple[Journal, Path | None]:
    """Open the journal; the second is the file of a damaged one that was set aside."""
    size_bytes = round(config.storage.journal_mb * 1e6)
    return open_journal(folder.journal, _new_boot_id, clock.utc_ns(), size_bytes)


def _described(
    config: EdgeConfig,
    raw: SampleEncoder,
    sensors: tuple[FittedSensor, ...],
    tracking: Tracking,
    clock: StationClock,
) -> UnitDescription:
    return raw.description(
        clock.monotonic_ns(),
        [one.as_sent() for one in sensors],
        source=config.source_text,
        tracker=tracking.name,
    )


def _command_handler(
    config: EdgeConfig,
    header_factory: HeaderFactory,
    pipeline: TrackerPipeline,
    journal: Journal,
    maydays: MaydayProgress,
    outputs: Outputs,
) -> CommandHandler:
    return CommandHandler(
        header_factory,
        pipeline.set_position_rate if config.tracker != NO_TRACKER else None,
        answers_before(journal),
        maydays,
        has_outputs=bool(outputs.kinds),
    )


def _black_box(
    config: EdgeConfig, folder: UnitDataFolder, description: UnitDescription, clock: StationClock
) -> BlackBox:
    size_bytes = round(config.storage.black_box_mb * 1e6)
    return BlackBox(folder.black_box, description, size_bytes, clock, clock.utc_std_s)


def _report_quarantine(
    outbox: Outbox, header_factory: HeaderFactory, folder: UnitDataFolder, damaged: Path | None
) -> None:
    for detail in _quarantine_reports(folder, damaged):
        outbox.put((UnitEvent.of(header_factory.header(), EventKind.STORAGE_FAULT, detail),))


def _quarantine_reports(folder: UnitDataFolder, damaged: Path | None) -> Iterator[str]:
    """Yield reports for a person of what was found in the unit's folder and cannot be used."""
    if damaged is not None:
        yield coded(
            "journal-set-aside",
            "the journal was damaged and is set aside as {file}",
            file=damaged.name,
        )
    if folder.quarantine is not None:
        yield coded(
            "journal-of-other-unit",
            "the folder held the journal of another unit, as if copied; it is set aside as {file}",
            file=folder.quarantine.name,
        )


def _link(
    unit_id: str,
    station: StationConnector,
    commands: SimpleQueue[bytes],
    journal: Journal,
    recordings: RecordingServer,
) -> Link:
    """Build the link over which commands come and the station fetches what it lacks."""
    servers = JournalServer(unit_id, journal), recordings
    return Link(
        unit_id,
        station,
        lambda _key, payload: commands.put(payload),
        [(server.key_expression, server.replies) for server in servers],
    )


def _pipeline(
    config: EdgeConfig,
    tracking: Tracking,
    sensors: tuple[FittedSensor, ...],
    header_factory: HeaderFactory,
    journal: Journal,
    latch: MaydayLatch,
    outputs: Outputs,
    clock: StationClock,
) -> TrackerPipeline:
    return TrackerPipeline(
        UnitIdentity(
            _version(),
            config.source_text,
            tracking.name,
            sensors,
            outputs=outputs.kinds,
            place=config.place,
        ),
        tracking.tracker,
        header_factory,
        position_rate_before(journal, clock.monotonic_ns()) or config.position_rate_hz,
        mayday=latch.was_active or mayday_before(journal),
        raw_uplink=RawUplink(header_factory) if config.tracker == NO_TRACKER else None,
        foot_sensor=tracking.foot_sensor,
        worn_on=tracking.worn_on,
        notes=tracking.notes,
    )


def _new_boot_id() -> int:
    """Return a random id, never 0, within what SQLite calls an integer."""
    return secrets.randbits(63) or 1


def _version() -> str:
    try:
        return importlib.metadata.version("muster")
    except importlib.metadata.PackageNotFoundError:  # run from the sources, not installed
        return "unknown"
