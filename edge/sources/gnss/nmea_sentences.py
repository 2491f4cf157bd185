"""Sentences of NMEA 0183: one line of a receiver, checked and parsed."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from datetime import time

from pynmeagps import NMEAReader
from pynmeagps.exceptions import NMEAMessageError, NMEAParseError, NMEAStreamError, NMEATypeError

from shared.clock import NS_PER_S
from shared.errors import WireError

LONGEST = 512  # bytes of a line: the standard's 82, what makers add, and binary between sentences

# Talker (two letters: GP, GN, GL, GA, GB ...) or P for a maker's own, kind, fields, checksum.
_FRAME = re.compile(rb"\$([A-Z]{2}[A-Z0-9]{3}|P[A-Z0-9]+),([\x20-\x7e]*)\*[0-9A-Fa-f]{2}\r?")
_READ = frozenset({"GGA", "GNS", "RMC", "GST", "GSA"})
_ERRORS = (NMEAMessageError, NMEAParseError, NMEAStreamError, NMEATypeError)
_VALUE_ERRORS = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)


@dataclass(frozen=True, slots=True)
class Sentence:
    """``kind`` without its talker, such as GGA; ``values``: the fields of those that are read."""

    kind: str
    values: dict[str, object]

    def number(self, name: str) -> float:
        """Return a number; NaN where it is empty or none."""
        value = self.values.get(name)
        if isinstance(value, int | float) and math.isfinite(value):
            return float(value)
        return math.nan

    def text(self, name: str) -> str:
        value = self.values.get(name)
        return value if isinstance(value, str) else ""

    @property
    def of_day_ns(self) -> int | None:
        """UTC since midnight; None where it is empty."""
        value = self.values.get("time")
        if not isinstance(value, time):
            return None
        seconds = (value.hour * 60 + value.minute) * 60 + value.second
        return seconds * NS_PER_S + value.microsecond * 1000

    @property
    def place(self) -> tuple[float, float]:
        """Latitude and longitude in degrees; NaN where either, or its hemisphere, is missing."""
        lat_deg, lon_deg = self.number("lat"), self.number("lon")
        sided = self.text("NS") in {"N", "S"} and self.text("EW") in {"E", "W"}
        if not sided or not (math.isfinite(lat_deg) and math.isfinite(lon_deg)):
            return math.nan, math.nan
        return lat_deg, lon_deg


def sentence_of(line: bytes) -> Sentence | None:
    """Return the sentence of a line; None of an empty line, or one of another protocol on the
    same line.

    What stands before the last dollar is left out: the end of something binary, a tag block.
    Raises WireError for what is no whole sentence.
    """
    if not line.strip() or line.startswith(b"!"):  # ships, on a boat's network
        return None
    frame = line[max(0, line.rfind(b"$")) :]
    match = _FRAME.fullmatch(frame)
    if match is None:
        raise WireError("no whole sentence")
    address = match[1].decode("ascii")
    if address.startswith("P") or address[2:] not in _READ:
        return Sentence(address if address.startswith("P") else address[2:], {})
    try:
        message = NMEAReader.parse(frame.rstrip(b"\r") + b"\r\n")
    except (*_ERRORS, *_VALUE_ERRORS) as error:
        raise WireError(" ".join(str(error).split())) from error
    sentence = Sentence(address[2:], {} if message is None else dict(vars(message)))
    lat_deg, lon_deg = sentence.place
    if abs(lat_deg) > 90.0 or abs(lon_deg) > 180.0:
        raise WireError("a place that is not on the Earth")
    return sentence
