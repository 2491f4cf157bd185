"""Somebody on the bus who wants to stop a station: a program of its own, which ends by itself.

python -m tests.bench.faults.flooding_unit WHAT ENROLMENT SECONDS
"""

from __future__ import annotations

import secrets
import socket
import ssl
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack, closing, suppress
from pathlib import Path

from base_station.config import endpoint_address
from base_station.security.router.internal_authority import load_identity
from shared.bus import QueryHandler
from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import POSITION, ROOT, Qos, alive_key
from shared.clock import SystemClock
from shared.codec import encode
from shared.enrolment import Enrolment, read_enrolment
from shared.errors import MusterError
from shared.messages import Header
from shared.tls import TlsIdentity
from tests.rig import message_factory
from tests.rig.endless_journal import LAST, large_journal, mayday_journal
from tests.rig.pacing import paced, wait_until

_MOST_SECONDS = 120.0
_RETRYING = 40
_SESSIONS_HZ = 50.0


def toggle(enrolment: Enrolment, seconds: float) -> None:
    """Its liveliness token comes and goes, as fast as the machine can."""
    with closing(_joined(enrolment)) as bus:
        end_s = time.monotonic() + seconds
        while time.monotonic() < end_s:
            bus.declare_alive(alive_key(enrolment.name)).close()


def serve_maydays(enrolment: Enrolment, seconds: float) -> None:
    """Its journal never ends, and all of it are maydays."""
    _serve_journal(enrolment, seconds, mayday_journal)


def serve_large_messages(enrolment: Enrolment, seconds: float) -> None:
    """Its journal never ends, and brings as many bytes as it is asked for."""
    _serve_journal(enrolment, seconds, large_journal)


def _serve_journal(
    enrolment: Enrolment, seconds: float, journal_of: Callable[[str, int], QueryHandler]
) -> None:
    name, boot_id = enrolment.name, secrets.randbits(63)
    clock = SystemClock()
    with closing(_joined(enrolment)) as bus:
        held = (
            bus.serve(f"{ROOT}/{name}/journal/**", journal_of(name, boot_id)),
            bus.declare_alive(alive_key(name)),
        )
        header = Header(name, boot_id, LAST, clock.monotonic_ns(), clock.utc_ns())
        bus.publish(POSITION.key(name), encode(message_factory.position(header)), Qos.LIVE)
        time.sleep(seconds)
        for one in held:
            one.close()


def retry_links(enrolment: Enrolment, seconds: float) -> None:
    """Forty units that try for ever, with an enrolment that does not hold here perhaps."""
    with ExitStack() as stack:
        for _ in range(_RETRYING):
            endpoint = UnitEndpoint(enrolment.connect, enrolment.identity)
            stack.enter_context(closing(ZenohBus(endpoint)))
        time.sleep(seconds)


def open_sessions(enrolment: Enrolment, seconds: float) -> None:
    """One after the other, with a certificate that was revoked perhaps."""
    [endpoint] = enrolment.connect
    opened: list[ssl.SSLSocket] = []
    for _ in paced(_SESSIONS_HZ, seconds):
        with suppress(OSError):
            opened.append(_handshake(endpoint_address(endpoint), enrolment.identity))
    for one in opened:
        one.close()


ATTACKS: dict[str, Callable[[Enrolment, float], None]] = {
    "toggle": toggle,
    "journal": serve_maydays,
    "large journal": serve_large_messages,
    "retry": retry_links,
    "sessions": open_sessions,
}


def _joined(enrolment: Enrolment) -> ZenohBus:
    bus = ZenohBus(UnitEndpoint(enrolment.connect, enrolment.identity))
    wait_until("the station listens", lambda: bus.has_subscriber(POSITION.key(enrolment.name)))
    return bus


def _handshake(address: tuple[str, int], identity: TlsIdentity) -> ssl.SSLSocket:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.load_verify_locations(cadata=identity.authority.decode())
    load_identity(context, identity)
    connection = socket.create_connection(address, 3.0)
    return context.wrap_socket(connection, server_hostname=address[0])


def main(what: str, enrolment: str, seconds: str) -> None:
    ATTACKS[what](read_enrolment(Path(enrolment)), min(float(seconds), _MOST_SECONDS))


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except MusterError as error:
        sys.exit(str(error))
