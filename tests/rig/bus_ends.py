"""A station and a unit on one bus, whatever the bus is: what the buses' contract runs on."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from typing import Protocol

from shared.bus import Bus
from shared.bus_memory import MemoryRouter
from shared.bus_zenoh import StationEndpoint, UnitEndpoint, ZenohBus
from shared.channels import Qos
from tests.rig.station_process import free_port
from tests.rig.waiting import until


class Fabric(Protocol):
    """A station and units on one bus."""

    def station(self) -> Bus: ...

    def unit(self) -> Bus:
        """Returns when the unit is linked to the station."""
        ...


class MemoryFabric:
    def __init__(self) -> None:
        self._router = MemoryRouter()

    def station(self) -> Bus:
        return self._router.attach_station()

    def unit(self) -> Bus:
        return self._router.attach_unit()


class ZenohFabric:
    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        self._address = f"tcp/127.0.0.1:{free_port()}"
        self._station: ZenohBus | None = None

    def station(self) -> Bus:
        if self._station is None:
            self._station = ZenohBus(StationEndpoint((self._address,)))
            self._stack.callback(self._station.close)
        return self._station

    def unit(self) -> Bus:
        bus = ZenohBus(UnitEndpoint((self._address,)))
        self._stack.callback(bus.close)
        wait_linked(self.station(), bus)
        return bus


def wait_linked(station: Bus, unit: Bus) -> None:
    """Messages and tokens go both ways."""
    received: list[str] = []
    watch = station.watch_alive("probe/*", lambda key, _: received.append(key))
    token = unit.declare_alive(f"probe/{id(unit)}")
    until(lambda: bool(received), "the unit's token at the station")
    echo = unit.subscribe("echo", lambda key, _: received.append(key))

    def echoed() -> bool:
        station.publish("echo", b"", Qos.LIVE)
        return "echo" in received

    until(echoed, "the station's message at the unit")
    for declared in (watch, token, echo):
        declared.close()


@dataclass
class BusEnds:
    station: Bus
    unit: Bus
    fabric: Fabric


class ReceivedMessages:
    """A handler that remembers."""

    def __init__(self) -> None:
        self.samples: list[tuple[str, bytes]] = []

    def __call__(self, key: str, payload: bytes) -> None:
        self.samples.append((key, payload))

    def has(self, count: int) -> bool:
        return len(self.samples) >= count


def publish_until_received(publisher: Bus, key: str, received: ReceivedMessages) -> None:
    """A subscription takes a moment to reach the other side; then it stands."""

    def arrived() -> bool:
        publisher.publish(key, b"probe", Qos.LIVE)
        return any(sample[0] == key for sample in received.samples)

    until(arrived, f"a first message under {key}")
    publisher.publish(key, b"end of probes", Qos.LIVE)
    until(lambda: (key, b"end of probes") in received.samples, "the last probe")
    received.samples.clear()
