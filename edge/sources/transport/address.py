"""Addresses of hardware on a TCP or serial line, and explanations of its errors."""

from __future__ import annotations

import errno
import math
import socket
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import parse_qsl, urlsplit

from edge.sources.transport.connection import Connection, SerialConnection, TcpConnection, speed_of
from shared.coded_text import coded
from shared.errors import ConfigError
from shared.host_names import can_be_looked_up

BAUD = (50.0, 4e6)  # least and most


@dataclass(frozen=True, slots=True)
class TransportAddress:
    """Address of a TCP server, or a serial port."""

    host: str  # empty: a serial port
    port: int
    path: str
    baud: int

    def __str__(self) -> str:
        return f"tcp://{self.host}:{self.port}" if self.host else self.path

    def open(self) -> Connection:
        """Raises OSError."""
        if self.host:
            return TcpConnection(self.host, self.port)
        return SerialConnection(self.path, self.baud)


def parse_address(
    scheme: str, text: str, values: Mapping[str, float], *, port: int | None, baud: int
) -> TransportAddress:
    """Return the address that ``tcp://HOST[:PORT]`` or ``/dev/PATH`` names, with the parsed
    options.

    ``port`` and ``baud`` are where they are left out; None: it may not be.  Raises ConfigError.
    """
    where = text.partition("?")[0]
    baud = int(values.get("baud", baud))
    speed_of(baud)
    if where.startswith("tcp:"):
        host, port, path = parse_server(where, port) or ("", 0, "")
        if not host or path not in ("", "/"):
            raise ConfigError(
                f"{scheme}:{text} names no server; write tcp://HOST:PORT, port 1 to 65535"
            )
        if "baud" in values:
            raise ConfigError(f"{scheme}:{text}: baud is of a serial line; leave it out")
        return TransportAddress(host, port, "", 0)
    if not where.startswith("/"):
        raise ConfigError(
            f"{scheme}:{text} names no device; write {scheme}:tcp://HOST:PORT, or the path of a "
            f"serial port as in {scheme}:/dev/ttyACM0"
        )
    return TransportAddress("", 0, where, baud)


def parse_server(where: str, port: int | None) -> tuple[str, int, str] | None:
    """Return host, port and path of ``SCHEME://HOST[:PORT][/PATH]``; None where it is none."""
    try:
        parts = urlsplit(where)
        host, written = parts.hostname, parts.port
    except ValueError:
        return None
    port = port if written is None else written
    return (host, port, parts.path) if host and port and can_be_looked_up(host) else None


def parse_options(
    scheme: str, text: str, known: Mapping[str, tuple[float, float]]
) -> dict[str, float]:
    """Return the numbers behind the ``?``; ``known``: the least and most of each.  Raises
    ConfigError.
    """
    values: dict[str, float] = {}
    for name, given in parse_qsl(text.partition("?")[2], keep_blank_values=True):
        if name not in known:
            raise ConfigError(
                f"{scheme}:{text}: unknown option {name!r}; known are {', '.join(known)}"
            )
        least, most = known[name]
        try:
            value = float(given)
        except ValueError:
            value = math.nan
        if not least <= value <= most:
            raise ConfigError(
                f"{scheme}:{text}: {name} is {given!r}; give a number from {least:g} to {most:g}"
            )
        values[name] = value
    return values


_DISCONNECTED = coded("line-gone", "it went away; is the cable in, and the device on and charged?")
_NO_DEVICE = coded("line-no-device", "there is no such device; is the cable in, and the device on?")
_NO_ROUTE = coded(
    "line-no-route", "there is no way to that address; is this machine in its network?"
)
_NO_PORT = coded("line-no-port", "it is no serial port; check the path")
_NO_PERMISSION = coded(
    "line-not-permitted",
    "this program may not read it; add its user to the group that owns it (dialout)",
)
_EXPLANATIONS = {
    errno.ECONNREFUSED: coded(
        "line-refused", "the connection is refused; is the port right, and the device's own?"
    ),
    errno.EHOSTUNREACH: _NO_ROUTE,
    errno.ENETUNREACH: _NO_ROUTE,
    errno.ENOENT: _NO_DEVICE,
    errno.ENXIO: _NO_DEVICE,
    errno.ENODEV: _NO_DEVICE,
    errno.EACCES: _NO_PERMISSION,
    errno.EPERM: _NO_PERMISSION,
    errno.EBUSY: coded("line-busy", "another program is reading it; end that one"),
    errno.ENOTTY: _NO_PORT,
    errno.EISDIR: _NO_PORT,
    errno.EIO: _DISCONNECTED,
    errno.ECONNRESET: _DISCONNECTED,
    errno.EPIPE: _DISCONNECTED,
}


def explain_os_error(error: OSError, place: TransportAddress) -> str:
    """Return what a person can do about a line that cannot be opened or read."""
    if isinstance(error, socket.gaierror):
        return coded(
            "line-unknown-name",
            "the name {host} is not known here; check the address",
            host=place.host,
        )
    if isinstance(error, TimeoutError):
        return coded(
            "line-no-answer", "it does not answer; is it on, and this machine in its network?"
        )
    return _EXPLANATIONS.get(error.errno or 0) or str(error)
