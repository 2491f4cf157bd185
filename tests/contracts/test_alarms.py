"""Contract of every alarm rule."""

from __future__ import annotations

import re

import msgspec
import pytest

from base_station.core.alarms import ALARMS
from base_station.core.alarms.alarm_manager import AlarmManager
from base_station.core.alarms.interface import AlarmRule, Clear, Finding
from base_station.core.alarms.sentences import SENTENCES, sentence
from base_station.core.alarms.thresholds import limits_of
from base_station.core.alarms.worn_wrong import WornWrong
from base_station.core.state import Fault, GpsUse, StationState, UnitState
from base_station.core.state.boot_state import BootState
from base_station.core.state.duty import Duty
from base_station.core.state.unit_heat import UnitHeat
from base_station.core.state.unit_place import UnitPlace
from shared.channels import NO_TRACKER
from shared.clock import NS_PER_S
from shared.messages import (
    AlarmParameters,
    FusedPosition,
    Header,
    Temperature,
)
from shared.quality import Quality, Reason
from tests.rig import message_factory

HEADER = Header("FF-01", 1, 1, 0)
T_NS = 1_700_000_000 * NS_PER_S


def calm(seen_ns: int = T_NS) -> UnitState:
    """A registered unit with all values known and none abnormal."""
    return UnitState(
        "FF-01",
        registered=True,
        last_message_ns=seen_ns,
        link="live",
        status=message_factory.status(HEADER),
        status_ns=seen_ns,
        heat=UnitHeat(Temperature(HEADER, 20.0), seen_ns),
        position=message_factory.position(HEADER),
        position_ns=seen_ns,
        place=UnitPlace(message_factory.fused(HEADER, "FF-01")),
        description=message_factory.description(HEADER),
        boots=[BootState(1, first_live_ns=seen_ns - 600 * NS_PER_S, last_live_ns=seen_ns)],
        gps=GpsUse(seen_ns),
    )


def lost_place(seen_ns: int) -> FusedPosition:
    return message_factory.fused(
        Header("station", 1, 1, seen_ns, t_utc_ns=seen_ns),
        "FF-01",
        std_north_m=40.0,
        std_east_m=40.0,
        quality=Quality.LOST,
        quality_reason="within 113 m",
    )


def in_trouble(seen_ns: int = T_NS, rule: AlarmRule | None = None) -> UnitState:
    """A unit with every abnormal value at once; a unit that is worn wrong has no other tracker
    fault.
    """
    unit = calm(seen_ns)
    reasons = Reason.NOT_ON_FOOT if isinstance(rule, WornWrong) else Reason.NONE
    assert unit.status is not None
    assert unit.position is not None
    unit.registered = False
    unit.last_message_ns = seen_ns - 60 * NS_PER_S
    unit.status = msgspec.structs.replace(unit.status, motionless_s=60.0, battery=0.05, mayday=True)
    unit.heat.temperature = Temperature(HEADER, 300.0)
    unit.heat.dose = 2.0
    unit.gps = GpsUse(seen_ns, "the receiver is stuck", seen_ns - 60 * NS_PER_S)
    unit.position = msgspec.structs.replace(
        unit.position, quality=Quality.LOST, reasons=reasons, distance_m=3000.0
    )
    unit.degraded_since_ns = seen_ns - 60 * NS_PER_S
    unit.mayday.t_ns = unit.fall.t_ns = seen_ns
    unit.place.fused = lost_place(seen_ns)
    unit.place.lost_since_ns = seen_ns - 60 * NS_PER_S
    unit.duty = Duty(
        seen_ns - 3600 * NS_PER_S, work_since_ns=seen_ns - 3600 * NS_PER_S,
        due_ns=seen_ns - NS_PER_S, rest_due_ns=seen_ns - NS_PER_S,
    )  # fmt: skip
    unit.fault = Fault(seen_ns, "the accelerometer is stuck")
    unit.tracker = UnitState("FF-01@tracker", fault=Fault(seen_ns, "the disk is full"))
    unit.boots = [
        BootState(boot_id, first_live_ns=seen_ns - 90 * NS_PER_S, last_live_ns=unit.last_message_ns)
        for boot_id in (1, 2)
    ]
    unit.description = message_factory.description(
        HEADER,
        tracker=NO_TRACKER,
        calibration="c1",
        calibrated_s=1,
        calibration_faults="accelerometer off by 0.2 m/s2",
    )
    return unit


@pytest.fixture(params=ALARMS, ids=lambda rule: rule.name)
def rule(request: pytest.FixtureRequest) -> AlarmRule:
    found: AlarmRule = request.param
    return found


def test_rule_names_are_those_of_the_log_and_unique() -> None:
    names = [rule.name for rule in ALARMS]
    assert len(set(names)) == len(names)
    assert all(re.fullmatch(r"[a-z]+(-[a-z]+)*", name) for name in names)


def test_default_of_each_threshold_lies_within_its_limits(rule: AlarmRule) -> None:
    for name, limits in limits_of(rule).items():
        assert msgspec.convert(getattr(rule, name), limits) == getattr(rule, name)


def test_rule_finds_its_condition(rule: AlarmRule) -> None:
    verdict = rule.judge(in_trouble(rule=rule), T_NS, "")
    assert isinstance(verdict, Finding)
    assert verdict.level in rule.levels
    assert verdict.priority in {1, 2, 3}
    assert verdict.code in SENTENCES
    assert "None" not in verdict.text  # each parameter of the sentence is present
    assert verdict.seen_ns <= T_NS


def test_sentences_are_made_of_their_parameters() -> None:
    full = AlarmParameters(
        member="Ana", member_before="Bo", unit_id="FF-01", duration_s=61.0, temperature_degc=120.0,
        heat_fraction=0.5, battery_fraction=0.1, radius_m=40.0, reasons=("no-stance", "stuck"),
        fault="stuck", part="disk", calibrated_s=1,
    )  # fmt: skip
    texts = {code: sentence(code, full) for code in SENTENCES}
    assert len(set(texts.values())) == len(texts)
    assert texts["mayday"] == "Mayday from Ana or, before, Bo"
    assert texts["par-overdue-unanswered"].endswith("PAR overdue, no answer for 1 min")
    assert "no footfall felt" in texts["tracker-lost"]
    assert "the receiver is stuck" in texts["gps-unused"]
    assert "1 January 1970" in texts["calibration-old"]


def test_rule_is_silent_for_a_calm_unit(rule: AlarmRule) -> None:
    assert not isinstance(rule.judge(calm(), T_NS, ""), Finding)


def test_unregistered_unit_raises_no_alarm() -> None:
    raised = AlarmManager(ALARMS).review(StationState(t_ns=T_NS), in_trouble())
    assert {alarm.rule for alarm in raised} == {"unknown-unit", "cloned-unit"}


def test_rule_returns_nothing_for_a_unit_never_received(rule: AlarmRule) -> None:
    assert not isinstance(rule.judge(UnitState("FF-01", registered=True), T_NS, ""), Finding)


def test_evidence_time_does_not_advance_without_messages(rule: AlarmRule) -> None:
    """A condition without newer reports cannot end: the evidence stays as old as the last
    message.
    """
    unit = calm()
    later_ns = T_NS + 5 * NS_PER_S
    for level in ("", *rule.levels):
        before, after = rule.judge(unit, T_NS, level), rule.judge(unit, later_ns, level)
        if isinstance(before, Clear) and isinstance(after, Clear):
            assert before.seen_ns == after.seen_ns


def test_rule_changes_no_state_and_repeats_its_result(rule: AlarmRule) -> None:
    for unit in (calm(), in_trouble(rule=rule)):
        before = msgspec.msgpack.encode(unit)
        first = rule.judge(unit, T_NS, "")
        assert rule.judge(unit, T_NS, "") == first
        assert msgspec.msgpack.encode(unit) == before


def test_level_is_no_easier_to_leave_than_to_reach(rule: AlarmRule) -> None:
    """Hysteresis: the value that raises an alarm also keeps it."""
    unit = in_trouble(rule=rule)
    found = rule.judge(unit, T_NS, "")
    assert isinstance(found, Finding)
    kept = rule.judge(unit, T_NS, found.level)
    assert isinstance(kept, Finding)
    assert rule.levels.index(kept.level) >= rule.levels.index(found.level)
