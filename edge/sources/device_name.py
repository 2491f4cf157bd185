"""Names of devices as they are written in settings: ``NAME[@ADDRESS][/CHANNEL]``."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from edge.sources.polled_device import Unreadable
from edge.sources.sysfs import address_of, devices_in, read_if_there
from shared.coded_text import coded
from shared.errors import ConfigError


@dataclass(frozen=True, slots=True)
class DeviceName:
    """Name of a device, and of one of its channels."""

    name: str
    address: str = ""  # on its bus; empty: there is one device of this name
    channel: str = ""  # empty: there is one channel

    def __str__(self) -> str:
        address = f"@{self.address}" if self.address else ""
        return f"{self.name}{address}"


def parse_device_name(scheme: str, text: str) -> DeviceName:
    """Raises ConfigError."""
    device, slash, channel = text.partition("/")
    name, at, address = device.partition("@")
    if not name or (at and not address) or (slash and not channel):
        raise ConfigError(
            f"{scheme}:{text} names no device; write {scheme}:NAME, {scheme}:NAME/CHANNEL or "
            f"{scheme}:NAME@ADDRESS where there are several of that name"
        )
    return DeviceName(name, address, channel)


def find_device(folder: Path, wanted: DeviceName, what: str) -> Path | Unreadable:
    """Return the device of a class or bus that has this name.  Raises OSError."""
    named = {device: read_if_there(device / "name") for device in devices_in(folder)}
    found = [device for device, name in named.items() if name == wanted.name]
    if wanted.address:
        found = [device for device in found if address_of(device) == wanted.address]
    if not found:
        there = listing(f"{name}@{address_of(device)}" for device, name in named.items() if name)
        return Unreadable(
            coded(
                "device-unknown",
                "there is no {kind} named {name}; {listed}",
                kind=what,
                name=str(wanted),
                listed=there,
            )
        )
    if len(found) > 1:
        names = ", ".join(f"{wanted.name}@{address_of(device)}" for device in found)
        return Unreadable(
            coded(
                "devices-several",
                "there are {count} named {name}; write one of {names}",
                count=len(found),
                name=wanted.name,
                names=names,
            )
        )
    return found[0]


def listing(names: Iterable[str]) -> str:
    """Return a sentence with what is there."""
    there = ", ".join(names)
    if not there:
        return coded("devices-none", "there is none at all")
    return coded("devices-there", "there are {there}", there=there)
