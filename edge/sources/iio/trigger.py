"""Trigger of a device: the interrupt, or the timer, by which the kernel samples it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from edge.sources.device_name import listing
from edge.sources.iio.attributes import IIO_DEVICES, UnusableDeviceError
from edge.sources.sysfs import devices_in, read_if_there, write_text
from shared.coded_text import coded

_CURRENT = Path("trigger") / "current_trigger"  # below the device
_FREQUENCY = "sampling_frequency"  # of a timer
_NEW_DATA = "-dev"


@dataclass(frozen=True, slots=True)
class Trigger:
    name: str
    folder: Path | None  # None: it is not to be found

    @property
    def is_timer(self) -> bool:
        """True for a timer, which is not synchronous with the device's measurements."""
        return self.folder is not None and (self.folder / _FREQUENCY).exists()

    def attach(self, device: Path, rate_hz: float) -> None:
        """Raises OSError."""
        if self.folder is not None and self.is_timer:
            write_text(self.folder / _FREQUENCY, f"{rate_hz:g}")
        if read_if_there(device / _CURRENT) != self.name:  # some cannot be written
            write_text(device / _CURRENT, self.name)


def needs_trigger(device: Path) -> bool:
    """Return True for a device that does not sample by itself."""
    return (device / _CURRENT).exists()


def find_trigger(device: Path, sysfs: Path, wanted: str) -> Trigger | None:
    """Return the trigger of this name; the device's own for no name, and None where it has none.

    Raises OSError, and UnusableDeviceError where no trigger has the name.
    """
    triggers = {
        read_if_there(folder / "name") or "": folder
        for folder in devices_in(sysfs / IIO_DEVICES)
        if folder.name.startswith("trigger")
    }
    if wanted:
        if wanted not in triggers:
            raise UnusableDeviceError(
                coded(
                    "iio-no-trigger",
                    "there is no trigger {name}; {listed}",
                    name=wanted,
                    listed=listing(sorted(triggers)),
                )
            )
        return Trigger(wanted, triggers[wanted])
    current = read_if_there(device / _CURRENT)
    if current:
        return Trigger(current, triggers.get(current))
    bus_device = device.resolve().parent
    own = [name for name, folder in triggers.items() if folder.resolve().parent == bus_device]
    # One of new data is named by the device, others by what they wait for, such as a motion.
    name = min(own, key=lambda each: (_NEW_DATA not in each, each), default=None)
    return None if name is None else Trigger(name, triggers[name])
