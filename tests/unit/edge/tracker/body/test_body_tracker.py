"""The body's tracker on even steps, at rest, and on motion that is no walk."""

from __future__ import annotations

from dataclasses import fields, replace
from math import degrees, radians

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.body.config import BodyConfig
from edge.tracker.body.tracker import BodyTracker
from edge.tracker.interface import Quality, Reason
from edge.tracker.track_rows import join_rows
from tests.rig.exact_steps import RATE_HZ, imu, steps, still


def tracked(batch: ImuBatch, *, iron_std_ut: float | None = None, place: str = ""):
    """``iron_std_ut``: of a calibrated compass."""
    description = SensorDescription("trunk", RATE_HZ, mag_iron_std_ut=iron_std_ut, place=place)
    tracker = BodyTracker(description)
    return join_rows([tracker.push(batch), tracker.finish()])


def heading_deg(rows):
    """Direction of the last two metres."""
    before = np.searchsorted(rows.distance_m, rows.distance_m[-1] - 2.0)
    north_m, east_m = (rows.position_n_m[-1] - rows.position_n_m[before])[:2]
    return degrees(np.arctan2(east_m, north_m))


def test_standing_wearer_stays_in_place_with_a_small_uncertainty():
    rows = tracked(imu(still(20.0)))
    assert rows.distance_m[-1] == 0.0
    assert rows.stationary.all()
    assert rows.position_cov_m2[-1, 0, 0] < 0.01
    assert rows.quality[-1] == Quality.GOOD


def test_steps_are_counted_two_to_a_stride():
    rows = tracked(imu(still(3.0), steps(20), still(3.0)))
    assert rows.steps[-1] == pytest.approx(10, abs=1)
    assert rows.distance_m[-1] > 8.0


@pytest.mark.parametrize("step_s", [0.34, 0.55, 0.8, 1.2])
def test_every_gait_is_seen_from_running_to_a_slow_walk(step_s):
    rows = tracked(imu(still(3.0), steps(20, step_s=step_s), still(3.0)))
    assert rows.steps[-1] == pytest.approx(10, abs=1)


def test_a_longer_and_a_stronger_step_go_further():
    usual, slow, strong = (
        tracked(imu(still(3.0), steps(20, **gait), still(3.0))).distance_m[-1]
        for gait in ({}, {"step_s": 0.65}, {"up_mps2": 3.0})
    )
    assert slow > usual
    assert strong > usual


@pytest.mark.parametrize("step_s", [0.34, 0.9])
def test_a_gait_that_is_no_usual_walk_is_doubted_by_the_way(step_s):
    usual = tracked(imu(still(3.0), steps(40), still(3.0)))
    other = tracked(imu(still(3.0), steps(40, step_s=step_s), still(3.0)))
    assert std_by_way(other) > 3.0 * std_by_way(usual)


def std_by_way(rows):
    return np.sqrt(rows.position_cov_m2[-1, 0, 0]) / rows.distance_m[-1]


def test_steps_of_a_trunk_are_stated_as_more_even_than_those_in_a_hand():
    walk = imu(still(3.0), steps(10), still(3.0))
    trunk, hand = (std_across(tracked(walk, place=place)) for place in ("waist", "hand"))
    assert 1.3 < hand / trunk <= 1.75  # by the stated steps, less what the heading adds to both


def std_across(rows):
    return np.sqrt(rows.position_cov_m2[-1, 1, 1]) / rows.distance_m[-1]


@pytest.mark.parametrize(
    ("place", "evenness"), [("waist", "trunk"), ("chest", "trunk"), ("hand", "any"), ("", "any")]
)
def test_noise_of_the_path_is_that_of_the_place(place, evenness):
    tracker = BodyTracker(SensorDescription("sensor", RATE_HZ, place=place))
    config = tracker.config
    step_std = {"trunk": config.trunk_step_std, "any": config.step_std}[evenness]
    assert place_noise(tracker) == pytest.approx(step_std * config.usual_step_m**0.5)


def place_noise(tracker):
    std_m = tracker.path_noise.place_std_m_per_sqrt_m
    assert std_m is not None
    return std_m


def test_noise_of_an_undescribed_sensor_is_a_trunk_s_once_it_is_recognised():
    tracker = BodyTracker(SensorDescription("sensor", RATE_HZ))
    before, before_m = tracker.path_noise, place_noise(tracker)
    tracker.push(imu(still(3.0), steps(20), still(3.0)))
    assert place_noise(tracker) < before_m
    assert tracker.path_noise.scale_std == before.scale_std


def test_doubt_of_a_run_stays_when_a_walk_follows_it():
    run = tracked(imu(still(3.0), steps(40, step_s=0.34)))
    walk = tracked(imu(still(3.0), steps(40, step_s=0.34), steps(10), still(3.0)))
    assert walk.position_cov_m2[-1, 0, 0] > run.position_cov_m2[-1, 0, 0]


def test_stairs_are_doubted_and_a_barometer_slower_than_the_rest_keeps_up():
    """17 cm a step; one pressure to ten samples."""
    walk = imu(still(3.0), steps(30), still(3.0))
    climbed_m = 0.17 * np.clip((walk.t_ns * 1e-9 - 3.0) / 0.55, 0.0, 30.0)
    pressure_pa = 101_325.0 * np.exp(-climbed_m / 8434.0)
    pressure_pa[np.arange(len(pressure_pa)) % 10 > 0] = np.nan
    stairs, level = tracked(replace(walk, pressure_pa=pressure_pa)), tracked(walk)
    assert std_by_way(stairs) > 3.0 * std_by_way(level)
    assert stairs.position_n_m[-1, 2] == pytest.approx(-30 * 0.17, abs=0.4)


def test_one_bump_is_no_walk():
    rows = tracked(imu(still(3.0), steps(1), still(3.0)))
    assert rows.distance_m[-1] < 1.0


def test_turning_on_the_spot_adds_no_distance():
    turning = tracked(imu(still(3.0), steps(10, rate_z_radps=3.0), still(3.0)))
    straight = tracked(imu(still(3.0), steps(10), still(3.0)))
    assert turning.distance_m[-1] < 0.35 * straight.distance_m[-1]


def test_a_rest_shows_the_bias_of_the_gyroscope():
    bias = radians(1.0)
    rested = tracked(imu(still(10.0, bias), steps(60, rate_z_radps=bias)))
    assert abs(heading_deg(rested)) < 8.0  # unaided: 33 degrees from the walk, 43 in all


def test_a_compass_holds_the_heading_that_a_bias_turns():
    bias = radians(1.0)
    walk = (still(0.1, bias), steps(120, rate_z_radps=bias))
    # The sensor does not turn, so the field stays where it is.
    without = tracked(imu(*walk))
    aided = tracked(imu(*walk, mag_n_ut=(20.0, 0.0, 40.0)), iron_std_ut=2.0)
    assert abs(heading_deg(aided)) < 0.6 * abs(heading_deg(without))
    assert aided.heading_std_rad[-1] < without.heading_std_rad[-1]


def test_coning_motion_adds_no_heading():
    """Its rate about the vertical has a mean, which is the angle that the cone encloses."""
    t_s = np.arange(round(60.0 * RATE_HZ)) / RATE_HZ
    angles_rad = np.column_stack([0.5 * np.cos(7.0 * t_s), 0.1 * np.sin(7.0 * t_s)])
    swung = Rotation.from_euler("YX", angles_rad)
    samples = still(60.0)
    samples[:, :3] = swung.inv().apply(samples[:, :3])
    samples[1:, 3:] = (swung[:-1].inv() * swung[1:]).as_rotvec() * RATE_HZ
    tracker = BodyTracker(SensorDescription("thigh", RATE_HZ))
    tracker.push(imu(samples))
    assert abs(degrees(tracker._state["heading_rad"][0])) < 12.0


@pytest.mark.parametrize("forward_deg", [-100.0, 0.0, 60.0])
def test_magnetic_north_is_stated_from_the_walk_and_not_from_the_sensor(forward_deg):
    walk = steps(40, forward_rad=radians(forward_deg))
    batch = imu(still(5.0), walk, mag_n_ut=(20.0, 0.0, 40.0))
    rows = tracked(batch, iron_std_ut=2.0)
    # The sensor's own axis points to magnetic north; the walk goes along the frame's north.
    assert degrees(rows.magnetic_north_rad[-1]) == pytest.approx(-forward_deg, abs=6.0)
    assert rows.magnetic_north_std_rad[-1] < 0.6
    # Iron on a wearer who never turned could be all that the compass shows.
    assert tracked(batch).magnetic_north_std_rad[-1] > 0.9
    assert np.isinf(rows.magnetic_north_std_rad[300])


def test_a_step_in_a_hand_is_shorter_than_its_swing_looks():
    hand = tracked(imu(still(3.0), steps(40, falling=0.2, rising=0.25), still(3.0)))
    trunk = tracked(imu(still(3.0), steps(40, falling=0.6, rising=0.1), still(3.0)))
    assert hand.distance_m[-1] < 0.9 * trunk.distance_m[-1]


@pytest.mark.parametrize("place", ["hip", "lower_back", "chest"])
def test_sensor_described_as_worn_on_the_trunk_is_not_classified_as_hand(place):
    walk = imu(still(3.0), steps(40, falling=0.2, rising=0.25), still(3.0))
    assert tracked(walk, place=place).distance_m[-1] > 1.1 * tracked(walk).distance_m[-1]


def test_sensor_recognised_on_the_upper_body_may_be_in_a_hand():
    walk = imu(still(3.0), steps(40, falling=0.2, rising=0.25), still(3.0))
    np.testing.assert_array_equal(
        tracked(walk, place="upper_body").distance_m, tracked(walk).distance_m
    )


def test_a_hand_by_its_description_has_a_hand_s_steps_from_the_first_one():
    walk = imu(still(3.0), steps(40, falling=0.2, rising=0.25), still(3.0))
    assert tracked(walk, place="hand").distance_m[-1] < tracked(walk).distance_m[-1] - 0.2


def test_what_an_arm_throws_to_and_fro_does_not_lengthen_a_hand_s_steps():
    """The same arm twice as strong, as level as up and down: a trunk's step would be 1.4 times as
    long.
    """
    calm, strong = (
        tracked(imu(still(3.0), steps(40, up_mps2=up_mps2, rising=0.9)), place="hand")
        for up_mps2 in (3.0, 6.0)
    )
    assert strong.distance_m[-1] < 1.25 * calm.distance_m[-1]


@pytest.mark.parametrize("place", ["", "pocket", "thigh"])
@pytest.mark.parametrize("speed_mps", [0.9, 1.4])
def test_a_thigh_goes_as_far_as_its_leg_turns_while_the_foot_stands(place, speed_mps):
    """Whatever the vertical motion: the leg of 0.9 m is slow in stance and fast in the swing."""
    walked, step_s = steps(60, up_mps2=6.0), 0.55
    phase = (np.arange(len(walked)) / (2.0 * step_s * RATE_HZ)) % 1.0
    walked[:, 4] = np.where(phase < 0.6, -1.0, 1.5) * speed_mps / 0.9
    rows = tracked(imu(still(3.0), walked, still(3.0)), place=place)
    assert rows.distance_m[-1] == pytest.approx(60 * step_s * speed_mps, rel=0.2 if place else 0.3)


def test_motion_without_steps_widens_what_is_stated():
    shaken = still(20.0)
    shaken[:, 3] = 2.0 * np.sin(np.arange(len(shaken)) * 0.9)
    quiet, moved = tracked(imu(still(23.0))), tracked(imu(still(3.0), shaken))
    assert moved.position_cov_m2[-1, 0, 0] > quiet.position_cov_m2[-1, 0, 0] + 1.0


def test_way_back_is_known_better_than_way_out():
    """The error of the length cancels at the start."""
    half_turn = still(1.0, np.pi)
    out = tracked(imu(still(5.0), steps(40)))
    back = tracked(imu(still(5.0), steps(40), half_turn, steps(40, rate_z_radps=0.0)))
    assert back.position_cov_m2[-1, 0, 0] < out.position_cov_m2[-1, 0, 0] + 5.0 * 0.35**2
    assert np.hypot(*back.position_n_m[-1, :2]) < 0.2 * back.distance_m[-1]


def test_a_hole_is_stated_and_the_walk_goes_on():
    whole = imu(still(5.0), steps(40))
    kept = np.r_[0:1200, 1350:2700]
    rows = tracked(ImuBatch(whole.t_ns[kept], whole.accel_mps2[kept], whole.gyro_radps[kept]))
    after = np.searchsorted(rows.t_ns, whole.t_ns[1350])
    assert rows.reasons[after + 1] & Reason.SAMPLE_GAP
    assert rows.heading_std_rad[after + 60] > rows.heading_std_rad[after - 200] + 0.1
    assert rows.distance_m[-1] > rows.distance_m[after] + 3.0


def test_height_is_that_of_the_barometer():
    batch = imu(still(5.0), steps(60))
    risen_share = np.clip(np.arange(len(batch)) / 1000.0 - 1.0, 0.0, 1.0)
    pressure_pa = np.asarray(101_325.0 - 36.0 * risen_share, np.float64)  # 3 m up
    risen = ImuBatch(batch.t_ns, batch.accel_mps2, batch.gyro_radps, None, pressure_pa)
    assert tracked(risen).position_n_m[-1, 2] == pytest.approx(-3.0, abs=0.2)
    assert tracked(batch).position_n_m[-1, 2] == 0.0


def test_rows_do_not_depend_on_batches_where_samples_are_bad():
    batch = imu(still(3.0), steps(30), mag_n_ut=(20.0, 5.0, 40.0))
    batch.accel_mps2[700:760] = np.nan
    tracker = BodyTracker(SensorDescription("trunk", RATE_HZ))
    parts = [tracker.push(batch.part(slice(k, k + 7))) for k in range(0, len(batch), 7)]
    rows, whole = join_rows([*parts, tracker.finish()]), tracked(batch)
    for field in fields(whole):
        assert np.array_equal(getattr(whole, field.name), getattr(rows, field.name)), field.name


def test_described_bias_of_the_gyroscope_replaces_that_of_a_data_sheet():
    """Walked from the first sample on, so that no rest shows the bias."""

    def heading_std_rad(gyro_bias_std_radps: float | None) -> float:
        description = SensorDescription(
            "hand", RATE_HZ, place="hand", gyro_bias_std_radps=gyro_bias_std_radps
        )
        tracker = BodyTracker(description)
        rows = join_rows([tracker.push(imu(steps(80))), tracker.finish()])
        return float(rows.heading_std_rad[-1])

    usual_rad = heading_std_rad(None)
    assert heading_std_rad(BodyConfig().first_bias_std_radps) == usual_rad
    assert heading_std_rad(0.001) < 0.6 * usual_rad < usual_rad < 0.6 * heading_std_rad(0.02)
