"""Temperature sensors on a 1-wire bus, such as a DS18B20, by the kernel's driver ``w1_therm``.

``/sys/bus/w1/devices/FAMILY-ID/temperature`` is in thousandths of a degree Celsius; kernels before
5.8 have only ``w1_slave``, whose first line ends with YES where its checksum is right and whose
second one ends with ``t=`` and the same number.  Reading one converts, which takes up to 0.75 s.
"""

from __future__ import annotations

import errno
import re
from pathlib import Path

from edge.sources.device_name import listing
from edge.sources.polled_device import Unreadable
from edge.sources.sysfs import devices_in, number_in, read_if_there, read_text
from edge.sources.temperature.interface import SensorRole
from shared.errors import ConfigError

_ID = re.compile(r"(?:10|22|28|3b|42)-[0-9a-f]{12}")
_MOST_DEGC = 125.0
_POWER_ON_DEGC = 85.0  # in its register until it has converted once
_STEP_DEGC = 15.0  # what the air may change by between two readings


class W1Sensor:
    """Sensor of an id such as ``28-0316a2794faa``."""

    def __init__(self, text: str, role: SensorRole, sysfs: Path) -> None:  # noqa: ARG002  # any role will do
        """Raises ConfigError."""
        if not _ID.fullmatch(text):
            raise ConfigError(
                f"w1:{text} names no temperature sensor; write its id as in w1:28-0316a2794faa"
            )
        self._id = text
        self._folder = sysfs / "bus" / "w1" / "devices"
        self._last_degc: float | None = None

    def read_degc(self) -> float | Unreadable:
        device = self._folder / self._id
        if not device.is_dir():
            names = (each.name for each in devices_in(self._folder))
            there = listing(f"w1:{name}" for name in names if _ID.fullmatch(name))
            return Unreadable(
                f"there is no 1-wire sensor {self._id}: its wires are open or shorted, or it is "
                f"another one; {there}"
            )
        try:
            found = self._converted(device)
        except OSError as error:
            self._last_degc = None
            if error.errno == errno.EIO:
                return Unreadable("the sensor does not answer: its wires are open or shorted")
            raise
        self._last_degc = None if isinstance(found, Unreadable) else found
        return found

    def _converted(self, device: Path) -> float | Unreadable:
        text = read_if_there(device / "temperature")
        if text is None:
            text = _after_checksum(read_text(device / "w1_slave"))
        milli_degc = number_in(text)
        if milli_degc is None:
            return Unreadable("what came over its wires is garbled; check them, and its supply")
        degc = milli_degc * 1e-3
        if degc > _MOST_DEGC:
            return Unreadable(f"{degc:.2f} °C is what it shows when its supply is too weak")
        if degc == _POWER_ON_DEGC and not self._is_near(degc):
            return Unreadable(
                "85 °C is what it shows before it has measured: its supply is too weak"
            )
        return degc

    def _is_near(self, degc: float) -> bool:
        """Return True if the air may have this temperature, after the reading before."""
        return self._last_degc is not None and abs(degc - self._last_degc) <= _STEP_DEGC


def _after_checksum(text: str) -> str:
    """Return the number of a ``w1_slave`` whose checksum is right; else nothing."""
    first, _, second = text.partition("\n")
    return second.rpartition("t=")[2] if first.endswith("YES") else ""
