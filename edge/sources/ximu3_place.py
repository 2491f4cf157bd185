"""Where an x-IMU3 is and how it is set: the text that names it."""

from __future__ import annotations

from dataclasses import dataclass

from edge.sources.line_place import BAUD, LinePlace, line_place, options_of

_PORT = 7000
_BAUD = 115200
_RATE_HZ = 400.0
_OPTIONS = {"baud": BAUD, "rate": (10.0, 400.0), "field": (10.0, 100.0)}  # least, most


@dataclass(frozen=True, slots=True)
class Place:
    line: LinePlace
    rate_hz: float
    field_ut: float | None  # where its magnetometer was calibrated; None: it is not used

    def __str__(self) -> str:
        return f"x-IMU3 at {self.line}"


def place_of(text: str) -> Place:
    """What ``tcp://HOST[:PORT]`` or ``/dev/PATH`` names, with ``?baud=&rate=&field=``.

    Raises ConfigError.
    """
    values = options_of("ximu3", text, _OPTIONS)
    line = line_place("ximu3", text, values, port=_PORT, baud=_BAUD)
    return Place(line, values.get("rate", _RATE_HZ), values.get("field"))
