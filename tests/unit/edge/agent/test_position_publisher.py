"""Content of a position about the path since the one before: heading, storeys, doubts, pressure."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from edge.agent.position_publisher import PositionPublisher
from edge.clocks.timeline import Timeline
from edge.samples import Floats, ImuBatch
from edge.tracker.interface import Quality, Reason, TrackBatch
from shared.clock import NS_PER_S, ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import Position
from shared.path_noise import PathNoise

RATE_HZ = 20
LIVE = Timeline()


def stream(rate_hz: float = 2.0) -> PositionPublisher:
    return PositionPublisher(HeaderFactory("u1", 7, ManualClock()), rate_hz)


def rows(position_n_m: Floats, from_s: float = 0.0) -> TrackBatch:
    """Rows at these places (n, 3), twenty a second."""
    n = len(position_n_m)
    return TrackBatch(
        t_ns=np.rint((from_s + np.arange(n) / RATE_HZ) * NS_PER_S).astype(np.int64),
        position_n_m=position_n_m,
        velocity_n_mps=np.tile([0.1, 0.2, 0.3], (n, 1)),
        quaternion_nb=np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)),
        position_cov_m2=np.tile(np.diag([0.04, 0.01, 0.09]), (n, 1, 1)),
        heading_std_rad=np.full(n, 0.1),
        stationary=np.zeros(n, np.bool_),
        past_shift_n_m=np.zeros((n, 2)),
        past_turn_rad=np.zeros(n),
        distance_m=np.arange(n, dtype=float),
        steps=np.zeros(n, np.int64),
        quality=np.full(n, Quality.GOOD, np.uint8),
        reasons=np.zeros(n, np.uint32),
        magnetic_north_rad=np.zeros(n),
        magnetic_north_std_rad=np.full(n, np.inf),
    )


def line(to_n_m: tuple[float, float, float], n: int = 40) -> Floats:
    return np.linspace(np.zeros(3), np.array(to_n_m), n)


def standing(n: int = 40) -> Floats:
    return np.zeros((n, 3))


@pytest.mark.parametrize("heading_deg", [0, 45, 90, 135, 180, 225, 270, 315])
def test_heading_is_that_of_travel_clockwise_from_north(heading_deg: int) -> None:
    angle_rad = math.radians(heading_deg)
    way = line((5.0 * math.cos(angle_rad), 5.0 * math.sin(angle_rad), 0.0))
    stated = stream().push(rows(way), LIVE)[-1].heading_rad
    assert 0.0 <= stated < math.tau
    assert math.remainder(stated - angle_rad, math.tau) == pytest.approx(0.0, abs=1e-9)


def test_small_motions_keep_the_heading_of_the_last_half_metre() -> None:
    out = stream(rate_hz=RATE_HZ)
    way = np.array([[0.0, 0, 0], [0, 0.55, 0], [0.45, 0.55, 0], [0.3, 0.5, 0], [-0.2, 0.6, 0]])
    stated = [position.heading_rad for position in out.push(rows(way), LIVE)]
    assert stated == [0.0, *[pytest.approx(math.pi / 2)] * 4]
    (turned,) = out.push(rows(np.array([[0.0, 1.3, 0.0]]), from_s=1.0), LIVE)
    assert turned.heading_rad == pytest.approx(math.pi / 2)
    (turned,) = out.push(rows(np.array([[-0.6, 1.3, 0.0]]), from_s=2.0), LIVE)
    assert turned.heading_rad == pytest.approx(math.pi)


def test_storeys_are_counted_up_and_down_and_a_landing_once() -> None:
    out = stream(rate_hz=RATE_HZ)
    assert out.floors_climbed == 0
    heights_m = [0.0, 1.95, 2.05, 3.0, 1.05, 0.95, -1.95, -2.05, -6.0]
    counted = []
    for number, height_m in enumerate(heights_m):
        out.push(rows(np.array([[0.0, 0.0, -height_m]]), from_s=float(number)), LIVE)
        counted.append(out.floors_climbed)
    assert counted == [0, 0, 1, 1, 1, 0, 0, -1, -2]


def test_flag_of_a_moment_between_two_positions_is_in_the_next() -> None:
    out = stream()
    track = rows(standing(42))
    track.quality[3:5] = (Quality.LOST, Quality.DEGRADED)
    track.reasons[3:5] = (Reason.SAMPLE_GAP, Reason.NO_STANCE)
    stated = [(one.quality, one.reasons) for one in out.push(track, LIVE)]
    bad = (Quality.LOST, Reason.SAMPLE_GAP | Reason.NO_STANCE)
    assert stated == [(Quality.GOOD, Reason.NONE), bad, *[(Quality.GOOD, Reason.NONE)] * 3]


@pytest.mark.parametrize("at_once", [1, 3, 10, 100])
def test_doubts_are_the_same_in_any_batching(at_once: int) -> None:
    whole = rows(standing(42))
    whole.quality[[3, 25]] = Quality.DEGRADED
    whole.reasons[[3, 25]] = (Reason.SAMPLE_GAP, Reason.NO_STANCE)
    out = stream()
    stated: list[Position] = []
    for first in range(0, 42, at_once):
        part = {
            name: getattr(whole, name)[first : first + at_once]
            for name in TrackBatch.__dataclass_fields__
        }
        stated += out.push(replace(whole, **part), LIVE)
    good, degraded = Quality.GOOD, Quality.DEGRADED
    assert [one.quality for one in stated] == [good, degraded, good, degraded, good]
    assert [one.reasons for one in stated] == [
        Reason.NONE,
        Reason.SAMPLE_GAP,
        Reason.NONE,
        Reason.NO_STANCE,
        Reason.NONE,
    ]


def test_doubts_of_a_row_that_is_no_number_go_with_the_next_position() -> None:
    out = stream()
    track = rows(standing(12))
    track.position_n_m[0] = np.nan
    track.quality[0], track.reasons[0] = Quality.LOST, Reason.SAMPLE_GAP
    first, second = out.push(track, LIVE)
    assert (first.quality, first.reasons) == (Quality.LOST, Reason.SAMPLE_GAP)
    assert first.header.t_mono_ns == NS_PER_S // RATE_HZ
    assert second.quality is Quality.GOOD
    assert out.rows_dropped == 1


@pytest.mark.parametrize("column", ["position_n_m", "velocity_n_mps", "position_cov_m2"])
def test_row_with_any_value_that_is_no_number_is_not_sent(column: str) -> None:
    out = stream(rate_hz=RATE_HZ)
    track = rows(standing(3))
    getattr(track, column)[1].flat[1] = np.inf
    assert len(out.push(track, LIVE)) == 2
    assert out.rows_dropped == 1


def test_uncertainty_and_direction_of_the_ellipse() -> None:
    track = rows(standing(1))
    track.position_cov_m2[0] = [[0.04, -0.01, 0.0], [-0.01, 0.01, 0.0], [0.0, 0.0, 0.09]]
    (position,) = stream().push(track, LIVE)
    stds = (position.std_north_m, position.std_east_m, position.std_down_m)
    assert stds == pytest.approx((0.2, 0.1, 0.3))
    assert position.correlation_ne == pytest.approx(-0.5)
    velocity = (position.velocity_north_mps, position.velocity_east_mps, position.velocity_down_mps)
    assert velocity == (0.1, 0.2, 0.3)


@pytest.mark.parametrize(("covariance", "correlation"), [(0.5, 1.0), (-0.5, -1.0)])
def test_rounding_makes_no_correlation_beyond_one(covariance: float, correlation: float) -> None:
    track = rows(standing(1))
    track.position_cov_m2[0, :2, :2] = [[0.04, covariance], [covariance, 0.01]]
    (position,) = stream().push(track, LIVE)
    assert position.correlation_ne == correlation


def test_unknown_variance_is_no_error() -> None:
    track = rows(standing(1))
    track.position_cov_m2[0] = 0.0
    track.position_cov_m2[0, 2, 2] = -1e-9
    track.heading_std_rad[0] = np.inf
    (position,) = stream().push(track, LIVE)
    assert (position.std_north_m, position.std_down_m, position.correlation_ne) == (0.0, 0.0, 0.0)
    assert position.heading_std_rad == math.pi


def test_no_rows_give_no_positions_and_the_path_continues() -> None:
    publishing = stream(5.0)
    (first,) = publishing.push(rows(np.ones((1, 3))), LIVE)
    assert publishing.push(rows(np.zeros((0, 3)), from_s=0.5), LIVE) == []
    (later,) = publishing.push(rows(np.full((1, 3), 2.0), from_s=1.0), LIVE)
    assert (first.north_m, later.north_m) == (1.0, 2.0)


@pytest.mark.parametrize(("std_rad", "is_reported"), [(0.79, True), (0.81, False), (np.nan, False)])
def test_magnetic_north_is_sent_where_it_adds_information(
    std_rad: float, is_reported: bool
) -> None:
    track = rows(standing(1))
    track.magnetic_north_rad[0], track.magnetic_north_std_rad[0] = 0.4, std_rad
    (position,) = stream().push(track, LIVE)
    assert (position.magnetic_north is not None) is is_reported
    if position.magnetic_north is not None:
        assert position.magnetic_north.heading_rad == 0.4


def air(from_s: float, pressures_pa: list[float]) -> ImuBatch:
    n = len(pressures_pa)
    t_ns = np.rint((from_s + np.arange(n) / RATE_HZ) * NS_PER_S).astype(np.int64)
    none = np.zeros((n, 3))
    return ImuBatch(t_ns, none, none, pressure_pa=np.array(pressures_pa))


def test_pressure_is_that_of_the_row_and_not_a_later_one() -> None:
    out = stream(rate_hz=RATE_HZ)
    out.take_pressure(air(0.0, [1000.0, 1001.0, np.nan, 1003.0]))
    out.take_pressure(air(0.2, []))
    stated = out.push(rows(standing(4)), LIVE)
    assert [one.pressure_pa for one in stated] == [1000.0, 1001.0, 1001.0, 1003.0]


def test_pressures_are_kept_for_as_long_as_rows_may_be_delayed() -> None:
    out = stream(rate_hz=RATE_HZ)
    for second in range(10):
        out.take_pressure(air(second, [1000.0 + second] * RATE_HZ))
        out.push(rows(standing(0)), LIVE)
    (held_back,) = out.push(rows(standing(1), from_s=7.5), LIVE)
    assert held_back.pressure_pa == 1007.0
    (too_old,) = out.push(rows(standing(1), from_s=1.0), LIVE)
    assert too_old.pressure_pa is None


@pytest.mark.parametrize(("after_s", "pressure_pa"), [(3.0, 1001.0), (3.2, None)])
def test_failed_barometer_does_not_repeat_its_last_reading(
    after_s: float, pressure_pa: float | None
) -> None:
    """A climbing wearer would stay on the floor where it failed."""
    out = stream(rate_hz=RATE_HZ)
    out.take_pressure(air(0.0, [1000.0, 1001.0]))
    out.take_pressure(air(0.1, [math.nan] * 80))
    (position,) = out.push(rows(standing(1), from_s=0.05 + after_s), LIVE)
    assert position.pressure_pa == pressure_pa


def test_no_pressure_before_the_first_reading_and_without_a_barometer() -> None:
    out = stream(rate_hz=RATE_HZ)
    (position,) = out.push(rows(standing(1)), LIVE)
    assert position.pressure_pa is None
    out.take_pressure(replace(air(0.0, [1000.0]), pressure_pa=None))
    out.take_pressure(air(1.0, [1001.0]))
    (position,) = out.push(rows(standing(1), from_s=0.5), LIVE)
    assert position.pressure_pa is None


def test_clock_that_went_back_leaves_no_pressure_of_the_future() -> None:
    out = stream(rate_hz=RATE_HZ)
    out.take_pressure(air(3.0, [900.0] * 40))
    out.take_pressure(air(1.0, [1000.0] * 5))
    (position,) = out.push(rows(standing(1), from_s=1.1), LIVE)
    assert position.pressure_pa == 1000.0
    (position,) = out.push(rows(standing(1), from_s=3.1), LIVE)
    assert position.pressure_pa == 1000.0


def test_positions_carry_the_noise_that_the_tracker_states() -> None:
    publisher, noise = stream(), PathNoise(0.08, 0.28, 0.014)
    (first, *_) = publisher.push(rows(standing()), LIVE)
    publisher.set_path_noise(noise)
    (later, *_) = publisher.push(rows(standing(), from_s=2.0), LIVE)
    assert first.path_noise is None
    assert not first.to_wire().path_scale_std_permille
    assert later.path_noise == Position.from_wire(later.to_wire()).path_noise == noise


def test_part_of_the_noise_may_be_unknown() -> None:
    publisher, noise = stream(), PathNoise(scale_std=0.18, place_std_m_per_sqrt_m=0.21)
    publisher.set_path_noise(noise)
    (one, *_) = publisher.push(rows(standing()), LIVE)
    assert Position.from_wire(one.to_wire()).path_noise == noise
