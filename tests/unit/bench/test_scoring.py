"""Error figures of tracks with known errors."""

from __future__ import annotations

import numpy as np
import pytest

from edge.sources.recording import RecordedTruth
from edge.tracker.interface import Quality, TrackBatch
from tests.bench.tracker.scoring import (
    fit_yaw,
    horizontal_nees,
    is_held,
    rows_at,
    score_track,
    turn_about_start,
)

TIMES_S = np.linspace(0.0, 200.0, 20_001)


def rows_along(position_n_m, std_m=0.1):
    n = len(position_n_m)
    return TrackBatch(
        t_ns=np.arange(n) * 10_000_000,
        position_n_m=position_n_m,
        velocity_n_mps=np.zeros((n, 3)),
        quaternion_nb=np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)),
        position_cov_m2=np.tile(std_m**2 * np.eye(3), (n, 1, 1)),
        heading_std_rad=np.zeros(n),
        stationary=np.zeros(n, bool),
        past_shift_n_m=np.zeros((n, 2)),
        past_turn_rad=np.zeros(n),
        distance_m=np.linspace(0.0, 20.0, n),
        steps=np.zeros(n, np.int64),
        quality=np.ones(n, np.uint8),
        reasons=np.zeros(n, np.uint32),
        magnetic_north_rad=np.zeros(n),
        magnetic_north_std_rad=np.full(n, np.inf),
    )


def curve(n=200):
    s = np.linspace(0.0, 4.0, n)
    return np.column_stack((5.0 * np.sin(s), 3.0 * np.cos(1.3 * s), 0.1 * s))


def test_yaw_and_shift_are_not_errors():
    c, s = np.cos(2.0), np.sin(2.0)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    truth = RecordedTruth(TIMES_S[:200], curve() @ turn.T + [7.0, -3.0, 40.0])
    score = score_track(rows_along(curve()), truth, closed_loop=False)
    assert score.ate_m == pytest.approx(0.0, abs=1e-9)
    assert score.vertical_rms_m == pytest.approx(0.0, abs=1e-9)
    assert score.coverage_95 == 1.0


def test_scale_and_mirror_are_errors():
    t_s = TIMES_S[:200]
    mirrored = RecordedTruth(t_s, curve() * [1.0, -1.0, 1.0])
    longer = RecordedTruth(t_s, curve() * [1.1, 1.1, 1.0])
    for truth, least_m in ((mirrored, 1.0), (longer, 0.1)):
        ate_m = score_track(rows_along(curve()), truth, closed_loop=False).ate_m
        assert ate_m is not None
        assert ate_m > least_m


def test_armse_is_ate_by_root_two_and_heights_lose_their_mean():
    position = curve()
    error = np.zeros_like(position)
    error[::2], error[1::2] = [0.1, 0.0, 0.25], [-0.1, 0.0, -0.15]
    truth = RecordedTruth(TIMES_S[:200], position + error)
    score = score_track(rows_along(position), truth, closed_loop=False)
    assert score.ate_m == pytest.approx(0.1, rel=1e-3)
    assert score.armse_2d_m == pytest.approx(0.1 / np.sqrt(2.0), rel=1e-3)
    assert score.vertical_rms_m == pytest.approx(0.2)
    assert score.per_cent_of_distance == pytest.approx(0.5, rel=1e-3)


def test_closed_loop_is_scored_by_its_ends():
    position = np.linspace([0.0, 0.0, 0.0], [0.3, 0.4, -0.2], 50)
    score = score_track(rows_along(position), None, closed_loop=True)
    assert score.closure_horizontal_m == pytest.approx(0.5)
    assert score.closure_vertical_m == pytest.approx(0.2)
    assert score.per_cent_of_distance == pytest.approx(2.5)
    assert score.ate_m is None


def test_errors_of_the_stated_size_are_in_the_ellipse_95_times_in_100():
    noise = np.random.default_rng(5)
    position = np.cumsum(noise.normal(0.0, 1.0, (20_000, 3)), axis=0)
    covariance = np.array([[0.04, 0.01, 0.0], [0.01, 0.09, 0.0], [0.0, 0.0, 0.01]])
    truth = position + noise.multivariate_normal(np.zeros(3), covariance, len(position))
    nees = horizontal_nees(position, truth, np.tile(covariance, (len(position), 1, 1)))
    assert nees.mean() == pytest.approx(2.0, abs=0.05)
    score = score_track(
        rows_along(position, 0.1), RecordedTruth(TIMES_S[: len(position)], truth),
        closed_loop=False,
    )  # fmt: skip
    assert score.coverage_95 is not None
    assert score.coverage_95 < 0.7  # 0.1 m is stated, 0.2 and 0.3 m are true


def test_a_flat_reference_has_no_vertical_error():
    truth = RecordedTruth(TIMES_S[:200], curve() * [1.0, 1.0, np.nan])
    assert score_track(rows_along(curve()), truth, closed_loop=False).vertical_rms_m is None


def test_covariance_turns_with_the_track():
    truth = curve() @ np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).T
    _, turned = fit_yaw(curve(), np.tile(np.diag([1.0, 4.0, 9.0]), (200, 1, 1)), truth)
    np.testing.assert_allclose(turned[0], np.diag([4.0, 1.0, 9.0]), atol=1e-9)


def test_drift_of_the_heading_is_not_spread_over_the_beginning():
    """Fitted, the start of a bent walk is wrong; aligned by its first heading it is right."""
    along_m = np.linspace(0.0, 50.0, 200)
    drift_rad = 0.004 * along_m
    truth = np.column_stack((along_m, np.zeros(200), np.zeros(200)))
    bent = np.column_stack((along_m * np.cos(drift_rad), along_m * np.sin(drift_rad), 0 * along_m))
    std_m = 0.005 + 0.1 * along_m * drift_rad
    covariance = std_m[:, None, None] ** 2 * np.eye(3)
    held, _ = turn_about_start(bent, covariance, truth)
    fitted, _ = fit_yaw(bent, covariance, truth)
    held_off_m, fitted_off_m = (np.abs((one - truth)[20, :2]).max() for one in (held, fitted))
    assert held_off_m < 0.2
    assert fitted_off_m > 3.0 * held_off_m
    assert held[0] == pytest.approx(truth[0], abs=1e-12)


def test_rows_are_interpolated_at_the_reference_times():
    position, _ = rows_at(rows_along(np.linspace([0, 0, 0], [49, 0, 0], 50)), np.array([0.105]))
    assert position[0, 0] == pytest.approx(10.5)


def test_silent_failure_is_an_error_over_three_stated_regions_with_good_quality():
    truth = RecordedTruth(TIMES_S[:200], curve())
    off_m = np.linspace(0.0, 2.0, 200)[:, np.newaxis]
    high = rows_along(curve() + off_m * [0.0, 0.0, 1.0])  # deviations of 0.1 m: 0.59 m are too much
    score = score_track(high, truth, closed_loop=False)
    assert score.silently_wrong == pytest.approx(1.0 - 0.6 / 2.0, abs=0.02)
    assert score.coverage_95_vertical == pytest.approx(0.2 / 2.0, abs=0.02)
    high.quality[:] = Quality.DEGRADED
    assert score_track(high, truth, closed_loop=False).silently_wrong == 0.0


def test_closed_walk_fails_silently_by_its_end():
    rows = rows_along(curve())
    assert score_track(rows, None, closed_loop=True).silently_wrong == 1.0
    rows.quality[-1] = Quality.LOST
    assert score_track(rows, None, closed_loop=True).silently_wrong == 0.0
    wide = score_track(rows_along(curve(), std_m=5.0), None, closed_loop=True)
    assert wide.silently_wrong == 0.0
    assert wide.stated_by_error == pytest.approx(
        5.0 * np.sqrt(2.0) / wide.closure_horizontal_m, rel=1e-3
    )


def test_reference_that_is_held_until_it_jumps_is_invalid():
    """Motion capture without its markers; a standing foot, and a running one, are valid."""
    t_s = np.linspace(0.0, 0.35, 8)
    north_m = np.array([0.0, 0.3, 0.3, 0.3, 1.3, 1.7, 1.7, 2.0])
    truth = RecordedTruth(t_s, np.column_stack((north_m, np.zeros(8), np.zeros(8))))
    assert is_held(truth).tolist() == [False, False, True, True, False, False, False, False]
