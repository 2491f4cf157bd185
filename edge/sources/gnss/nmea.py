"""Receiver with NMEA 0183, on a serial line or over TCP."""

from __future__ import annotations

from edge.sources.gnss.interface import Report
from edge.sources.gnss.nmea_epochs import Epochs
from edge.sources.gnss.nmea_sentences import LONGEST, sentence_of
from edge.sources.transport.address import BAUD, TransportAddress, parse_address, parse_options
from edge.sources.transport.connection import Connection
from shared.coded_text import CodedText, coded

_BAUD = 9600
_LATENCY_S = 0.1  # receivers for people compute for 0.05 to 0.2 s
LATENCY = (0.0, 2.0)  # least and most
_UBX = b"\xb5b"
_OPTIONS = {"baud": BAUD, "latency": LATENCY}


class Nmea:
    """``text`` is a serial port's path or ``tcp://HOST:PORT``, with ``?baud=9600&latency=0.1``.

    Raises ConfigError for what names neither.
    """

    def __init__(self, text: str) -> None:
        values = parse_options("nmea", text, _OPTIONS)
        self.place: TransportAddress = parse_address("nmea", text, values, port=None, baud=_BAUD)
        self.latency_s = values.get("latency", _LATENCY_S)
        self.longest = LONGEST
        self.hint = coded(
            "gps-hint-line",
            "is the cable good, this the right device, and on a serial line ?baud= right?",
        )
        self._forget()

    def __str__(self) -> str:
        return str(self.title)

    @property
    def title(self) -> CodedText:
        return coded("device-gps", "GPS receiver at {place}", place=str(self.place))

    def open(self) -> Connection:
        line = self.place.open()
        self._forget()
        return line

    def parse_line(self, line: bytes, began_ns: int) -> tuple[Report, ...]:
        self._is_binary |= _UBX in line
        sentence = sentence_of(line)
        if sentence is None:
            return ()
        self._kinds.add(sentence.kind)
        return self._epochs.push(sentence, began_ns)

    def end_of_burst(self) -> tuple[Report, ...]:
        return self._epochs.end_of_burst()

    def silence_reason(self) -> str:
        if self._kinds & {"GGA", "GNS", "RMC"}:
            return ""
        if self._kinds:
            return coded(
                "gps-no-places",
                "it sends {kinds} and no GGA, GNS or RMC sentences; switch GGA and RMC on in its "
                "settings",
                kinds=", ".join(sorted(self._kinds)),
            )
        if self._is_binary:
            return coded(
                "gps-binary",
                "it sends u-blox's binary messages and no NMEA; switch NMEA on in its settings, or "
                "let gpsd read it",
            )
        return ""

    def _forget(self) -> None:
        self._epochs = Epochs()
        self._kinds: set[str] = set()
        self._is_binary = False
