"""Alarms of calibrations: old, poor, and never for a missing one."""

from __future__ import annotations

import pytest

from base_station.core.alarms.calibration import CalibrationPoor
from base_station.core.alarms.interface import ADVISORY, Clear, Finding
from base_station.core.state import UnitState
from shared.clock import NS_PER_S
from shared.messages import Header
from tests.rig import message_factory

LAST_S = 1_800_000_000
DAY_S = 86_400


def unit(calibrated_s: int | None, faults: str = "") -> UnitState:
    description = message_factory.description(
        Header("FF-01", 1, 1, 0),
        calibration="c1",
        calibrated_s=calibrated_s,
        calibration_faults=faults,
    )
    return UnitState("FF-01", last_message_ns=LAST_S * NS_PER_S, description=description)


@pytest.mark.parametrize(
    ("age_days", "faults", "level"),
    [(179, "", None), (181, "", "old"), (1, "gyroscope off by 1 deg/s", "poor")],
)
def test_alarm_follows_age_and_residuals(age_days, faults, level):
    verdict = CalibrationPoor().judge(unit(LAST_S - age_days * DAY_S, faults), 0, "")
    if level is None:
        assert isinstance(verdict, Clear)
        return
    assert isinstance(verdict, Finding)
    assert (verdict.level, verdict.priority) == (level, ADVISORY)
    assert "FF-01: calibration of the unit is " in verdict.text
    assert faults in verdict.text


def test_unit_without_calibration_raises_no_alarm():
    assert isinstance(CalibrationPoor().judge(unit(None), 0, ""), Clear)
