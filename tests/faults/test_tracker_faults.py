"""Faults of real logs: the flags and the recovery expected of each."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.eskf import EskfTracker
from edge.tracker.huang import HuangTracker
from edge.tracker.port import Quality, Reason
from edge.tracker.rows import join_rows
from tests.walking import walk

WALK = walk(strides=12)
LENGTH_M = 12 * 1.3
IN_SWING = 2.0 + 5 * 1.2 + 0.35  # s, the middle of the sixth swing
IN_STANCE = 2.0 + 5 * 1.2 + 0.95


def copy():
    imu = WALK.imu
    return imu.t_ns.copy(), imu.accel_mps2.copy(), imu.gyro_radps.copy()


def run(t_ns, accel, gyro, description=WALK.description):
    tracker = EskfTracker(description)
    rows = join_rows([tracker.push(ImuBatch(t_ns, accel, gyro)), tracker.finish()])
    assert len(rows) == len(t_ns)
    assert np.array_equal(rows.t_ns, t_ns)
    assert np.isfinite(rows.position_n_m).all()
    assert np.isfinite(rows.position_cov_m2).all()
    return rows


def index(t_s):
    return int(np.searchsorted(WALK.imu.t_ns, t_s * 1e9))


def reached_m(rows):
    return float(np.linalg.norm(rows.position_n_m[-1, :2]))


def flagged(rows, reason):
    return (rows.reasons & int(reason)) != 0


def test_a_clean_walk_raises_no_flag():
    rows = run(*copy())
    assert reached_m(rows) == pytest.approx(LENGTH_M, abs=0.15)
    assert not rows.reasons.any()
    assert (rows.quality == Quality.GOOD).all()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e30])
def test_impossible_values_are_left_out_and_flagged(value):
    t_ns, accel, gyro = copy()
    accel[index(IN_SWING), 1] = value
    gyro[index(IN_STANCE), 2] = value
    rows = run(t_ns, accel, gyro)
    bad = flagged(rows, Reason.BAD_SAMPLES)
    assert list(np.flatnonzero(bad)) == [index(IN_SWING), index(IN_STANCE)]
    assert reached_m(rows) == pytest.approx(LENGTH_M, abs=0.2)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("t_s", [IN_SWING, IN_STANCE, IN_STANCE + 0.21])
def test_a_spike_of_a_rate_is_left_out_and_flagged(t_s, axis):
    t_ns, accel, gyro = copy()
    gyro[index(t_s), axis] -= 9.0  # for 5 ms, a turn of 2.6 degrees
    rows, clean = run(t_ns, accel, gyro), run(*copy())
    assert list(np.flatnonzero(flagged(rows, Reason.BAD_SAMPLES))) == [index(t_s)]
    off_m = np.linalg.norm(rows.position_n_m - clean.position_n_m, axis=1)
    assert off_m.max() < 0.02
    assert np.linalg.norm(rows.quaternion_nb[-1] - clean.quaternion_nb[-1]) < 2e-3


def test_a_rate_that_rises_to_stay_is_no_spike():
    t_ns, accel, gyro = copy()
    gyro[index(IN_SWING) :, 2] += 2.0
    assert not flagged(run(t_ns, accel, gyro), Reason.BAD_SAMPLES).any()


def test_repeated_samples_change_nothing_but_their_own_flag():
    t_ns, accel, gyro = copy()
    at = np.sort(np.r_[np.arange(len(t_ns)), np.arange(300, 2000, 97)])
    rows = run(t_ns[at], accel[at], gyro[at])
    repeated = np.r_[False, np.diff(at) == 0]
    assert np.array_equal(flagged(rows, Reason.BAD_SAMPLES), repeated)
    np.testing.assert_allclose(rows.position_n_m[~repeated], run(*copy()).position_n_m, atol=5e-3)


def test_stamps_that_go_back_are_left_out():
    t_ns, accel, gyro = copy()
    k = index(IN_SWING)
    t_ns[k] = t_ns[k - 3]
    rows = run(t_ns, accel, gyro)
    assert list(np.flatnonzero(flagged(rows, Reason.BAD_SAMPLES))) == [k]
    assert reached_m(rows) == pytest.approx(LENGTH_M, abs=0.2)


def test_late_stamps_are_put_right():
    """Stamps of a transport that delivers every fourth sample late, with the next one."""
    t_ns, accel, gyro = copy()
    late = np.arange(100, len(t_ns) - 1, 4)
    t_ns[late] = t_ns[late + 1] - 50_000
    rows = run(t_ns, accel, gyro)
    assert reached_m(rows) == pytest.approx(LENGTH_M, abs=0.15)
    assert not flagged(rows, Reason.BAD_SAMPLES).any()


def test_a_gap_is_flagged_widens_the_uncertainty_and_heals():
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
def test_a_hole_shorter_than_a_swing_is_bridged(begin_s):
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


def test_a_gap_makes_no_heading_surer():
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


ALL = (0, 1, 2)


@pytest.mark.parametrize(
    ("accel_axes", "gyro_axes"),
    [(ALL, ALL), (ALL, ()), ((), ALL), ((0,), ()), ((2,), ()), ((), (1,))],
    ids=["both", "accelerometer", "gyroscope", "accel x", "accel z", "gyro y"],
)
def test_what_hangs_mid_swing_is_noticed(accel_axes, gyro_axes):
    t_ns, accel, gyro = copy()
    first, stop = index(IN_SWING + 0.05), index(IN_SWING + 0.3)
    accel[first:stop, accel_axes] = accel[first, accel_axes]
    gyro[first:stop, gyro_axes] = gyro[first, gyro_axes]
    rows = run(t_ns, accel, gyro)
    assert flagged(rows, Reason.BAD_SAMPLES)[first + 11 : stop].all()
    assert not flagged(rows, Reason.BAD_SAMPLES)[stop:].any()
    off_m = abs(reached_m(rows) - LENGTH_M)
    assert off_m < 2.5 * np.sqrt(np.trace(rows.position_cov_m2[-1, :2, :2]))


def test_what_is_bad_from_the_start_is_not_doubted_for_the_age_of_the_clock():
    t_ns, accel, gyro = copy()
    accel[:5] = np.nan
    rows = EskfTracker(WALK.description).push(ImuBatch(t_ns + 10**15, accel, gyro))
    assert np.sqrt(rows.position_cov_m2[:100, 0, 0].max()) < 1.0


@pytest.mark.parametrize("value", [0.5, 1.0, np.nan])  # of the highest reading before
@pytest.mark.parametrize("axis", range(6))
def test_an_axis_that_fails_for_good_is_doubted_more_and_more(axis, value):
    t_ns, accel, gyro = copy()
    first, noticed = index(IN_SWING), index(IN_SWING + 0.45)
    readings = accel if axis < 3 else gyro
    readings[first:, axis % 3] = value * np.abs(readings[:, axis % 3]).max()
    rows = run(t_ns, accel, gyro)
    assert flagged(rows, Reason.BAD_SAMPLES)[noticed:].all()
    assert (rows.quality[noticed:] != Quality.GOOD).all()
    off_m = np.abs(rows.position_n_m - WALK.position_n_m)
    std_m = np.sqrt(np.diagonal(rows.position_cov_m2, axis1=1, axis2=2))
    assert (off_m < 2.5 * std_m + 2.0)[first:].all()  # a stride until it is noticed
    assert std_m[-1].min() > 10.0
    assert rows.heading_std_rad[-1] > np.pi / 2
    since_s = 1e-9 * (t_ns[-1] - t_ns[first])
    assert since_s < 10.0 or rows.quality[-1] == Quality.LOST


@pytest.mark.parametrize("make", [EskfTracker, HuangTracker])
def test_a_long_failure_gives_every_row_once_however_the_samples_come(make):
    t_ns, accel, gyro = copy()
    accel[index(IN_SWING) : index(IN_SWING + 7.5)] = np.nan
    whole, bits = make(WALK.description), make(WALK.description)
    imu = ImuBatch(t_ns, accel, gyro)
    at_once = join_rows([whole.push(imu), whole.finish()])
    parts = [bits.push(imu.part(slice(k, k + 10))) for k in range(0, len(t_ns), 10)]
    last_ns = [int(rows.t_ns[-1]) if len(rows) else 0 for rows in parts]
    late_ns = t_ns[9::10] - np.maximum.accumulate(last_ns)
    assert late_ns[100:].max() <= 1_400_000_000
    live = join_rows([*parts, bits.finish()])
    for rows in (at_once, live):
        np.testing.assert_array_equal(rows.t_ns, t_ns)
        assert np.isfinite(rows.position_n_m).all()
    np.testing.assert_array_equal(live.position_n_m, at_once.position_n_m)


@pytest.mark.parametrize("axes", [2, (0, 1, 2)])
def test_what_was_made_to_feel_no_turn_hangs_not(axes):
    t_ns, accel, gyro = copy()
    gyro[:, axes] = 0.0
    assert not flagged(run(t_ns, accel, gyro), Reason.BAD_SAMPLES).any()


def test_a_clipped_gyroscope_is_flagged_and_widens_the_uncertainty():
    t_ns, accel, gyro = copy()
    full_scale = 0.7 * np.abs(gyro).max()
    description = SensorDescription("clipping", 200.0, gyro_full_scale_radps=full_scale)
    rows = run(t_ns, accel, np.clip(gyro, -full_scale, full_scale), description)
    clipped = np.abs(gyro).max(axis=1) >= full_scale
    assert flagged(rows, Reason.GYRO_SATURATED)[clipped].all()
    assert not flagged(rows, Reason.GYRO_SATURATED)[:300].any()
    honest = run(*copy())
    assert np.trace(rows.position_cov_m2[-1]) > np.trace(honest.position_cov_m2[-1])


def test_a_clipped_accelerometer_is_flagged():
    t_ns, accel, gyro = copy()
    description = SensorDescription("clipping", 200.0, accel_full_scale_mps2=15.0)
    rows = run(t_ns, np.clip(accel, -15.0, 15.0), gyro, description)
    assert flagged(rows, Reason.ACCEL_SATURATED).any()


def test_no_stance_is_degraded_then_lost():
    """Shaken without a rest: the tracker must not stay confident."""
    noise = np.random.default_rng(3)
    t_ns = np.arange(0, 20 * 200) * 5_000_000
    accel = np.array([0.0, 0.0, -9.8]) + noise.normal(0.0, 30.0, (len(t_ns), 3))
    gyro = noise.normal(0.0, 6.0, (len(t_ns), 3))
    rows = run(t_ns, accel, gyro)
    assert flagged(rows, Reason.ALIGNING)[0]
    assert flagged(rows, Reason.NO_STANCE)[1000]
    assert rows.quality[-1] == Quality.LOST


@pytest.mark.parametrize("described_hz", [50.0, 100.0, 400.0, 1000.0])
def test_a_wrong_described_rate_does_no_harm(described_hz):
    t_ns, accel, gyro = copy()
    rows = run(t_ns, accel, gyro, SensorDescription("wrong", described_hz))
    assert reached_m(rows) == pytest.approx(LENGTH_M, abs=0.3)


def test_a_start_on_the_move_finds_its_feet():
    first = index(2.3)  # in the first swing
    t_ns, accel, gyro = copy()
    rows = run(t_ns[first:], accel[first:], gyro[first:])
    missing_m = WALK.position_n_m[first, 0]
    assert reached_m(rows) == pytest.approx(LENGTH_M - missing_m, abs=0.5)
    assert rows.quality[-1] == Quality.GOOD


@pytest.mark.parametrize("spike_mps2", [60.0, 150.0, 1e5])
def test_a_spike_does_no_lasting_harm(spike_mps2):
    t_ns, accel, gyro = copy()
    accel[index(IN_SWING), 0] += spike_mps2
    accel[index(IN_STANCE), 2] -= spike_mps2
    rows = run(t_ns, accel, gyro)
    assert reached_m(rows) == pytest.approx(LENGTH_M, abs=0.5)
    assert rows.quality[-1] == Quality.GOOD
    absurd = spike_mps2 > 4000.0
    assert flagged(rows, Reason.BAD_SAMPLES)[index(IN_SWING)] == absurd


def test_memory_does_not_grow():
    tracker = EskfTracker(WALK.description)
    held = tracker._ring.nbytes, tracker._trail.nbytes
    for lap in range(4):
        shifted = WALK.imu.t_ns + lap * (WALK.imu.t_ns[-1] + 5_000_000)
        tracker.push(ImuBatch(shifted, WALK.imu.accel_mps2, WALK.imu.gyro_radps))
    assert (tracker._ring.nbytes, tracker._trail.nbytes) == held


@pytest.mark.parametrize("scale", [0.96, 1.07])
def test_a_wrong_accelerometer_scale_is_mostly_put_right(scale):
    t_ns, accel, gyro = copy()
    rows = run(t_ns, scale * accel, gyro)
    wrong_m = abs(scale - 1.0) * LENGTH_M
    assert abs(reached_m(rows) - LENGTH_M) < 0.6 * wrong_m


@pytest.mark.parametrize("rate_hz", [67.0, 100.0, 200.0])
def test_clipping_that_nobody_told_shows_by_its_plateaus(rate_hz):
    t_ns, accel, gyro = copy()
    every = round(200.0 / rate_hz)
    t_ns, accel, gyro = t_ns[::every], accel[::every], gyro[::every]
    full_scale = 0.85 * np.abs(gyro).max()
    description = SensorDescription("untold", rate_hz)
    rows = run(t_ns, accel, np.clip(gyro, -full_scale, full_scale), description)
    clipped = np.abs(gyro).max(axis=1) >= full_scale
    assert not flagged(rows, Reason.GYRO_SATURATED)[: np.flatnonzero(clipped)[0] - 1].any()
    assert flagged(rows, Reason.GYRO_SATURATED)[np.argmax(np.abs(gyro).max(axis=1))]
    whole = run(t_ns, accel, gyro, description)
    assert not flagged(whole, Reason.GYRO_SATURATED).any()


def test_a_full_scale_that_is_passed_was_none():
    t_ns, accel, gyro = copy()
    full_scale = 0.85 * np.abs(gyro).max()
    early = slice(0, index(IN_STANCE))
    gyro[early] = np.clip(gyro[early], -full_scale, full_scale)
    rows = run(t_ns, accel, gyro)
    assert flagged(rows, Reason.GYRO_SATURATED)[early].any()
    assert not flagged(rows, Reason.GYRO_SATURATED)[-300:].any()


def test_a_gyroscope_that_hides_most_of_a_swing_is_not_stated_endlessly():
    """What a rest shows of its bias then differs from sample to sample."""
    t_ns, accel, gyro = copy()
    rows = run(t_ns, accel, np.clip(gyro, -1.5, 1.5))  # too slow to be taken for a full scale
    assert np.sqrt(rows.position_cov_m2[-1, 0, 0]) < 100.0


def test_a_lull_in_a_rise_is_no_full_scale():
    t_ns, accel, gyro = copy()
    k = int(np.argmax(np.abs(gyro[:, 1]) > 0.85 * np.abs(gyro).max()))
    gyro[k : k + 4, 1] = gyro[k, 1]  # for once the same to the last bit
    assert not flagged(run(t_ns, accel, gyro), Reason.GYRO_SATURATED).any()


@pytest.mark.parametrize("full_scale", [0.8, 0.85])
def test_plateaus_that_were_smoothed_show_a_full_scale(full_scale):
    """Real sensors filter and rotate what has clipped."""
    t_ns, accel, gyro = copy()
    full_scale *= np.abs(gyro).max()
    clipped = np.clip(gyro, -full_scale, full_scale)
    weights = (0.2, 0.6, 0.2)
    smooth = np.column_stack([np.convolve(clipped[:, j], weights, "same") for j in range(3)])
    ripple = 1.0 + 0.003 * np.sin(0.7 * np.arange(len(smooth)))
    rows = run(t_ns, accel, ripple[:, np.newaxis] * smooth)
    late = slice(index(IN_SWING), None)
    assert flagged(rows, Reason.GYRO_SATURATED)[late][np.abs(gyro[late, 1]) >= full_scale].all()
    flat_n_m = run(t_ns, accel, gyro).position_n_m
    assert np.abs(rows.position_n_m[-1] - flat_n_m[-1]).max() < 0.3


def smoothed(readings):
    """As real sensors filter what has clipped."""
    columns = [np.convolve(readings[:, j], (0.2, 0.6, 0.2), "same") for j in range(3)]
    return np.column_stack(columns)


def in_counts(readings, full_scale):
    """As a converter of 12 bits gives them, which reaches further down than up."""
    step = full_scale / 2048
    return step * np.clip(np.round(readings / step), -2048, 2047)


@pytest.mark.parametrize("rate_hz", [67.0, 100.0, 200.0])
@pytest.mark.parametrize("sensor", ["clips", "filters", "counts"])
def test_a_full_scale_of_forces_that_nobody_told_shows_by_its_plateaus(rate_hz, sensor):
    t_ns, accel, gyro = copy()
    every = round(200.0 / rate_hz)
    t_ns, accel, gyro = t_ns[::every], accel[::every], gyro[::every]
    full_scale = 0.75 * np.abs(accel).max()
    clipped = np.clip(accel, -full_scale, full_scale)
    if sensor == "filters":
        clipped = smoothed(clipped)
    if sensor == "counts":
        clipped = in_counts(accel, full_scale)
    description = SensorDescription("untold", rate_hz)
    rows = run(t_ns, clipped, gyro, description)
    hidden = np.abs(accel).max(axis=1) >= full_scale
    assert not flagged(rows, Reason.ACCEL_SATURATED)[: np.flatnonzero(hidden)[0] - 1].any()
    later = hidden & (t_ns > (IN_SWING - 1.2) * 1e9)
    assert flagged(rows, Reason.ACCEL_SATURATED)[later].all()
    whole = run(t_ns, accel, gyro, description)
    assert not flagged(whole, Reason.ACCEL_SATURATED).any()


@pytest.mark.parametrize("every", [3, 4])
def test_forces_that_a_slow_sensor_holds_are_no_full_scale(every):
    t_ns, accel, gyro = copy()
    held = accel[np.arange(len(accel)) // every * every]
    assert not flagged(run(t_ns, held, gyro), Reason.ACCEL_SATURATED).any()


def test_what_is_found_untold_is_bridged_and_doubted_as_if_told():
    t_ns, accel, gyro = copy()
    full_scale = 0.75 * np.abs(accel).max()
    clipped = np.clip(accel, -full_scale, full_scale)
    told = SensorDescription("told", 200.0, accel_full_scale_mps2=full_scale)
    more = SensorDescription("told too much", 200.0, accel_full_scale_mps2=10.0 * full_scale)
    known = run(t_ns, clipped, gyro, told)
    whole = run(t_ns, accel, gyro)
    assert known.position_cov_m2[-1, 0, 0] > 2.0 * whole.position_cov_m2[-1, 0, 0]
    for description in (WALK.description, more):
        rows = run(t_ns, clipped, gyro, description)
        assert reached_m(rows) == pytest.approx(reached_m(known), rel=0.02)
        stated_m2 = rows.position_cov_m2[-1, 0, 0]
        assert stated_m2 == pytest.approx(known.position_cov_m2[-1, 0, 0], rel=0.3)
