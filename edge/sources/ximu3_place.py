"""Where an x-IMU3 is: the text that names it, and why it cannot be reached there."""

from __future__ import annotations

import errno
import math
import socket
from dataclasses import dataclass
from urllib.parse import parse_qsl, urlsplit

from edge.sources.line import Line, SerialLine, SocketLine, speed_of
from shared.errors import ConfigError

_PORT = 7000
_BAUD = 115200
_RATE_HZ = 400.0
_OPTIONS = {  # least and most of each
    "baud": (50.0, 4e6),
    "rate": (10.0, 400.0),
    "field": (10.0, 100.0),
}


@dataclass(frozen=True, slots=True)
class Place:
    """A TCP server, or a serial port; how the device there is set."""

    host: str  # empty: a serial port
    port: int
    path: str
    baud: int
    rate_hz: float
    field_ut: float | None  # where its magnetometer was calibrated; None: it is not used

    def __str__(self) -> str:
        where = f"tcp://{self.host}:{self.port}" if self.host else self.path
        return f"x-IMU3 at {where}"

    def open(self) -> Line:
        """Raises OSError."""
        if self.host:
            return SocketLine(self.host, self.port)
        return SerialLine(self.path, self.baud)


def place_of(text: str) -> Place:
    """What ``tcp://HOST[:PORT]`` or ``/dev/PATH`` names, with ``?baud=&rate=&field=``.

    Raises ConfigError.
    """
    where, _, query = text.partition("?")
    values = _values(text, query)
    baud = int(values.get("baud", _BAUD))
    speed_of(baud)
    host, port, path = "", 0, where
    if where.startswith("tcp:"):
        host, port = _server(text, where)
        path = ""
        if "baud" in values:
            raise ConfigError(f"ximu3:{text}: baud is of a serial line; leave it out")
    elif not where.startswith("/"):
        raise ConfigError(
            f"ximu3:{text} names no device; write ximu3:tcp://192.168.1.1:7000, or the path of a "
            "serial port as in ximu3:/dev/ttyACM0"
        )
    return Place(host, port, path, baud, values.get("rate", _RATE_HZ), values.get("field"))


def _server(text: str, where: str) -> tuple[str, int]:
    try:
        parts = urlsplit(where)
        host, port = parts.hostname, parts.port
    except ValueError:
        host, port = None, None
    if not host or port == 0 or parts.path not in ("", "/"):
        raise ConfigError(f"ximu3:{text} names no server; write tcp://HOST:PORT, port 1 to 65535")
    return host, _PORT if port is None else port


def _values(text: str, query: str) -> dict[str, float]:
    values: dict[str, float] = {}
    for name, said in parse_qsl(query, keep_blank_values=True):
        if name not in _OPTIONS:
            known = ", ".join(_OPTIONS)
            raise ConfigError(f"ximu3:{text}: unknown option {name!r}; known are {known}")
        least, most = _OPTIONS[name]
        try:
            value = float(said)
        except ValueError:
            value = math.nan
        if not least <= value <= most:
            raise ConfigError(
                f"ximu3:{text}: {name} is {said!r}; give a number from {least:g} to {most:g}"
            )
        values[name] = value
    return values


_AWAY = "it went away; is the cable in, and the device on and charged?"
_MISSING = "there is no such device; is the cable in, and the device on?"
_NO_WAY = "there is no way to that address; is this machine in its network?"
_NO_PORT = "it is no serial port; check the path"
_FORBIDDEN = "this program may not read it; add its user to the group that owns it (dialout)"
_WHY = {
    errno.ECONNREFUSED: "the connection is refused; is the port right, and the device's own?",
    errno.EHOSTUNREACH: _NO_WAY,
    errno.ENETUNREACH: _NO_WAY,
    errno.ENOENT: _MISSING,
    errno.ENXIO: _MISSING,
    errno.ENODEV: _MISSING,
    errno.EACCES: _FORBIDDEN,
    errno.EPERM: _FORBIDDEN,
    errno.EBUSY: "another program is reading it; end that one",
    errno.ENOTTY: _NO_PORT,
    errno.EISDIR: _NO_PORT,
    errno.EIO: _AWAY,
    errno.ECONNRESET: _AWAY,
    errno.EPIPE: _AWAY,
}


def why_not(error: OSError, place: Place) -> str:
    """What a person can do about a line that cannot be opened or read."""
    if isinstance(error, socket.gaierror):
        return f"nobody here knows the name {place.host}; check the address"
    if isinstance(error, TimeoutError):
        return "it does not answer; is it on, and this machine in its network?"
    return _WHY.get(error.errno or 0, str(error))
