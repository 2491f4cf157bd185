"""A simulated walk to be spoiled, and what the tracker makes of it."""

from __future__ import annotations

import numpy as np

from edge.samples import ImuBatch
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.track_rows import join_rows
from tests.rig.exact_strides import walk

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
