"""Registry of temperature sensors.  A new kind is a file and a line in ``TEMPERATURE_SENSORS``."""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path
from urllib.parse import parse_qsl

from edge.sources.sysfs import SYSFS
from edge.sources.temperature.hwmon import HwmonSensor
from edge.sources.temperature.iio import IioSensor
from edge.sources.temperature.interface import SensorKind, SensorRole
from edge.sources.temperature.reader import NamedSensor, TemperatureReader
from edge.sources.temperature.w1 import W1Sensor
from shared.clock import Clock
from shared.errors import ConfigError

TEMPERATURE_SENSORS: tuple[SensorKind, ...] = (
    SensorKind("hwmon", HwmonSensor, "CHIP[@ADDRESS][/INPUT]"),
    SensorKind("iio", IioSensor, "DEVICE[@ADDRESS][/CHANNEL]"),
    SensorKind("w1", W1Sensor, "28-0123456789ab"),
)

_LONGEST_NAME = 32
_OPTIONS = ("name", "role")
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9 _.-]{0,31}")


def open_temperature_reader(
    texts: Iterable[str], clock: Clock, sysfs: Path = SYSFS
) -> TemperatureReader:
    """Return a reader of the sensors that ``scheme:argument?name=NAME&role=ROLE`` name.

    Raises ConfigError.
    """
    sensors = [_named_sensor(text, sysfs) for text in texts]
    names = [sensor.name for sensor in sensors]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ConfigError(
            f"two temperature sensors are named {twice}; tell them apart, as in ?name=front"
        )
    return TemperatureReader(sensors, clock)


def sensor_name(text: str) -> str:
    """Return the name that the readings of a sensor bear.  Raises ConfigError."""
    place, _, options = text.partition("?")
    name = _options(text, options).get("name")
    return place.partition(":")[2][:_LONGEST_NAME] if name is None else name


def _named_sensor(text: str, sysfs: Path) -> NamedSensor:
    place, _, options = text.partition("?")
    scheme, colon, argument = place.partition(":")
    values = _options(text, options)
    role = _role(text, values.get("role", SensorRole.ENVIRONMENT))
    for kind in TEMPERATURE_SENSORS:
        if colon and argument and kind.scheme == scheme:
            sensor = kind.make(argument, role, sysfs)
            return NamedSensor(sensor_name(text), text, role, sensor)
    choices = ", ".join(f"{kind.scheme}:{kind.argument}" for kind in TEMPERATURE_SENSORS)
    schemes = [kind.scheme for kind in TEMPERATURE_SENSORS]
    near = get_close_matches(scheme, schemes, n=1)
    hint = f"did you mean {near[0]}:? " if near and near[0] != scheme else ""
    raise ConfigError(f"{text!r} names no temperature sensor; {hint}Known are {choices}")


def _options(text: str, options: str) -> dict[str, str]:
    values: dict[str, str] = {}
    for option, value in parse_qsl(options, keep_blank_values=True):
        if option not in _OPTIONS:
            known = ", ".join(_OPTIONS)
            raise ConfigError(f"{text}: unknown option {option!r}; known are {known}")
        values[option] = value
    name = values.get("name")
    if name is not None and not _NAME.fullmatch(name):
        raise ConfigError(
            f"{text}: the name {name!r} cannot be used; take 1 to 32 letters, digits, spaces or "
            "_ . -"
        )
    return values


def _role(text: str, value: str) -> SensorRole:
    try:
        return SensorRole(value)
    except ValueError:
        roles = ", ".join(SensorRole)
        raise ConfigError(f"{text}: the role is {value!r}; known are {roles}") from None
