"""Straight segments at one pace: the places between two ends that need not be kept."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from base_station.fusion.odometry.straight_segment import OFF_M, StraightnessTest

STEP = st.tuples(st.floats(0.05, 3.0), st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))


@given(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.lists(STEP, min_size=1, max_size=30))
def test_path_to_the_next_end_was_near_the_segment_all_the_time(
    north_mps: float, east_mps: float, steps: list[tuple[float, float, float]]
) -> None:
    straight, after_s = StraightnessTest(), 0.0
    passed: list[tuple[float, float, float]] = []
    for step_s, off_north_m, off_east_m in steps:
        after_s += step_s
        north_m, east_m = north_mps * after_s + off_north_m, east_mps * after_s + off_east_m
        if not straight.allows(north_m, east_m, after_s):
            break
        for was_s, was_north_m, was_east_m in passed:
            part = was_s / after_s
            assert part * north_m == pytest.approx(was_north_m, abs=OFF_M + 1e-9)
            assert part * east_m == pytest.approx(was_east_m, abs=OFF_M + 1e-9)
        straight.narrow(north_m, east_m, after_s)
        passed.append((after_s, north_m, east_m))


@given(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.lists(STEP, min_size=1, max_size=30))
def test_one_pace_passes_deviations_below_the_tolerance(
    north_mps: float, east_mps: float, steps: list[tuple[float, float, float]]
) -> None:
    straight, after_s = StraightnessTest(), 0.0
    for step_s, sway_north, sway_east in steps:
        after_s += step_s
        straight.narrow(
            north_mps * after_s + 0.99 * OFF_M * sway_north / 0.3,
            east_mps * after_s + 0.99 * OFF_M * sway_east / 0.3,
            after_s,
        )
        assert straight.allows(
            north_mps * (after_s + 2.0), east_mps * (after_s + 2.0), after_s + 2.0
        )


def test_ten_centimetres_beside_is_another_way() -> None:
    assert OFF_M == 0.1
    for north_m, east_m in ((2.0, 0.0), (0.0, 2.0)):
        for beside in (0.19, -0.19):
            straight = StraightnessTest()
            straight.narrow(north_m, east_m, 2.0)
            assert straight.allows(2.0 * north_m + beside, 2.0 * east_m, 4.0)
            assert straight.allows(2.0 * north_m, 2.0 * east_m + beside, 4.0)
            assert not straight.allows(2.0 * north_m + 1.1 * beside, 2.0 * east_m, 4.0)
            assert not straight.allows(2.0 * north_m, 2.0 * east_m + 1.1 * beside, 4.0)


@pytest.mark.parametrize("way", [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
@pytest.mark.parametrize(
    ("then_m", "led_mps", "misled_mps"),
    [(1.0, 0.95, 0.85), (1.2, 1.05, 1.15)],
    ids=["slower", "faster"],
)
def test_place_ruled_out_once_is_not_allowed_by_a_later_one(
    way: tuple[float, float], then_m: float, led_mps: float, misled_mps: float
) -> None:
    north, east = way
    straight = StraightnessTest()
    straight.narrow(north, east, 1.0)
    straight.narrow(then_m * north, then_m * east, 1.1)
    assert straight.allows(2.0 * led_mps * north, 2.0 * led_mps * east, 2.0)
    assert not straight.allows(2.0 * misled_mps * north, 2.0 * misled_mps * east, 2.0)
