"""Temperature sensors of the kernel's Industrial I/O, such as thermocouple converters.

``/sys/bus/iio/devices/iio:deviceN``: ``in_temp_raw``, to which ``in_temp_offset`` is added and
which ``in_temp_scale`` makes thousandths of a degree Celsius, or ``in_temp_input``, which is that.
``in_temp_ambient_*`` is the cold junction: the converter's own temperature.

How an open circuit or a short shows, by the kernel's drivers: MAX31856 has ``fault_oc`` and
``fault_ovuv``, and fails with EIO; MAX31855 and MAX6675 (driver ``maxim_thermocouple``) fail with
EINVAL for either; MCP9600 shows neither.
"""

from __future__ import annotations

import errno
import re
from pathlib import Path

from edge.fault_texts import fault_of
from edge.sources.device_name import find_device, listing, parse_device_name
from edge.sources.iio.attributes import (
    IIO_DEVICES,
    UnusableDeviceError,
    is_one,
    read_scaled,
)
from edge.sources.polled_device import Unreadable
from edge.sources.temperature.interface import SensorRole, several_temperatures
from shared.coded_text import coded, text_of_error
from shared.errors import ConfigError

_CHANNEL = re.compile(r"in_temp_?(\w*?)_?(?:raw|input)")
_KIND = "in_temp"
_COLD_JUNCTION = "ambient"
_UNSIGNED_BITS = {"mcp9600": 16}  # its driver hands over the register without its sign
_FAULTS = {
    "fault_oc": coded(
        "thermocouple-open", "open circuit: the thermocouple is broken or not connected"
    ),
    "fault_ovuv": coded(
        "thermocouple-short",
        "short circuit: over- or undervoltage at the thermocouple's input",
    ),
}


class IioSensor:
    """Sensor ``NAME[@ADDRESS][/CHANNEL]``; CHANNEL is what stands behind ``in_temp`` in sysfs."""

    def __init__(self, text: str, role: SensorRole, sysfs: Path) -> None:
        """Raises ConfigError."""
        self._wanted = parse_device_name("iio", text)
        self._folder = sysfs / IIO_DEVICES
        if self._wanted.channel == _COLD_JUNCTION and role is SensorRole.ENVIRONMENT:
            raise ConfigError(
                f"iio:{text}: {_COLD_JUNCTION} is the cold junction, which is the converter's own "
                "temperature; write role=electronics to have it as that"
            )

    def read_degc(self) -> float | Unreadable:
        device = find_device(self._folder, self._wanted, "IIO device")
        if isinstance(device, Unreadable):
            return device
        channel = self._channel(device)
        if isinstance(channel, Unreadable):
            return channel
        for attribute, fault in _FAULTS.items():
            if is_one(device / attribute):
                return Unreadable(fault)
        try:
            signed_bits = _UNSIGNED_BITS.get(self._wanted.name)
            return 1e-3 * read_scaled(device, channel, _KIND, signed_bits=signed_bits)
        except UnusableDeviceError as error:
            return Unreadable(fault_of(str(self._wanted), text_of_error(error)))
        except OSError as error:
            if error.errno == errno.EINVAL:
                return Unreadable(
                    coded(
                        "thermocouple-fault",
                        "open circuit or short: the converter reports a fault of its thermocouple",
                    )
                )
            raise

    def _channel(self, device: Path) -> str | Unreadable:
        """Return the beginning of the channel's attributes, such as ``in_temp``."""
        matches = filter(None, (_CHANNEL.fullmatch(each.name) for each in device.iterdir()))
        channels = sorted({match[1] for match in matches})
        wanted = self._wanted.channel
        if wanted in channels:
            return _beginning(wanted)
        there = listing(f"{self._wanted}/{one}" if one else str(self._wanted) for one in channels)
        if wanted:
            return Unreadable(
                coded(
                    "temperature-unknown",
                    "{device} has no temperature {name}; {listed}",
                    device=str(self._wanted),
                    name=wanted,
                    listed=there,
                )
            )
        others = [one for one in channels if one != _COLD_JUNCTION]
        if len(others) == 1:
            return _beginning(others[0])
        return Unreadable(several_temperatures(str(self._wanted), len(others), there))


def _beginning(channel: str) -> str:
    """Return the beginning of a channel's attributes, such as ``in_temp_ambient``."""
    return f"in_temp_{channel}" if channel[:1].isalpha() else f"in_temp{channel}"
