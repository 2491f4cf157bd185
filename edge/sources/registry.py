"""Registry of sources.  A new kind of source is a file and a line in ``SOURCES``."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches

from edge.sources.black_box import BlackBoxSource
from edge.sources.bus import BusSource
from edge.sources.iio.source import IioSource
from edge.sources.interface import Quantity, Source, SourceKind
from edge.sources.recording import RecordingSource
from edge.sources.sensor_group import SensorGroup
from edge.sources.simulated import SimulatedSource, worn_by_one
from edge.sources.tabletop import TabletopSource
from edge.sources.ximu3.source import Ximu3Source
from shared.errors import ConfigError

_OF_THE_UNIT = frozenset(Quantity)  # whatever the unit that was recorded, or that sends, has
_OF_A_FILE = frozenset(
    {Quantity.MAGNETIC_FIELD, Quantity.PRESSURE, Quantity.SENSOR_TEMPERATURE}
)  # where the file has the columns

SOURCES: tuple[SourceKind, ...] = (
    SourceKind("recording", RecordingSource, "PATH", _OF_A_FILE),
    SourceKind(
        "simulated", SimulatedSource, "SCENARIO", frozenset(Quantity) - {Quantity.MAYDAY_BUTTON}
    ),
    SourceKind("mcap", BlackBoxSource, "PATH", _OF_THE_UNIT),
    SourceKind(
        "bench",
        TabletopSource,
        "SEED",
        frozenset({Quantity.MAGNETIC_FIELD, Quantity.SENSOR_TEMPERATURE}),
    ),
    SourceKind("bus", BusSource, "UNIT", _OF_THE_UNIT),
    SourceKind(
        "ximu3",
        Ximu3Source,
        "tcp://HOST:PORT or /dev/PORT?baud=115200",
        frozenset(
            {
                Quantity.MAGNETIC_FIELD,
                Quantity.SENSOR_TEMPERATURE,
                Quantity.BATTERY,
                Quantity.ACKNOWLEDGE_BUTTON,
            }
        ),
    ),
    SourceKind(
        "iio",
        IioSource,
        "DEVICE or ACCEL+GYRO, each NAME[@ADDRESS], ?rate=400",
        frozenset({Quantity.MAGNETIC_FIELD, Quantity.PRESSURE, Quantity.SENSOR_TEMPERATURE}),
    ),
)


def open_sensor(text: str, place: str) -> Source:
    """Open the source of the only sensor; a simulated one is worn at ``place`` where that is set.

    Raises ``ConfigError`` and others, as ``open_source``.
    """
    return open_source(worn_by_one(text, 0, place))


def open_source(text: str) -> Source:
    """Open the source that ``scheme:argument`` names, as in ``recording:PATH``.

    Raises ``ConfigError`` for a text that names no source, and whatever
    ``MusterError`` the source itself raises for its argument.
    """
    return source_kind(text).make(text.partition(":")[2])


def open_sensors(sources: Mapping[str, str], places: Mapping[str, str]) -> Source:
    """Open the sources of several sensors of one person, each under the name of its sensor.

    A simulated one is worn where ``places`` has it, by the person whom the first one simulates.
    """
    return SensorGroup(
        {
            name: open_source(worn_by_one(text, number, places.get(name, "")))
            for number, (name, text) in enumerate(sources.items())
        }
    )


def source_kind(text: str) -> SourceKind:
    """Return the kind of the source that ``scheme:argument`` names.  Raises ConfigError."""
    scheme, colon, argument = text.partition(":")
    for kind in SOURCES:
        if colon and argument and kind.scheme == scheme:
            return kind
    choices = ", ".join(f"{kind.scheme}:{kind.argument}" for kind in SOURCES)
    schemes = [kind.scheme for kind in SOURCES]
    if scheme in schemes:
        raise ConfigError(f"source {text!r} says nothing after {scheme}:; write one of {choices}")
    near = get_close_matches(scheme, schemes, n=1)
    hint = f"did you mean {near[0]}:? " if near else ""
    raise ConfigError(f"unknown source {text!r}; {hint}Known are {choices}")
