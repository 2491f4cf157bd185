"""Missing samples and jumps of timestamps: a short gap is bridged, a long one doubted."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.interface import Quality, Reason
from edge.tracker.track_rows import join_rows
from tests.rig.faulty_walk import (
    IN_STANCE,
    IN_SWING,
    LENGTH_M,
    WALK,
    copy,
    flagged,
    index,
    reached_m,
    run,
)


def test_backward_time_stamps_are_rejected():
    t_ns, accel, gyro = copy()
    k = index(IN_SWING)
    t_ns[k] = t_ns[k - 3]
    rows = run(t_ns, accel, gyro)
    assert list(np.flatnonzero(flagged(rows, Reason.BAD_SAMPLES))) == [k]
    assert reached_m(rows) == pytest.approx(LENGTH_M, abs=0.2)


def test_late_time_stamps_are_corrected():
    """Stamps of a transport that delivers every fourth sample late, with the next one."""
    t_ns, accel, gyro = copy()
    late = np.arange(100, len(t_ns) - 1, 4)
    t_ns[late] = t_ns[late + 1] - 50_000
    rows = run(t_ns, accel, gyro)
    assert reached_m(rows) == pytest.approx(LENGTH_M, abs=0.15)
    assert not flagged(rows, Reason.BAD_SAMPLES).any()


def test_gap_is_flagged_and_increases_the_uncertainty_until_recovery():
    t_ns, accel, gyro = copy()
    first, stop = index(IN_SWING), index(IN_SWING + 0.4)
    keep = np.r_[0:first, stop : len(t_ns)]
    rows = run(t_ns[keep], accel[keep], gyro[keep])
    gap = flagged(rows, Reason.SAMPLE_GAP)
    assert not gap[:first].any()
    assert gap[first : first + 200].all()
    assert not gap[-200:].any()
    assert rows.quality[first] != Quality.GOOD
    lost_m = abs(reached_m(rows) - LENGTH_M)
    std_m = np.sqrt(np.trace(rows.position_cov_m2[-1, :2, :2]))
    assert std_m > 0.3
    assert lost_m < 2.5 * std_m


@pytest.mark.parametrize("begin_s", [IN_SWING - 0.2, IN_SWING, IN_STANCE])
def test_gap_shorter_than_a_swing_is_bridged(begin_s):
    t_ns, accel, gyro = copy()
    first, stop = index(begin_s), index(begin_s + 0.14)
    keep = np.r_[0:first, stop : len(t_ns)]
    rows = run(t_ns[keep], accel[keep], gyro[keep])
    whole = run(*copy())
    assert flagged(rows, Reason.SAMPLE_GAP)[first]
    off_m = np.linalg.norm(rows.position_n_m[-1] - whole.position_n_m[-1])
    assert off_m < 0.2
    variances_m2 = np.diagonal(rows.position_cov_m2[-1] - whole.position_cov_m2[-1])
    assert off_m < 3.0 * np.sqrt(variances_m2.sum())


@pytest.mark.parametrize("lasts_s", [0.05, 0.2, 0.3])
@pytest.mark.parametrize("begin_s", [IN_SWING - 0.3, IN_SWING - 0.1, IN_SWING + 0.1])
def test_gap_is_filled_from_the_previous_strides(begin_s, lasts_s):
    """These strides are all alike, so next to nothing is lost: by straight lines decimetres are."""
    t_ns, accel, gyro = copy()
    first, stop = index(begin_s), index(begin_s + lasts_s)
    keep = np.r_[0:first, stop : len(t_ns)]
    rows = run(t_ns[keep], accel[keep], gyro[keep])
    off_m = np.linalg.norm(rows.position_n_m[-1] - run(*copy()).position_n_m[-1])
    assert off_m < 0.015


def test_swing_with_a_stuck_sensor_is_filled_from_the_previous_strides():
    t_ns, accel, gyro = copy()
    first, stop = index(IN_SWING - 0.1), index(IN_SWING + 0.15)
    accel[first:stop] = accel[first]
    rows = run(t_ns, accel, gyro)
    assert flagged(rows, Reason.BAD_SAMPLES)[first:stop].any()
    off_m = np.linalg.norm(rows.position_n_m[-1] - run(*copy()).position_n_m[-1])
    assert off_m < 0.04  # it hangs for a while before that is known


@pytest.mark.parametrize("spoiled", ["nothing", "every stride"])
def test_gap_is_filled_from_complete_strides_only(spoiled):
    """A hole in the same part of every stride before leaves none to go by."""
    t_ns, accel, gyro = copy()
    begins_s = [IN_SWING - 0.1]
    if spoiled == "every stride":
        begins_s += [IN_SWING - 0.1 - 1.2 * n for n in range(1, 6)]
    kept = np.ones(len(t_ns), np.bool_)
    for begin_s in begins_s:
        kept[index(begin_s) : index(begin_s + 0.2)] = False
    rows = run(t_ns[kept], accel[kept], gyro[kept])
    off_m = np.linalg.norm(rows.position_n_m[-1] - run(*copy()).position_n_m[-1])
    assert (off_m < 0.015) == (spoiled == "nothing")


def test_uncertainty_of_a_gap_grows_with_the_variation_of_strides():
    first, stop = index(IN_SWING - 0.1), index(IN_SWING + 0.15)

    def grown_rad2(differ):
        t_ns, accel, gyro = copy()
        for n in range(5):
            stride = slice(index(2.0 + 1.2 * n), index(2.0 + 1.2 * (n + 1)))
            gyro[stride] *= 1.0 + differ * (n % 3 - 1)
        keep = np.r_[0:first, stop : len(t_ns)]
        rows, whole = run(t_ns[keep], accel[keep], gyro[keep]), run(t_ns, accel, gyro)
        return rows.heading_std_rad[-1] ** 2 - whole.heading_std_rad[-1] ** 2

    assert grown_rad2(0.2) > 1.25 * grown_rad2(0.0) > 0.0


def test_unflagged_short_gap_increases_the_uncertainty():
    t_ns, accel, gyro = copy()
    first, stop = index(IN_SWING), index(IN_SWING + 0.09)
    keep = np.r_[0:first, stop : len(t_ns)]
    rows = run(t_ns[keep], accel[keep], gyro[keep])
    whole = run(*copy())
    assert not flagged(rows, Reason.SAMPLE_GAP).any()
    later = 30  # samples; the foot still swings
    assert not rows.stationary[first : first + later].any()
    variance_m2 = np.trace(rows.position_cov_m2[first + later])
    assert variance_m2 > 1.02 * np.trace(whole.position_cov_m2[stop + later])


@pytest.mark.parametrize(("lasts_s", "faulty"), [(0.05, True), (0.01, False)])
def test_stride_with_a_gap_is_marked_faulty(lasts_s, faulty):
    t_ns, accel, gyro = copy()
    first, stop = index(IN_SWING), index(IN_SWING + lasts_s)
    keep = np.r_[0:first, stop : stop + 5]
    tracker = EskfTracker(WALK.description)
    tracker.push(ImuBatch(t_ns[keep], accel[keep], gyro[keep]))
    tracker.finish()
    assert tracker._state[0]["faulty_stride"] == faulty


def test_scattered_sample_loss_costs_a_centimetre():
    whole = run(*copy())
    squares_m2 = []
    for seed in range(6):
        t_ns, accel, gyro = copy()
        keep = np.random.default_rng(seed).random(len(t_ns)) >= 0.2
        rows = run(t_ns[keep], accel[keep], gyro[keep])
        squares_m2.append(np.sum((rows.position_n_m[-1] - whole.position_n_m[-1]) ** 2))
    assert np.sqrt(np.mean(squares_m2)) < 0.012


def test_gap_does_not_reduce_the_heading_uncertainty():
    t_ns, accel, gyro = copy()
    description = SensorDescription("clipping", 200.0, gyro_full_scale_radps=0.4)  # much doubt
    first, stop = index(IN_STANCE), index(IN_STANCE + 0.2)
    keep = np.r_[0:first, stop : len(t_ns)]
    rows = run(t_ns[keep], accel[keep], gyro[keep], description)
    assert rows.heading_std_rad[first] > rows.heading_std_rad[first - 1]


def test_a_clock_that_jumps_ahead_is_a_gap():
    t_ns, accel, gyro = copy()
    k = index(IN_STANCE)
    t_ns[k:] += 3_600_000_000_000
    rows = run(t_ns, accel, gyro)
    assert flagged(rows, Reason.SAMPLE_GAP)[k]
    assert rows.quality[k] == Quality.LOST


def test_a_clock_set_back_is_followed_after_a_moment():
    t_ns, accel, gyro = copy()
    k = index(IN_STANCE)
    t_ns[k:] -= 5_000_000_000
    rows = run(t_ns, accel, gyro)
    assert flagged(rows, Reason.BAD_SAMPLES)[k : k + 20].all()
    assert flagged(rows, Reason.SAMPLE_GAP)[k + 30]
    assert not flagged(rows, Reason.BAD_SAMPLES)[k + 40 :].any()
    assert reached_m(rows) == pytest.approx(LENGTH_M, abs=0.3)


@pytest.mark.parametrize("after_lift_s", [-0.3, -0.2, 0.0, 0.2, 0.4])
def test_restart_during_a_swing_is_levelled_by_the_next_stance(after_lift_s):
    t_ns, accel, gyro = copy()
    begin_s = IN_SWING - 0.35 + after_lift_s
    first, stop = index(begin_s), index(begin_s + 0.4)
    keep = np.r_[0:first, stop : len(t_ns)]
    rows = run(t_ns[keep], accel[keep], gyro[keep])
    off_m = rows.position_n_m[-1] - WALK.position_n_m[-1]
    assert abs(off_m[2]) < 0.2  # a foot is lifted by less
    assert abs(off_m[0]) < 1.3  # what the foot may have gone in the hole: a stride
    assert abs(off_m[1]) < 0.3


@pytest.mark.parametrize("late_s", [0.0, 0.05, 0.1])
def test_stillest_part_of_a_swing_after_a_long_gap_is_no_stance(late_s):
    t_ns, accel, gyro = copy()
    lift_s = IN_SWING - 0.35
    first, stop = index(lift_s - 1.0), index(lift_s + late_s)
    keep = np.r_[0:first, stop : len(t_ns)]
    rows = run(t_ns[keep], accel[keep], gyro[keep])
    swings = (rows.t_ns > 1e9 * (lift_s + 0.02)) & (rows.t_ns < 1e9 * (lift_s + 0.68))
    assert swings.sum() > 100
    assert not rows.stationary[swings].any()


def test_rows_before_a_long_gap_are_released_without_waiting():
    t_ns, accel, gyro = copy()
    first, stop = index(IN_SWING), index(IN_SWING + 0.4)
    tracker = EskfTracker(WALK.description)
    before = tracker.push(ImuBatch(t_ns[:first], accel[:first], gyro[:first]))
    assert before.t_ns[-1] < t_ns[first - 1]
    soon = slice(stop, index(IN_SWING + 0.6))
    after = tracker.push(ImuBatch(t_ns[soon], accel[soon], gyro[soon]))
    assert after.t_ns[-1] == t_ns[first - 1]


def test_rotation_at_both_ends_of_a_long_gap_is_kept():
    """It turns evenly about an axis that is not level, of which levelling alone sees but a part."""
    rate_radps, axis_b = 1.5, np.array([1.0, 0.0, 1.0]) / np.sqrt(2.0)
    t_s = np.arange(0.0, 6.0, 0.005)
    angle_rad = rate_radps * np.clip(t_s - 3.0, 0.0, 0.6)
    up_n = np.array([0.0, 0.0, -9.80665])
    accel = np.array([_turned(axis_b, -angle) @ up_n for angle in angle_rad])
    gyro = np.where((t_s > 3.0) & (t_s < 3.6), rate_radps, 0.0)[:, None] * axis_b
    noise = np.random.default_rng(1).normal(0.0, 1.0, (2, len(t_s), 3))
    accel, gyro = accel + 0.02 * noise[0], gyro + 0.002 * noise[1]
    lost = (t_s > 3.1) & (t_s < 3.5)
    tracker = EskfTracker(SensorDescription("turning", 200.0))
    kept = ImuBatch(np.rint(1e9 * t_s[~lost]).astype(np.int64), accel[~lost], gyro[~lost])
    rows = join_rows([tracker.push(kept), tracker.finish()])
    whole = EskfTracker(SensorDescription("turning", 200.0))
    all_of_it = ImuBatch(np.rint(1e9 * t_s).astype(np.int64), accel, gyro)
    true = join_rows([whole.push(all_of_it), whole.finish()])
    off_rad = abs(_heading_rad(rows.quaternion_nb[-1]) - _heading_rad(true.quaternion_nb[-1]))
    unknown_rad = rate_radps * 0.4 * axis_b[2]
    assert 0.4 * unknown_rad < off_rad < 0.75 * unknown_rad


def _turned(axis, angle_rad):
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle_rad) * cross + (1.0 - np.cos(angle_rad)) * cross @ cross


def _heading_rad(quaternion_nb):
    w, x, y, z = quaternion_nb
    return np.arctan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (y * y + z * z))
