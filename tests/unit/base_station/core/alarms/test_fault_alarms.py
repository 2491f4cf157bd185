"""Alarms of faults: of a unit, of the station, of a rule itself."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from base_station.core.alarms import ALARMS
from base_station.core.alarms.interface import WARNING, Verdict
from base_station.core.checkpoint import read_checkpoint
from base_station.core.pipeline import StationPipeline
from base_station.core.state import UnitState
from base_station.fusion import FUSERS
from edge.fault_texts import fault_of
from shared.coded_text import coded
from shared.messages import AlarmState, EventKind, Message
from shared.messages.station import (
    AcknowledgeAlarm,
    ReportProblem,
    ResolveAlarm,
)
from tests.rig.alarm_transitions import U
from tests.rig.station_script import Script


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(U)
    return script


def test_sensor_fault_is_an_alarm_with_the_units_text_until_acknowledged(
    script: Script,
) -> None:
    script.event(U, EventKind.SENSOR_FAULT, "the accelerometer is stuck")
    (alarm,) = script.alarms
    assert (alarm.rule, alarm.priority) == ("unit-fault", WARNING)
    assert alarm.text == "unit FF-01's unit: the accelerometer is stuck"
    script.wait(60, lambda: script.status(U))
    script.act(ResolveAlarm(alarm.alarm_id, "gets another"))
    script.now_s += 1.0
    script.event(U, EventKind.STORAGE_FAULT)
    assert script.alarms[-1].text == "unit FF-01's unit: storage fault"
    assert [one.state.name for one in script.alarms] == ["RAISED", "RESOLVED", "RAISED"]


def test_code_of_a_units_fault_goes_with_its_alarm(script: Script) -> None:
    fault = fault_of("BAT0", coded("reading-hangs", "no reading for {silent_s:.0f} s", silent_s=6))
    script.event(U, EventKind.SENSOR_FAULT, fault)
    (alarm,) = script.alarms
    assert alarm.text == "unit FF-01's unit: BAT0: no reading for 6 s"
    given = alarm.parameters
    assert (given.member, given.fault) == ("unit FF-01", "BAT0: no reading for 6 s")
    assert given.fault_code == "fault-of"
    assert given.fault_texts["fault:"] == "reading-hangs"
    assert given.fault_numbers == {"fault:silent_s": 6.0}


def test_fault_of_a_foreign_unit_is_an_alarm_with_its_text_alone(script: Script) -> None:
    script.event(U, EventKind.SENSOR_FAULT, "the accelerometer is stuck")
    given = script.alarms[-1].parameters
    assert (given.fault, given.fault_code) == ("the accelerometer is stuck", None)


def test_what_ended_an_alarm_has_a_code_beside_its_text(script: Script) -> None:
    script.act(ReportProblem("log", "the disk is full"))
    script.act(ReportProblem("log", ""))
    ended = script.alarms[-1]
    assert (ended.by, ended.reason) == ("works again", "over-works-again")
    script.act(ReportProblem("log", "the disk is full"))
    script.act(ResolveAlarm(script.alarms[-1].alarm_id, "mended", reason="cause_removed"))
    assert script.alarms[-1].reason == "cause_removed"


def fault_texts(script: Script) -> set[str]:
    """Texts of the open fault alarms."""
    alarms = script.pipeline.state.alarms.values()
    return {one.text.partition(": ")[2] for one in alarms if one.is_open}


def test_faults_of_one_unit_are_separate_alarms_each_raised_once(script: Script) -> None:
    details = ("the accelerometer is stuck", "the gyroscope is stuck", "no sample for 1.3 s")
    for detail in (*details, *details, "no sample for 2.5 s"):
        script.event(U, EventKind.SENSOR_FAULT, detail)
        script.act(AcknowledgeAlarm(script.alarms[-1].alarm_id))
        script.wait(1)
    reported = [one.text for one in script.alarms if one.state is AlarmState.RAISED]
    assert [text.partition(": ")[2] for text in reported] == list(details)
    assert fault_texts(script) == set(details)


def test_fault_ends_by_itself_and_is_raised_again_when_it_returns(script: Script) -> None:
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


def test_simultaneous_faults_have_own_ids(script: Script) -> None:
    """Backfilled messages of one batch may have one time."""
    for detail in ("A", "B", "C"):
        script.event(U, EventKind.SENSOR_FAULT, detail)
    assert len({one.alarm_id for one in script.alarms}) == 3
    assert fault_texts(script) == {"A", "B", "C"}


def test_endless_faults_raise_the_last_and_few_are_kept(script: Script) -> None:
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
    reported = script.alarms[-1].text
    script.act(ResolveAlarm(script.alarms[0].alarm_id, ""))
    script.wait(3)
    assert script.alarms[-1].state is AlarmState.RESOLVED, "nothing is told anew for the room"
    assert reported.partition(": ")[2] in fault_texts(script)


def test_open_faults_survive_a_restart(script: Script) -> None:
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


def test_problem_of_the_station_is_an_alarm(script: Script) -> None:
    script.act(ReportProblem("log", "The disk is full"), by="station")
    script.act(ReportProblem("log", "The disk is full"), by="station")
    assert script.pipeline.state.problems == {"log": "The disk is full"}
    script.act(ReportProblem("log", ""), by="station")
    assert [(a.unit_id, a.state.name, a.text) for a in script.alarms] == [
        ("", "RAISED", "The disk is full"),
        ("", "RESOLVED", "The disk is full"),
    ]
    assert script.pipeline.state.problems == {}


def test_problem_resolved_by_a_person_ends_until_it_is_reported_again(
    script: Script,
) -> None:
    for _ in range(2):
        script.act(ReportProblem("log", "The disk is full"), by="station")
        script.act(ResolveAlarm(script.alarms[-1].alarm_id, "it has room again"))
        assert script.pipeline.state.problems == {}
    assert [one.state.name for one in script.alarms] == ["RAISED", "RESOLVED"] * 2


def test_second_problem_of_a_part_is_raised_while_the_first_is_open(
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


def test_problem_with_less_or_other_numbers_is_not_raised_anew(script: Script) -> None:
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
    applies_to_unregistered: bool = False
    triggered_by: tuple[type[Message], ...] = ()

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:
        raise ZeroDivisionError("nothing to divide")


def test_failing_rule_is_reported_and_the_others_continue() -> None:
    script = Script(StationPipeline((Broken(), *ALARMS), FUSERS[0]))
    script.register(U)
    script.wait(3, lambda: script.event(U, EventKind.MAYDAY))
    assert [a.rule for a in script.alarms] == ["station", "mayday"]
    assert "'broken'" in script.alarms[0].text
    assert "ZeroDivisionError" in script.alarms[0].text


def test_rule_that_fails_for_every_unit_is_one_problem() -> None:
    script = Script(StationPipeline((Broken(),), FUSERS[0]))
    script.register(U, "FF-02")
    script.wait(3)
    assert [a.state.name for a in script.alarms] == ["RAISED"]
    script.act(ResolveAlarm(script.alarms[0].alarm_id, "reported"))
    script.wait(1)
    assert [a.state.name for a in script.alarms] == ["RAISED", "RESOLVED", "RAISED"]
