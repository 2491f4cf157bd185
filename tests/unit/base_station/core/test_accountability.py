"""Check-ins: who is due when, hand-overs, and events that are no check-in."""

from __future__ import annotations

import pytest

from base_station.core.accountability import warning_s
from base_station.core.checkpoint import read_checkpoint
from base_station.core.state import Incident
from shared.clock import NS_PER_S
from shared.messages import (
    AlarmState,
    EventKind,
)
from shared.messages.station import (
    Assign,
    CheckIn,
    CloseIncident,
    OpenIncident,
    ResolveAlarm,
    SetAccountability,
    SetRest,
    Unassign,
)
from tests.rig.people_on_duty import (
    INTERVAL_S,
    at_work,
    confirmed,
    left_s,
    overdue,
    refusals,
    rest_left_s,
    unit,
)
from tests.rig.station_script import Script


@pytest.fixture
def script() -> Script:
    return at_work()


def test_check_in_of_one_member_counts_for_no_other(script: Script) -> None:
    """Members without a crew are not a crew."""
    for number in (1, 2, 3):
        script.act(Assign(f"FF-0{number}", f"p{number}", f"Person {number}", "", ""))
    script.wait(20)
    script.act(CheckIn("FF-01", "", False))
    assert left_s(script, "FF-01") == pytest.approx(60.0)
    assert left_s(script, "FF-02") == pytest.approx(40.0)
    assert left_s(script, "FF-03") == pytest.approx(40.0)


def test_check_ins_are_due_only_while_an_incident_is_open() -> None:
    script = Script()
    script.register("FF-01")
    script.act(Assign("FF-01", "p1", "Person 1", "red", ""))
    assert unit(script).duty is None
    script.act(OpenIncident("i1", "Mill Lane"))
    assert left_s(script) == 20 * 60.0  # the usual
    script.act(CloseIncident("i1"))
    assert unit(script).duty is None


def test_member_who_comes_later_is_due_later(script: Script) -> None:
    script.register("FF-04")
    script.wait(30)
    script.act(Assign("FF-04", "p4", "Person 4", "blue", ""))
    assert left_s(script, "FF-04") == INTERVAL_S
    assert left_s(script, "FF-01") == INTERVAL_S - 30.0


def test_measurements_of_a_unit_are_no_check_in(script: Script) -> None:
    def everything() -> None:
        script.status("FF-01", motionless_s=0.0)
        script.position("FF-01", 1.0, 1.0)
        script.temperature("FF-01", 20.0)
        script.event("FF-01", EventKind.MAYDAY_CANCELLED)

    script.wait(61, everything)
    raised = [alarm for alarm in overdue(script) if alarm.unit_id == "FF-01"]
    assert [alarm.state for alarm in raised] == [AlarmState.RAISED]
    assert raised[0].priority == 1
    assert raised[0].text == "Person 1: PAR overdue, not yet confirmed, on duty for 1 min"


def test_alarm_fires_once_and_is_rearmed_by_the_check_in(script: Script) -> None:
    script.wait(200)
    assert len([one for one in overdue(script) if one.unit_id == "FF-01"]) == 1
    script.act(CheckIn("FF-01", "", False))
    mine = [one for one in overdue(script) if one.unit_id == "FF-01"]
    assert [one.state for one in mine] == [AlarmState.RAISED, AlarmState.RESOLVED]
    assert mine[-1].by == "not overdue; PAR confirmed by radio, entered by chief"
    script.wait(59)
    assert len([one for one in overdue(script) if one.unit_id == "FF-01"]) == 2
    script.wait(2)
    mine = [one for one in overdue(script) if one.unit_id == "FF-01"]
    assert [one.state for one in mine][-1] is AlarmState.RAISED
    assert len({one.alarm_id for one in mine}) == 2


def test_alarm_resolved_by_a_person_is_not_raised_again_before_a_check_in(script: Script) -> None:
    script.wait(61)
    alarm = next(one for one in overdue(script) if one.unit_id == "FF-01")
    script.act(ResolveAlarm(alarm.alarm_id, "seen at the engine"))
    script.wait(600)
    mine = [one for one in overdue(script) if one.unit_id == "FF-01"]
    assert [one.state for one in mine] == [AlarmState.RAISED, AlarmState.RESOLVED]


def test_crew_and_everyone_are_checked_in_at_once(script: Script) -> None:
    script.wait(30)
    script.act(CheckIn("", "red", False), by="Ana")
    assert [left_s(script, f"FF-0{number}") for number in (1, 2, 3)] == [60.0, 60.0, 30.0]
    assert confirmed(script) == ("radio", "Ana")
    script.act(CheckIn("", "", True))
    assert left_s(script, "FF-03") == 60.0


def test_other_intervals_apply_at_once_and_to_everybody(script: Script) -> None:
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # walked in
    script.wait(1)
    script.act(SetAccountability(600.0, 900.0))
    assert left_s(script, "FF-01") == left_s(script, "FF-03") == 599.0
    assert rest_left_s(script) == 899.0


def test_other_intervals_are_no_check_in(script: Script) -> None:
    script.wait(1)
    script.act(CheckIn("FF-01", "", False), by="Ana")
    script.wait(61)
    script.act(SetAccountability(600.0, 900.0))
    (ended,) = [
        one
        for one in overdue(script)[1:]
        if one.state is AlarmState.RESOLVED and one.unit_id == "FF-01"
    ]
    assert ended.by == "not overdue; PAR confirmed by radio, entered by Ana"


def test_other_intervals_do_not_affect_an_unworn_unit(script: Script) -> None:
    script.register("FF-09")
    script.act(SetAccountability(300.0, 2400.0))
    assert (unit(script, "FF-09").duty, left_s(script)) == (None, 300.0)


def test_assignment_after_the_incident_is_not_on_duty(script: Script) -> None:
    script.act(CloseIncident("i1"))
    script.act(Assign("FF-01", "p9", "Person 9", "red", ""))
    assert refusals(script) == []
    assert (unit(script).wearer.person is not None, unit(script).duty) == (True, None)


def test_intervals_cannot_be_changed_without_an_open_incident() -> None:
    script = Script()
    script.act(SetAccountability(300.0, 2400.0))
    script.act(OpenIncident("i1", "Mill Lane"))
    script.act(CloseIncident("i1"))
    script.act(SetAccountability(300.0, 2400.0))
    assert refusals(script) == ["no incident is open"] * 2


def test_check_in_without_an_open_incident_is_refused(script: Script) -> None:
    """They wear their units still, and the operator learns that the entry counts for nothing."""
    script.act(CloseIncident("i1"))
    for meant in (CheckIn("FF-01", "", False), CheckIn("", "red", False), CheckIn("", "", True)):
        script.act(meant)
    assert refusals(script) == [
        f"nobody of {action} is on duty in an open incident"
        for action in ("FF-01", "red", "everyone")
    ]


def test_member_who_returns_the_unit_is_not_due(script: Script) -> None:
    script.wait(61)
    script.act(Unassign("FF-01"))
    mine = [one for one in overdue(script) if one.unit_id == "FF-01"]
    assert mine[-1].state is AlarmState.RESOLVED
    assert mine[-1].by == "off duty"


def test_next_wearer_of_a_unit_has_not_been_inside_since_the_hand_over(
    script: Script,
) -> None:
    def walk() -> None:
        script.position("FF-01", 9.0, 0.0, distance_m=9.0)

    script.wait(20, walk)
    went_in_ns = unit(script).place.inside_since_ns
    assert went_in_ns == script.t_ns - 19 * NS_PER_S
    script.act(Assign("FF-01", "p1", "Person One", "red", "officer"))
    assert unit(script).place.inside_since_ns == went_in_ns, "it is the same person"
    script.act(Assign("FF-01", "p9", "Person 9", "red", ""))
    assert unit(script).place.inside_since_ns is None
    script.wait(5, walk)
    assert unit(script).place.inside_since_ns == script.t_ns - 4 * NS_PER_S
    script.act(Unassign("FF-01"))
    assert unit(script).place.inside_since_ns is None
    script.wait(5, walk)
    script.act(Assign("FF-01", "p1", "Person 1", "red", ""))
    assert unit(script).place.inside_since_ns == script.t_ns - 4 * NS_PER_S, (
        "said late who wears it"
    )


def test_new_name_of_the_same_person_is_no_check_in(script: Script) -> None:
    script.wait(30)
    script.act(Assign("FF-01", "p1", "Person One", "red", "officer"))
    assert left_s(script) == 30.0


def test_missed_member_stays_missed_with_another_unit(script: Script) -> None:
    """A corrected assignment at the console is no contact with the wearer."""
    script.wait(61)
    script.register("FF-04")
    script.act(Assign("FF-04", "p1", "Person 1", "red", ""))
    reported = [(one.unit_id, one.state.name) for one in overdue(script)[3:]]
    assert reported == [("FF-01", "RESOLVED"), ("FF-04", "RAISED")]
    script.act(CheckIn("FF-04", "", False))
    assert overdue(script)[-1].state is AlarmState.RESOLVED


def test_unworn_unit_is_not_due() -> None:
    script = Script()
    script.register("FF-01")
    script.act(OpenIncident("i1", "Mill Lane"))
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # it is carried in
    script.wait(1)
    assert unit(script).duty is None
    script.act(CheckIn("FF-01", "", False))
    assert refusals(script) == ["nobody of FF-01 is on duty in an open incident"]


def test_first_incident_is_closed_before_the_second_opens(script: Script) -> None:
    script.act(OpenIncident("i2", "Dock"))
    script.act(CloseIncident("i2"))
    assert refusals(script) == [
        "the incident 'Mill Lane' is open; close it first",
        "no open incident i2",
    ]
    assert left_s(script) == INTERVAL_S
    script.act(CloseIncident("i1"))
    script.act(CloseIncident("i1"))
    assert refusals(script)[2:] == ["no open incident i1"]


@pytest.mark.parametrize(("interval_s", "before_s"), [(600.0, 150.0), (2400.0, 300.0)])
def test_check_in_is_announced_in_the_last_quarter_and_five_minutes_at_most(
    interval_s: float, before_s: float
) -> None:
    assert warning_s(Incident("i1", "Mill Lane", 0, None, interval_s)) == before_s


@pytest.mark.parametrize(
    "action",
    [
        CheckIn("", "", False),
        CheckIn("FF-01", "red", False),
        CheckIn("FF-09", "", False),
        SetAccountability(float("nan"), 2400.0),
        SetAccountability(29.9, 2400.0),
        SetAccountability(1200.0, 43_200.1),
        SetRest("FF-09", True),
    ],
)
def test_impossible_check_in_is_refused_with_a_sentence(
    script: Script, action: CheckIn | SetAccountability | SetRest
) -> None:
    before = script.pipeline.checkpoint()
    script.act(action)
    assert len(refusals(script)) == 1
    after = read_checkpoint(script.pipeline.checkpoint())
    saved = read_checkpoint(before)
    assert saved is not None
    assert after is not None
    assert saved.state.units == after.state.units


@pytest.mark.parametrize(
    ("par_s", "work_s", "opens"), [(30.0, 43_200.0, True), (29.9, 60.0, False)]
)
def test_intervals_of_an_incident_are_feasible(par_s: float, work_s: float, opens: bool) -> None:
    script = Script()
    script.act(OpenIncident("i1", "Mill Lane", par_s, work_s))
    assert (script.pipeline.state.shown_incident is not None) is opens
    assert len(refusals(script)) == (not opens)


def test_old_log_has_the_default_intervals() -> None:
    script = Script()
    script.act(OpenIncident("i1", "Mill Lane"))
    incident = script.pipeline.state.shown_incident
    assert incident is not None
    assert (incident.par_interval_s, incident.work_limit_s) == (1200.0, 2400.0)
