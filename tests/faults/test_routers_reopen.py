"""Two routers in processes of their own that reopen at any time link again each time.

Enrolling somebody has both open again at nearly the same moment, and so does a power cut.
"""

from __future__ import annotations

import os
import random
import signal
import time
from collections.abc import Iterator
from contextlib import ExitStack, closing
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from base_station.security.pki.folder import PkiFolder
from base_station.security.router.process import RouterProcess
from base_station.security.router.router import station_endpoint
from shared.bus_zenoh import ZenohBus
from shared.channels import Qos
from tests.rig.station_process import free_port
from tests.rig.waiting import until

ROUNDS = 10
SEED = 4
SPREAD_S = 1.0  # a router looks once a second whether it is to open again


@dataclass
class End:
    """A router's process and a station's session on it."""

    name: str
    pki: PkiFolder
    process: RouterProcess
    bus: ZenohBus
    received: set[str] = field(default_factory=set)

    def note(self, key: str, payload: bytes) -> None:
        self.received.add(payload.decode())

    def receives(self, other: End, words: str) -> bool:
        other.bus.publish(f"muster/v1/{other.name}/up/status", words.encode(), Qos.LIVE)
        time.sleep(0.02)
        return words in self.received

    def open_again(self, chance: random.Random, authority: PkiFolder) -> None:
        """Some time within the next second or two; killed, or because somebody was enrolled."""
        time.sleep(SPREAD_S * chance.random())
        if chance.random() < 0.5:
            os.kill(self.process.pid, signal.SIGKILL)
            return
        authority.enroll(f"unit-{chance.getrandbits(32):x}")
        self.pki.take_registry(authority.registry())


def wait_received(one: End, other: End, words: str) -> None:
    what = f"{one.name} hears {other.name} in {words}"
    until(lambda: one.receives(other, words), what)


@pytest.fixture
def ends(tmp_path: Path) -> Iterator[tuple[End, End]]:
    addresses = [f"tls/127.0.0.1:{free_port()}" for _ in range(2)]
    first, second = PkiFolder(tmp_path / "first"), PkiFolder(tmp_path / "second")
    first.create("here", ["127.0.0.1"], [addresses[0]])
    second.join(first.enroll_station("second", ["127.0.0.1"], addresses[1]))
    second.take_registry(first.registry())
    with ExitStack() as stack:
        yield (
            _end(first, addresses[0], addresses[1], stack),
            _end(second, addresses[1], addresses[0], stack),
        )


def _end(pki: PkiFolder, own: str, other: str, stack: ExitStack) -> End:
    data = pki.path.parent
    process = stack.enter_context(closing(RouterProcess(data, (own,), (other,)).wait_open()))
    bus = stack.enter_context(closing(ZenohBus(station_endpoint(data, (own,)))))
    end = End(data.name, pki, process, bus)
    stack.enter_context(closing(bus.subscribe("muster/v1/**", end.note)))
    return end


def test_routers_reopened_at_any_instant_link_again(ends: tuple[End, End]) -> None:
    chance = random.Random(SEED)
    first, second = ends
    for number in range(ROUNDS):
        for end in chance.sample(ends, 2):
            end.open_again(chance, first.pki)
        second.pki.take_registry(first.pki.registry())
        time.sleep(SPREAD_S)
        wait_received(first, second, f"round {number}")
        wait_received(second, first, f"round {number}")
