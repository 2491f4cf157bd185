"""Alarms of heat: their levels, how they ease, and a wearer's budget."""

from __future__ import annotations

import pytest

from base_station.core.alarms.interface import WARNING
from base_station.storage.db.known_people import person_lookup
from base_station.views.units import unit_views
from shared.messages.station import (
    AcknowledgeAlarm,
    CloseIncident,
    OpenIncident,
    ResolveAlarm,
)
from tests.rig.alarm_transitions import U, changes
from tests.rig.station_script import Script


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    return script


def test_heat_rises_at_once_and_falls_with_hysteresis(script: Script) -> None:
    for ambient_degc in (90, 120, 180, 270):
        script.wait(1, lambda t=ambient_degc: script.temperature(U, t))  # type: ignore[misc]
    assert changes(script, "heat") == [
        ("RAISED", "caution"),
        ("RAISED", "warning"),
        ("RAISED", "critical"),
    ]
    script.wait(30, lambda: script.temperature(U, 255.0))
    assert len(changes(script, "heat")) == 3, "within the hysteresis nothing changes"
    script.wait(30, lambda: script.temperature(U, 40.0))
    assert changes(script, "heat")[-1] == ("RESOLVED", "critical")
    assert script.alarms[-1].by == "cooled down"


def test_level_of_easing_heat_falls_once_it_stays_lower(script: Script) -> None:
    script.wait(1, lambda: script.temperature(U, 270.0))
    script.wait(8, lambda: script.temperature(U, 170.0))
    script.wait(1, lambda: script.temperature(U, 270.0))
    script.act(AcknowledgeAlarm(script.alarms[0].alarm_id))
    script.wait(10, lambda: script.temperature(U, 170.0))
    assert changes(script, "heat") == [("RAISED", "critical"), ("ACKNOWLEDGED", "critical")]
    script.wait(1, lambda: script.temperature(U, 170.0))
    assert changes(script, "heat")[2:] == [("ACKNOWLEDGED", "warning")]
    assert script.alarms[-1].priority == WARNING
    assert "170 °C" in script.alarms[-1].text
    script.wait(10, lambda: script.temperature(U, 120.0))
    assert len(changes(script, "heat")) == 3, "that it is lower still has to stay so, too"
    script.wait(1, lambda: script.temperature(U, 120.0))
    assert changes(script, "heat")[3:] == [("ACKNOWLEDGED", "caution")]


def test_heat_that_flickers_about_a_limit_is_one_alarm(script: Script) -> None:
    for step in range(60):
        script.wait(1, lambda s=step: script.temperature(U, 99.0 + 3.0 * (s % 2)))  # type: ignore[misc]
    assert changes(script, "heat") == [("RAISED", "caution")]


def test_used_up_heat_budget_is_an_alarm_below_every_limit(script: Script) -> None:
    script.wait(1600, lambda: script.temperature(U, 90.0))
    assert changes(script, "heat") == []
    assert changes(script, "heat-dose") == [("RAISED", "used up")]
    raised_s = (script.alarms[0].raised_ns - script.records[0][0]) / 1e9
    assert raised_s == pytest.approx(1501.0, abs=2.0)
    state = script.pipeline.state
    (shown,) = unit_views(state, [state.units[U]], person_lookup({}))
    assert shown.heat_used == pytest.approx(1600.0 / 1500.0, abs=0.01), "as it is now"


def test_used_up_heat_budget_hides_no_heat_and_is_reset_by_another_incident(
    script: Script,
) -> None:
    def hot(degc: float, duration_s: float) -> None:
        script.wait(duration_s, lambda: script.temperature(U, degc))

    script.act(OpenIncident("i1", "Mill Lane"))
    hot(300.0, 65.0)
    for alarm in [one for one in script.alarms if one.rule.startswith("heat")]:
        script.act(ResolveAlarm(alarm.alarm_id, "seen"))
    hot(20.0, 30.0)
    hot(200.0, 5.0)
    assert changes(script, "heat")[-1] == ("RAISED", "warning")
    assert changes(script, "heat-dose") == [("RAISED", "used up"), ("RESOLVED", "used up")]
    hot(20.0, 30.0)
    script.act(CloseIncident("i1"))
    script.act(OpenIncident("i2", "Dock Street"))
    hot(20.0, 5.0)
    assert script.pipeline.state.units[U].heat.dose == 0.0
    hot(300.0, 65.0)
    assert changes(script, "heat-dose")[2:] == [("RAISED", "used up")]
