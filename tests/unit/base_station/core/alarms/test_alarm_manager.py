"""Lives of alarms over seconds: events of a unit and the transitions that follow."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from base_station.core.alarms.interface import WARNING, Verdict
from base_station.core.checkpoint import read_checkpoint
from base_station.core.events import Refused
from base_station.core.pipeline import StationPipeline
from base_station.core.state import UnitState
from base_station.fusion import FUSERS
from shared.channels import EVENT, backfilled_key
from shared.codec import encode
from shared.messages import AlarmState, EventKind, Message, Position, Status, UnitEvent
from shared.messages.station import (
    AcknowledgeAlarm,
    RegisterUnit,
    ResolveAlarm,
    SetStart,
)
from shared.quality import Quality, Reason
from tests.rig.alarm_transitions import U, changes, still
from tests.rig.station_script import Script


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    return script


def test_no_motion_warns_then_latches_until_a_person_resets_it(script: Script) -> None:
    still(script, 0, 35)
    assert changes(script, "no-motion") == [("RAISED", "pre-alert"), ("RAISED", "alarm")]
    pre_alert, alarm = script.alarms
    assert pre_alert.alarm_id == alarm.alarm_id
    assert (alarm.header.t_utc_ns - pre_alert.header.t_utc_ns) == 10_000_000_000
    still(script, 0, 15)
    assert len(script.alarms) == 2, "motion does not end the full alarm"
    script.act(ResolveAlarm(alarm.alarm_id, "is well", reason="member_well"))
    resolved = script.alarms[-1]
    assert (resolved.state, resolved.by) == (AlarmState.RESOLVED, "chief")
    assert (resolved.reason, resolved.note, resolved.peak) == ("member_well", "is well", 34.0)


def test_motion_cancels_the_pre_alert(script: Script) -> None:
    still(script, 0, 25)
    still(script, 0, 3)
    assert changes(script, "no-motion") == [("RAISED", "pre-alert"), ("RESOLVED", "pre-alert")]
    assert script.alarms[-1].by == "motion"


def test_no_motion_that_lasts_after_a_reset_alarms_again(script: Script) -> None:
    still(script, 0, 35)
    script.act(ResolveAlarm(script.alarms[-1].alarm_id, ""))
    still(script, 35, 60)
    assert changes(script, "no-motion")[-1] == ("RESOLVED", "alarm")
    still(script, 60, 70)
    assert changes(script, "no-motion")[-1] == ("RAISED", "alarm")


@pytest.mark.parametrize("kind", [EventKind.MAYDAY, EventKind.FALL])
def test_second_alarm_must_be_acknowledged_again(script: Script, kind: EventKind) -> None:
    script.event(U, kind)
    script.wait(1)
    script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
    script.wait(5, lambda: script.status(U, mayday=kind is EventKind.MAYDAY))
    assert script.alarms[-1].state.name == "ACKNOWLEDGED", "it is the same one"
    script.event(U, kind)
    assert script.alarms[-1].state.name == "RAISED"
    assert len({alarm.alarm_id for alarm in script.alarms}) == 1
    assert script.alarms[-1].by == ""


def test_second_stillness_must_be_acknowledged_again(script: Script) -> None:
    still(script, 0, 35)
    script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
    still(script, 35, 60)
    assert changes(script, "no-motion")[-1] == ("ACKNOWLEDGED", "alarm")
    still(script, 0, 25)
    assert changes(script, "no-motion")[-1] == ("ACKNOWLEDGED", "alarm")
    still(script, 25, 31)
    assert changes(script, "no-motion")[-1] == ("RAISED", "alarm")


def test_acknowledged_pre_alert_becomes_the_alarm_of_a_later_stillness(
    script: Script,
) -> None:
    """No message reported the motion between the two."""
    still(script, 0, 25)
    script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
    script.wait(60)
    script.status(U, motionless_s=40.0)
    assert changes(script, "no-motion")[-1] == ("RAISED", "alarm")
    assert script.alarms[-1].priority == 1
    still(script, 0, 5)
    assert changes(script, "no-motion")[-1] == ("RAISED", "alarm"), "a person resolves it"


def test_alarm_keeps_the_time_of_its_last_raising(
    script: Script,
) -> None:
    """An alarm that has eased still asks for an acknowledgement since it was raised."""
    script.wait(5, lambda: script.temperature(U, 120.0))
    script.wait(5, lambda: script.temperature(U, 270.0))
    script.wait(20, lambda: script.temperature(U, 170.0))
    raised, worse, eased = script.alarms
    script.act(AcknowledgeAlarm(raised.alarm_id))
    script.wait(1, lambda: script.temperature(U, 270.0))
    taken, again = script.alarms[3:]
    reported_s = [
        (one.last_raised_ns - raised.header.t_utc_ns) // 10**9
        for one in (raised, worse, eased, taken, again)
    ]
    assert reported_s == [0, 5, 5, 5, 30]
    assert {one.raised_ns for one in script.alarms} == {raised.header.t_utc_ns}


def test_worsening_after_a_person_resolved_it_is_another_alarm(script: Script) -> None:
    script.wait(1, lambda: script.temperature(U, 120.0))
    script.act(ResolveAlarm(script.alarms[0].alarm_id, "is on his way out"))
    script.wait(60, lambda: script.temperature(U, 120.0))
    assert changes(script, "heat")[-1] == ("RESOLVED", "caution")
    script.wait(1, lambda: script.temperature(U, 170.0))
    assert changes(script, "heat")[-1] == ("RAISED", "warning")
    script.act(ResolveAlarm(script.alarms[-1].alarm_id, "is on his way out"))
    script.wait(60, lambda: script.temperature(U, 120.0))
    assert len(changes(script, "heat")) == 4, "what is less is no news of what was resolved"


def test_last_fifty_resolved_alarms_are_kept(script: Script) -> None:
    for _ in range(51):
        script.now_s += 1.0
        script.event(U, EventKind.FALL)
        script.act(ResolveAlarm(script.alarms[-1].alarm_id, ""))
    resolved = [one.alarm_id for one in script.alarms if one.state is AlarmState.RESOLVED]
    assert [one.alarm_id for one in script.pipeline.state.history] == resolved[1:]


def test_resolved_alarm_is_unchanged_after_a_checkpoint(
    script: Script,
) -> None:
    script.wait(1, lambda: script.temperature(U, 120.0))
    script.act(ResolveAlarm(script.alarms[0].alarm_id, "is on his way out"))
    saved = read_checkpoint(script.pipeline.checkpoint())
    script.wait(30, lambda: script.temperature(U, 20.0))
    assert saved is not None
    assert script.pipeline.state.history == saved.state.history


def test_silence_resolves_nothing(script: Script) -> None:
    """The last message was one cool sample; without another the alarm stays."""
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
    assert script.alarms[-1].priority == WARNING
    assert "signal lost" in script.alarms[-1].text
    script.wait(600)
    assert len(changes(script, "link-lost")) == 1
    script.wait(6, lambda: script.status(U))
    assert changes(script, "link-lost") == [("RAISED", "lost"), ("RESOLVED", "lost")]
    assert script.alarms[-1].by == "messages return"


def test_switched_off_unit_is_information_only(script: Script) -> None:
    script.event(U, EventKind.STOPPED)
    script.wait(40)
    (alarm,) = script.alarms
    assert (alarm.rule, alarm.level, alarm.priority) == ("link-lost", "switched off", 3)
    assert "was switched off" in alarm.text


@pytest.mark.parametrize("run", ["earlier", "same"])
def test_backfilled_goodbye_switches_off_no_unit_received_since(script: Script, run: str) -> None:
    script.status(U)
    goodbye = UnitEvent(script.header(U), EventKind.STOPPED)
    script.boot_ids[U] = 8 if run == "earlier" else 7
    script.wait(5, lambda: script.status(U))
    script.record(backfilled_key(U, EVENT.suffix), encode(goodbye))
    script.wait(40)
    assert changes(script, "link-lost") == [("RAISED", "lost")]


def test_battery_resolves_only_above_its_hysteresis(script: Script) -> None:
    script.wait(2, lambda: script.status(U, battery=0.09))
    script.wait(60, lambda: script.status(U, battery=0.12))
    assert changes(script, "battery") == [("RAISED", "low")]
    script.wait(60, lambda: script.status(U, battery=0.9))
    assert changes(script, "battery")[-1] == ("RESOLVED", "low")
    script.wait(1, lambda: script.status(U, battery=0.12))
    assert len(changes(script, "battery")) == 2, "what is resolved stands no more"


def test_two_short_calm_periods_are_no_long_one(
    script: Script,
) -> None:
    for battery, seconds in ((0.09, 2), (0.9, 20), (0.09, 2), (0.9, 20)):
        script.wait(seconds, lambda b=battery: script.status(U, battery=b))  # type: ignore[misc]
    assert changes(script, "battery") == [("RAISED", "low")]


def test_two_calm_moments_are_no_calm_period(script: Script) -> None:
    """The doubt in between cannot be judged yet, which does not mean that there is none."""

    def walk(seconds: int, quality: Quality) -> None:
        script.wait(seconds, lambda: script.position(U, 0.0, 0.0, quality=quality))

    walk(20, Quality.LOST)
    for _ in range(4):
        walk(1, Quality.GOOD)
        walk(9, Quality.LOST)
    assert changes(script, "tracker-degraded") == [("RAISED", "lost")]
    walk(12, Quality.GOOD)
    assert changes(script, "tracker-degraded")[1:] == [("RESOLVED", "lost")]


def test_degradation_for_another_reason_is_raised_once(script: Script) -> None:
    for quality, reasons, seconds in (
        (Quality.LOST, Reason.NO_STANCE, 20),
        (Quality.GOOD, Reason.NONE, 5),
        (Quality.LOST, Reason.SAMPLE_GAP, 20),
    ):
        doubted = {"quality": quality, "reasons": reasons}
        script.wait(seconds, lambda d=doubted: script.position(U, 0.0, 0.0, **d))  # type: ignore[misc]
    assert changes(script, "tracker-degraded") == [("RAISED", "lost")]


def test_two_less_severe_moments_do_not_lower_the_level(script: Script) -> None:
    def walk(seconds: int, quality: Quality) -> None:
        script.wait(seconds, lambda: script.position(U, 0.0, 0.0, quality=quality))

    walk(20, Quality.LOST)
    walk(2, Quality.DEGRADED)
    walk(1, Quality.GOOD)
    walk(14, Quality.LOST)
    walk(4, Quality.DEGRADED)
    assert changes(script, "tracker-degraded") == [("RAISED", "lost")]


def test_two_messages_far_apart_are_no_link(script: Script) -> None:
    script.wait(5, lambda: script.status(U))
    script.wait(31)
    for _ in range(4):
        script.status(U)
        script.wait(25)
    assert changes(script, "link-lost") == [("RAISED", "lost")]


def test_resolved_alarm_is_not_reopened_by_a_late_acknowledgement(script: Script) -> None:
    """At two consoles, one resolves it while the other is about to acknowledge it."""
    script.event(U, EventKind.MAYDAY)
    alarm_id = script.alarms[-1].alarm_id
    script.act(ResolveAlarm(alarm_id, "is well"))
    for too_late in (AcknowledgeAlarm(alarm_id), ResolveAlarm(alarm_id, "")):
        (refused,) = script.act(too_late, by="deputy")
        assert isinstance(refused, Refused)
        assert refused.reason == f"no open alarm {alarm_id}"
    assert changes(script, "mayday") == [("RAISED", "mayday"), ("RESOLVED", "mayday")]


def test_lost_position_is_an_alarm_until_it_is_known(script: Script) -> None:
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


def test_acknowledged_alarm_that_worsens_must_be_acknowledged_again(script: Script) -> None:
    script.wait(1, lambda: script.temperature(U, 120.0))
    script.act(AcknowledgeAlarm(script.alarms[0].alarm_id), by="anna")
    assert (script.alarms[-1].state, script.alarms[-1].by) == (AlarmState.ACKNOWLEDGED, "anna")
    (again,) = script.act(AcknowledgeAlarm(script.alarms[0].alarm_id), by="bert")
    assert isinstance(again, Refused)
    assert "anna" in again.reason
    script.wait(1, lambda: script.temperature(U, 170.0))
    assert (script.alarms[-1].state, script.alarms[-1].level) == (AlarmState.RAISED, "warning")
    assert script.pipeline.state.alarms[f"heat|{U}"].changed_ns == script.t_ns


def test_unregistered_unit_raises_one_alarm_and_no_other() -> None:
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


@dataclass(frozen=True)
class CountingRule:
    """A rule without state: it appends the time of each call to a list."""

    asked: list[int]
    name: str = "asked"
    levels: tuple[str, ...] = ("x",)
    clear_after_s: float = 0.0
    rearm_after_s: float | None = None
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:
        self.asked.append(t_ns)
        return None


@pytest.mark.parametrize(("triggered_by", "times"), [((), 0), ((Status,), 1), ((Position,), 0)])
def test_frequent_inputs_call_only_the_rules_triggered_by_them(
    triggered_by: tuple[type[Message], ...], times: int
) -> None:
    rule = CountingRule([], triggered_by=triggered_by)
    script = Script(StationPipeline((rule,), FUSERS[0]))
    script.register(U)
    rule.asked.clear()
    script.status(U)
    assert len(rule.asked) == times
    script.event(U, EventKind.FALL)
    assert len(rule.asked) == times + 1
