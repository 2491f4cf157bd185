"""The sockets on which the bus is reached."""

from __future__ import annotations

import errno
import socket
from collections.abc import Sequence

from base_station.config import endpoint_address
from shared.bus_zenoh import cannot_listen
from shared.errors import ConfigError

_BACKLOG = 4096  # the kernel takes less where it is set to


def listen_on(endpoints: Sequence[str]) -> list[socket.socket]:
    """Non-blocking sockets of the endpoints.

    Raises BusError; PortInUseError where another program listens there.
    """
    listening: list[socket.socket] = []
    try:
        for endpoint in endpoints:
            listening += _listen(*endpoint_address(endpoint), _interface(endpoint))
    except OSError as error:
        for one in listening:
            one.close()
        in_use = error.errno == errno.EADDRINUSE
        raise cannot_listen(endpoints, error.strerror or str(error), in_use=in_use) from error
    return listening


def free_port() -> int:
    """Port of this machine's loopback that is free at this moment."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def _interface(endpoint: str) -> str:
    """Network interface of an endpoint such as ``tls/0.0.0.0:7447#iface=eth0``; empty: any."""
    _, _, options = endpoint.partition("#")
    name, _, value = options.partition("=")
    if name not in ("", "iface") or ";" in value:
        raise ConfigError(f"{endpoint!r}: of Zenoh's options only #iface=INTERFACE is known here")
    return value


def _listen(host: str, port: int, interface: str) -> list[socket.socket]:
    """Listen on all addresses of the name.  Raises OSError where none of them is possible."""
    found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    listening: list[socket.socket] = []
    failed: OSError | None = None
    for family, kind, protocol, _, address in dict.fromkeys(found):
        one = socket.socket(family, kind, protocol)
        try:
            one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            if interface:
                one.setsockopt(socket.SOL_SOCKET, socket.SO_BINDTODEVICE, interface.encode())
            one.bind(address)
            one.listen(_BACKLOG)
            one.setblocking(False)
            listening.append(one)
        except OSError as error:
            failed = error
            one.close()
    if failed is not None and (not listening or failed.errno == errno.EADDRINUSE):
        for one in listening:
            one.close()
        raise failed
    return listening
