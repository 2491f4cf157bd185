"""Climb by barometer: over seconds, from medians, and none without readings."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from edge.activity.pressure_height import PressureHeight
from edge.samples import Floats, ImuBatch
from shared.clock import NS_PER_S
from shared.geo import pressure_pa_at

RATE_HZ = 20


def samples(until_s: float, height_m: Callable[[Floats], Floats], from_s: float = 0.0) -> ImuBatch:
    """A barometer that is moved to these heights."""
    t_s = np.arange(round(from_s * RATE_HZ), round(until_s * RATE_HZ)) / RATE_HZ
    pressure_pa = np.array([pressure_pa_at(one_m) for one_m in height_m(t_s).tolist()])
    none = np.zeros((len(t_s), 3))
    return ImuBatch(np.rint(t_s * NS_PER_S).astype(np.int64), none, none, pressure_pa=pressure_pa)


def level(t_s: Floats) -> Floats:
    return np.full_like(t_s, 100.0)


def upstairs(t_s: Floats) -> Floats:
    """Three metres between 4 and 8 s."""
    return 100.0 + 3.0 * np.clip((t_s - 4.0) / 4.0, 0.0, 1.0)


def climbed_m(air: PressureHeight, from_s: float, to_s: float) -> float | None:
    return air.climbed_m(round(from_s * NS_PER_S), round(to_s * NS_PER_S))


def test_storey_up_is_three_metres_and_down_the_same() -> None:
    air = PressureHeight()
    air.push(samples(12.0, upstairs))
    assert climbed_m(air, 2.0, 10.0) == pytest.approx(3.0, abs=0.02)
    assert climbed_m(air, 10.0, 2.0) == pytest.approx(-3.0, abs=0.02)
    assert climbed_m(air, 2.0, 6.0) == pytest.approx(1.5, abs=0.1)


@pytest.mark.parametrize("at_once", [1, 7])
def test_climb_is_the_same_in_any_batching(at_once: int) -> None:
    imu = samples(12.0, upstairs)
    whole, cut = PressureHeight(), PressureHeight()
    whole.push(imu)
    for first in range(0, len(imu), at_once):
        cut.push(imu.part(slice(first, first + at_once)))
    assert climbed_m(cut, 2.0, 10.0) == climbed_m(whole, 2.0, 10.0)


def test_slamming_door_is_no_climb() -> None:
    def slammed(t_s: Floats) -> Floats:
        return level(t_s) + 20.0 * ((t_s >= 5.0) & (t_s < 5.5))

    air = PressureHeight()
    air.push(samples(12.0, slammed))
    assert climbed_m(air, 2.0, 5.25) == pytest.approx(0.0, abs=0.01)


def test_climb_is_unknown_without_readings_around_the_time() -> None:
    air = PressureHeight()
    assert climbed_m(air, 0.0, 0.0) is None
    air.push(samples(4.0, level))
    air.push(samples(12.0, level, from_s=8.0))
    assert climbed_m(air, 2.0, 6.0) is None
    assert climbed_m(air, 6.0, 10.0) is None
    assert climbed_m(air, 3.0, 9.0) == pytest.approx(0.0, abs=1e-6)
    # Three quarters of a second around: the last whole quarter before the gap ends with it.
    assert climbed_m(air, 4.5, 9.0) == pytest.approx(0.0, abs=1e-6)
    assert climbed_m(air, 4.8, 9.0) is None


def test_unit_without_a_barometer_has_no_climb() -> None:
    air = PressureHeight()
    none = np.zeros((100, 3))
    air.push(ImuBatch(np.arange(100) * (NS_PER_S // RATE_HZ), none, none))
    assert climbed_m(air, 1.0, 4.0) is None


def test_missing_and_zero_readings_are_left_out() -> None:
    """Zero comes from a sensor that has just been switched on."""
    imu = samples(12.0, level)
    assert imu.pressure_pa is not None
    imu.pressure_pa[::2] = np.nan
    imu.pressure_pa[6 * RATE_HZ + 1 :: 4] = 0.0
    air = PressureHeight()
    air.push(imu)
    assert climbed_m(air, 2.0, 10.0) == pytest.approx(0.0, abs=1e-6)


def test_half_a_minute_is_kept_and_no_more() -> None:
    air = PressureHeight()
    air.push(samples(60.0, level))
    assert climbed_m(air, 31.0, 58.0) == pytest.approx(0.0, abs=1e-6)
    assert climbed_m(air, 27.0, 58.0) is None


def test_readings_before_the_clock_went_back_are_dropped() -> None:
    air = PressureHeight()
    air.push(samples(130.0, lambda t_s: level(t_s) + 50.0, from_s=100.0))
    air.push(samples(112.0, level, from_s=90.0))
    assert climbed_m(air, 92.0, 110.0) == pytest.approx(0.0, abs=1e-6)
    assert climbed_m(air, 92.0, 120.0) is None


def test_reading_overtaken_at_the_edge_of_a_quarter_changes_nothing() -> None:
    air = PressureHeight()
    imu = samples(12.0, upstairs)
    air.push(imu.part(slice(0, 8 * RATE_HZ + 1)))
    air.push(imu.part(slice(8 * RATE_HZ - 1, None)))
    assert climbed_m(air, 2.0, 10.0) == pytest.approx(3.0, abs=0.02)
