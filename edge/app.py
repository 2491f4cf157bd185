"""The composition root of the agent: the only place that chooses what it is made of."""

from __future__ import annotations

import importlib.metadata
import re
import secrets
from collections.abc import Callable
from contextlib import ExitStack
from queue import SimpleQueue
from threading import Event

from edge.black_box import BlackBox
from edge.commands import CommandDesk
from edge.config import EdgeConfig
from edge.data_folder import DataFolder
from edge.journal_server import JournalServer
from edge.link import Link
from edge.outbox import Outbox
from edge.pipeline import TrackerPipeline, UnitIdentity
from edge.raw_stream import RawStream, sensor_of
from edge.runtime import Agent, Parts
from edge.source_reader import SourceReader
from edge.sources import open_source
from edge.sources.port import Source
from edge.spool import open_spool
from edge.tracker import make_tracker
from shared.bus import Bus
from shared.channels import validate_unit_id
from shared.clock import SystemClock
from shared.envelope import Stamper
from shared.errors import ConfigError
from shared.messages import EventKind, UnitEvent

_ENDPOINT = re.compile(r"tcp/(\[[0-9A-Fa-f:.]+\]|[^\s/:]+):([0-9]{1,5})")


def run_agent(config: EdgeConfig, stop: Event, *, for_s: float | None, paced: bool) -> None:
    """Run one agent until it is told to stop, its source ends or ``for_s`` is over.

    Raises MusterError where the settings cannot work; nothing has been sent then.
    """
    validate_unit_id(config.unit)
    open_bus = _bus_opener(config.connect)
    source = open_source(config.source)
    with ExitStack() as held:
        held.callback(source.close)
        folder = DataFolder(config.data / config.unit)
        held.callback(folder.close)
        agent = compose_agent(
            config, folder, source, open_bus, speed=config.speed if paced else None
        )
        agent.run(stop, for_s=for_s)


def compose_agent(
    config: EdgeConfig,
    folder: DataFolder,
    source: Source,
    open_bus: Callable[[], Bus],
    speed: float | None,
) -> Agent:
    """The agent and its threads; ``speed`` None plays a recording without waiting."""
    clock = SystemClock()
    spool, damaged = open_spool(
        folder.journal, _new_boot_id, clock.utc_ns(), round(config.storage.journal_mb * 1e6)
    )
    raw = RawStream(config.unit, spool.boot_id)
    stamper = Stamper(config.unit, spool.boot_id, clock)
    description = raw.description(
        clock.monotonic_ns(), source.description, source=config.source, tracker=config.tracker
    )
    sensor = sensor_of(description)
    pipeline = TrackerPipeline(
        UnitIdentity(_version(), config.source, config.tracker, sensor),
        make_tracker(config.tracker, sensor),
        stamper,
        config.position_rate_hz,
    )
    commands: SimpleQueue[bytes] = SimpleQueue()
    server = JournalServer(config.unit, spool)
    link = Link(
        config.unit,
        ", ".join(config.connect),
        open_bus,
        lambda _key, payload: commands.put(payload),
        (server.key_expression, server.replies),
    )
    outbox = Outbox(config.unit, spool, link.publish)
    if damaged is not None:
        detail = f"the journal was damaged and is set aside as {damaged.name}"
        outbox.put((UnitEvent(stamper.header(), EventKind.STORAGE_FAULT, detail),))
    return Agent(
        Parts(
            source=source,
            reader=SourceReader(source, clock, speed),
            raw=raw,
            pipeline=pipeline,
            desk=CommandDesk(stamper, pipeline.set_position_rate),
            stamper=stamper,
            clock=clock,
            black_box=BlackBox(
                folder.black_box, description, round(config.storage.black_box_mb * 1e6), clock
            ),
            spool=spool,
            outbox=outbox,
            link=link,
            commands=commands,
        )
    )


def _bus_opener(endpoints: tuple[str, ...]) -> Callable[[], Bus]:
    """Checks the endpoints now; what it returns imports Zenoh when the link is opened."""
    if not endpoints:
        raise ConfigError("connect names no station; write for example tcp/127.0.0.1:7447")
    for endpoint in endpoints:
        parts = _ENDPOINT.fullmatch(endpoint)
        if parts is None or not 0 < int(parts[2]) < 65536:
            raise ConfigError(
                f"{endpoint!r} is no place to connect to; write tcp/HOST:PORT, for example "
                "tcp/127.0.0.1:7447"
            )

    def open_bus() -> Bus:
        from shared.bus_zenoh import UnitEndpoint, ZenohBus  # noqa: PLC0415  # slow to load

        return ZenohBus(UnitEndpoint(endpoints))

    return open_bus


def _new_boot_id() -> int:
    """Never 0, and within what SQLite calls an integer."""
    return secrets.randbits(63) or 1


def _version() -> str:
    try:
        return importlib.metadata.version("muster")
    except importlib.metadata.PackageNotFoundError:  # run from the sources, not installed
        return "unknown"
