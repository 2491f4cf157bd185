"""Station with an authority of its own and one enrolled unit, as far as a unit sees it."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

from base_station.security.pki.access import access_control
from base_station.security.pki.folder import PkiFolder
from base_station.unit_sync.clock_server import ClockServer
from shared.bus_zenoh import ClientEndpoint, StationEndpoint, ZenohBus
from shared.channels import HEARTBEAT, IMU, POSITION, alive_key, clock_key
from shared.clock import SystemClock
from shared.codec import decode


class EnrolledSite:
    """A station with an authority of its own; u1 is enrolled."""

    def __init__(self, folder: Path, stack: ExitStack, port: int) -> None:
        address = f"tls/127.0.0.1:{port}"
        self.pki = PkiFolder(folder)
        self.pki.create("Test", hosts=[], connect=[address])
        self.enrolment = folder / "u1.toml"
        self.pki.enroll("u1").write(self.enrolment)
        self._address = address
        self._stack = stack
        self.positions: list[str] = []
        self.boot_ids: set[int] = set()
        self.alive: list[bool] = []
        self.utc_std_s = 0.0

    def _note(self, key: str, payload: bytes) -> None:
        self.positions.append(key)
        self.boot_ids.add(decode(POSITION, payload).header.boot_id)

    def _note_heartbeat(self, _: str, payload: bytes) -> None:
        self.utc_std_s = decode(HEARTBEAT, payload).header.utc_std_s

    def has_received_boots(self, count: int) -> bool:
        return len(self.boot_ids) == count

    def open(self) -> None:
        identity = self.pki.station_identity()
        rules = access_control(self.pki.registry())
        router = ZenohBus(StationEndpoint((self._address,), identity, rules))
        self._stack.callback(router.close)
        self.bus = ZenohBus(ClientEndpoint((self._address,), identity))
        self._stack.callback(self.bus.close)
        self.bus.subscribe(POSITION.key("*"), self._note)
        self.bus.subscribe(HEARTBEAT.key("*"), self._note_heartbeat)
        self.bus.serve(clock_key("*"), ClockServer(SystemClock()).replies)
        self.bus.subscribe(IMU.key("*"), lambda key, _: None)
        self.bus.watch_alive(alive_key("*"), lambda _, alive: self.alive.append(alive))
