"""Registry of satellite receivers.  A new kind is a file and a line in ``RECEIVERS``."""

from __future__ import annotations

from difflib import get_close_matches

from edge.sources.gnss.gpsd import Gpsd
from edge.sources.gnss.interface import ReceiverKind
from edge.sources.gnss.nmea import Nmea
from edge.sources.gnss.reader import GnssReader
from shared.clock import Clock
from shared.errors import ConfigError

RECEIVERS: tuple[ReceiverKind, ...] = (
    ReceiverKind("gpsd", Gpsd, "//HOST:PORT"),
    ReceiverKind("nmea", Nmea, "/dev/PORT?baud=9600 or nmea:tcp://HOST:PORT"),
)


def open_receiver(text: str, clock: Clock) -> GnssReader:
    """Return a reader of what ``scheme:argument`` names, as in ``gpsd://127.0.0.1``.

    Raises ConfigError for a text that names no receiver.
    """
    scheme, colon, argument = text.partition(":")
    for kind in RECEIVERS:
        if colon and argument and kind.scheme == scheme:
            return GnssReader(kind.make(argument), clock)
    choices = ", ".join(f"{kind.scheme}:{kind.argument}" for kind in RECEIVERS)
    near = get_close_matches(scheme, [kind.scheme for kind in RECEIVERS], n=1)
    hint = f"did you mean {near[0]}:? " if near and near[0] != scheme else ""
    raise ConfigError(f"{text!r} names no GPS receiver; {hint}Known are {choices}")
