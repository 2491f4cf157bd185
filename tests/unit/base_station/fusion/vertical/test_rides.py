"""Rides in lifts, detected from pressure while the wearer stands."""

from __future__ import annotations

import pytest

from base_station.fusion.interface import BarometricHeight
from base_station.fusion.vertical.rides import WITHIN_NS, LiftDetector
from shared.clock import NS_PER_S

RATE_HZ = 5


def update_barometer(
    lift_detector: LiftDetector, downs_m: list[float], begin_s: float = 0.0, climbed_m: float = 0.0
) -> list[float]:
    """Detected rides, with a reading every fifth of a second."""
    reported = []
    for tick, down_m in enumerate(downs_m):
        t_ns = round((begin_s + tick / RATE_HZ) * NS_PER_S)
        reported.append(
            lift_detector.update_barometer(
                BarometricHeight(t_ns, down_m, referenced=True), climbed_m
            )
        )
    return [one for one in reported if one]


def ramp(lifted_m: float, lasts_s: float, rest_s: float = 4.0) -> list[float]:
    """Standing, going up, and standing."""
    rest, steps = round(rest_s * RATE_HZ), round(lasts_s * RATE_HZ)
    return (
        [5.0] * rest
        + [5.0 - lifted_m * (step + 1) / steps for step in range(steps)]
        + [5.0 - lifted_m] * rest
    )


@pytest.mark.parametrize("lifted_m", [3.0, -3.0, 24.0])
def test_ride_is_reported_once_with_its_sign(lifted_m: float) -> None:
    assert update_barometer(LiftDetector(), ramp(lifted_m, abs(lifted_m))) == pytest.approx(
        [-lifted_m]
    )


def test_second_ride_is_reported_too() -> None:
    lift_detector = LiftDetector()
    assert update_barometer(lift_detector, ramp(3.0, 5.0)) == pytest.approx([-3.0])
    assert update_barometer(lift_detector, ramp(3.0, 5.0), begin_s=60.0) == pytest.approx([-3.0])


def test_less_than_a_storey_and_own_motion_are_no_ride() -> None:
    assert update_barometer(LiftDetector(), ramp(2.0, 5.0)) == []
    assert update_barometer(LiftDetector(), ramp(2.4, 5.0)) != []
    assert update_barometer(LiftDetector(), ramp(3.0, 5.0), climbed_m=-3.0) == []
    assert update_barometer(LiftDetector(), ramp(3.0, 5.0), climbed_m=0.4) != []


def test_weather_over_minutes_is_no_ride() -> None:
    assert update_barometer(LiftDetector(), ramp(3.0, 90.0)) == []
    assert update_barometer(LiftDetector(), ramp(3.0, 30.0)) != []


def test_one_step_is_a_door_and_three_steps_are_a_ride() -> None:
    assert update_barometer(LiftDetector(), [5.0] * 30 + [2.0] * 30) == []
    assert update_barometer(LiftDetector(), [5.0] * 30 + [4.0] * 3 + [3.0] * 3 + [2.0] * 30) != []


def test_ride_is_not_reported_before_its_end() -> None:
    """Two seconds without change: it stops at storeys."""
    downs_m = ramp(6.0, 10.0)
    over = next(at for at, down_m in enumerate(downs_m) if down_m <= -1.0)
    assert update_barometer(LiftDetector(), downs_m[: over + RATE_HZ]) == []


def test_half_a_minute_of_standing_is_kept_and_no_more() -> None:
    lift_detector = LiftDetector()
    update_barometer(lift_detector, [5.0] * 5000)
    assert len(lift_detector.heights) == WITHIN_NS // NS_PER_S * RATE_HZ + 1


def test_clock_that_goes_back_hides_no_ride_and_fills_no_memory() -> None:
    """The unit restarted with another battery, while its wearer stood."""
    lift_detector = LiftDetector()
    update_barometer(lift_detector, [5.0] * 50, begin_s=9000.0)
    update_barometer(lift_detector, [5.0] * 5000)
    assert len(lift_detector.heights) <= WITHIN_NS // NS_PER_S * RATE_HZ + 1
    assert update_barometer(lift_detector, ramp(3.0, 5.0), begin_s=1000.0) == pytest.approx([-3.0])
