"""Samples that are missing and stamps that jump: a short hole is bridged, a long one doubted."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import SensorDescription
from edge.tracker.port import Quality, Reason
from tests.faulty_walk import IN_STANCE, IN_SWING, LENGTH_M, copy, flagged, index, reached_m, run


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
