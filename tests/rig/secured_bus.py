"""A router with the rules of an authority, and what must not come through it."""

from __future__ import annotations

import time
from contextlib import ExitStack
from pathlib import Path

from base_station.security.pki.access import access_control
from base_station.security.pki.folder import PkiFolder
from shared.bus_zenoh import ClientEndpoint, StationEndpoint, UnitEndpoint, ZenohBus
from shared.channels import COMMAND, POSITION, Qos, alive_key
from shared.enrolment import Enrolment
from tests.rig.station_process import free_port
from tests.rig.waiting import until

# Long enough for what is allowed to have arrived twice over: what is forbidden must not have.
QUIET_S = 0.7


class Site:
    """A router with the rules of an authority, and the station as its client."""

    def __init__(self, data: Path, stack: ExitStack) -> None:
        port = free_port()
        self.address = f"127.0.0.1:{port}"
        self.unnamed_address = f"127.0.0.2:{port}"  # its certificate does not stand for it
        self.pki = PkiFolder(data)
        self.pki.create("Test", hosts=[], connect=[f"tls/{self.address}"])
        self._stack = stack
        self.received: list[tuple[str, bytes]] = []
        self.alive: set[str] = set()

    def open(self) -> None:
        """After everyone is enrolled: rules are read when the router opens."""
        self.router = self._open_router()
        self.station = self.join(
            ClientEndpoint((f"tls/{self.address}",), self.pki.station_identity())
        )
        self.station.subscribe("muster/v1/**", lambda k, p: self.received.append((k, p)))
        self.station.watch_alive("muster/v1/**", self._token)

    def reopen(self) -> None:
        self.router.close()
        self.router = self._open_router()

    def _open_router(self) -> ZenohBus:
        router = ZenohBus(
            StationEndpoint(
                (f"tls/{self.address}", f"tls/{self.unnamed_address}"),
                self.pki.station_identity(),
                access_control(self.pki.registry()),
            )
        )
        self._stack.callback(router.close)
        return router

    def join(self, endpoint: UnitEndpoint | ClientEndpoint) -> ZenohBus:
        bus = ZenohBus(endpoint)
        self._stack.callback(bus.close)
        return bus

    def unit(self, enrolment: Enrolment) -> ZenohBus:
        return self.join(UnitEndpoint(enrolment.connect, enrolment.identity))

    def received_under(self, key: str) -> list[bytes]:
        return [payload for received, payload in self.received if received == key]

    def _token(self, key: str, alive: bool) -> None:
        (self.alive.add if alive else self.alive.discard)(key)


def publish_until_received(site: Site, unit: ZenohBus, unit_id: str) -> None:
    key = POSITION.key(unit_id)
    before = len(site.received_under(key))

    def arrived() -> bool:
        unit.publish(key, b"here", Qos.LIVE)
        return len(site.received_under(key)) > before

    until(arrived, f"a message of {unit_id}")


def say_forged(bus: ZenohBus, key: str) -> None:
    """As a unit says it, under a declared number, and as somebody's own program may, by the key."""
    bus.publish(key, b"forged", Qos.ALERT)
    bus._session.put(key, b"forged")


def assert_powerless(site: Site, enrolment: Enrolment) -> None:
    """Linked, and yet nothing goes either way."""
    unit = site.unit(enrolment)
    until(unit.is_linked, "the link")
    assert_speechless(site, unit, enrolment.name)


def assert_speechless(site: Site, unit: ZenohBus, name: str) -> None:
    site.received.clear()
    received: list[str] = []
    unit.subscribe(COMMAND.key(name), lambda key, _: received.append(key))
    token = unit.declare_alive(alive_key(name))
    unit.serve(f"muster/v1/{name}/journal/**", lambda *_: [b"forged"])
    deadline = time.monotonic() + QUIET_S
    while time.monotonic() < deadline:
        say_forged(unit, POSITION.key(name))
        site.station.publish(COMMAND.key(name), b"secret", Qos.ALERT)
        time.sleep(0.02)
    assert not unit.has_subscriber(POSITION.key(name))
    assert list(site.station.query(f"muster/v1/{name}/journal/range", b"", 0.5)) == []
    assert site.received_under(POSITION.key(name)) == []
    assert received == []
    assert site.alive == set()
    token.close()


def assert_never_linked(site: Site, endpoint: UnitEndpoint) -> None:
    unit = site.join(endpoint)
    deadline = time.monotonic() + QUIET_S
    while time.monotonic() < deadline:
        unit.publish(POSITION.key("anna"), b"forged", Qos.LIVE)
        assert not unit.is_linked()
        time.sleep(0.02)
    assert site.received == []
