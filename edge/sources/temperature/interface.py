"""Interface of temperature sensors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Protocol

from edge.sources.polled_device import Unreadable
from shared.coded_text import CodedText, coded

RANGE_DEGC = (-55.0, 1250.0)  # what any of them can measure; beyond is a fault, not heat


class SensorRole(StrEnum):
    """Place whose temperature a sensor measures."""

    ENVIRONMENT = "environment"  # the air around the equipment: heat alarms
    ELECTRONICS = "electronics"  # inside the unit: it shows whether the unit will last


def several_temperatures(device: str, count: int, listed: str) -> CodedText:
    """Reason that a device is not read: none of its temperatures is named in the settings."""
    return coded(
        "temperatures-several",
        "{device} has {count} temperatures; {listed}",
        device=device,
        count=count,
        listed=listed,
    )


class TemperatureSensor(Protocol):
    """Sensor that is read when asked; called by one thread."""

    def read_degc(self) -> float | Unreadable:
        """Return the temperature now; may take a second.  Raises OSError where the kernel does."""
        ...


@dataclass(frozen=True, slots=True)
class SensorKind:
    """Kind of temperature sensor, as written ``scheme:argument``."""

    scheme: str
    make: Callable[
        [str, SensorRole, Path], TemperatureSensor
    ]  # argument, role, where sysfs is mounted
    argument: str  # what stands after the colon, for help texts
