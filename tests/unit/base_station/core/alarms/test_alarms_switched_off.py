"""Alarms that end when a unit is switched off in order, and those that stay."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from shared.messages import EventKind
from shared.messages.event import FAILED
from shared.messages.station import OpenIncident, SetAnchor, SetStart
from shared.quality import Quality, Reason
from tests.rig.station_script import Script

U = "FF-01"
OFF = "the unit was switched off"


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    script.act(SetAnchor(52.0, 4.0, 0.0, 0.0))
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(SetStart(U, 0.0, 0.0, 0.0, 0.0, 0.5, 0.1))
    script.status(U)
    return script


def unsure(script: Script) -> None:
    script.position(U, 0.0, 0.0, quality=Quality.LOST, distance_m=script.now_s)


def worn_elsewhere(script: Script) -> None:
    reasons = Reason.NOT_ON_FOOT
    script.position(U, 0.0, 0.0, quality=Quality.LOST, reasons=reasons, distance_m=script.now_s)


def begun_anywhere(script: Script) -> None:
    """It began somewhere in the quarter."""
    script.act(SetStart(U, 0.0, 0.0, 0.0, 0.0, 200.0, 0.1))
    script.position(U, 0.0, 0.0)


def at_the_equator(script: Script) -> None:
    script.position(U, 0.0, 0.0)
    script.gps(U, 0.0, 0.0)


MOOT = {
    "tracker-degraded": unsure,
    "worn-wrong": worn_elsewhere,
    "position-lost": begun_anywhere,
    "gps-unused": at_the_equator,
}


def life(script: Script, rule: str) -> list[tuple[str, str]]:
    return [(one.state.name, one.by) for one in script.alarms if one.rule == rule]


@pytest.mark.parametrize("rule", MOOT)
def test_alarms_of_the_units_function_end_with_the_reason(script: Script, rule: str) -> None:
    script.wait(60, lambda: MOOT[rule](script))
    assert life(script, rule) == [("RAISED", "")]
    script.event(U, EventKind.STOPPED, "stopped by a signal")
    script.wait(60)
    assert life(script, rule) == [("RAISED", ""), ("RESOLVED", OFF)]
    script.boot_ids[U] = 8
    script.wait(60, lambda: script.status(U))
    assert len(life(script, rule)) == 2, "what was before tells nothing of now"
    script.wait(60, lambda: MOOT[rule](script))
    assert life(script, rule)[2:] == [("RAISED", "")]


@pytest.mark.parametrize(
    ("kind", "detail"),
    [
        (EventKind.STOPPED, FAILED),
        (EventKind.SOURCE_ENDED, "the sensor is gone"),
        (EventKind.SENSOR_FAULT, "the sensor is gone"),
    ],
)
def test_failed_unit_is_missing(script: Script, kind: EventKind, detail: str) -> None:
    """A shutdown by failure is reported, and is no order."""
    script.wait(60, lambda: unsure(script))
    script.event(U, kind, detail)
    script.wait(60)
    assert life(script, "tracker-degraded") == [("RAISED", "")]
    (lost,) = [one for one in script.alarms if one.rule == "link-lost"]
    assert lost.level == "lost"


DANGERS: dict[str, Callable[[Script], object]] = {
    "mayday": lambda script: script.event(U, EventKind.MAYDAY),
    "fall": lambda script: script.event(U, EventKind.FALL),
    "no-motion": lambda script: script.status(U, motionless_s=40.0),
    "heat": lambda script: script.temperature(U, 300.0),
    "unit-fault": lambda script: script.event(U, EventKind.SENSOR_FAULT, "it is stuck"),
    "battery": lambda script: script.status(U, battery=0.05),
}


@pytest.mark.parametrize("rule", DANGERS)
def test_alarms_of_wearer_and_damage_stay(script: Script, rule: str) -> None:
    DANGERS[rule](script)
    script.wait(1)
    assert life(script, rule) == [("RAISED", "")]
    script.event(U, EventKind.STOPPED, "stopped by a signal")
    script.wait(600)
    assert life(script, rule) == [("RAISED", "")]
