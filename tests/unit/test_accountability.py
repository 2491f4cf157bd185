"""The roll call: who is due, what answers it and what does not; work and rest."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from base_station.accountability import warning_s
from base_station.checkpoint import read_checkpoint
from base_station.events import Refused
from base_station.live_state import Duty, Incident, UnitState
from shared.clock import NS_PER_S
from shared.messages import (
    AlarmChange,
    AlarmState,
    CommandKind,
    CommandReply,
    CommandState,
    EventKind,
)
from shared.messages.station import (
    AcknowledgeAlarm,
    Assign,
    CheckIn,
    CloseIncident,
    ConfirmCommand,
    OpenIncident,
    ResolveAlarm,
    SendCommand,
    SetAccountability,
    SetRest,
    Unassign,
)
from tests.station_script import Script

INTERVAL_S = 60.0


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register("FF-01", "FF-02", "FF-03")
    for number, crew in ((1, "red"), (2, "red"), (3, "blue")):
        script.act(Assign(f"FF-0{number}", f"p{number}", f"Person {number}", crew, ""))
    script.act(OpenIncident("i1", "Mill Lane", INTERVAL_S, 120.0))
    return script


def unit(script: Script, unit_id: str = "FF-01") -> UnitState:
    return script.pipeline.state.units[unit_id]


def duty(script: Script, unit_id: str = "FF-01") -> Duty:
    found = unit(script, unit_id).duty
    assert found is not None
    return found


def left_s(script: Script, unit_id: str = "FF-01") -> float:
    return (duty(script, unit_id).due_ns - script.t_ns) / NS_PER_S


def rest_left_s(script: Script) -> float:
    due_ns = duty(script).rest_due_ns
    assert due_ns is not None
    return (due_ns - script.t_ns) / NS_PER_S


def test_a_check_in_of_one_is_nobody_else_s(script: Script) -> None:
    """Nobody of these has a crew: that does not make them one."""
    for number in (1, 2, 3):
        script.act(Assign(f"FF-0{number}", f"p{number}", f"Person {number}", "", ""))
    script.wait(20)
    script.act(CheckIn("FF-01", "", False))
    assert left_s(script, "FF-01") == pytest.approx(60.0)
    assert left_s(script, "FF-02") == pytest.approx(40.0)
    assert left_s(script, "FF-03") == pytest.approx(40.0)


def overdue(script: Script) -> list[AlarmChange]:
    return [alarm for alarm in script.alarms if alarm.rule == "missed-check-in"]


def rest_alarms(script: Script) -> list[AlarmChange]:
    return [alarm for alarm in script.alarms if alarm.rule == "rest-due"]


def refusals(script: Script) -> list[str]:
    return [output.reason for output in script.outputs if isinstance(output, Refused)]


def order(script: Script, kind: CommandKind, command_id: str = "c1") -> None:
    script.act(SendCommand(command_id, kind, "", "", True, "", 0.0, lasts_s=600.0))


def test_it_runs_only_while_an_incident_is_open() -> None:
    script = Script()
    script.register("FF-01")
    script.act(Assign("FF-01", "p1", "Person 1", "red", ""))
    assert unit(script).duty is None
    script.act(OpenIncident("i1", "Mill Lane"))
    assert left_s(script) == 20 * 60.0  # the usual
    script.act(CloseIncident("i1"))
    assert unit(script).duty is None


def test_whoever_comes_later_is_due_later(script: Script) -> None:
    script.register("FF-04")
    script.wait(30)
    script.act(Assign("FF-04", "p4", "Person 4", "blue", ""))
    assert left_s(script, "FF-04") == INTERVAL_S
    assert left_s(script, "FF-01") == INTERVAL_S - 30.0


def test_nothing_that_a_unit_measures_answers_it(script: Script) -> None:
    def everything() -> None:
        script.status("FF-01", motionless_s=0.0)
        script.position("FF-01", 1.0, 1.0)
        script.temperature("FF-01", 20.0)
        script.event("FF-01", EventKind.MAYDAY_CANCELLED)

    script.wait(61, everything)
    raised = [alarm for alarm in overdue(script) if alarm.unit_id == "FF-01"]
    assert [alarm.state for alarm in raised] == [AlarmState.RAISED]
    assert raised[0].priority == 1
    assert raised[0].text == "Person 1: PAR overdue, not heard from for 1 min"


def test_it_fires_once_and_is_armed_again_by_the_check_in(script: Script) -> None:
    script.wait(200)
    assert len([one for one in overdue(script) if one.unit_id == "FF-01"]) == 1
    script.act(CheckIn("FF-01", "", False))
    mine = [one for one in overdue(script) if one.unit_id == "FF-01"]
    assert [one.state for one in mine] == [AlarmState.RAISED, AlarmState.RESOLVED]
    assert "chief" in mine[-1].by
    script.wait(59)
    assert len([one for one in overdue(script) if one.unit_id == "FF-01"]) == 2
    script.wait(2)
    mine = [one for one in overdue(script) if one.unit_id == "FF-01"]
    assert [one.state for one in mine][-1] is AlarmState.RAISED
    assert len({one.alarm_id for one in mine}) == 2


def test_one_that_a_person_resolved_is_not_raised_again_before_a_check_in(script: Script) -> None:
    script.wait(61)
    alarm = next(one for one in overdue(script) if one.unit_id == "FF-01")
    script.act(ResolveAlarm(alarm.alarm_id, "seen at the engine"))
    script.wait(600)
    mine = [one for one in overdue(script) if one.unit_id == "FF-01"]
    assert [one.state for one in mine] == [AlarmState.RAISED, AlarmState.RESOLVED]


@pytest.mark.parametrize("dealt_with", [AcknowledgeAlarm, lambda one: ResolveAlarm(one, "seen")])
def test_who_does_not_answer_the_evacuation_is_overdue_anew(
    script: Script, dealt_with: Callable[[str], AcknowledgeAlarm | ResolveAlarm]
) -> None:
    """Somebody had dealt with the alarm of before, and nobody has heard from the wearer since."""
    script.wait(61)
    before = next(one for one in overdue(script) if one.unit_id == "FF-01")
    script.act(dealt_with(before.alarm_id))
    script.wait(60)
    order(script, CommandKind.EVACUATE)
    script.wait(179)
    assert [one for one in overdue(script) if one.unit_id == "FF-01"][-1].by.startswith("chief")
    script.wait(2)
    again = [one for one in overdue(script) if one.unit_id == "FF-01"][2:]
    assert [one.state for one in again] == [AlarmState.RAISED]


def test_a_crew_and_everyone_are_ticked_off_at_once(script: Script) -> None:
    script.wait(30)
    script.act(CheckIn("", "red", False), by="Ana")
    assert [left_s(script, f"FF-0{number}") for number in (1, 2, 3)] == [60.0, 60.0, 30.0]
    assert duty(script).checked_in_by == "Ana"
    script.act(CheckIn("", "", True))
    assert left_s(script, "FF-03") == 60.0


def test_the_wearers_own_button_answers_a_roll_call_and_having_it_does_not(script: Script) -> None:
    script.wait(30)
    order(script, CommandKind.PAR_REQUEST)
    script.reply("FF-01", "c1", CommandState.RECEIVED)
    assert duty(script).asked_ns is not None
    assert left_s(script) == 30.0
    script.reply("FF-01", "c1", CommandState.ACKNOWLEDGED)
    assert duty(script).asked_ns is None
    assert duty(script).checked_in_by == "Person 1"
    assert left_s(script) == INTERVAL_S
    script.act(ConfirmCommand("c1", "FF-02"))
    assert duty(script, "FF-02").checked_in_by == "chief"


def answer(script: Script, captured_s: float) -> None:
    """The wearer's press, out of the journal of a unit whose clock is known."""
    header = script.header("FF-01", captured_s)
    script.say(CommandReply(header, "c1", CommandState.ACKNOWLEDGED, ""))


def test_an_answer_that_waited_for_the_link_counts_from_when_it_was_given(script: Script) -> None:
    script.status("FF-01")
    script.wait(10)
    order(script, CommandKind.PAR_REQUEST)
    script.wait(5)
    pressed_s = script.now_s
    script.wait(30)
    answer(script, pressed_s)
    assert duty(script).asked_ns is None
    assert left_s(script) == pytest.approx(INTERVAL_S - 30.0, abs=0.1)


def test_no_answer_was_given_before_it_was_asked_for(script: Script) -> None:
    """Whatever a unit believes of the time: who answered is not overdue."""
    script.status("FF-01")
    script.wait(10)
    order(script, CommandKind.PAR_REQUEST)
    answer(script, script.now_s - 8.0)
    assert duty(script).asked_ns is None
    assert left_s(script) == pytest.approx(INTERVAL_S)


def test_who_answered_before_the_evacuation_is_still_to_be_heard_from(script: Script) -> None:
    """The press was made before the order, and its message came after."""
    script.status("FF-01")
    order(script, CommandKind.PAR_REQUEST)
    script.wait(5)
    pressed_s = script.now_s
    script.wait(5)
    order(script, CommandKind.EVACUATE, "c2")
    ordered_ns = script.t_ns
    answer(script, pressed_s)
    assert duty(script).checked_in_by == "Person 1"
    assert duty(script).asked_ns == ordered_ns


def test_to_ask_again_gives_nobody_more_time(script: Script) -> None:
    script.act(SetAccountability(1200.0, 2400.0))
    order(script, CommandKind.PAR_REQUEST)
    script.wait(100)
    order(script, CommandKind.PAR_REQUEST, "c2")
    assert left_s(script) == 80.0


def test_other_times_hold_at_once_and_for_everybody(script: Script) -> None:
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # walked in
    script.wait(1)
    script.act(SetAccountability(600.0, 900.0))
    assert left_s(script, "FF-01") == left_s(script, "FF-03") == 599.0
    assert rest_left_s(script) == 899.0


def test_a_roll_call_on_demand_is_due_in_three_minutes(script: Script) -> None:
    script.act(SetAccountability(1200.0, 2400.0))
    script.wait(10)
    order(script, CommandKind.PAR_REQUEST)
    assert left_s(script) == 180.0
    script.wait(181)
    assert {one.unit_id for one in overdue(script)} == {"FF-01", "FF-02", "FF-03"}
    assert "PAR overdue, asked and not heard from for 3 min" in overdue(script)[0].text


def test_who_has_heard_of_the_evacuation_is_not_out_yet(script: Script) -> None:
    script.act(SetAccountability(1200.0, 2400.0))
    order(script, CommandKind.EVACUATE)
    script.reply("FF-01", "c1", CommandState.ACKNOWLEDGED)
    assert duty(script).asked_ns is not None
    assert left_s(script) == 180.0


def test_a_text_asks_nobody_to_be_accounted_for(script: Script) -> None:
    script.act(SendCommand("c1", CommandKind.TEXT, "", "", True, "hello", 0.0, lasts_s=600.0))
    assert duty(script).asked_ns is None


def test_who_hands_the_unit_back_is_not_waited_for(script: Script) -> None:
    script.wait(61)
    script.act(Unassign("FF-01"))
    mine = [one for one in overdue(script) if one.unit_id == "FF-01"]
    assert mine[-1].state is AlarmState.RESOLVED
    assert mine[-1].by == "off duty"


def test_a_new_name_for_the_same_person_is_no_check_in(script: Script) -> None:
    script.wait(30)
    script.act(Assign("FF-01", "p1", "Person One", "red", "officer"))
    assert left_s(script) == 30.0


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
    assert due.text == "Person 1 has worked for 2 min: send to rest"
    script.act(SetRest("FF-01", True))
    rests = rest_alarms(script)[-1]
    assert (rests.state, rests.by) == (AlarmState.RESOLVED, "rests")
    assert duty(script).rest_since_ns == script.t_ns


def test_who_is_not_sent_to_rest_is_named_again_after_ten_minutes(script: Script) -> None:
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # walked in
    script.wait(121)
    script.act(ResolveAlarm(rest_alarms(script)[-1].alarm_id, "in a moment"))
    script.wait(599)
    assert len(rest_alarms(script)) == 2
    script.wait(1)
    assert len(rest_alarms(script)) == 3


def test_work_lasts_until_the_rest_wherever_it_goes_on(script: Script) -> None:
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # walked in
    script.wait(1)
    assert rest_left_s(script) == 119.0
    unit(script).inside_since_ns = None  # out for a moment, and in again
    script.wait(1)
    unit(script).inside_since_ns = script.t_ns
    script.wait(1)
    assert rest_left_s(script) == 117.0
    script.act(SetRest("FF-01", True))
    script.wait(1)
    assert duty(script).work_since_ns is None, "who rests where it is warm does not work"


def test_work_after_a_rest_is_counted_from_its_end(script: Script) -> None:
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # walked in
    script.wait(100)
    script.act(SetRest("FF-01", True))
    script.wait(100)
    script.act(SetRest("FF-01", False))
    assert duty(script).rest_due_ns is None
    script.wait(1)
    assert rest_left_s(script) == 119.0
    assert rest_alarms(script) == []


def test_who_takes_over_a_unit_has_not_worked_yet(script: Script) -> None:
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # walked in
    script.wait(100)
    script.act(Assign("FF-01", "p9", "Person 9", "red", ""))
    script.wait(1)
    assert rest_left_s(script) == 119.0


def test_an_answer_that_comes_after_a_newer_word_changes_nothing(script: Script) -> None:
    script.status("FF-01")
    order(script, CommandKind.PAR_REQUEST)
    script.wait(5)
    pressed_s = script.now_s
    script.wait(20)
    script.act(CheckIn("FF-01", "", False))
    answer(script, pressed_s)
    assert left_s(script) == INTERVAL_S
    assert duty(script).checked_in_by == "chief"


def test_a_unit_that_nobody_wears_is_waited_for_by_nobody() -> None:
    script = Script()
    script.register("FF-01")
    script.act(OpenIncident("i1", "Mill Lane"))
    script.position("FF-01", 9.0, 0.0, distance_m=9.0)  # it is carried in
    script.wait(1)
    assert unit(script).duty is None
    script.act(CheckIn("FF-01", "", False))
    assert refusals(script) == ["nobody of FF-01 is on duty in an open incident"]


def test_of_two_incidents_the_first_is_closed_before_the_second_opens(script: Script) -> None:
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
def test_a_check_in_is_announced_in_the_last_quarter_and_five_minutes_at_most(
    interval_s: float, before_s: float
) -> None:
    assert warning_s(Incident("i1", "Mill Lane", 0, None, interval_s)) == before_s


def test_nobody_rests_twice(script: Script) -> None:
    script.act(SetRest("FF-01", True))
    script.act(SetRest("FF-01", True))
    assert refusals(script) == ["Person 1 is resting already"]


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
def test_what_makes_no_sense_is_refused_with_a_sentence(
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
def test_an_incident_has_times_that_can_be_kept(par_s: float, work_s: float, opens: bool) -> None:
    script = Script()
    script.act(OpenIncident("i1", "Mill Lane", par_s, work_s))
    assert (script.pipeline.state.incident is not None) is opens
    assert len(refusals(script)) == (not opens)


def test_an_old_log_has_the_usual_times() -> None:
    script = Script()
    script.act(OpenIncident("i1", "Mill Lane"))
    incident = script.pipeline.state.incident
    assert incident is not None
    assert (incident.par_interval_s, incident.work_limit_s) == (1200.0, 2400.0)
