"""Battery of the unit's computer, as the kernel's power supply class shows it.

``/sys/class/power_supply/NAME``: ``type`` is Battery; ``capacity`` in per cent, or the charge
(uAh) or energy (uWh) now and full; ``status``; ``time_to_empty_avg`` or ``time_to_empty_now`` in
seconds, else that follows from the present current (uA) or power (uW), averaged over a minute.
"""

from __future__ import annotations

import math
from pathlib import Path

from edge.samples import BatterySample
from edge.sources.device_name import listing
from edge.sources.polled_device import PolledDevice, Unreadable
from edge.sources.sysfs import SYSFS, devices_in, number_in, read_if_there
from shared.clock import Clock
from shared.coded_text import coded
from shared.errors import ConfigError
from shared.messages import BatteryState

AUTO = "auto"  # the one battery that there is
_PERIOD_S = 5.0
_AVERAGE_S = 60.0
_LONGEST_S = 240 * 3600.0  # more is no estimate: the current was next to nothing
_STATES = {
    "Charging": BatteryState.CHARGING,
    "Discharging": BatteryState.DISCHARGING,
    "Full": BatteryState.FULL,
    "Not charging": BatteryState.FULL,
}
_AMOUNTS = (("energy", "power"), ("charge", "current"))  # what is stored, and what flows


class BatteryReader:
    """``start``, then ``take`` what was read; see ``edge.sources.interface.AuxiliarySource``."""

    def __init__(self, name: str, clock: Clock, sysfs: Path = SYSFS) -> None:
        """Raises ConfigError."""
        if "/" in name or name in (".", ".."):
            raise ConfigError(
                f"battery {name!r} is no name of a power supply; write one of those in "
                f"/sys/class/power_supply, or {AUTO}"
            )
        battery = _Battery(name, clock, sysfs / "class" / "power_supply")
        self._device = PolledDevice(
            coded("device-battery", "battery {name}", name=name), battery.read, _PERIOD_S, clock
        )

    def start(self) -> None:
        self._device.start()

    def take(self) -> tuple[BatterySample, ...]:
        return self._device.take()

    def take_faults(self) -> tuple[str, ...]:
        return self._device.take_faults()

    def close(self) -> None:
        self._device.stop()
        self._device.join()


class _Battery:
    def __init__(self, name: str, clock: Clock, folder: Path) -> None:
        self._name = name
        self._clock = clock
        self._folder = folder
        self._flow = math.nan  # average

    def read(self) -> BatterySample | Unreadable:
        battery = self._find()
        if isinstance(battery, Unreadable):
            return battery
        if read_if_there(battery / "present") == "0":
            return Unreadable(coded("battery-out", "no battery is inserted"))
        level = _level(battery)
        if not 0.0 <= level <= 1.0:
            return Unreadable(coded("battery-no-charge", "it shows no charge between 0 and 100 %"))
        state = _STATES.get(read_if_there(battery / "status") or "", BatteryState.UNKNOWN)
        left_s = self._left_s(battery) if state is BatteryState.DISCHARGING else math.nan
        if state is not BatteryState.DISCHARGING:
            self._flow = math.nan
        return BatterySample(self._clock.monotonic_ns(), level, left_s, state, battery.name)

    def _find(self) -> Path | Unreadable:
        supplies = devices_in(self._folder)
        batteries = [one for one in supplies if _is_battery(one)]
        there = ", ".join(one.name for one in batteries)
        if self._name == AUTO:
            if len(batteries) == 1:
                return batteries[0]
            return Unreadable(
                coded(
                    "batteries-several",
                    "there are {count} batteries; name one of {there}",
                    count=len(batteries),
                    there=there,
                )
                if batteries
                else coded("battery-none", "this machine has no battery that the kernel shows")
            )
        found = next((one for one in supplies if one.name == self._name), None)
        if found is None or found not in batteries:
            listed = (
                coded("batteries-there", "batteries are {there}", there=there)
                if there
                else listing(())
            )
            return Unreadable(
                coded(
                    "battery-unknown",
                    "there is no battery named {name}; {listed}",
                    name=self._name,
                    listed=listed,
                )
            )
        return found

    def _left_s(self, battery: Path) -> float:
        for attribute in ("time_to_empty_avg", "time_to_empty_now"):
            given_s = _number(battery, attribute)
            if 0.0 < given_s <= _LONGEST_S:
                return given_s
        for amount, flow in _AMOUNTS:
            stored = _number(battery, f"{amount}_now")
            present = abs(_number(battery, f"{flow}_now"))  # some drivers show it with a sign
            if stored >= 0.0 and present > 0.0:
                left_s = 3600.0 * stored / self._averaged(present)
                return left_s if left_s <= _LONGEST_S else math.nan
        return math.nan

    def _averaged(self, flow: float) -> float:
        share = 1.0 if math.isnan(self._flow) else _PERIOD_S / _AVERAGE_S
        self._flow = flow if share == 1.0 else self._flow + share * (flow - self._flow)
        return self._flow


def _is_battery(supply: Path) -> bool:
    """Return True for a battery of this machine, not of a mouse or the like."""
    is_battery = read_if_there(supply / "type") == "Battery"
    return is_battery and read_if_there(supply / "scope") != "Device"


def _level(battery: Path) -> float:
    percent = _number(battery, "capacity")
    if not math.isnan(percent):
        return percent / 100.0
    for amount, _ in _AMOUNTS:
        stored, full = _number(battery, f"{amount}_now"), _number(battery, f"{amount}_full")
        if full > 0.0:
            return min(1.0, stored / full)  # a new one may hold more than it was made for
    return math.nan


def _number(device: Path, attribute: str) -> float:
    """Return a number; NaN where the driver does not have it or has none now."""
    text = read_if_there(device / attribute)
    number = None if text is None else number_in(text)
    return math.nan if number is None else number
