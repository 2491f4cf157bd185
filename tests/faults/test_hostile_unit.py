"""An enrolled unit that floods a station costs the other units nothing."""

from __future__ import annotations

import secrets
import statistics
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from pathlib import Path
from threading import Event, Thread

import pytest

from shared.bus import QueryHandler
from shared.bus_zenoh import ZenohBus
from shared.channels import POSITION, Qos, alive_key, parse_key
from shared.clock import NS_PER_S, SystemClock
from shared.codec import decode, encode
from shared.header_factory import HeaderFactory
from shared.mcap_log import read_log, segment_paths
from shared.messages import (
    Header,
    Position,
)
from tests.rig.endless_journal import (
    LAST,
    large_journal,
    mayday_journal,
    ordinary_large_journal,
)
from tests.rig.loaded_program import launch_loaded
from tests.rig.message_factory import position
from tests.rig.pacing import wait_until
from tests.rig.simulated_units import BenchUnit, unit_names
from tests.rig.station_process import Membership, StationProcess, station_process

EVIL, GREEDY, HOARDER = "evil", "greedy", "hoarder"
SECONDS = 4
FLOOD_S = 0.01
AT_ONCE = 100  # 10,000 a second, where the machine can
GROWN_MB = 150.0
MAYDAYS = 3500  # 500 at once, and as many as one answer may bring beyond
AT_ONCE_S = 0.3
AT_ONCE_MB = 64.0  # of a journal
ON_ITS_WAY_MB = 8.0  # 500 alerts of that size, what one answer brings beyond, and the others

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
        member = Membership(folder, [*names, EVIL, GREEDY, HOARDER], plain=False)
        self.station: StationProcess = stack.enter_context(
            station_process(folder, member.address, launch=launch_loaded)
        )
        self.units = [BenchUnit(name, member.endpoint_of(name), stack) for name in names]
        self.evil = stack.enter_context(closing(ZenohBus(member.endpoint_of(EVIL))))
        self.others = {
            name: stack.enter_context(closing(ZenohBus(member.endpoint_of(name))))
            for name in (GREEDY, HOARDER)
        }
        for name in [*names, EVIL, *self.others]:
            self.station.api.post("/units", {"unit_id": name})
        wait_until("the station listens", lambda: all(unit.is_received for unit in self.units))
        wait_until("to the other one too", lambda: self.evil.has_subscriber(POSITION.key(EVIL)))
        for name, bus in self.others.items():
            wait_until(f"and to {name}", lambda: bus.has_subscriber(POSITION.key(name)))  # noqa: B023

    def flood(self, say: Say, over: Event) -> None:
        header_factory = HeaderFactory(EVIL, secrets.randbits(63), SystemClock())
        while not over.wait(FLOOD_S):
            for _ in range(AT_ONCE):
                say(self.evil, header_factory.header())

    def problems(self) -> str:
        return " ".join(self.station.api.get("/health")["problems"])


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Scene]:
    with ExitStack() as stack:
        yield Scene(tmp_path_factory.mktemp("station"), stack)


@pytest.mark.parametrize(
    ("say", "reported"),
    [
        (say_position, "evil sends more than any unit does"),
        (say_another_boot, "A unit's program starts more often"),
        (say_any_time, "evil sends more than any unit does"),
        (say_16_mb, ""),
    ],
)
def test_flood_by_a_unit_affects_neither_others_nor_the_stations_memory(
    scene: Scene, say: Say, reported: str
) -> None:
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
        wait_until("a person is told", lambda: reported in scene.problems())
        assert scene.station.memory_mb() < before_mb + GROWN_MB
    finally:
        over.set()
        flood.join()
    assert sum(unit.sent.messages for unit in scene.units) == sent + 21 * SECONDS
    wait_until(
        "nothing of the others is missing",
        lambda: logged(scene) == [unit.sent.messages for unit in scene.units],
    )


def maydays(scene: Scene) -> int:
    """In the log, of the one that runs wild."""
    return sum(f"/{EVIL}/" in key and "alert/" in key for _, key, _ in read_log(scene.station.log))


def test_endless_journal_is_limited_and_reported(scene: Scene) -> None:
    boot_id = secrets.randbits(63)
    serving = scene.evil.serve(f"muster/v1/{EVIL}/journal/**", mayday_journal(EVIL, boot_id))
    token = scene.evil.declare_alive(alive_key(EVIL))  # who has a link is asked
    try:
        scene.evil.publish(
            POSITION.key(EVIL), encode(position(Header(EVIL, boot_id, LAST, 1))), Qos.LIVE
        )
        wait_until("a person is told", lambda: "evil's journal brings more" in scene.problems())
        assert maydays(scene) < MAYDAYS
        for _ in range(7 * SECONDS):
            for unit in scene.units:
                unit.speak()
            time.sleep(1.0 / 7.0)
        wait_until(
            "nothing of the others is missing",
            lambda: logged(scene) == [unit.sent.messages for unit in scene.units],
        )
        assert maydays(scene) < MAYDAYS
    finally:
        for declared in (serving, token):
            declared.close()


def log_mb(scene: Scene) -> float:
    return sum(one.stat().st_size for one in segment_paths(scene.station.log)) / 1e6


@pytest.mark.parametrize(
    ("name", "journal_of", "most_mb"),
    [
        (GREEDY, large_journal, ON_ITS_WAY_MB),  # it says that all of it is urgent
        (HOARDER, ordinary_large_journal, AT_ONCE_MB + ON_ITS_WAY_MB),
    ],
    ids=["urgent", "ordinary"],
)
def test_large_messages_of_a_journal_are_limited_and_reported(
    scene: Scene, name: str, journal_of: Callable[[str, int], QueryHandler], most_mb: float
) -> None:
    before_mb, before_ns, began_s = log_mb(scene), time.time_ns(), time.monotonic()
    boot_id, bus = secrets.randbits(63), scene.others[name]
    serving = bus.serve(f"muster/v1/{name}/journal/**", journal_of(name, boot_id))
    token = bus.declare_alive(alive_key(name))
    try:
        first = encode(position(Header(name, boot_id, LAST, 1)))
        bus.publish(POSITION.key(name), first, Qos.LIVE)
        wait_until("a person is told", lambda: f"{name}'s journal brings more" in scene.problems())
        for _ in range(7 * SECONDS):
            for unit in scene.units:
                unit.speak()
            time.sleep(1.0 / 7.0)
        share_mb = time.monotonic() - began_s  # 1 MB a second
        assert most_mb - ON_ITS_WAY_MB < log_mb(scene) - before_mb < most_mb + share_mb
        wait_until(
            "nothing of the others is missing",
            lambda: logged(scene) == [unit.sent.messages for unit in scene.units],
        )
        assert statistics.median(delays_s(scene, before_ns)) < AT_ONCE_S
    finally:
        for declared in (serving, token):
            declared.close()


def delays_s(scene: Scene, since_ns: int) -> list[float]:
    """Delays of the others' positions, from their sending to the log."""
    return [
        (t_ns - message.header.t_utc_ns) / NS_PER_S
        for t_ns, key, payload in read_log(scene.station.log, start_ns=since_ns)
        if "/up/position" in key
        and isinstance(message := decode(POSITION, payload), Position)
        and message.header.unit_id not in (EVIL, GREEDY, HOARDER)
    ]


def test_other_units_are_received_at_once_beside_a_flapping_token(scene: Scene) -> None:
    """Last: afterwards the unit is shut out."""
    before_mb, began_ns = scene.station.memory_mb(), time.time_ns()
    over = Event()
    flood = Thread(target=toggle, args=(scene.evil, over))
    flood.start()
    try:
        for _ in range(7 * SECONDS):
            for unit in scene.units:
                unit.speak()
            time.sleep(1.0 / 7.0)
        wait_until("a person is told", lambda: "evil appears and vanishes" in scene.problems())
        assert scene.station.memory_mb() < before_mb + GROWN_MB
        wait_until("it has no link", lambda: not scene.evil.has_subscriber(POSITION.key(EVIL)))
    finally:
        over.set()
        flood.join()
    wait_until(
        "nothing of the others is missing",
        lambda: logged(scene) == [unit.sent.messages for unit in scene.units],
    )
    assert statistics.median(delays_s(scene, began_ns)) < AT_ONCE_S


def toggle(bus: ZenohBus, over: Event) -> None:
    """As fast as the machine can."""
    while not over.is_set():
        bus.declare_alive(alive_key(EVIL)).close()


def logged(scene: Scene) -> list[int]:
    """Number of messages of each of the others in the log."""
    senders = [parse_key(key)[0] for _, key, _ in read_log(scene.station.log) if "/up/" in key]
    return [senders.count(unit.unit_id) for unit in scene.units]
