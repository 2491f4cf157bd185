"""Sensors that hang or fail, on one axis or on all, for a moment or for good."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import ImuBatch
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.huang.tracker import HuangTracker
from edge.tracker.interface import Quality, Reason
from edge.tracker.track_rows import join_rows
from tests.rig.faulty_walk import IN_SWING, LENGTH_M, WALK, copy, flagged, index, reached_m, run

ALL = (0, 1, 2)


@pytest.mark.parametrize(
    ("accel_axes", "gyro_axes"),
    [(ALL, ALL), (ALL, ()), ((), ALL), ((0,), ()), ((2,), ()), ((), (1,))],
    ids=["both", "accelerometer", "gyroscope", "accel x", "accel z", "gyro y"],
)
def test_axis_stuck_during_a_swing_is_detected(accel_axes, gyro_axes):
    t_ns, accel, gyro = copy()
    first, stop = index(IN_SWING + 0.05), index(IN_SWING + 0.3)
    accel[first:stop, accel_axes] = accel[first, accel_axes]
    gyro[first:stop, gyro_axes] = gyro[first, gyro_axes]
    rows = run(t_ns, accel, gyro)
    assert flagged(rows, Reason.BAD_SAMPLES)[first + 11 : stop].all()
    assert not flagged(rows, Reason.BAD_SAMPLES)[stop:].any()
    off_m = abs(reached_m(rows) - LENGTH_M)
    assert off_m < 2.5 * np.sqrt(np.trace(rows.position_cov_m2[-1, :2, :2]))


def test_missing_samples_are_no_stance():
    """The filter's own time stands still meanwhile."""
    t_ns, accel, gyro = copy()
    first = index(IN_SWING)
    accel[first:] = np.nan
    rows = run(t_ns, accel, gyro)
    assert not flagged(rows, Reason.NO_STANCE)[: index(IN_SWING + 2.0)].any()
    assert flagged(rows, Reason.NO_STANCE)[index(IN_SWING + 3.1) :].all()


@pytest.mark.parametrize("value", [0.5, 1.0, np.nan])  # of the highest reading before
@pytest.mark.parametrize("axis", range(6))
def test_uncertainty_grows_with_a_permanently_failed_axis(axis, value):
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
def test_long_failure_gives_every_row_once(make):
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
def test_simulated_axis_without_rotation_is_not_stuck(axes):
    t_ns, accel, gyro = copy()
    gyro[:, axes] = 0.0
    assert not flagged(run(t_ns, accel, gyro), Reason.BAD_SAMPLES).any()
