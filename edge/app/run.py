"""Commands that run an agent, or open its source: from the settings to a composed agent."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager
from threading import Event, Timer

from edge.app.composition import compose_agent
from edge.app.opened_sources import open_sources
from edge.app.zenoh_station import ZenohStation
from edge.config import EdgeConfig
from edge.identity import unit_connection
from edge.sample_codec.listener import RawStreamListener
from edge.sources.bus import BusSource
from edge.sources.gnss.registry import open_receiver
from edge.sources.interface import AuxiliarySource, Source
from edge.sources.power_supply import BatteryReader
from edge.sources.sighting_reader import SightingReader
from edge.sources.temperature.registry import open_temperature_reader
from edge.storage.data_folder import UnitDataFolder
from edge.wearer.registry import open_button
from shared.channels import NO_TRACKER, tracker_id
from shared.clock import SystemClock
from shared.errors import ConfigError
from shared.tls import TlsIdentity

logger = logging.getLogger(__name__)


def run_agent(config: EdgeConfig, stop: Event, *, for_s: float | None, paced: bool) -> None:
    """Run one agent until it is stopped, its source ends or ``for_s`` is over.

    Raises MusterError where the settings cannot work; nothing has been sent then.
    """
    member = unit_connection(config)
    station = ZenohStation(member)
    if member.identity is None:
        logger.warning("the link is not secured: anyone on this network can listen and forge")
    source = open_sources(config)
    if isinstance(source, BusSource):
        if config.tracker == NO_TRACKER:
            raise ConfigError(f"{config.source} is there to be tracked; choose a tracker")
        if any(_auxiliaries_set(config)):
            raise ConfigError(
                f"nothing is read beside {config.source}: sightings, gps, temperatures, battery, "
                "button and outputs are the unit's own"
            )
        listener = RawStreamListener(source.unit_id, station.open_listening_bus)
        with closing(listener):
            _track_for(config, source, listener, station, stop, for_s)
        return
    speed = config.speed if paced else None
    auxiliaries = open_auxiliaries(config)
    _run_once(
        config, member.unit_id, source, station, stop, for_s, speed, auxiliaries, member.identity
    )


def _auxiliaries_set(config: EdgeConfig) -> tuple[object, ...]:
    read = (config.sightings, config.gps, config.temperatures, config.battery, config.button)
    return (*read, config.outputs)


def open_auxiliaries(config: EdgeConfig) -> tuple[AuxiliarySource, ...]:
    """Open what is set to be read beside the source.  Raises ConfigError."""
    auxiliaries: list[AuxiliarySource] = []
    if config.sightings:
        auxiliaries.append(SightingReader(config.sightings, SystemClock()))
    if config.gps:
        auxiliaries.append(open_receiver(config.gps, SystemClock()))
    if config.battery:
        auxiliaries.append(BatteryReader(config.battery, SystemClock()))
    if config.temperatures:
        auxiliaries.append(open_temperature_reader(config.temperatures, SystemClock()))
    if config.button:
        auxiliaries.append(open_button(config.button, SystemClock()))
    return tuple(auxiliaries)


@contextmanager
def opened_source(config: EdgeConfig) -> Iterator[Source]:
    """Open the source that is set, ready to be read; wait for one on the bus until it sends."""
    source = open_sources(config)
    with ExitStack() as cleanup:
        cleanup.callback(source.close)
        if isinstance(source, BusSource):
            station = ZenohStation(unit_connection(config))
            listener = RawStreamListener(source.unit_id, station.open_listening_bus)
            cleanup.callback(listener.close)
            never = Event()
            listener.open(never)
            source.follow(listener, never)
        yield source


def _track_for(
    config: EdgeConfig,
    source: BusSource,
    listener: RawStreamListener,
    station: ZenohStation,
    stop: Event,
    for_s: float | None,
) -> None:
    """Run an agent for each boot of the unit: its path begins again, and so does everything
    here.
    """
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
    auxiliaries: tuple[AuxiliarySource, ...] = (),
    certificate: TlsIdentity | None = None,
) -> None:
    with ExitStack() as cleanup:
        cleanup.callback(source.close)
        folder = UnitDataFolder(config.data / unit_id)
        cleanup.callback(folder.close)
        agent = compose_agent(
            config, unit_id, folder, source, station, speed, auxiliaries, certificate
        )
        agent.run(stop, for_s=for_s)
