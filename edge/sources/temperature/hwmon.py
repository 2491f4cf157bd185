"""Temperature sensors of the kernel's hardware monitoring class.

``/sys/class/hwmon/hwmonN``: ``name`` of the chip, ``tempM_input`` in thousandths of a degree
Celsius, ``tempM_label``, and ``tempM_fault``, which is 1 where the chip finds its sensor open or
shorted.
The number N changes from start to start: a chip is found by its name.
"""

from __future__ import annotations

import re
from pathlib import Path

from edge.sources.device_name import find_device, listing, parse_device_name
from edge.sources.polled_device import Unreadable
from edge.sources.sysfs import no_number, number_in, read_if_there, read_text
from edge.sources.temperature.interface import SensorRole, several_temperatures
from shared.coded_text import CodedText, coded
from shared.errors import ConfigError

# Chips that measure the machine itself, by their drivers' names.
_MACHINE = re.compile(
    r"coretemp|k8temp|k10temp|zenpower|fam15h_power|via_cputemp|acpitz|pch_.*|"
    r"(cpu|gpu|soc|bigcore\d*|littlecore\d*|center|package)_?thermal|.*_cpu.*|cpu.*|"
    r"rp1_adc|raspberrypi_hwmon|nvme|drivetemp|amdgpu|nouveau|i915|xe|iwlwifi.*"
)
_INPUT = re.compile(r"(temp\d+)_input")


class HwmonSensor:
    """Sensor ``CHIP[@ADDRESS][/INPUT]``; INPUT is the label or ``temp1``."""

    def __init__(self, text: str, role: SensorRole, sysfs: Path) -> None:
        """Raises ConfigError."""
        self._wanted = parse_device_name("hwmon", text)
        self._role = role
        self._folder = sysfs / "class" / "hwmon"
        if role is SensorRole.ENVIRONMENT and _MACHINE.fullmatch(self._wanted.name):
            raise ConfigError(f"hwmon:{text}: {_refusal(self._wanted.name)}")

    def read_degc(self) -> float | Unreadable:
        chip = find_device(self._folder, self._wanted, "hwmon chip")
        if isinstance(chip, Unreadable):
            return chip
        if self._role is SensorRole.ENVIRONMENT and _is_thermal_zone(chip):
            return Unreadable(_refusal(self._wanted.name))
        found = self._input(chip)
        if isinstance(found, Unreadable):
            return found
        if read_if_there(chip / f"{found}_fault") == "1":
            return Unreadable(
                coded(
                    "temperature-chip-fault",
                    "open circuit or short: the chip reports a fault of its sensor",
                )
            )
        text = read_text(chip / f"{found}_input")
        milli_degc = number_in(text)
        if milli_degc is None:
            return Unreadable(no_number(f"{found}_input", text))
        return milli_degc * 1e-3

    def _input(self, chip: Path) -> str | Unreadable:
        """Return the prefix of the input's attributes, such as ``temp1``."""
        matches = filter(None, (_INPUT.fullmatch(each.name) for each in chip.iterdir()))
        labels = {
            match[1]: read_if_there(chip / f"{match[1]}_label") or match[1] for match in matches
        }
        if not self._wanted.channel and len(labels) == 1:
            return next(iter(labels))
        for name, label in labels.items():
            if self._wanted.channel in (name, label):
                return name
        there = listing(sorted(f"{self._wanted}/{label}" for label in labels.values()))
        if not self._wanted.channel:
            return Unreadable(several_temperatures(str(self._wanted), len(labels), there))
        return Unreadable(
            coded(
                "temperature-no-input",
                "{device} has no input {name}; {listed}",
                device=str(self._wanted),
                name=self._wanted.channel,
                listed=there,
            )
        )


def _is_thermal_zone(chip: Path) -> bool:
    """Return True for a zone of the machine's own cooling, whatever its name."""
    return (chip / "device").resolve().name.startswith("thermal_zone")


def _refusal(name: str) -> CodedText:
    return coded(
        "temperature-of-machine",
        "{name} measures the machine itself, not the air around it; write role=electronics to "
        "have it as the unit's own temperature",
        name=name,
    )
