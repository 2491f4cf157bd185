"""Resources of a live station that are opened before any part runs: folder, port, disk, router and
bus.
"""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from socket import socket
from subprocess import Popen

from base_station.api.hub import Hub
from base_station.api.server import bind
from base_station.app.console_presence import ConsolePresence
from base_station.app.exposed_secrets import ExposedSecrets
from base_station.app.factories import Announce
from base_station.app.station_presence import StationPresence
from base_station.app.station_storage import StationStorage, open_storage
from base_station.config import StationConfig, host_and_port
from base_station.engine.feed import LiveFeed
from base_station.security.pki.expiry import ConsoleExpiry, ExpiryWatch
from base_station.security.pki.folder import PkiFolder
from base_station.security.pki.renewal import Renewal
from base_station.security.router.process import RouterProcess
from base_station.security.router.router import station_endpoint
from base_station.storage.data_folder import DataFolder
from base_station.storage.recorder import Recorder
from base_station.unit_sync.recordings.transfer import ask_via_bus
from base_station.unit_sync.recordings.transfer_queue import TransferQueue
from shared.bus import Bus
from shared.bus_zenoh import ZenohBus
from shared.clock import Clock, SystemClock
from shared.mcap_log import SegmentPolicy


@dataclass(frozen=True)
class Resources:
    """Resources; none of them depends on the station."""

    config: StationConfig
    clock: Clock  # the machine's; the station's own is the disk's
    recorder: Recorder
    listening: socket
    disk: StationStorage
    feed: LiveFeed
    hub: Hub
    router: RouterProcess
    bus: Bus
    pki: PkiFolder
    expiry: ExpiryWatch
    console_expiry: ConsoleExpiry
    renewal: Renewal
    recordings: TransferQueue
    exposed: ExposedSecrets
    presence: StationPresence
    console_presence: ConsolePresence


def open_station(
    config: StationConfig,
    announce: Announce,
    closing: ExitStack,
    loading_router: Popen[str] | None = None,
) -> Resources:
    """Open the resources.  If the settings cannot work, raises MusterError before anything is
    created.
    """
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
    exposed = ExposedSecrets(folder, config.http.private_key, config.database_password_file)
    for sentence in exposed.problems():
        announce(sentence)
    alone = not config.standby.name
    # It opens while the disk is looked at.
    router = RouterProcess(folder.path, config.bus.listen, config.standby.peer, loading_router)
    try:
        disk = open_storage(
            folder, recorder, clock, announce, closing, config.database_server, alone=alone
        )
    finally:
        closing.callback(router.close)
    router.wait_open()
    bus = ZenohBus(router.endpoint)
    closing.callback(bus.close)
    recordings = TransferQueue(ask_via_bus(bus), folder.recordings, disk.clock)
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
        exposed=exposed,
        presence=closing.enter_context(StationPresence(pki, config)),
        console_presence=closing.enter_context(ConsolePresence(config.http)),
    )
