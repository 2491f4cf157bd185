"""Where hardware is that talks on a line: the text that names it, and why it cannot be reached."""

from __future__ import annotations

import errno
import math
import socket
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import parse_qsl, urlsplit

from edge.sources.line import Line, SerialLine, SocketLine, speed_of
from shared.errors import ConfigError
from shared.host_names import can_be_looked_up

BAUD = (50.0, 4e6)  # least and most


@dataclass(frozen=True, slots=True)
class LinePlace:
    """A TCP server, or a serial port."""

    host: str  # empty: a serial port
    port: int
    path: str
    baud: int

    def __str__(self) -> str:
        return f"tcp://{self.host}:{self.port}" if self.host else self.path

    def open(self) -> Line:
        """Raises OSError."""
        if self.host:
            return SocketLine(self.host, self.port)
        return SerialLine(self.path, self.baud)


def line_place(
    scheme: str, text: str, values: Mapping[str, float], *, port: int | None, baud: int
) -> LinePlace:
    """What ``tcp://HOST[:PORT]`` or ``/dev/PATH`` names, with what ``options_of`` found behind it.

    ``port`` and ``baud`` are where they are left out; None: it may not be.  Raises ConfigError.
    """
    where = text.partition("?")[0]
    baud = int(values.get("baud", baud))
    speed_of(baud)
    if where.startswith("tcp:"):
        host, port, path = server_of(where, port) or ("", 0, "")
        if not host or path not in ("", "/"):
            raise ConfigError(
                f"{scheme}:{text} names no server; write tcp://HOST:PORT, port 1 to 65535"
            )
        if "baud" in values:
            raise ConfigError(f"{scheme}:{text}: baud is of a serial line; leave it out")
        return LinePlace(host, port, "", 0)
    if not where.startswith("/"):
        raise ConfigError(
            f"{scheme}:{text} names no device; write {scheme}:tcp://HOST:PORT, or the path of a "
            f"serial port as in {scheme}:/dev/ttyACM0"
        )
    return LinePlace("", 0, where, baud)


def server_of(where: str, port: int | None) -> tuple[str, int, str] | None:
    """Host, port and path of ``SCHEME://HOST[:PORT][/PATH]``; None where it is none."""
    try:
        parts = urlsplit(where)
        host, written = parts.hostname, parts.port
    except ValueError:
        return None
    port = port if written is None else written
    return (host, port, parts.path) if host and port and can_be_looked_up(host) else None


def options_of(
    scheme: str, text: str, known: Mapping[str, tuple[float, float]]
) -> dict[str, float]:
    """The numbers behind the ``?``; ``known``: the least and most of each.  Raises ConfigError."""
    values: dict[str, float] = {}
    for name, said in parse_qsl(text.partition("?")[2], keep_blank_values=True):
        if name not in known:
            raise ConfigError(
                f"{scheme}:{text}: unknown option {name!r}; known are {', '.join(known)}"
            )
        least, most = known[name]
        try:
            value = float(said)
        except ValueError:
            value = math.nan
        if not least <= value <= most:
            raise ConfigError(
                f"{scheme}:{text}: {name} is {said!r}; give a number from {least:g} to {most:g}"
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


def why_not(error: OSError, place: LinePlace) -> str:
    """What a person can do about a line that cannot be opened or read."""
    if isinstance(error, socket.gaierror):
        return f"nobody here knows the name {place.host}; check the address"
    if isinstance(error, TimeoutError):
        return "it does not answer; is it on, and this machine in its network?"
    return _WHY.get(error.errno or 0, str(error))
