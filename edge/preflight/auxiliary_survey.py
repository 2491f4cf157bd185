"""Survey of what a unit reads beside its inertial sensor: temperatures, batteries, satellites,
beacons and buttons.

A device that is configured and gives nothing has failed; a device that the unit lacks is a finding,
too, with its consequence.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from edge.agent.batteries import Batteries
from edge.config import EdgeConfig
from edge.preflight.finding import CheckFinding, Severity
from edge.samples import (
    AmbientSample,
    BatterySample,
    ButtonPress,
    ElectronicsSample,
    GpsSample,
    OtherSample,
    SightingSample,
)
from edge.sources.interface import Quantity
from edge.sources.temperature.registry import sensor_name

_TEMPERATURE_DEGC = (-40.0, 60.0)  # around a unit, and inside one, before its wearer goes in
_BATTERY_LOW, _BATTERY_EMPTY = 0.5, 0.2  # of full; half lasts an incident
_LEFT_MIN_S = 3600.0
_FIX_STD_MAX_M = 20.0
_TWO_DIMENSIONAL = 2  # fix type
_BUTTONS = frozenset({Quantity.MAYDAY_BUTTON, Quantity.ACKNOWLEDGE_BUTTON})

_NO_HEAT_ALARM = "no heat alarm for this wearer: give --temperature"
_NO_LOW_BATTERY = "there is no warning before it is empty: give --battery"
_NO_MAYDAY = "the wearer cannot call a mayday with this unit: give --button"


class AuxiliarySurvey:
    """Takes in samples; ``findings`` then compares them with what the unit should have."""

    def __init__(self, config: EdgeConfig, gives: frozenset[Quantity]) -> None:
        """``gives``: quantities that the source may give."""
        self._config = config
        self._gives = gives | _BUTTONS if config.button else gives
        self._temperatures: dict[str, float] = {}  # by sensor, the newest
        self._batteries = Batteries()
        self._best_fix: GpsSample | None = None
        self._has_receiver_answered = False
        self._sightings = 0
        self._buttons: set[str] = set()
        self._newest_ns = 0

    def push(self, sample: OtherSample) -> None:
        self._newest_ns = max(self._newest_ns, sample.t_ns)
        match sample:
            case AmbientSample() | ElectronicsSample():
                self._temperatures[sample.sensor] = sample.temperature_degc
            case BatterySample():
                self._batteries.push(sample)
            case GpsSample():
                self._note_fix(sample)
            case SightingSample():
                self._sightings += 1
            case ButtonPress():
                self._buttons.add(sample.button)

    def findings(self, *, asks_press: bool = True) -> Iterator[CheckFinding]:
        """``asks_press``: a person was asked to press the button."""
        yield from self._temperature()
        yield from self._battery()
        yield from self._gnss()
        if self._config.sightings:
            text = f"{self._sightings} sightings"
            yield CheckFinding(
                "beacons", Severity.OK, text if self._sightings else "none in reach now"
            )
        yield from self._button(asks_press=asks_press)

    def _note_fix(self, fix: GpsSample) -> None:
        self._has_receiver_answered = True
        if fix.fix_type >= _TWO_DIMENSIONAL and (
            self._best_fix is None or fix.horizontal_std_m < self._best_fix.horizontal_std_m
        ):
            self._best_fix = fix

    def _temperature(self) -> Iterator[CheckFinding]:
        subject = "temperature"
        if not self._config.temperatures and not self._temperatures:
            yield CheckFinding(subject, Severity.WARNING, "the unit has no sensor", _NO_HEAT_ALARM)
        for sensor in map(sensor_name, self._config.temperatures):
            if sensor not in self._temperatures:
                yield CheckFinding(
                    f"{subject} {sensor}", Severity.FAILED, "no reading", _NO_HEAT_ALARM
                )
        least_degc, most_degc = _TEMPERATURE_DEGC
        for sensor, degc in sorted(self._temperatures.items()):
            is_plausible = least_degc <= degc <= most_degc
            yield CheckFinding(
                f"{subject} {sensor}".strip(),
                Severity.OK if is_plausible else Severity.WARNING,
                f"{degc:.1f} °C",
                "" if is_plausible else "out here it makes no sense: check the sensor's wiring",
            )

    def _battery(self) -> Iterator[CheckFinding]:
        battery = self._batteries.emptiest(self._newest_ns)
        if battery is None:
            is_set = bool(self._config.battery)
            level = Severity.FAILED if is_set else Severity.WARNING
            text = "no reading" if is_set else "the unit does not know its battery"
            yield CheckFinding("battery", level, text, _NO_LOW_BATTERY)
            return
        text = f"{battery.level:.0%} of {battery.battery or 'the sensor'}"
        if math.isfinite(battery.left_s):
            text += f", {battery.left_s / 3600.0:.1f} h left"
        if battery.level < _BATTERY_EMPTY:
            yield CheckFinding("battery", Severity.FAILED, text, "charge or change it")
        elif battery.level < _BATTERY_LOW or battery.left_s < _LEFT_MIN_S:
            yield CheckFinding("battery", Severity.WARNING, text, "it may not last the incident")
        else:
            yield CheckFinding("battery", Severity.OK, text)

    def _gnss(self) -> Iterator[CheckFinding]:
        subject, fix = "satellites", self._best_fix
        if not self._config.gps and Quantity.FIX not in self._gives:
            yield CheckFinding(
                subject,
                Severity.WARNING,
                "the unit has no receiver",
                "its place on the map has to come from a pin, a beacon or the others",
            )
        elif not self._has_receiver_answered:
            if self._config.gps:
                yield CheckFinding(
                    subject, Severity.FAILED, "the receiver is silent", "check its cable"
                )
        elif fix is None or not fix.horizontal_std_m <= _FIX_STD_MAX_M:
            yield CheckFinding(
                subject, Severity.WARNING, "no fix yet", "wait under the open sky before going in"
            )
        else:
            text = f"fix of {fix.satellites} satellites, {fix.horizontal_std_m:.0f} m"
            yield CheckFinding(subject, Severity.OK, text)

    def _button(self, *, asks_press: bool) -> Iterator[CheckFinding]:
        if Quantity.MAYDAY_BUTTON not in self._gives:
            yield CheckFinding("mayday button", Severity.WARNING, "the unit has none", _NO_MAYDAY)
        if self._buttons:
            yield CheckFinding(
                "button", Severity.OK, f"pressed: {', '.join(sorted(self._buttons))}"
            )
        elif asks_press and not self._gives.isdisjoint(_BUTTONS):
            yield CheckFinding(
                "button", Severity.WARNING, "not pressed during the check", "press it once"
            )
