"""Settings of an inertial sensor, as written behind ``iio:``."""

from __future__ import annotations

from dataclasses import dataclass
from urllib.parse import parse_qsl

from edge.sources.device_name import DeviceName, parse_device_name
from shared.errors import ConfigError
from shared.options import number_within

_SCHEME = "iio"
_OPTIONS = ("rate", "trigger", "mag", "pressure")
_RATE_HZ = (25.0, 2000.0)  # least and most


@dataclass(frozen=True, slots=True)
class IioSettings:
    accel: DeviceName
    gyro: DeviceName  # the same one, where a device has both
    rate_hz: float | None = None  # None: what the driver offers nearest to the usual one
    trigger: str = ""  # name; empty: the device's own
    mag: DeviceName | None = None  # None: where the inertial sensor has one, that
    pressure: DeviceName | None = None

    @property
    def separate_mag(self) -> DeviceName | None:
        """Magnetometer that is another device than the inertial sensor."""
        return None if self.mag in (self.accel, self.gyro) else self.mag

    def __str__(self) -> str:
        return "+".join(dict.fromkeys((str(self.accel), str(self.gyro))))


def parse_settings(text: str) -> IioSettings:
    """Return the settings in ``DEVICE`` or ``ACCEL+GYRO``, each ``NAME[@ADDRESS]``, with
    ``?rate=&trigger=&mag=&pressure=``.

    Raises ConfigError.
    """
    names, _, options = text.partition("?")
    values = _parse_options(text, options)
    devices = [_parse_name(text, name) for name in names.split("+")]
    if len(devices) > 2:
        raise ConfigError(f"{_SCHEME}:{text} names {len(devices)} devices; write ACCEL+GYRO")
    settings = IioSettings(
        accel=devices[0],
        gyro=devices[-1],
        rate_hz=_parse_rate(text, values.get("rate")),
        trigger=values.get("trigger", ""),
        mag=_parse_name(text, values["mag"]) if "mag" in values else None,
        pressure=_parse_name(text, values["pressure"]) if "pressure" in values else None,
    )
    if settings.pressure in devices:
        raise ConfigError(
            f"{_SCHEME}:{text}: {settings.pressure} is captured as the inertial sensor; a "
            "barometer has to be another device"
        )
    return settings


def _parse_name(text: str, name: str) -> DeviceName:
    device = parse_device_name(_SCHEME, name)
    if device.channel:
        raise ConfigError(f"{_SCHEME}:{text}: {name} names a channel; write the device alone")
    return device


def _parse_options(text: str, options: str) -> dict[str, str]:
    values: dict[str, str] = {}
    for name, value in parse_qsl(options, keep_blank_values=True):
        if name not in _OPTIONS:
            known = ", ".join(_OPTIONS)
            raise ConfigError(f"{_SCHEME}:{text}: unknown option {name!r}; known are {known}")
        values[name] = value
    return values


def _parse_rate(text: str, given: str | None) -> float | None:
    if given is None:
        return None
    least_hz, most_hz = _RATE_HZ
    rate_hz = number_within(given, least_hz, most_hz)
    if rate_hz is None:
        raise ConfigError(
            f"{_SCHEME}:{text}: rate is {given!r}; give a number from {least_hz:g} to {most_hz:g}"
        )
    return rate_hz
