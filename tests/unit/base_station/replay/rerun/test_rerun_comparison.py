"""A re-run compared with the shown state."""

from __future__ import annotations

import pytest

from base_station.replay.rerun.comparison import (
    AlarmOutcome,
    RaisedAlarm,
    compare_alarms,
    compare_trail,
)
from base_station.storage.db.records import TrackSample
from shared.clock import NS_PER_S


def point(second: int, north_m: float, floor: int | None = 0) -> TrackSample:
    t_ns = second * NS_PER_S
    return TrackSample(t_ns, north_m, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, floor, "good")


def test_trails_are_compared_at_their_common_seconds() -> None:
    shown = [point(second, 0.0) for second in range(10)]
    rerun = [point(second, float(second), int(second in {6, 7})) for second in range(2, 12)]
    found = compare_trail("FF-01", "eskf", (50, 40), shown, rerun)
    assert (found.seconds, found.max_m, found.end_m) == (8, 9.0, 9.0)
    assert found.median_m == pytest.approx(5.5)
    assert found.other_floor_s == 2
    (change,) = found.floor_changes
    assert (change.from_ms, change.until_ms, change.shown, change.rerun) == (6000, 7000, 0, 1)


def test_trails_without_a_common_second_have_no_figures() -> None:
    found = compare_trail("FF-01", "eskf", (5, 0), [point(1, 0.0)], [point(9, 0.0)])
    assert (found.seconds, found.median_m) == (0, None)


def test_alarms_are_paired_with_the_nearest_of_their_kind() -> None:
    def alarm(rule: str, second: int) -> RaisedAlarm:
        return RaisedAlarm(rule, "FF-01", second * NS_PER_S)

    shown = [alarm("fall", 10), alarm("heat", 50), alarm("fall", 900)]
    rerun = [alarm("fall", 12), alarm("fall", 100), alarm("heat", 50)]
    found = [(one.rule, one.outcome) for one in compare_alarms(shown, rerun)]
    assert found == [
        ("fall", AlarmOutcome.LATER),
        ("heat", AlarmOutcome.SAME),
        ("fall", AlarmOutcome.ADDED),
        ("fall", AlarmOutcome.MISSED),
    ]
