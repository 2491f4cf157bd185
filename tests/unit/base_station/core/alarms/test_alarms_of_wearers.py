"""Wearers of alarms: the wearer of the unit at the time of the event, however late it arrives."""

from __future__ import annotations

import msgspec
import pytest

from base_station.core.state import WEARERS_KEPT
from shared.channels import EVENT, NO_TRACKER, backfilled_key, tracker_id
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.messages import AlarmState, EventKind, UnitEvent
from shared.messages.station import (
    AcknowledgeAlarm,
    Assign,
    CheckIn,
    ForgetWearers,
    OpenIncident,
    ResolveAlarm,
    Unassign,
)
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    return script


@pytest.mark.parametrize("kind", [EventKind.MAYDAY, EventKind.FALL])
@pytest.mark.parametrize("way", ["journal", "live"])
def test_late_alert_belongs_to_the_wearer_at_its_time(
    script: Script, kind: EventKind, way: str
) -> None:
    events = {}
    for name in ("Ana", "Bo", ""):
        script.act(Assign(U, name, name, "", "") if name else Unassign(U))
        script.wait(3, lambda: script.status(U))
        events[name] = UnitEvent(script.header(U), kind)
        script.wait(3, lambda: script.status(U))
    script.act(Assign(U, "cem", "Cem", "", ""))
    script.wait(3)
    key = EVENT.key(U) if way == "live" else backfilled_key(U, EVENT.suffix)
    reported = {}
    for name, event in events.items():
        script.record(key, encode(event))
        reported[name] = script.alarms[-1].text
        script.act(ResolveAlarm(script.alarms[-1].alarm_id, ""))
        script.wait(1)
    script.event(U, kind)
    reported["Cem"] = script.alarms[-1].text
    text = "Mayday from {}" if kind is EventKind.MAYDAY else "{}: possible fall"
    assert reported == {name: text.format(name or f"unit {U}") for name in reported}


@pytest.mark.parametrize("kind", [EventKind.MAYDAY, EventKind.FALL])
@pytest.mark.parametrize("has_time", [False, True])
def test_alert_of_a_run_without_live_messages_names_possible_wearers(
    script: Script, kind: EventKind, has_time: bool
) -> None:
    """Its monotonic clock gives no time; where it knew the station's time, that does."""
    texts = []
    for name in ("Ana", "Bo"):
        script.act(Assign(U, name, name, "", ""))
        script.wait(3)
        script.boot_ids[U] = 6
        header = script.header(U)
        script.boot_ids[U] = 7
        if has_time:
            header = msgspec.structs.replace(header, t_utc_ns=script.t_ns, utc_std_s=0.1)
        if name == "Ana":
            of_ana = encode(UnitEvent(header, kind))
        script.wait(3, lambda: script.status(U))
    script.record(backfilled_key(U, EVENT.suffix), of_ana)
    texts.append(script.alarms[-1].text)
    script.act(ResolveAlarm(script.alarms[-1].alarm_id, ""))
    script.wait(1)
    script.event(U, kind)
    texts.append(script.alarms[-1].text)
    text = "Mayday from {}" if kind is EventKind.MAYDAY else "{}: possible fall"
    wearer = "Ana" if has_time else "Bo or, before, Ana"
    assert texts == [text.format(wearer), text.format("Bo")]


def test_alert_belongs_to_the_only_wearer_whatever_its_time(script: Script) -> None:
    script.act(Assign(U, "ana", "Ana", "", ""))
    script.wait(3, lambda: script.status(U))
    script.boot_ids[U] = 6
    script.record(
        backfilled_key(U, EVENT.suffix), encode(UnitEvent(script.header(U), EventKind.MAYDAY))
    )
    assert script.alarms[-1].text == "Mayday from Ana"


def open_texts(script: Script) -> set[str]:
    return {one.text for one in script.pipeline.state.alarms.values() if one.is_open}


@pytest.mark.parametrize("kind", [EventKind.MAYDAY, EventKind.FALL])
@pytest.mark.parametrize("late", [False, True])
def test_two_wearers_of_one_unit_raise_two_alarms(
    script: Script, kind: EventKind, late: bool
) -> None:
    """In either order of reception."""
    script.act(Assign(U, "ana", "Ana", "", ""))
    script.wait(3, lambda: script.status(U))
    of_ana = UnitEvent(script.header(U), kind)
    if not late:
        script.record(EVENT.key(U), encode(of_ana))
        script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
    script.wait(3)
    script.act(Assign(U, "bo", "Bo", "", ""))
    script.wait(3, lambda: script.status(U))
    script.event(U, kind)
    if late:
        script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
        script.wait(3)
        script.record(backfilled_key(U, EVENT.suffix), encode(of_ana))
    script.wait(3)
    text = "Mayday from {}" if kind is EventKind.MAYDAY else "{}: possible fall"
    ana, bo = (text.format(name) for name in ("Ana", "Bo"))
    assert open_texts(script) == {ana, bo}
    assert [one.text for one in script.alarms if one.state is AlarmState.RAISED] == (
        [bo, ana] if late else [ana, bo]
    )
    of_bo = next(one.alarm_id for one in script.alarms if one.text == bo)
    script.act(ResolveAlarm(of_bo, "helped"))
    script.wait(3)
    assert open_texts(script) == {ana}
    script.act(ResolveAlarm(next(one.alarm_id for one in script.alarms if one.text == ana), ""))
    script.wait(3)
    assert open_texts(script) == set()
    assert len(script.pipeline.state.alarms) == 1, "of each rule and unit the newest is kept"


def test_alarms_of_other_kinds_and_units_are_separate(script: Script) -> None:
    units = (U, "FF-02")
    script.register("FF-02")
    events_of: dict[str, list[tuple[str, UnitEvent]]] = {}
    for name in ("Ana", "Bo"):
        for unit_id in units:
            script.act(Assign(unit_id, name + unit_id, name + unit_id, "", ""))
        script.wait(3, lambda: [script.status(unit_id) for unit_id in units])
        events_of[name] = [
            (unit_id, UnitEvent(script.header(unit_id), kind))
            for unit_id in units
            for kind in (EventKind.MAYDAY, EventKind.FALL)
        ]
        script.wait(3)
    for name in ("Bo", "Ana"):
        for unit_id, event in events_of[name]:
            script.record(backfilled_key(unit_id, EVENT.suffix), encode(event))
    for unit_id, kind in ((U, EventKind.FALL), ("FF-02", EventKind.MAYDAY)):
        script.event(unit_id, kind)
    script.wait(3)
    assert len(open_texts(script)) == 8


def test_alert_received_again_is_separate_from_an_alarm_of_another_wearer(
    script: Script,
) -> None:
    maydays = []
    for name in ("Ana", "Bo"):
        script.act(Assign(U, name, name, "", ""))
        script.wait(3, lambda: script.status(U))
        maydays.append(UnitEvent(script.header(U), EventKind.MAYDAY))
        script.wait(3)
    ana, bo = maydays
    for late in (bo, ana):
        script.record(backfilled_key(U, EVENT.suffix), encode(late))
        script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
        script.wait(3)
    raised = len(script.alarms)
    script.event(U, EventKind.MAYDAY)
    (again,) = script.alarms[raised:]
    assert (again.text, again.alarm_id) == ("Mayday from Bo", script.alarms[0].alarm_id)
    assert len(script.pipeline.state.alarms) == 2


@pytest.mark.parametrize("kind", [EventKind.MAYDAY, EventKind.FALL])
def test_alert_of_an_unworn_unit_is_raised_once_it_is_worn_next(
    script: Script, kind: EventKind
) -> None:
    script.act(Assign(U, "ana", "Ana", "", ""))
    script.wait(3, lambda: script.status(U))
    script.act(Unassign(U))
    script.wait(3, lambda: script.status(U))
    script.event(U, kind)
    script.wait(3)
    script.act(Assign(U, "bo", "Bo", "", ""))
    script.wait(3)
    assert len(script.alarms) == 1


def lie(script: Script, from_s: int, to_s: int) -> None:
    for motionless_s in range(from_s, to_s):
        script.now_s += 1.0
        script.status(U, motionless_s=float(motionless_s))


def test_two_motionless_wearers_of_one_unit_raise_two_alarms(script: Script) -> None:
    script.act(Assign(U, "ana", "Ana", "", ""))
    lie(script, 0, 40)
    script.act(Assign(U, "bo", "Bo", "", ""))
    lie(script, 0, 40)
    ana, bo = "Ana: no motion, 30 s", "Bo: no motion, 30 s"
    assert open_texts(script) == {ana, bo}
    of_bo = next(one.alarm_id for one in script.alarms if one.text == bo)
    lie(script, 0, 3)
    script.act(ResolveAlarm(of_bo, "rests"))
    lie(script, 0, 3)
    assert open_texts(script) == {ana}


def test_wearer_of_a_unit_that_lay_still_can_raise_alarms(script: Script) -> None:
    lie(script, 0, 40)
    script.act(Assign(U, "ana", "Ana", "", ""))
    lie(script, 0, 40)
    assert open_texts(script) == {
        "unit FF-01: no motion, 30 s",
        "Ana: no motion, 30 s",
    }


def test_still_unit_that_is_assigned_again_is_one_alarm(script: Script) -> None:
    script.act(Assign(U, "ana", "Ana", "", ""))
    lie(script, 0, 40)
    count = len(script.alarms)
    script.act(Assign(U, "bo", "Bo", "", ""))
    lie(script, 40, 100)
    assert len(script.alarms) == count


def test_stillness_before_a_hand_over_names_both_wearers(script: Script) -> None:
    """The unit may have changed hands before the station was told."""
    script.act(Assign(U, "ana", "Ana", "", ""))
    lie(script, 0, 25)
    script.act(Assign(U, "bo", "Bo", "", ""))
    lie(script, 25, 40)
    assert [one.text for one in script.alarms] == [
        "Ana: no motion, 20 s",
        "Bo or, before, Ana: no motion, 30 s",
    ]
    assert len({one.alarm_id for one in script.alarms}) == 1


def test_short_stillness_before_a_hand_over_does_not_name_the_former_wearer(script: Script) -> None:
    script.act(Assign(U, "ana", "Ana", "", ""))
    lie(script, 0, 10)
    script.act(Assign(U, "bo", "Bo", "", ""))
    lie(script, 10, 40)
    assert {one.text for one in script.alarms} == {
        f"Bo: no motion, {lain_s} s" for lain_s in (20, 30)
    }


def test_pre_alert_of_a_former_wearer_ends(script: Script) -> None:
    """No message reported that the wearer moved."""
    script.act(Assign(U, "ana", "Ana", "", ""))
    lie(script, 0, 25)
    script.wait(60)
    script.act(Assign(U, "bo", "Bo", "", ""))
    script.wait(30)
    lie(script, 20, 22)
    no_motion = [one for one in script.alarms if one.rule == "no-motion"]
    assert [(one.text.partition(":")[0], one.state.name) for one in no_motion] == [
        ("Ana", "RAISED"),
        ("Ana", "RESOLVED"),
        ("Bo", "RAISED"),
    ]


def test_renamed_wearer_has_one_mayday(script: Script) -> None:
    script.act(Assign(U, "ana", "Ana", "", ""))
    script.wait(3, lambda: script.status(U))
    script.event(U, EventKind.MAYDAY)
    script.act(Assign(U, "ana", "Ana B.", "", ""))
    script.wait(3)
    assert len(script.alarms) == 1


def test_former_wearer_is_erased_from_an_alarm(script: Script) -> None:
    script.act(Assign(U, "ana", "Ana", "", ""))
    script.wait(3, lambda: script.status(U))
    fell = UnitEvent(script.header(U), EventKind.FALL)
    script.wait(3)
    script.act(Assign(U, "bo", "Bo", "", ""))
    script.act(ForgetWearers(U))
    assert b"Ana" not in script.pipeline.checkpoint()
    script.record(backfilled_key(U, EVENT.suffix), encode(fell))
    assert script.alarms[-1].text == "(forgotten): possible fall"


def test_late_fall_of_an_agent_belongs_to_the_wearer_at_its_time(script: Script) -> None:
    agent = tracker_id(U)
    script.boot_ids[agent] = 8
    script.say(message_factory.description(script.header(U), tracker=NO_TRACKER))
    script.act(Assign(U, "ana", "Ana", "", ""))
    script.wait(3, lambda: script.status(agent))
    fell = UnitEvent(script.header(agent), EventKind.FALL)
    script.wait(3)
    script.act(Assign(U, "bo", "Bo", "", ""))
    script.wait(3)
    script.record(backfilled_key(agent, EVENT.suffix), encode(fell))
    assert script.alarms[-1].text == "Ana: possible fall"


def overdue_pair(script: Script) -> None:
    """Ana wears FF-01 and Bo FF-02, and both check-ins are overdue."""
    script.register(U, "FF-02")
    script.act(OpenIncident("i1", "Mill Lane", 30.0, 60.0))
    for unit_id, name in ((U, "Ana"), ("FF-02", "Bo")):
        script.act(Assign(unit_id, name, name, "", ""))
    script.wait(40)


@pytest.mark.parametrize("dealt_with", [False, True])
def test_overdue_member_stays_overdue_with_another_units_alarm(
    script: Script, dealt_with: bool
) -> None:
    overdue_pair(script)
    if dealt_with:
        (of_bo,) = (one for one in script.alarms if one.unit_id == "FF-02")
        script.act(ResolveAlarm(of_bo.alarm_id, ""))
        script.wait(3)
    script.act(Assign("FF-02", "Ana", "Ana", "", ""))
    script.wait(3)
    assert open_texts(script) == {"Ana: PAR overdue, not yet confirmed, on duty for 0 min"}
    script.wait(3)
    raised = [one for one in script.alarms if one.state is AlarmState.RAISED]
    assert len(raised) == 3
    over = [one.alarm_id for one in script.alarms if one.state is AlarmState.RESOLVED]
    assert len(set(over)) == len(over) == 2


def test_hand_over_is_no_check_in_of_an_overdue_member(script: Script) -> None:
    overdue_pair(script)
    script.act(Assign(U, "cem", "Cem", "", ""))
    (over,) = (one for one in script.alarms if one.state is AlarmState.RESOLVED)
    assert (over.text.partition(":")[0], over.by) == ("Ana", "handed over")
    script.act(CheckIn("FF-02", "", everyone=False))
    assert script.alarms[-1].by == "not overdue; PAR confirmed by radio, entered by chief"


def test_member_due_to_rest_is_due_with_another_unit(script: Script) -> None:
    script.register(U, "FF-02")
    script.act(OpenIncident("i1", "Mill Lane", 3600.0, 30.0))
    for unit_id, name in ((U, "Ana"), ("FF-02", "Bo")):
        script.act(Assign(unit_id, name, name, "", ""))
        duty = script.pipeline.state.units[unit_id].duty
        assert duty is not None
        duty.work_since_ns = script.t_ns
        duty.rest_due_ns = script.t_ns + 30 * NS_PER_S
    script.wait(40)
    script.act(Assign("FF-02", "Ana", "Ana", "", ""))
    script.wait(3)
    assert open_texts(script) == {"Ana: work limit reached (1 min), send to rehab"}


STANDING = {
    "mayday": lambda script: script.event(U, EventKind.MAYDAY),
    "fall": lambda script: script.event(U, EventKind.FALL),
    "no-motion": lambda script: script.status(U, motionless_s=40.0),
}


@pytest.mark.parametrize("rule", STANDING)
@pytest.mark.parametrize("known", [False, True])
def test_alarm_stays_the_same_over_any_number_of_hand_overs(
    script: Script, rule: str, known: bool
) -> None:
    script.act(Assign(U, "ana", "Ana", "", ""))
    script.wait(60, lambda: script.status(U))
    began_s = script.now_s - 40.0
    STANDING[rule](script)
    (alarm,) = (one for one in script.alarms if one.rule == rule)
    if known:
        script.act(AcknowledgeAlarm(alarm.alarm_id))
    script.wait(1)
    before = len(script.alarms)
    for number in range(3 * WEARERS_KEPT):
        script.act(Assign(U, str(number), f"P{number}", "", ""))
        still_s = script.now_s - began_s if rule == "no-motion" else 0.0
        script.status(U, motionless_s=still_s, mayday=rule == "mayday")
        script.wait(20)
    assert [one.text for one in script.alarms[before:] if one.rule == rule] == []
    former_wearers = script.pipeline.state.units[U].wearer.former
    assert len(former_wearers) <= 2 * WEARERS_KEPT, "and nothing grows"
