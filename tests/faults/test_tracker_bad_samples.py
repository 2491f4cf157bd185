"""Impossible values, spikes and repeats in samples are flagged, and never fatal."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.interface import Quality, Reason
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


def test_lasting_rise_of_a_rate_is_no_spike():
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


def test_bad_first_samples_do_not_inflate_the_uncertainty():
    t_ns, accel, gyro = copy()
    accel[:5] = np.nan
    rows = EskfTracker(WALK.description).push(ImuBatch(t_ns + 10**15, accel, gyro))
    assert np.sqrt(rows.position_cov_m2[:100, 0, 0].max()) < 1.0


def test_missing_stances_are_degraded_then_lost():
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


def test_start_in_motion_recovers_after_some_steps():
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
def test_wrong_accelerometer_scale_is_mostly_corrected(scale):
    t_ns, accel, gyro = copy()
    rows = run(t_ns, scale * accel, gyro)
    wrong_m = abs(scale - 1.0) * LENGTH_M
    assert abs(reached_m(rows) - LENGTH_M) < 0.6 * wrong_m
