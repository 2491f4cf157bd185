"""Lives of alarms, told in seconds: what happens to a unit and which changes come of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import pytest

from base_station.alarms import ALARMS
from base_station.alarms.port import SOON, Verdict
from base_station.bench.rig import said
from base_station.checkpoint import read_checkpoint
from base_station.events import Refused
from base_station.fusion import FUSERS
from base_station.live_state import UnitState
from base_station.pipeline import StationPipeline
from shared.channels import EVENT, backfilled_key
from shared.codec import encode
from shared.messages import AlarmState, EventKind, Message, Position, Status, UnitEvent
from shared.messages.station import (
    AcknowledgeAlarm,
    CloseIncident,
    OpenIncident,
    RegisterUnit,
    ReportProblem,
    ResolveAlarm,
    SetStart,
)
from shared.quality import Quality, Reason
from tests.station_script import Script

U = "FF-01"


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    return script


def changes(script: Script, rule: str) -> list[tuple[str, str]]:
    return [(a.state.name, a.level) for a in script.alarms if a.rule == rule]


def still(script: Script, from_s: float, to_s: float) -> None:
    for motionless_s in range(round(from_s), round(to_s)):
        script.wait(1, lambda m=motionless_s: script.status(U, motionless_s=float(m)))  # type: ignore[misc]


def test_no_motion_warns_then_latches_until_a_person_resets_it(script: Script) -> None:
    still(script, 0, 35)
    assert changes(script, "no-motion") == [("RAISED", "pre-alert"), ("RAISED", "alarm")]
    pre_alert, alarm = script.alarms
    assert pre_alert.alarm_id == alarm.alarm_id
    assert (alarm.header.t_utc_ns - pre_alert.header.t_utc_ns) == 10_000_000_000
    still(script, 0, 15)
    assert len(script.alarms) == 2, "motion does not end the full alarm"
    script.act(ResolveAlarm(alarm.alarm_id, "is well"))
    assert script.alarms[-1].state is AlarmState.RESOLVED
    assert script.alarms[-1].by == "chief: is well"


def test_motion_cancels_the_pre_alert(script: Script) -> None:
    still(script, 0, 25)
    still(script, 0, 3)
    assert changes(script, "no-motion") == [("RAISED", "pre-alert"), ("RESOLVED", "pre-alert")]
    assert script.alarms[-1].by == "motion"


def test_no_motion_that_goes_on_after_a_reset_alarms_again(script: Script) -> None:
    still(script, 0, 35)
    script.act(ResolveAlarm(script.alarms[-1].alarm_id, ""))
    still(script, 35, 60)
    assert changes(script, "no-motion")[-1] == ("RESOLVED", "alarm")
    still(script, 60, 70)
    assert changes(script, "no-motion")[-1] == ("RAISED", "alarm")


def test_mayday_is_immediate_and_the_wearer_cannot_resolve_it(script: Script) -> None:
    (alarm,) = [o for o in script.event(U, EventKind.MAYDAY) if o in script.alarms]
    script.wait(20, lambda: script.status(U, mayday=True))
    script.event(U, EventKind.MAYDAY_CANCELLED)
    script.wait(20, lambda: script.status(U, mayday=False))
    assert changes(script, "mayday") == [("RAISED", "mayday")]
    script.act(ResolveAlarm(alarm.alarm_id, "spoke to him"))
    script.wait(5, lambda: script.status(U, mayday=False))
    assert changes(script, "mayday")[-1] == ("RESOLVED", "mayday")


def test_a_mayday_whose_event_was_lost_is_seen_in_the_status(script: Script) -> None:
    script.wait(3, lambda: script.status(U, mayday=True))
    assert changes(script, "mayday") == [("RAISED", "mayday")]


@pytest.mark.parametrize("dealt_with", [AcknowledgeAlarm, lambda one: ResolveAlarm(one, "seen")])
def test_the_press_that_a_status_told_is_no_other_one_when_the_journal_brings_it(
    script: Script, dealt_with: Callable[[str], AcknowledgeAlarm | ResolveAlarm]
) -> None:
    script.wait(1, lambda: script.status(U))
    pressed = UnitEvent(script.header(U), EventKind.MAYDAY)
    script.wait(1, lambda: script.status(U, mayday=True))
    script.wait(5)
    script.act(dealt_with(script.alarms[-1].alarm_id))
    script.wait(5, lambda: script.status(U, mayday=True))
    script.record(backfilled_key(U, EVENT.suffix), encode(pressed))
    script.wait(1)
    assert len(changes(script, "mayday")) == 2
    script.event(U, EventKind.MAYDAY)
    assert changes(script, "mayday")[2:] == [("RAISED", "mayday")]


def test_a_mayday_taken_back_before_it_was_pressed_again_stands(script: Script) -> None:
    """The radio lost the first press and that it was taken back."""
    script.wait(1, lambda: script.status(U))
    cancelled = UnitEvent(script.header(U), EventKind.MAYDAY_CANCELLED)
    script.wait(3)
    script.event(U, EventKind.MAYDAY)
    script.wait(1)
    script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
    script.record(backfilled_key(U, EVENT.suffix), encode(cancelled))
    script.wait(3, lambda: script.status(U, mayday=True))
    assert changes(script, "mayday") == [("RAISED", "mayday"), ("ACKNOWLEDGED", "mayday")]


@pytest.mark.parametrize("is_pressed", [True, False])
@pytest.mark.parametrize("before_s", [0.0, 0.1])
def test_a_status_that_an_alert_overtook_presses_nothing_and_takes_nothing_back(
    script: Script, is_pressed: bool, before_s: float
) -> None:
    words = [EventKind.MAYDAY, EventKind.MAYDAY_CANCELLED, EventKind.MAYDAY]
    for kind in words if is_pressed else words[:2]:
        before = said.status(script.header(U), mayday=not is_pressed)
        script.now_s += before_s
        script.event(U, kind)
        script.now_s += 0.1
    script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
    count = len(changes(script, "mayday"))
    script.wait(1)
    script.say(before)
    script.wait(3, lambda: script.status(U, mayday=is_pressed))
    assert len(changes(script, "mayday")) == count


def test_a_press_that_comes_at_once_with_an_earlier_cancellation_is_a_mayday(
    script: Script,
) -> None:
    """What comes out of a journal in one go may have one time."""
    script.event(U, EventKind.MAYDAY_CANCELLED)
    script.event(U, EventKind.MAYDAY)
    assert changes(script, "mayday") == [("RAISED", "mayday")]


def test_pressing_again_is_another_mayday(script: Script) -> None:
    script.event(U, EventKind.MAYDAY)
    script.act(ResolveAlarm(script.alarms[-1].alarm_id, ""))
    script.wait(5, lambda: script.status(U, mayday=True))
    assert changes(script, "mayday")[-1] == ("RESOLVED", "mayday"), "it is the same press"
    script.event(U, EventKind.MAYDAY)
    assert changes(script, "mayday")[-1] == ("RAISED", "mayday")
    assert script.alarms[0].alarm_id != script.alarms[-1].alarm_id


def test_who_presses_again_after_taking_it_back_is_heard(script: Script) -> None:
    script.event(U, EventKind.MAYDAY)
    script.wait(1)
    script.event(U, EventKind.MAYDAY_CANCELLED)
    script.act(ResolveAlarm(script.alarms[-1].alarm_id, "spoke to him"))
    script.wait(5, lambda: script.status(U))
    assert changes(script, "mayday")[-1] == ("RESOLVED", "mayday")
    script.event(U, EventKind.MAYDAY)
    assert changes(script, "mayday")[-1] == ("RAISED", "mayday")


@pytest.mark.parametrize("kind", [EventKind.MAYDAY, EventKind.FALL])
def test_another_one_is_to_be_acknowledged_again(script: Script, kind: EventKind) -> None:
    script.event(U, kind)
    script.wait(1)
    script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
    script.wait(5, lambda: script.status(U, mayday=kind is EventKind.MAYDAY))
    assert script.alarms[-1].state.name == "ACKNOWLEDGED", "it is the same one"
    script.event(U, kind)
    assert script.alarms[-1].state.name == "RAISED"
    assert len({alarm.alarm_id for alarm in script.alarms}) == 1
    assert script.alarms[-1].by == ""


def test_who_lies_still_a_second_time_is_to_be_acknowledged_again(script: Script) -> None:
    still(script, 0, 35)
    script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
    still(script, 35, 60)
    assert changes(script, "no-motion")[-1] == ("ACKNOWLEDGED", "alarm")
    still(script, 0, 25)
    assert changes(script, "no-motion")[-1] == ("ACKNOWLEDGED", "alarm")
    still(script, 25, 31)
    assert changes(script, "no-motion")[-1] == ("RAISED", "alarm")


def test_a_pre_alert_that_was_acknowledged_becomes_the_alarm_of_a_later_stillness(
    script: Script,
) -> None:
    """Nobody heard of the motion between the two."""
    still(script, 0, 25)
    script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
    script.wait(60)
    script.status(U, motionless_s=40.0)
    assert changes(script, "no-motion")[-1] == ("RAISED", "alarm")
    assert script.alarms[-1].priority == 1
    still(script, 0, 5)
    assert changes(script, "no-motion")[-1] == ("RAISED", "alarm"), "a person resolves it"


def test_a_late_mayday_of_an_earlier_run_still_counts(script: Script) -> None:
    script.event(U, EventKind.STARTED)
    late = script.header(U, captured_s=-5.0)
    script.event(U, EventKind.STOPPED)
    script.say(UnitEvent(late, EventKind.MAYDAY))
    assert changes(script, "mayday") == [("RAISED", "mayday")]


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


def test_heat_that_eases_is_of_a_lower_level_once_it_stays_so(script: Script) -> None:
    script.wait(1, lambda: script.temperature(U, 270.0))
    script.wait(8, lambda: script.temperature(U, 170.0))
    script.wait(1, lambda: script.temperature(U, 270.0))
    script.act(AcknowledgeAlarm(script.alarms[0].alarm_id))
    script.wait(10, lambda: script.temperature(U, 170.0))
    assert changes(script, "heat") == [("RAISED", "critical"), ("ACKNOWLEDGED", "critical")]
    script.wait(1, lambda: script.temperature(U, 170.0))
    assert changes(script, "heat")[2:] == [("ACKNOWLEDGED", "warning")]
    assert script.alarms[-1].priority == SOON
    assert "170 °C" in script.alarms[-1].text
    script.wait(10, lambda: script.temperature(U, 120.0))
    assert len(changes(script, "heat")) == 3, "that it is lower still has to stay so, too"
    script.wait(1, lambda: script.temperature(U, 120.0))
    assert changes(script, "heat")[3:] == [("ACKNOWLEDGED", "caution")]


def test_an_alarm_says_when_it_was_raised_last_whatever_has_become_of_it_since(
    script: Script,
) -> None:
    """An alarm that has eased asks for somebody since it was raised."""
    script.wait(5, lambda: script.temperature(U, 120.0))
    script.wait(5, lambda: script.temperature(U, 270.0))
    script.wait(20, lambda: script.temperature(U, 170.0))
    raised, worse, eased = script.alarms
    script.act(AcknowledgeAlarm(raised.alarm_id))
    script.wait(1, lambda: script.temperature(U, 270.0))
    taken, again = script.alarms[3:]
    told_s = [
        (one.last_raised_ns - raised.header.t_utc_ns) // 10**9
        for one in (raised, worse, eased, taken, again)
    ]
    assert told_s == [0, 5, 5, 5, 30]
    assert {one.raised_ns for one in script.alarms} == {raised.header.t_utc_ns}


def test_what_gets_worse_after_a_person_resolved_it_is_another_alarm(script: Script) -> None:
    script.wait(1, lambda: script.temperature(U, 120.0))
    script.act(ResolveAlarm(script.alarms[0].alarm_id, "is on his way out"))
    script.wait(60, lambda: script.temperature(U, 120.0))
    assert changes(script, "heat")[-1] == ("RESOLVED", "caution")
    script.wait(1, lambda: script.temperature(U, 170.0))
    assert changes(script, "heat")[-1] == ("RAISED", "warning")
    script.act(ResolveAlarm(script.alarms[-1].alarm_id, "is on his way out"))
    script.wait(60, lambda: script.temperature(U, 120.0))
    assert len(changes(script, "heat")) == 4, "what is less is no news of what was resolved"


def test_the_last_fifty_resolved_alarms_are_at_hand(script: Script) -> None:
    for _ in range(51):
        script.now_s += 1.0
        script.event(U, EventKind.FALL)
        script.act(ResolveAlarm(script.alarms[-1].alarm_id, ""))
    resolved = [one.alarm_id for one in script.alarms if one.state is AlarmState.RESOLVED]
    assert [one.alarm_id for one in script.pipeline.state.history] == resolved[1:]


def test_a_resolved_alarm_stays_as_it_ended_from_a_checkpoint_as_in_memory(
    script: Script,
) -> None:
    script.wait(1, lambda: script.temperature(U, 120.0))
    script.act(ResolveAlarm(script.alarms[0].alarm_id, "is on his way out"))
    saved = read_checkpoint(script.pipeline.checkpoint())
    script.wait(30, lambda: script.temperature(U, 20.0))
    assert saved is not None
    assert script.pipeline.state.history == saved.state.history


def test_heat_that_flickers_about_a_limit_is_one_alarm(script: Script) -> None:
    for step in range(60):
        script.wait(1, lambda s=step: script.temperature(U, 99.0 + 3.0 * (s % 2)))  # type: ignore[misc]
    assert changes(script, "heat") == [("RAISED", "caution")]


def test_a_used_up_heat_budget_is_told_below_every_limit(script: Script) -> None:
    script.wait(1600, lambda: script.temperature(U, 90.0))
    assert changes(script, "heat") == []
    assert changes(script, "heat-dose") == [("RAISED", "used up")]
    raised_s = (script.alarms[0].raised_ns - script.records[0][0]) / 1e9
    assert raised_s == pytest.approx(1501.0, abs=2.0)


def test_a_used_up_heat_budget_hides_no_heat_and_is_whole_in_another_incident(
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
    assert script.pipeline.state.units[U].heat_dose == 0.0
    hot(300.0, 65.0)
    assert changes(script, "heat-dose")[2:] == [("RAISED", "used up")]


def test_silence_resolves_nothing(script: Script) -> None:
    """The last word was one cool sample; without another the alarm stays."""
    script.wait(1, lambda: script.temperature(U, 120.0))
    script.wait(1, lambda: script.temperature(U, 20.0))
    script.wait(200)
    assert changes(script, "heat") == [("RAISED", "caution")]


def test_link_lost_is_raised_at_30_s_and_ends_when_messages_return(script: Script) -> None:
    script.wait(5, lambda: script.status(U))
    script.wait(29)
    assert changes(script, "link-lost") == []
    script.wait(2)
    assert changes(script, "link-lost") == [("RAISED", "lost")]
    assert script.alarms[-1].priority == SOON
    assert "Nothing heard" in script.alarms[-1].text
    script.wait(600)
    assert len(changes(script, "link-lost")) == 1
    script.wait(6, lambda: script.status(U))
    assert changes(script, "link-lost") == [("RAISED", "lost"), ("RESOLVED", "lost")]
    assert script.alarms[-1].by == "messages return"


def test_a_unit_that_was_switched_off_is_information_only(script: Script) -> None:
    script.event(U, EventKind.STOPPED)
    script.wait(40)
    (alarm,) = script.alarms
    assert (alarm.rule, alarm.level, alarm.priority) == ("link-lost", "switched off", 3)
    assert "was switched off" in alarm.text


@pytest.mark.parametrize("run", ["earlier", "same"])
def test_a_goodbye_out_of_the_journal_switches_nobody_off_who_has_spoken_since(
    script: Script, run: str
) -> None:
    script.status(U)
    goodbye = UnitEvent(script.header(U), EventKind.STOPPED)
    script.boot_ids[U] = 8 if run == "earlier" else 7
    script.wait(5, lambda: script.status(U))
    script.record(backfilled_key(U, EVENT.suffix), encode(goodbye))
    script.wait(40)
    assert changes(script, "link-lost") == [("RAISED", "lost")]


def test_a_sensor_that_fails_is_told_in_the_unit_s_words_until_a_person_has_seen_it(
    script: Script,
) -> None:
    script.event(U, EventKind.SENSOR_FAULT, "the accelerometer is stuck")
    (alarm,) = script.alarms
    assert (alarm.rule, alarm.priority) == ("unit-fault", SOON)
    assert alarm.text == "unit FF-01's unit: the accelerometer is stuck"
    script.wait(60, lambda: script.status(U))
    script.act(ResolveAlarm(alarm.alarm_id, "gets another"))
    script.now_s += 1.0
    script.event(U, EventKind.STORAGE_FAULT)
    assert script.alarms[-1].text == "unit FF-01's unit: storage fault"
    assert [one.state.name for one in script.alarms] == ["RAISED", "RESOLVED", "RAISED"]


def fault_texts(script: Script) -> set[str]:
    """Of those that stand."""
    alarms = script.pipeline.state.alarms.values()
    return {one.text.partition(": ")[2] for one in alarms if one.is_open}


def test_faults_of_one_unit_stand_beside_each_other_and_each_is_told_once(script: Script) -> None:
    details = ("the accelerometer is stuck", "the gyroscope is stuck", "no sample for 1.3 s")
    for detail in (*details, *details, "no sample for 2.5 s"):
        script.event(U, EventKind.SENSOR_FAULT, detail)
        script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
        script.wait(1)
    told = [one.text for one in script.alarms if one.state is AlarmState.RAISED]
    assert [text.partition(": ")[2] for text in told] == list(details)
    assert fault_texts(script) == set(details)


def test_a_fault_is_over_by_itself_and_is_told_anew_when_it_comes_again(script: Script) -> None:
    ids = {}
    for detail in ("A", "B", "C"):
        script.event(U, EventKind.SENSOR_FAULT, detail)
        ids[detail] = script.alarms[-1].alarm_id
        script.wait(1)
    for detail, standing in (("C", {"A", "B"}), ("A", {"B"})):
        script.act(ResolveAlarm(ids[detail], ""))
        script.wait(3)
        assert fault_texts(script) == standing
    before = len(script.alarms)
    script.event(U, EventKind.SENSOR_FAULT, "B")
    script.wait(1)
    assert len(script.alarms) == before, "it stands, though one that came later is over"
    script.event(U, EventKind.SENSOR_FAULT, "A")
    script.wait(1)
    assert script.alarms[-1].alarm_id not in ids.values()
    assert fault_texts(script) == {"A", "B"}


def test_faults_that_come_at_once_have_ids_of_their_own(script: Script) -> None:
    """What comes out of a journal in one go may have one time."""
    for detail in ("A", "B", "C"):
        script.event(U, EventKind.SENSOR_FAULT, detail)
    assert len({one.alarm_id for one in script.alarms}) == 3
    assert fault_texts(script) == {"A", "B", "C"}


def test_of_faults_without_end_the_last_is_told_and_few_are_kept(script: Script) -> None:
    details = [letter * 3 for letter in "abcdefghijklmnopqrstuvwxyz"]
    for detail in details:
        script.event(U, EventKind.SENSOR_FAULT, detail)
        script.wait(1)
        assert script.alarms[-1].text.endswith(detail)
        assert script.alarms[-1].state is AlarmState.RAISED
    assert fault_texts(script) == {*details[:10], details[-1]}
    before = len(script.alarms)
    script.event(U, EventKind.SENSOR_FAULT, details[3])
    script.wait(1)
    assert len(script.alarms) == before, "of those that are kept each stands by itself"
    script.event(U, EventKind.SENSOR_FAULT, "and yet another")
    told = script.alarms[-1].text
    script.act(ResolveAlarm(script.alarms[0].alarm_id, ""))
    script.wait(3)
    assert script.alarms[-1].state is AlarmState.RESOLVED, "nothing is told anew for the room"
    assert told.partition(": ")[2] in fault_texts(script)


def test_faults_that_stand_do_so_after_a_restart(script: Script) -> None:
    for detail in ("A", "B"):
        script.event(U, EventKind.SENSOR_FAULT, detail)
        script.wait(1)
    saved = read_checkpoint(script.pipeline.checkpoint())
    script.pipeline = StationPipeline(ALARMS, FUSERS[0], saved)
    before = len(script.alarms)
    for detail in ("A", "B"):
        script.event(U, EventKind.SENSOR_FAULT, detail)
        script.wait(1)
    assert len(script.alarms) == before
    assert fault_texts(script) == {"A", "B"}


def test_battery_resolves_only_above_its_hysteresis(script: Script) -> None:
    script.wait(2, lambda: script.status(U, battery=0.09))
    script.wait(60, lambda: script.status(U, battery=0.12))
    assert changes(script, "battery") == [("RAISED", "low")]
    script.wait(60, lambda: script.status(U, battery=0.9))
    assert changes(script, "battery")[-1] == ("RESOLVED", "low")
    script.wait(1, lambda: script.status(U, battery=0.12))
    assert len(changes(script, "battery")) == 2, "what is resolved stands no more"


def test_what_was_well_for_two_short_whiles_has_not_been_well_for_a_long_one(
    script: Script,
) -> None:
    for battery, seconds in ((0.09, 2), (0.9, 20), (0.09, 2), (0.9, 20)):
        script.wait(seconds, lambda b=battery: script.status(U, battery=b))  # type: ignore[misc]
    assert changes(script, "battery") == [("RAISED", "low")]


def test_what_was_well_for_two_moments_has_not_been_well_in_between(script: Script) -> None:
    """Nothing can be said yet of the doubt in between, which is not to say that there is none."""

    def walk(seconds: int, quality: Quality) -> None:
        script.wait(seconds, lambda: script.position(U, 0.0, 0.0, quality=quality))

    walk(20, Quality.LOST)
    for _ in range(4):
        walk(1, Quality.GOOD)
        walk(9, Quality.LOST)
    assert changes(script, "tracker-degraded") == [("RAISED", "lost")]
    walk(12, Quality.GOOD)
    assert changes(script, "tracker-degraded")[1:] == [("RESOLVED", "lost")]


def test_doubt_that_comes_again_for_another_reason_is_told_once(script: Script) -> None:
    for quality, reasons, seconds in (
        (Quality.LOST, Reason.NO_STANCE, 20),
        (Quality.GOOD, Reason.NONE, 5),
        (Quality.LOST, Reason.SAMPLE_GAP, 20),
    ):
        doubted = {"quality": quality, "reasons": reasons}
        script.wait(seconds, lambda d=doubted: script.position(U, 0.0, 0.0, **d))  # type: ignore[misc]
    assert changes(script, "tracker-degraded") == [("RAISED", "lost")]


def test_what_was_less_bad_for_two_moments_has_not_been_so_in_between(script: Script) -> None:
    def walk(seconds: int, quality: Quality) -> None:
        script.wait(seconds, lambda: script.position(U, 0.0, 0.0, quality=quality))

    walk(20, Quality.LOST)
    walk(2, Quality.DEGRADED)
    walk(1, Quality.GOOD)
    walk(14, Quality.LOST)
    walk(4, Quality.DEGRADED)
    assert changes(script, "tracker-degraded") == [("RAISED", "lost")]


def test_two_words_far_apart_are_no_link(script: Script) -> None:
    script.wait(5, lambda: script.status(U))
    script.wait(31)
    for _ in range(4):
        script.status(U)
        script.wait(25)
    assert changes(script, "link-lost") == [("RAISED", "lost")]


def test_what_is_resolved_is_not_opened_again_by_who_presses_too_late(script: Script) -> None:
    """At two consoles, one resolves it while the other is about to acknowledge it."""
    script.event(U, EventKind.MAYDAY)
    alarm_id = script.alarms[-1].alarm_id
    script.act(ResolveAlarm(alarm_id, "is well"))
    for too_late in (AcknowledgeAlarm(alarm_id), ResolveAlarm(alarm_id, "")):
        (refused,) = script.act(too_late, by="deputy")
        assert isinstance(refused, Refused)
        assert refused.reason == f"no open alarm {alarm_id}"
    assert changes(script, "mayday") == [("RAISED", "mayday"), ("RESOLVED", "mayday")]


def test_a_position_that_nobody_knows_is_an_alarm_until_it_is_known(script: Script) -> None:
    script.act(SetStart(U, 0.0, 0.0, 0.0, 0.0, 200.0, 0.1))
    script.wait(10, lambda: script.position(U, 0.0, 0.0))
    assert changes(script, "position-lost") == []
    script.wait(60)
    assert changes(script, "position-lost") == [], "silence is another alarm"
    script.wait(10, lambda: script.position(U, 0.0, 0.0))
    assert changes(script, "position-lost") == [("RAISED", "lost")]
    script.act(SetStart(U, 0.0, 0.0, 0.0, 0.0, 1.0, 0.1))
    script.wait(9, lambda: script.position(U, 0.0, 0.0))
    assert len(changes(script, "position-lost")) == 1, "it has to stay known"
    script.wait(3, lambda: script.position(U, 0.0, 0.0))
    assert changes(script, "position-lost")[-1] == ("RESOLVED", "lost")


def test_an_acknowledged_alarm_that_gets_worse_asks_again(script: Script) -> None:
    script.wait(1, lambda: script.temperature(U, 120.0))
    script.act(AcknowledgeAlarm(script.alarms[0].alarm_id), by="anna")
    assert (script.alarms[-1].state, script.alarms[-1].by) == (AlarmState.ACKNOWLEDGED, "anna")
    (again,) = script.act(AcknowledgeAlarm(script.alarms[0].alarm_id), by="bert")
    assert isinstance(again, Refused)
    assert "anna" in again.reason
    script.wait(1, lambda: script.temperature(U, 170.0))
    assert (script.alarms[-1].state, script.alarms[-1].level) == (AlarmState.RAISED, "warning")
    assert script.pipeline.state.alarms[f"heat|{U}"].changed_ns == script.t_ns


def test_an_unknown_unit_is_reported_once_and_not_believed() -> None:
    script = Script()
    script.event("stranger", EventKind.MAYDAY)
    script.wait(50, lambda: script.position("stranger", 1.0, 2.0))
    assert [(a.rule, a.unit_id) for a in script.alarms] == [("unknown-unit", "stranger")]
    assert script.fused == []
    script.act(RegisterUnit("stranger", "four"))
    assert [(a.rule, a.state.name) for a in script.alarms[1:]] == [
        ("mayday", "RAISED"),
        ("unknown-unit", "RESOLVED"),
    ]


def test_a_press_that_was_taken_back_before_the_unit_was_ours_is_no_mayday() -> None:
    script = Script()
    script.event(U, EventKind.MAYDAY)
    script.event(U, EventKind.MAYDAY_CANCELLED)
    script.register(U)
    assert changes(script, "mayday") == []


def test_a_problem_of_the_station_is_an_alarm(script: Script) -> None:
    script.act(ReportProblem("log", "The disk is full"), by="station")
    script.act(ReportProblem("log", "The disk is full"), by="station")
    assert script.pipeline.state.problems == {"log": "The disk is full"}
    script.act(ReportProblem("log", ""), by="station")
    assert [(a.unit_id, a.state.name, a.text) for a in script.alarms] == [
        ("", "RAISED", "The disk is full"),
        ("", "RESOLVED", "The disk is full"),
    ]
    assert script.pipeline.state.problems == {}


def test_a_problem_that_a_person_resolved_is_none_until_it_is_reported_again(
    script: Script,
) -> None:
    for _ in range(2):
        script.act(ReportProblem("log", "The disk is full"), by="station")
        script.act(ResolveAlarm(script.alarms[-1].alarm_id, "it has room again"))
        assert script.pipeline.state.problems == {}
    assert [one.state.name for one in script.alarms] == ["RAISED", "RESOLVED"] * 2


def test_another_problem_of_the_same_part_is_told_while_the_first_one_stands(
    script: Script,
) -> None:
    script.act(ReportProblem("log", "The disk is nearly full"), by="station")
    script.act(AcknowledgeAlarm(script.alarms[0].alarm_id))
    for _ in range(2):
        script.wait(1)
        script.act(ReportProblem("log", "The log cannot be written"), by="station")
    assert [(a.state.name, a.text, a.by) for a in script.alarms[1:]] == [
        ("ACKNOWLEDGED", "The disk is nearly full", "chief"),
        ("RAISED", "The log cannot be written", ""),
    ]
    assert len({a.alarm_id for a in script.alarms}) == 1
    changed_ns = script.pipeline.state.alarms["station|log"].changed_ns
    assert changed_ns == script.alarms[-1].header.t_utc_ns


def test_a_part_that_says_less_or_other_numbers_says_nothing_new(script: Script) -> None:
    for text in (
        "3 records are missing",
        "3 records are missing; its disk does not answer",
        "4 records are missing",
        "9 records are missing; its disk does not answer",
    ):
        script.wait(1)
        script.act(ReportProblem("log", text), by="station")
    assert [a.text for a in script.alarms] == [
        "3 records are missing",
        "3 records are missing; its disk does not answer",
    ]


@dataclass(frozen=True)
class Broken:
    name: str = "broken"
    levels: tuple[str, ...] = ("x",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    for_strangers: bool = False
    heeds: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:
        raise ZeroDivisionError("nothing to divide")


def test_a_failing_rule_is_reported_and_the_others_go_on() -> None:
    script = Script(StationPipeline((Broken(), *ALARMS), FUSERS[0]))
    script.register(U)
    script.wait(3, lambda: script.event(U, EventKind.MAYDAY))
    assert [a.rule for a in script.alarms] == ["station", "mayday"]
    assert "'broken'" in script.alarms[0].text
    assert "ZeroDivisionError" in script.alarms[0].text


def test_a_rule_that_fails_for_every_unit_is_one_problem() -> None:
    script = Script(StationPipeline((Broken(),), FUSERS[0]))
    script.register(U, "FF-02")
    script.wait(3)
    assert [a.state.name for a in script.alarms] == ["RAISED"]
    script.act(ResolveAlarm(script.alarms[0].alarm_id, "reported"))
    script.wait(1)
    assert [a.state.name for a in script.alarms] == ["RAISED", "RESOLVED", "RAISED"]


@dataclass(frozen=True)
class Asked:
    """Keeps nothing of itself: it notes in a list when it was asked."""

    asked: list[int]
    name: str = "asked"
    levels: tuple[str, ...] = ("x",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    for_strangers: bool = False
    heeds: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:
        self.asked.append(t_ns)
        return None


@pytest.mark.parametrize(("heeds", "times"), [((), 0), ((Status,), 1), ((Position,), 0)])
def test_a_rule_looks_at_what_comes_all_the_time_only_where_it_heeds_it(
    heeds: tuple[type[Message], ...], times: int
) -> None:
    rule = Asked([], heeds=heeds)
    script = Script(StationPipeline((rule,), FUSERS[0]))
    script.register(U)
    rule.asked.clear()
    script.status(U)
    assert len(rule.asked) == times
    script.event(U, EventKind.FALL)
    assert len(rule.asked) == times + 1
