"""Thresholds of rules: the value that raises an alarm and the one that ends it, as documented."""

from __future__ import annotations

import pytest

from base_station.core.alarms.battery import BatteryLow
from base_station.core.alarms.cloned_unit import ClonedUnit
from base_station.core.alarms.heat import Heat
from base_station.core.alarms.heat_dose import HeatDose
from base_station.core.alarms.interface import (
    ADVISORY,
    EMERGENCY,
    WARNING,
    AlarmRule,
    Clear,
    Finding,
)
from base_station.core.alarms.link_lost import LinkLost
from base_station.core.alarms.no_motion import NoMotion
from base_station.core.alarms.position_lost import PositionLost
from base_station.core.alarms.tracker_degraded import TrackerDegraded
from base_station.core.alarms.tracker_gone import TrackerGone
from base_station.core.alarms.worn_wrong import WornWrong
from base_station.core.state import UnitState
from base_station.core.state.boot_state import BootState
from base_station.core.state.unit_heat import UnitHeat
from base_station.core.state.unit_place import UnitPlace
from shared.channels import NO_TRACKER
from shared.clock import NS_PER_S
from shared.messages import Header, Temperature
from shared.quality import Quality, Reason
from tests.rig import message_factory

NOW_NS = 1_700_000_000 * NS_PER_S
HEADER = Header("FF-01", 7, 1, 1000 * NS_PER_S, NOW_NS, 0.01)


def ns(seconds: float) -> int:
    return round(seconds * NS_PER_S)


def judged(rule: AlarmRule, unit: UnitState, level: str = "") -> str | None:
    """Level of the finding; "over" for a calm unit, None where the rule returns nothing."""
    verdict = rule.judge(unit, NOW_NS, level)
    if verdict is None:
        return None
    return verdict.level if isinstance(verdict, Finding) else "over"


@pytest.mark.parametrize(
    ("battery", "standing", "found"),
    [
        (None, "", None),
        (0.10, "", "over"),
        (0.099, "", "low"),
        (0.149, "low", "low"),
        (0.151, "low", "over"),
    ],
)
def test_the_battery(battery: float | None, standing: str, found: str | None) -> None:
    unit = UnitState("FF-01", status=message_factory.status(HEADER, battery=battery))
    assert judged(BatteryLow(), unit, standing) == found


@pytest.mark.parametrize(
    ("ambient_degc", "standing", "found"),
    [
        (99.9, "", "over"),
        (100.0, "", "caution"),
        (159.9, "", "caution"),
        (160.0, "", "warning"),
        (259.9, "", "warning"),
        (260.0, "", "critical"),
        (250.0, "critical", "critical"),
        (249.9, "critical", "warning"),
        (150.0, "caution", "caution"),
        (90.0, "caution", "caution"),
        (89.9, "caution", "over"),
    ],
)
def test_heat(ambient_degc: float, standing: str, found: str) -> None:
    unit = UnitState("FF-01", heat=UnitHeat(Temperature(HEADER, ambient_degc)))
    assert judged(Heat(), unit, standing) == found


@pytest.mark.parametrize(("dose", "found"), [(0.99, "over"), (1.0, "used up")])
@pytest.mark.parametrize("ambient_degc", [20.0, 300.0])
def test_heat_dose(dose: float, ambient_degc: float, found: str) -> None:
    unit = UnitState("FF-01", heat=UnitHeat(Temperature(HEADER, ambient_degc), dose=dose))
    assert judged(HeatDose(), unit) == found


@pytest.mark.parametrize(
    ("ambient_degc", "priority"), [(100.0, ADVISORY), (160.0, WARNING), (260.0, EMERGENCY)]
)
def test_priority_of_heat_follows_its_level(ambient_degc: float, priority: int) -> None:
    unit = UnitState("FF-01", heat=UnitHeat(Temperature(HEADER, ambient_degc)))
    verdict = Heat().judge(unit, NOW_NS, "")
    assert isinstance(verdict, Finding)
    assert verdict.priority == priority


@pytest.mark.parametrize(
    ("motionless_s", "found"),
    [(19.9, "over"), (20.0, "pre-alert"), (29.9, "pre-alert"), (30.0, "alarm")],
)
def test_no_motion(motionless_s: float, found: str) -> None:
    unit = UnitState(
        "FF-01", status=message_factory.status(HEADER, motionless_s=motionless_s), status_ns=NOW_NS
    )
    assert judged(NoMotion(), unit) == found
    verdict = NoMotion().judge(unit, NOW_NS, "")
    if isinstance(verdict, Finding):
        assert verdict.onset_ns == NOW_NS - ns(motionless_s)
        assert verdict.latched is (found == "alarm")
        assert verdict.priority == (EMERGENCY if found == "alarm" else WARNING)


@pytest.mark.parametrize(
    ("silent_s", "found"), [(9.9, "over"), (10.0, None), (29.9, None), (30.0, "lost")]
)
def test_a_silent_unit_and_a_silent_agent(silent_s: float, found: str | None) -> None:
    unit = UnitState("FF-01", last_message_ns=NOW_NS - ns(silent_s))
    assert judged(LinkLost(), unit) == found
    agent = UnitState("FF-01@tracker", last_message_ns=NOW_NS - ns(silent_s))
    tracked = UnitState("FF-01", last_message_ns=NOW_NS, tracker=agent)
    tracked.boots = [BootState(1, first_live_ns=NOW_NS - ns(900), last_live_ns=NOW_NS)]
    tracked.description = message_factory.description(HEADER, tracker=NO_TRACKER)
    reported = "gone" if found == "lost" else found
    assert judged(TrackerGone(), tracked) == reported
    tracked.tracker = UnitState("FF-01@tracker")  # its last message came out of its journal
    tracked.boots = [BootState(1, first_live_ns=NOW_NS - ns(silent_s), last_live_ns=NOW_NS)]
    assert judged(TrackerGone(), tracked) == (reported if reported == "gone" else None)


@pytest.mark.parametrize(("silent_s", "found"), [(29.9, "cloned"), (30.0, "over")])
@pytest.mark.parametrize("silent", [1, 2])
@pytest.mark.parametrize("who", ["unit", "tracking agent"])
def test_duplicate_devices_alarm_until_one_is_silent(
    silent_s: float, found: str, silent: int, who: str
) -> None:
    """Either of the two; an older run was there with neither."""
    speaker = UnitState("FF-01", last_message_ns=NOW_NS)
    speaker.boots = [
        BootState(3, first_live_ns=NOW_NS - ns(900), last_live_ns=NOW_NS - ns(800))
    ] + [
        BootState(
            boot_id,
            first_live_ns=NOW_NS - ns(100 - boot_id),
            last_live_ns=NOW_NS - (ns(silent_s) if silent == boot_id else 0),
        )
        for boot_id in (1, 2)
    ]
    tracked = UnitState("FF-01", last_message_ns=NOW_NS, tracker=speaker)
    unit = speaker if who == "unit" else tracked
    assert judged(ClonedUnit(), unit) == found
    verdict = ClonedUnit().judge(unit, NOW_NS, "")
    if isinstance(verdict, Finding):
        assert verdict.code == ("duplicate-unit" if who == "unit" else "duplicate-agent")
        assert verdict.onset_ns == NOW_NS - ns(98)


@pytest.mark.parametrize(("lasted_s", "found"), [(14.9, None), (15.0, "lost")])
def test_position_lost(lasted_s: float, found: str | None) -> None:
    unit = UnitState(
        "FF-01",
        position=message_factory.position(HEADER, quality=Quality.LOST),
        position_ns=NOW_NS,
        degraded_since_ns=NOW_NS - ns(lasted_s),
        place=UnitPlace(
            message_factory.fused(HEADER, "FF-01"), lost_since_ns=NOW_NS - ns(lasted_s)
        ),
    )
    assert judged(TrackerDegraded(), unit) == found
    assert judged(PositionLost(), unit) == found
    unit.degraded_since_ns = unit.place.lost_since_ns = None
    assert isinstance(TrackerDegraded().judge(unit, NOW_NS, ""), Clear)
    assert isinstance(PositionLost().judge(unit, NOW_NS, ""), Clear)


@pytest.mark.parametrize(
    ("reasons", "found"), [(Reason.NOT_ON_FOOT, "not-on-foot"), (Reason.NO_STANCE, None)]
)
def test_wrongly_worn_unit_is_the_only_alarm_and_names_the_remedy(
    reasons: Reason, found: str | None
) -> None:
    position = message_factory.position(HEADER, quality=Quality.LOST, reasons=reasons)
    unit = UnitState("FF-01", position=position, position_ns=NOW_NS)
    unit.degraded_since_ns = NOW_NS - ns(15.0)
    verdict = WornWrong().judge(unit, NOW_NS, "")
    assert isinstance(verdict, Finding) == (found is not None)
    assert isinstance(TrackerDegraded().judge(unit, NOW_NS, ""), Finding) == (found is None)
    if isinstance(verdict, Finding):
        assert verdict.level == found
        assert verdict.text.startswith("FF-01: unit is not worn on a foot")


@pytest.mark.parametrize(
    ("quality", "reasons", "level", "text"),
    [
        (Quality.LOST, Reason.SAMPLE_GAP, "lost", "is lost (samples missing)"),
        (Quality.DEGRADED, Reason.NONE, "degraded", "is unsure (it gives no reason)"),
    ],
)
def test_degraded_tracker_names_its_reason(
    quality: Quality, reasons: Reason, level: str, text: str
) -> None:
    position = message_factory.position(HEADER, quality=quality, reasons=reasons)
    unit = UnitState("FF-01", position=position, position_ns=NOW_NS)
    unit.degraded_since_ns = NOW_NS - ns(15.0)
    verdict = TrackerDegraded().judge(unit, NOW_NS, "")
    assert isinstance(verdict, Finding)
    assert verdict.level == level
    assert verdict.text.endswith(text)
