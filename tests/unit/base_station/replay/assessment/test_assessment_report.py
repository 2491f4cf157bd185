"""Assessment of an incident: shown places against pins and against the smoothed trail."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import cast

import msgspec
import numpy as np
import pytest

from base_station.core.state import OWN_SITE_ID, SiteState, StationState, UnitState
from base_station.fusion.odometry.path_history import PathHistory
from base_station.replay.assessment.report import assess
from base_station.site.plan import Plan
from base_station.site.storeys import Storey
from shared.clock import NS_PER_S
from tests.rig.assessed_unit import assessed, pin, shown


@pytest.mark.parametrize(("t_s", "north_m"), [(12.0, 10.0), (97.0, 50.0), (9.2, 9.0), (0.0, 0.0)])
def test_pin_is_compared_with_the_place_shown_nearest_to_its_time(
    t_s: float, north_m: float
) -> None:
    """A wearer without contact is shown at the last place."""
    live = [shown(float(second), float(second)) for second in range(11)]
    (residual,) = assessed(
        [*live, shown(100.0, 50.0, floor=1)], (), pin(t_s, north_m)
    ).pin_residuals
    assert residual.shown_m == 0.0
    assert residual.floor_right is (t_s > 50.0)


def test_pin_of_a_time_without_shown_place_is_not_compared() -> None:
    for t_s in (16.0, 50.0, 94.0):
        (residual,) = assessed([shown(10.0), shown(100.0)], (), pin(t_s, 0.0)).pin_residuals
        assert (residual.shown_m, residual.floor_right) == (None, None)


def test_floor_that_was_not_shown_was_not_wrong() -> None:
    live = [msgspec.structs.replace(shown(10.0), floor=None)]
    (residual,) = assessed(live, (), pin(10.0, 0.0)).pin_residuals
    assert (residual.shown_m, residual.floor_right) == (0.0, None)


def test_pin_at_the_start_is_compared_with_the_first_shown_place() -> None:
    (residual,) = assessed([shown(100.0, 7.0), shown(101.0, 8.0)], (), pin(0.0, 7.0)).pin_residuals
    assert residual.shown_m == 0.0


def test_pin_of_another_unit_is_not_compared() -> None:
    other = msgspec.structs.replace(pin(10.0, 0.0), unit_id="FF-02")
    assert assessed([shown(10.0)], (), other).pin_residuals == ()


def test_nearest_two_storeys_give_the_certainty_of_a_floor() -> None:
    storeys = (Storey(0, 0.0), Storey(1, -3.0), Storey(2, -9.0))
    state = StationState(sites={OWN_SITE_ID: SiteState(plan=Plan(b"", storeys, ()))})
    live = {"FF-01": [shown(1.0)]}
    (unit,) = assess("i1", "path-graph", 0, state, {}, live, {}, {}).units
    assert unit.floor_probability == pytest.approx(0.8664, abs=1e-3)  # 1.5 standard deviations


@pytest.mark.parametrize(
    ("fixes_s", "jump_s", "found"),
    [
        ((0.0, 60.0, 121.0), 121.0, (7.0,)),
        ((0.0, 60.0, 121.0), 136.0, (7.0,)),
        ((0.0, 60.0, 121.0), 145.0, (0.0,)),
        ((0.0, 60.0, 120.0), 120.0, ()),
    ],
)
def test_jump_counts_as_fixes_come_back_after_a_minute(
    fixes_s: Sequence[float], jump_s: float, found: Sequence[float]
) -> None:
    fix_t_ns = np.array([round(one * NS_PER_S) for one in fixes_s])
    history = SimpleNamespace(begin_ns=0, arrays=lambda: SimpleNamespace(fix_t_ns=fix_t_ns))
    state = StationState(paths={"FF-01": cast("PathHistory", history)})
    live = [shown(float(second), 7.0 if second >= jump_s else 0.0) for second in range(200)]
    smoothed = [shown(0.0), shown(199.0)]
    (unit,) = assess(
        "i1", "path-graph", 0, state, {}, {"FF-01": live}, {"FF-01": smoothed}, {}
    ).units
    assert unit.reentry_jumps_m == found


def test_floor_at_rest_is_compared_with_the_smoothed_trail_of_that_time() -> None:
    """The trail has a point in ten seconds there."""
    smoothed = [shown(float(second), floor=0) for second in range(0, 101, 10)]
    live = [shown(float(second), floor=1 if second % 10 < 5 else 0) for second in range(100)]
    assert assessed(live, smoothed).floor_right == pytest.approx(0.5)


def test_nothing_shown_is_nothing_known() -> None:
    unit = assessed(())
    assert (unit.seconds, unit.walked_m, unit.stated, unit.floor_right) == (0.0, 0.0, None, None)


def test_rejected_fixes_are_listed_the_most_frequent_reason_first() -> None:
    unit = UnitState("FF-01", rejected_counts={"from the future": 2, "too far from the site": 30})
    tracks = {"FF-01": [shown(1.0)]}
    state = StationState(units={"FF-01": unit})
    (report,) = assess("i1", "path-graph", 0, state, {}, tracks, tracks, tracks).units
    assert report.not_used == (("too far from the site", 30), ("from the future", 2))


def test_loop_closes_at_the_last_return() -> None:
    way_m = [*range(21), *range(20, -1, -1)]
    smoothed = [shown(float(second), float(north_m)) for second, north_m in enumerate(way_m)]
    state = StationState()
    raw = [
        shown(one.t_ns / NS_PER_S, 1.1 * one.north_m, 0.1 * row) for row, one in enumerate(smoothed)
    ]
    tracks = {"FF-01": smoothed}
    report = assess("i1", "path-graph", 0, state, {}, tracks, tracks, {"FF-01": raw})
    (unit,) = report.units
    assert unit.loop_closure_m == pytest.approx(4.1)
    assert unit.loop_closure_percent == pytest.approx(100.0 * 4.1 / unit.walked_m, abs=0.02)


def test_error_of_a_loop_is_relative_to_its_length() -> None:
    way_m = [*range(21), *range(19, -1, -1), *range(1, 31)]
    smoothed = [shown(float(second), float(north_m)) for second, north_m in enumerate(way_m)]
    raw = [msgspec.structs.replace(one, north_m=1.1 * one.north_m) for one in smoothed]
    tracks = {"FF-01": smoothed}
    report = assess("i1", "path-graph", 0, StationState(), {}, tracks, tracks, {"FF-01": raw})
    (unit,) = report.units
    assert unit.walked_m == pytest.approx(77.0)
    assert unit.loop_closure_m == pytest.approx(0.2)  # two metres out again it was last near
    assert unit.loop_closure_percent == pytest.approx(100.0 * 0.2 / (1.1 * 42.0), abs=0.01)


@pytest.mark.parametrize(("furthest_m", "last_m"), [(20, 20), (20, 4), (14, 0)])
def test_short_way_or_no_return_closes_no_loop(furthest_m: int, last_m: int) -> None:
    way_m = [*range(furthest_m + 1), *range(furthest_m, last_m - 1, -1)]
    smoothed = [shown(float(second), float(north_m)) for second, north_m in enumerate(way_m)]
    assert assessed(smoothed, smoothed).loop_closure_m is None
