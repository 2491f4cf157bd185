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
from edge.preflight.finding import HAS_NONE, NO_READING, CheckFinding, Severity, subject
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
from shared.coded_text import CodedText, Term, coded

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
        """``asks_press``: a person was requested to press the button."""
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
        if not self._config.temperatures and not self._temperatures:
            yield CheckFinding(
                _temperature_subject(""),
                Severity.WARNING,
                coded("check-no-temperature", "the unit has no sensor"),
                _NO_HEAT_ALARM,
            )
        for sensor in map(sensor_name, self._config.temperatures):
            if sensor not in self._temperatures:
                yield CheckFinding(
                    _temperature_subject(sensor), Severity.FAILED, NO_READING, _NO_HEAT_ALARM
                )
        least_degc, most_degc = _TEMPERATURE_DEGC
        for sensor, degc in sorted(self._temperatures.items()):
            is_plausible = least_degc <= degc <= most_degc
            yield CheckFinding(
                _temperature_subject(sensor),
                Severity.OK if is_plausible else Severity.WARNING,
                f"{degc:.1f} °C",
                "" if is_plausible else "out here it makes no sense: check the sensor's wiring",
            )

    def _battery(self) -> Iterator[CheckFinding]:
        battery, about = self._batteries.emptiest(self._newest_ns), subject("battery", "battery")
        if battery is None:
            is_set = bool(self._config.battery)
            level = Severity.FAILED if is_set else Severity.WARNING
            unknown = coded("check-battery-unknown", "the unit does not know its battery")
            yield CheckFinding(about, level, NO_READING if is_set else unknown, _NO_LOW_BATTERY)
            return
        text = _battery_text(battery)
        if battery.level < _BATTERY_EMPTY:
            yield CheckFinding(about, Severity.FAILED, text, "charge or change it")
        elif battery.level < _BATTERY_LOW or battery.left_s < _LEFT_MIN_S:
            yield CheckFinding(about, Severity.WARNING, text, "it may not last the incident")
        else:
            yield CheckFinding(about, Severity.OK, text)

    def _gnss(self) -> Iterator[CheckFinding]:
        about, fix = subject("satellites", "satellites"), self._best_fix
        if not self._config.gps and Quantity.FIX not in self._gives:
            yield CheckFinding(
                about,
                Severity.WARNING,
                coded("check-no-receiver", "the unit has no receiver"),
                "its place on the map has to come from a pin, a beacon or the others",
            )
        elif not self._has_receiver_answered:
            if self._config.gps:
                silent = coded("check-receiver-silent", "the receiver is silent")
                yield CheckFinding(about, Severity.FAILED, silent, "check its cable")
        elif fix is None or not fix.horizontal_std_m <= _FIX_STD_MAX_M:
            yield CheckFinding(
                about,
                Severity.WARNING,
                coded("check-no-fix", "no fix yet"),
                "wait under the open sky before going in",
            )
        else:
            text = f"fix of {fix.satellites} satellites, {fix.horizontal_std_m:.0f} m"
            yield CheckFinding(about, Severity.OK, text)

    def _button(self, *, asks_press: bool) -> Iterator[CheckFinding]:
        if Quantity.MAYDAY_BUTTON not in self._gives:
            yield CheckFinding(
                subject("mayday_button", "mayday button"),
                Severity.WARNING,
                HAS_NONE,
                _NO_MAYDAY,
            )
        if self._buttons:
            yield CheckFinding(
                "button", Severity.OK, f"pressed: {', '.join(sorted(self._buttons))}"
            )
        elif asks_press and not self._gives.isdisjoint(_BUTTONS):
            yield CheckFinding(
                "button", Severity.WARNING, "not pressed during the check", "press it once"
            )


def _temperature_subject(sensor: str) -> CodedText:
    if not sensor:
        return subject("temperature", "temperature")
    term = Term("temperature", "temperature")
    return coded("check-subject-named", "{subject} {sensor}", subject=term, sensor=sensor)


def _battery_text(battery: BatterySample) -> CodedText:
    of = battery.battery or coded("check-sensor", "the sensor")
    if not math.isfinite(battery.left_s):
        return coded(
            "check-battery", "{level_fraction:.0%} of {of}", level_fraction=battery.level, of=of
        )
    return coded(
        "check-battery-left",
        "{level_fraction:.0%} of {of}, {left_h:.1f} h left",
        level_fraction=battery.level,
        of=of,
        left_h=round(battery.left_s / 3600.0, 1),
    )
