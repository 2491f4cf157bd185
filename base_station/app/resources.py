"""What a live station opens before anything runs: its folder, port, disk, router and bus."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from socket import socket

from base_station.api.hub import Hub
from base_station.api.server import bind
from base_station.app.disk import Disk, open_disk
from base_station.app.parts import Announce
from base_station.config import StationConfig, host_and_port
from base_station.feed import LiveFeed
from base_station.pki.expiry import ConsoleExpiry, ExpiryWatch
from base_station.pki.folder import PkiFolder
from base_station.pki.renewal import Renewal
from base_station.recordings.desk import RecordingDesk
from base_station.recordings.fetch import ask_over
from base_station.router.process import RouterProcess
from base_station.router.router import station_endpoint
from base_station.storage.data_folder import DataFolder
from base_station.storage.recorder import Recorder
from shared.bus import Bus
from shared.bus_zenoh import ZenohBus
from shared.clock import Clock, SystemClock
from shared.mcap_log import SegmentPolicy


@dataclass(frozen=True)
class Resources:
    """None of them knows what the station does with it."""

    config: StationConfig
    clock: Clock  # the machine's; the station's own is the disk's
    recorder: Recorder
    listening: socket
    disk: Disk
    feed: LiveFeed
    hub: Hub
    router: RouterProcess
    bus: Bus
    pki: PkiFolder
    expiry: ExpiryWatch
    console_expiry: ConsoleExpiry
    renewal: Renewal
    recordings: RecordingDesk


def open_station(config: StationConfig, announce: Announce, closing: ExitStack) -> Resources:
    """Raises MusterError, before anything is made where the settings cannot work."""
    joining, pki = station_endpoint(config.data, config.bus.listen), PkiFolder(config.data)
    if joining.tls is not None:
        pki.require_valid_station()
    clock = SystemClock()
    folder = DataFolder(config.data)
    recorder = Recorder(
        folder.path, clock, SegmentPolicy(config.log.segment_s, config.log.flush_every_s)
    )
    closing.callback(recorder.close)
    listening = closing.enter_context(bind(*host_and_port(config.http.listen)))
    alone = not config.standby.name
    disk = open_disk(folder, recorder, clock, announce, closing, alone=alone)
    router = RouterProcess(folder.path, config.bus.listen, config.standby.peer)
    closing.callback(router.close)
    bus = ZenohBus(joining)
    closing.callback(bus.close)
    recordings = RecordingDesk(ask_over(bus), folder.recordings, disk.clock)
    closing.enter_context(recordings)
    return Resources(
        config=config,
        clock=clock,
        recorder=recorder,
        listening=listening,
        disk=disk,
        feed=LiveFeed(disk.clock),
        hub=Hub(),
        router=router,
        bus=bus,
        pki=pki,
        expiry=ExpiryWatch(pki, clock),
        console_expiry=ConsoleExpiry(config.http.certificate, pki, clock),
        renewal=Renewal(pki, joining.tls, clock),
        recordings=recordings,
    )
