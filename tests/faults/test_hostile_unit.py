"""An enrolled unit that runs wild, beside others at a real station: they lose nothing by it."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from pathlib import Path
from threading import Event, Thread

import pytest

from base_station.bench.rig.said import position
from base_station.bench.rig.station import Membership, StationProcess, station_process
from base_station.bench.rig.units import BenchUnit, unit_names
from base_station.bench.rig.waiting import wait_until
from shared.bus_zenoh import ZenohBus
from shared.channels import POSITION, Qos, parse_key
from shared.clock import SystemClock
from shared.codec import encode
from shared.envelope import Stamper
from shared.mcap_log import read_log
from shared.messages import Header

EVIL = "evil"
SECONDS = 4
FLOOD_S = 0.01
AT_ONCE = 100  # 10,000 a second, where the machine can
GROWN_MB = 150.0

Say = Callable[[ZenohBus, Header], None]


def say_position(bus: ZenohBus, header: Header) -> None:
    bus.publish(POSITION.key(EVIL), encode(position(header)), Qos.LIVE)


def say_another_boot(bus: ZenohBus, header: Header) -> None:
    say_position(bus, Header(EVIL, secrets.randbits(63), header.seq, header.t_mono_ns))


def say_any_time(bus: ZenohBus, header: Header) -> None:
    times_ns = secrets.randbits(63), secrets.randbits(63)
    say_position(bus, Header(EVIL, header.boot_id, header.seq, *times_ns))


def say_16_mb(bus: ZenohBus, header: Header) -> None:
    if header.seq % AT_ONCE == 0:
        bus.publish(POSITION.key(EVIL), bytes(16_000_000), Qos.LIVE)


class Scene:
    def __init__(self, folder: Path, stack: ExitStack) -> None:
        names = unit_names(3)
        member = Membership(folder, [*names, EVIL], plain=False)
        self.station: StationProcess = stack.enter_context(station_process(folder, member.address))
        self.units = [BenchUnit(name, member.endpoint_of(name), stack) for name in names]
        self.evil = stack.enter_context(closing(ZenohBus(member.endpoint_of(EVIL))))
        for name in [*names, EVIL]:
            self.station.api.post("/units", {"unit_id": name})
        wait_until("the station listens", lambda: all(unit.is_heard for unit in self.units))
        wait_until("to the other one too", lambda: self.evil.is_heard(POSITION.key(EVIL)))

    def flood(self, say: Say, over: Event) -> None:
        stamper = Stamper(EVIL, secrets.randbits(63), SystemClock())
        while not over.wait(FLOOD_S):
            for _ in range(AT_ONCE):
                say(self.evil, stamper.header())

    def problems(self) -> str:
        return " ".join(self.station.api.get("/health")["problems"])


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Scene]:
    with ExitStack() as stack:
        yield Scene(tmp_path_factory.mktemp("station"), stack)


@pytest.mark.parametrize(
    ("say", "told"),
    [
        (say_position, "evil says more than any unit does"),
        (say_another_boot, "More starts of a unit's program"),
        (say_any_time, "evil says more than any unit does"),
        (say_16_mb, ""),
    ],
)
def test_others_are_heard_and_the_station_does_not_grow(scene: Scene, say: Say, told: str) -> None:
    before_mb = scene.station.memory_mb()
    sent = sum(unit.sent.messages for unit in scene.units)
    over = Event()
    flood = Thread(target=scene.flood, args=(say, over))
    flood.start()
    try:
        for _ in range(7 * SECONDS):
            for unit in scene.units:
                unit.speak()
            time.sleep(1.0 / 7.0)
        wait_until("a person is told", lambda: told in scene.problems())
        assert scene.station.memory_mb() < before_mb + GROWN_MB
    finally:
        over.set()
        flood.join()
    assert sum(unit.sent.messages for unit in scene.units) == sent + 21 * SECONDS
    wait_until(
        "nothing of the others is missing",
        lambda: logged(scene) == [unit.sent.messages for unit in scene.units],
    )


def logged(scene: Scene) -> list[int]:
    """How many messages of each of the others are in the log."""
    senders = [parse_key(key)[0] for _, key, _ in read_log(scene.station.log) if "/up/" in key]
    return [senders.count(unit.unit_id) for unit in scene.units]
