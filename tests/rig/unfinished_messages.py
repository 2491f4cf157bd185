"""A holder whose large messages never end: the last piece of each does not reach the router.

Zenoh's own client makes the pieces.  It speaks to a relay of this machine, which shows the holder's
certificate and leaves out every last piece.
"""

from __future__ import annotations

import socket
import ssl
import struct
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager, suppress
from threading import Thread

import zenoh

from base_station.config import endpoint_address
from base_station.security.router.internal_authority import load_identity
from shared.bus_zenoh import ClientEndpoint, ZenohBus
from shared.enrolment import Enrolment

_FRAGMENT, _KIND_BITS, _MORE_BIT = 0x06, 0x1F, 0x40  # of the first byte of what is sent at once
_READ_BYTES = 65_536
_PRIORITIES = (
    zenoh.Priority.REAL_TIME,
    zenoh.Priority.INTERACTIVE_HIGH,
    zenoh.Priority.INTERACTIVE_LOW,
    zenoh.Priority.DATA_HIGH,
    zenoh.Priority.DATA,
    zenoh.Priority.DATA_LOW,
    zenoh.Priority.BACKGROUND,
)


@contextmanager
def unfinished_messages(enrolment: Enrolment, key: str, size: int) -> Iterator[None]:
    """One message of each priority over one more link of this holder, none of which ends."""
    with ExitStack() as stack:
        listening = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
        Thread(target=_relay, args=(listening, enrolment), daemon=True).start()
        address = f"tcp/127.0.0.1:{listening.getsockname()[1]}"
        bus = stack.enter_context(closing(ZenohBus(ClientEndpoint((address,)))))
        for priority in _PRIORITIES:
            bus._session.put(
                key,
                bytes(size),
                priority=priority,
                congestion_control=zenoh.CongestionControl.BLOCK,
            )
        yield


def _relay(listening: socket.socket, enrolment: Enrolment) -> None:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.load_verify_locations(cadata=enrolment.identity.authority.decode())
    load_identity(context, enrolment.identity)
    [endpoint] = enrolment.connect
    address = endpoint_address(endpoint)
    with suppress(OSError), ExitStack() as stack:
        near = stack.enter_context(listening.accept()[0])
        plain = socket.create_connection(address, 10.0)
        far = stack.enter_context(context.wrap_socket(plain, server_hostname=address[0]))
        far.settimeout(None)
        Thread(target=_pass_back, args=(far, near), daemon=True).start()
        with near.makefile("rb") as coming:
            while head := coming.read(2):
                (length,) = struct.unpack("<H", head)
                batch = coming.read(length)
                is_fragment = batch[0] & _KIND_BITS == _FRAGMENT
                if not is_fragment or batch[0] & _MORE_BIT:
                    far.sendall(head + batch)


def _pass_back(far: ssl.SSLSocket, near: socket.socket) -> None:
    with suppress(OSError):
        while data := far.recv(_READ_BYTES):
            near.sendall(data)
