"""A flood of connections without a certificate does not keep units from linking."""

from __future__ import annotations

import socket
import ssl
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, closing, suppress
from pathlib import Path

import pytest

from base_station.security.pki.folder import PkiFolder
from base_station.security.router.internal_authority import load_identity
from base_station.security.router.process import RouterProcess
from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import POSITION, Qos
from shared.enrolment import Enrolment
from shared.tls import TlsIdentity
from tests.rig import processes
from tests.rig.connection_flood import connection_flood
from tests.rig.station_process import free_port
from tests.rig.unfinished_messages import unfinished_messages
from tests.rig.waiting import until

KEY = POSITION.key("anna")
LINKED_WITHIN_S = 3.0
UNFINISHED_MB = 110.0  # of four links, in each of seven priorities 2 MB, and what was read of them


class Bus:
    """A router in its own process, the station at it, and its authority."""

    def __init__(self, data: Path, stack: ExitStack) -> None:
        self.port = free_port()
        listen = (f"tls/127.0.0.1:{self.port}",)
        self.pki = PkiFolder(data)
        self.pki.create("Test", hosts=[], connect=listen)
        self.anna = self.pki.enroll("anna")
        self.router = stack.enter_context(closing(RouterProcess(data, listen).wait_open()))
        self.station = stack.enter_context(closing(ZenohBus(self.router.endpoint)))
        self.station.subscribe("muster/v1/**", lambda *_: None)
        self.link_s()  # what is made once is not measured

    def link_s(self) -> float:
        """Time until a unit is linked and received."""
        began_s = time.monotonic()
        with closing(unit(self.anna)) as bus:
            until(lambda: bus.has_subscriber(KEY), "the link")
            return time.monotonic() - began_s


def unit(enrolment: Enrolment) -> ZenohBus:
    return ZenohBus(UnitEndpoint(enrolment.connect, enrolment.identity))


@pytest.fixture(scope="module")
def bus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bus]:
    with ExitStack() as stack:
        yield Bus(tmp_path_factory.mktemp("station"), stack)


@pytest.mark.parametrize(
    ("kind", "held", "per_s", "sources"),
    [
        ("silent", 1500, 200, 1),
        ("hello", 500, 100, 1),
        ("closed", 0, 200, 1),
        ("garbage", 0, 10, 50),
        ("hello", 0, 10, 50),
    ],
)
def test_a_unit_links_at_once_beside_a_flood_of_connections(
    bus: Bus, kind: str, held: int, per_s: float, sources: int
) -> None:
    before = bus.router.refused.total
    with connection_flood(
        kind, "127.0.0.1", bus.port, 60.0, held=held, per_s=per_s, sources=sources
    ):
        assert max(bus.link_s() for _ in range(2)) < LINKED_WITHIN_S
        if kind in ("closed", "garbage"):  # the others are waited for, up to ten seconds
            until(lambda: bus.router.refused.total > before, "the count of who was refused")


def test_links_return_at_once_after_an_enrolment_during_a_flood(bus: Bus) -> None:
    with closing(unit(bus.anna)) as anna:
        until(lambda: anna.has_subscriber(KEY), "the link")
        with (
            connection_flood("hello", "127.0.0.1", bus.port, 60.0, held=200, per_s=100),
            ThreadPoolExecutor(1) as watcher,
        ):
            # Watched from before: on a busy machine the link may be back when enrolling returns.
            outage_s = watcher.submit(next_outage_s, anna)
            bus.pki.enroll("ben")
            assert outage_s.result() < LINKED_WITHIN_S


def next_outage_s(anna: ZenohBus) -> float:
    """Duration of the next loss of the link."""
    until(lambda: not anna.has_subscriber(KEY), "the router opens again", poll_interval_s=0.002)
    closed_s = time.monotonic()
    until(lambda: anna.has_subscriber(KEY), "the link is back")
    return time.monotonic() - closed_s


def test_refused_connections_are_reported_with_their_addresses(bus: Bus) -> None:
    with connection_flood("garbage", "127.0.0.1", bus.port, 60.0, held=0, per_s=200):
        until(lambda: any("127.0.1.1" in one for one in bus.router.problems()), "the problem")
    [problem] = bus.router.problems()
    assert "connections to the bus were refused in the last minute" in problem
    assert "docs/howto/when-attacked.md" in problem


def test_repeated_attempts_of_forty_units_of_an_old_authority_delay_no_link(
    bus: Bus, tmp_path: Path
) -> None:
    earlier = PkiFolder(tmp_path)
    earlier.create("Earlier", hosts=[], connect=[f"tls/127.0.0.1:{bus.port}"])
    theirs = earlier.enroll("anna").identity
    # One knows this authority already, and shows the certificate of the other; one knows neither.
    mixed = TlsIdentity(bus.anna.identity.authority, theirs.certificate, theirs.private_key)
    before = bus.router.refused.total
    with ExitStack() as stack:
        for number in range(40):
            foreign = UnitEndpoint(bus.anna.connect, mixed if number % 2 else theirs)
            stack.enter_context(closing(ZenohBus(foreign)))
        until(lambda: bus.router.refused.total >= before + 120, "each has tried a few times")
        assert max(bus.link_s() for _ in range(3)) < LINKED_WITHIN_S


def greet(bus: Bus, identity: TlsIdentity) -> ssl.SSLSocket:
    """A connection whose handshake is over."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.load_verify_locations(cadata=identity.authority.decode())
    load_identity(context, identity)
    connection = socket.create_connection(("127.0.0.1", bus.port), 10.0)
    return context.wrap_socket(connection, server_hostname="127.0.0.1")


def is_ended(connection: ssl.SSLSocket, within_s: float = 0.01) -> bool:
    connection.settimeout(within_s)
    try:
        return connection.recv(1) == b""
    except TimeoutError:
        return False
    except OSError:
        return True


def test_a_revoked_certificate_opens_no_session(bus: Bus) -> None:
    lost = bus.pki.enroll("lost").identity
    bus.pki.revoke("lost")
    before = bus.router.refused.total
    with ExitStack() as stack:
        opened = [stack.enter_context(greet(bus, lost)) for _ in range(100)]
        until(lambda: all(is_ended(one) for one in opened), "the end of each")
    until(lambda: bus.router.refused.total >= before + 100, "the count")
    assert bus.link_s() < LINKED_WITHIN_S


def test_simultaneous_sessions_of_a_holder_are_limited(bus: Bus) -> None:
    many = bus.pki.enroll("many").identity
    with ExitStack() as stack:

        def stays() -> bool:
            return not is_ended(stack.enter_context(greet(bus, many)), 0.2)

        until(stays, "its place on the list", poll_interval_s=0.2)
        began_s = time.monotonic()
        opened = []
        for _ in range(20):
            with suppress(OSError):  # refused before this end has read to the end
                opened.append(stack.enter_context(greet(bus, many)))
        until(lambda: sum(not is_ended(one) for one in opened) <= 4, "the end of all but a few")
        assert time.monotonic() - began_s < 9.0  # sooner than silence ends any of them
    assert bus.link_s() < LINKED_WITHIN_S


def test_unfinished_messages_of_a_holder_are_limited(bus: Bus) -> None:
    """In every priority of each link that it may have; as much beside a standby."""
    many, key = bus.pki.enroll("unfinished"), POSITION.key("unfinished")
    with closing(unit(many)) as linked:
        until(lambda: linked.has_subscriber(key), "its place on the list")
    before_mb = processes.memory_mb(bus.router.pid)
    with ExitStack() as stack:
        for size in (1_900_000, 60_000_000, 1_900_000, 60_000_000, 1_900_000, 60_000_000):
            stack.enter_context(unfinished_messages(many, key, size))
        time.sleep(2.0)  # what is on its way
        assert processes.memory_mb(bus.router.pid) < before_mb + UNFINISHED_MB
    assert bus.link_s() < LINKED_WITHIN_S


def test_messages_of_60_mb_do_not_increase_the_routers_memory(bus: Bus) -> None:
    before_mb = processes.memory_mb(bus.router.pid)
    with closing(unit(bus.anna)) as anna:
        for _ in range(5):
            until(lambda: anna.has_subscriber(KEY), "the link")
            anna.publish(KEY, bytes(60_000_000), Qos.LIVE)
            assert processes.memory_mb(bus.router.pid) < before_mb + 30.0
    assert bus.link_s() < LINKED_WITHIN_S
