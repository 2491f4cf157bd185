"""Work and rest: how long a wearer has worked, and when rest is due."""

from __future__ import annotations

import pytest

from shared.messages import (
    AlarmState,
)
from shared.messages.station import (
    Assign,
    CheckIn,
    ResolveAlarm,
    SetRest,
)
from tests.rig.people_on_duty import (
    at_work,
    duty,
    refusals,
    rest_alarms,
    rest_left_s,
    unit,
)
from tests.rig.station_script import Script


@pytest.fixture
def script() -> Script:
    return at_work()


def test_work_begins_inside_and_rest_is_due_after_it(script: Script) -> None:
    script.wait(5)
    assert duty(script).work_since_ns is None
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # walked in
    script.wait(1)
    assert duty(script).work_since_ns is not None
    script.wait(118, lambda: script.act(CheckIn("", "", True)))
    assert rest_alarms(script) == []
    script.wait(3)
    (due,) = rest_alarms(script)
    assert (due.unit_id, due.priority) == ("FF-01", 3)
    assert due.text == "Person 1: work limit reached (2 min), send to rehab"
    script.act(SetRest("FF-01", True))
    rests = rest_alarms(script)[-1]
    assert (rests.state, rests.by) == (AlarmState.RESOLVED, "rests")
    assert duty(script).rest_since_ns == script.t_ns


def test_wearer_not_sent_to_rest_is_named_again_after_ten_minutes(script: Script) -> None:
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # walked in
    script.wait(121)
    script.act(ResolveAlarm(rest_alarms(script)[-1].alarm_id, "in a moment"))
    script.wait(599)
    assert len(rest_alarms(script)) == 2
    script.wait(1)
    assert len(rest_alarms(script)) == 3
    assert rest_alarms(script)[-1].text == "Person 1: work limit reached (12 min), send to rehab"


def test_work_lasts_until_the_rest_wherever_it_continues(script: Script) -> None:
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # walked in
    script.wait(1)
    assert rest_left_s(script) == 119.0
    unit(script).place.inside_since_ns = None  # out for a moment, and in again
    script.wait(1)
    unit(script).place.inside_since_ns = script.t_ns
    script.wait(1)
    assert rest_left_s(script) == 117.0
    script.act(SetRest("FF-01", True))
    script.wait(1)
    assert duty(script).work_since_ns is None, "who rests where it is warm does not work"


def test_work_after_a_rest_counts_from_its_end(script: Script) -> None:
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # walked in
    script.wait(100)
    script.act(SetRest("FF-01", True))
    script.wait(100)
    script.act(SetRest("FF-01", False))
    assert duty(script).rest_due_ns is None
    script.wait(1)
    assert rest_left_s(script) == 119.0
    assert rest_alarms(script) == []


def test_next_wearer_of_a_unit_has_not_worked_yet(script: Script) -> None:
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # walked in
    script.wait(100)
    script.act(Assign("FF-01", "p9", "Person 9", "red", ""))
    script.wait(1)
    assert duty(script).work_since_ns is None, "it was the other one who had walked in"
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)
    script.wait(1)
    assert rest_left_s(script) == 119.0


def test_second_rest_is_refused(script: Script) -> None:
    script.act(SetRest("FF-01", True))
    script.act(SetRest("FF-01", True))
    assert refusals(script) == ["Person 1 is in rehab already"]


def test_wearer_with_another_unit_keeps_the_work_done(script: Script) -> None:
    """The battery was empty."""
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # walked in
    script.wait(100)
    script.register("FF-04")
    script.act(Assign("FF-04", "p1", "Person 1", "red", ""))
    script.wait(21)
    assert [(one.unit_id, one.text) for one in rest_alarms(script)] == [
        ("FF-04", "Person 1: work limit reached (2 min), send to rehab")
    ]
    assert unit(script).duty is None


def test_resting_wearer_rests_with_another_unit(script: Script) -> None:
    script.act(SetRest("FF-01", True))
    script.register("FF-04")
    script.act(Assign("FF-04", "p1", "Person 1", "red", ""))
    script.act(SetRest("FF-04", True))
    assert refusals(script) == ["Person 1 is in rehab already"]
