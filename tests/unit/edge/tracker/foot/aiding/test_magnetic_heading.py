"""Heading from the magnetic field: its benefit on open ground, and no harm by steel."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from edge.samples import ImuBatch
from edge.tracker.foot.aiding.magnetic_field import (
    ACROSS,
    ALONG,
    FIELD,
    IRON,
    NEAR,
    VERTICAL,
    WIDE,
    component_row,
    set_field_direction,
)
from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.foot.state import COMPASS, COMPASS_SIZE, FIELD_HYPOTHESIS
from edge.tracker.mechanization.strapdown import rotate_navigation, rotation_matrix
from edge.tracker.track_rows import join_rows
from tests.bench.tracker.walk_errors import rms
from tests.rig.compass_walk import SEEDS, bent, searched


def run(description, imu, cuts=()):
    tracker = EskfTracker(description)
    parts = [imu.part(slice(a, b)) for a, b in pairwise([0, *cuts, len(imu)])]
    return join_rows([*(tracker.push(part) for part in parts), tracker.finish()])


def heading_errors_rad(rows, truth, every=200):
    """Drift of the heading since the first row."""
    angles = []
    rotation = np.zeros((3, 3))
    for k in range(0, len(rows), every):
        rotation_matrix(rows.quaternion_nb[k], rotation)
        turn = rotation @ truth.rotation_nb[k].T
        angles.append(np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1]))
    drift = np.unwrap(angles)
    return drift - drift[0]


@cache
def blind_errors_rad(seed):
    description, imu, truth = searched(seed)
    return heading_errors_rad(run(description, replace(imu, mag_ut=None)), truth)


@pytest.mark.slow
def test_on_open_ground_it_holds_the_heading_that_the_gyroscope_loses():
    """With hard and soft iron as no calibration left it."""
    blind, seeing = [], []
    for seed in SEEDS:
        description, imu, truth = searched(seed)
        rows = run(description, imu)
        blind.append(blind_errors_rad(seed))
        seeing.append(heading_errors_rad(rows, truth))
        late = slice(len(seeing[-1]) // 2, None)
        stated = rows.heading_std_rad[::200]
        assert rms(seeing[-1][late] / stated[late]) < 2.0
    assert rms(np.concatenate(seeing)) < 0.5 * rms(np.concatenate(blind))


@pytest.mark.slow
def test_in_a_building_of_some_steel_it_is_still_of_use():
    blind, seeing = [], []
    for seed in SEEDS:
        description, imu, truth = searched(seed, building=True)
        blind.append(heading_errors_rad(run(description, replace(imu, mag_ut=None)), truth))
        seeing.append(heading_errors_rad(run(description, imu), truth))
    assert rms(np.concatenate(seeing)) < 0.9 * rms(np.concatenate(blind))


@pytest.mark.slow
def test_among_heavy_steel_it_is_left_alone():
    """Fields bent by 50 degrees from step to step, as over the reinforced floor of ``loops``."""
    for seed in SEEDS:
        description, imu, truth = searched(seed)
        rows = run(description, bent(imu, truth, seed, wave_m=(0.5, 3.0), bend_ut=12.0))
        error_rad = rms(heading_errors_rad(rows, truth))
        assert error_rad < rms(blind_errors_rad(seed)) + np.radians(1.0)


@pytest.mark.slow
@pytest.mark.parametrize("bend_ut", [2.0, 5.0, 10.0])
def test_a_field_that_bends_slowly_does_no_harm(bend_ut):
    """Over 25 to 80 m, so that no footfall differs much from the next."""
    blind, seeing = [], []
    for seed in SEEDS:
        description, imu, truth = searched(seed)
        rows = run(description, bent(imu, truth, seed, wave_m=(25.0, 80.0), bend_ut=bend_ut))
        blind.append(blind_errors_rad(seed))
        seeing.append(heading_errors_rad(rows, truth))
        late = slice(len(seeing[-1]) // 2, None)
        assert rms(seeing[-1][late] / rows.heading_std_rad[::200][late]) < 2.5
        assert rms(seeing[-1]) < rms(blind[-1]) + np.radians(2.0)
    assert rms(np.concatenate(seeing)) < rms(np.concatenate(blind))


@pytest.mark.slow
@pytest.mark.parametrize("fault", ["stuck", "missing", "infinite", "absurd"])
def test_a_broken_magnetometer_is_as_good_as_none(fault):
    description, imu, _ = searched(0)
    values = {"stuck": (20.0, -5.0, 40.0), "missing": np.nan, "infinite": np.inf, "absurd": 5e3}
    mag_ut = np.broadcast_to(np.asarray(values[fault], dtype=np.float64), (len(imu), 3)).copy()
    first = imu.part(slice(0, 20_000))
    blind = run(description, replace(first, mag_ut=None))
    broken = run(description, replace(first, mag_ut=mag_ut[:20_000]))
    np.testing.assert_allclose(broken.position_n_m, blind.position_n_m, atol=0.02)


def test_batching_does_not_change_a_bit():
    description, imu, _ = searched(0)
    first = imu.part(slice(0, 20_000))
    whole = run(description, first)
    cut = run(description, first, cuts=range(7, 20_000, 137))
    assert np.array_equal(whole.position_n_m, cut.position_n_m)
    assert np.array_equal(whole.position_cov_m2, cut.position_cov_m2)


@pytest.mark.slow
@pytest.mark.parametrize("axis", [ALONG, VERTICAL, ACROSS])
def test_the_row_is_the_derivative_of_the_model(axis):
    noise = np.random.default_rng(axis)
    compass, hypothesis = np.zeros(1, COMPASS)[0], np.zeros(1, FIELD_HYPOTHESIS)[0]
    attitude = noise.standard_normal(4)
    attitude /= np.linalg.norm(attitude)
    rotation_matrix(attitude, compass["rotation_nb"])
    field_n_ut = np.array([16.0, -4.0, 45.0])
    hypothesis["estimate"][FIELD : FIELD + 3] = field_n_ut
    hypothesis["covariance"][FIELD, FIELD] = 1e-6  # known
    set_field_direction(hypothesis)
    ahead, right = hypothesis["field_direction_n"]
    axes = {ALONG: (ahead, right, 0.0), VERTICAL: (0.0, 0.0, 1.0), ACROSS: (-right, ahead, 0.0)}
    component_row(compass, hypothesis, axis, EskfConfig())

    def component(states):
        """Predicted measurement for these states, by the estimated attitude."""
        true = attitude.copy()
        rotate_navigation(true, 0.0, 0.0, states[0])
        true_nb = np.zeros((3, 3))
        rotation_matrix(true, true_nb)
        field = sum(states[k : k + 3] for k in (FIELD, NEAR, WIDE))
        seen_b = true_nb.T @ field + states[IRON : IRON + 3]
        return np.asarray(axes[axis]) @ compass["rotation_nb"] @ seen_b

    here = hypothesis["estimate"].copy()
    for state in range(COMPASS_SIZE):
        step = 1e-5 * np.eye(COMPASS_SIZE)[state]
        slope = (component(here + step) - component(here - step)) / 2e-5
        assert compass["row"][state] == pytest.approx(slope, abs=1e-4), state


@pytest.mark.slow
def test_iron_that_is_put_on_on_the_way_does_no_harm():
    """A magnetic tool in the boot: what was learned of the iron is wrong from then on."""
    for seed in SEEDS:
        description, imu, truth = searched(seed)
        assert imu.mag_ut is not None
        mag_ut = imu.mag_ut.copy()
        mag_ut[len(imu) // 2 :] += [40.0, -25.0, 30.0]
        rows = run(description, replace(imu, mag_ut=mag_ut))
        error_rad = rms(heading_errors_rad(rows, truth))
        assert error_rad < rms(blind_errors_rad(seed)) + np.radians(2.0)


def test_the_mount_of_the_sensor_makes_no_difference():
    """To the shape of the path; its north is the first attitude's."""
    description, imu, _ = searched(0)
    first = imu.part(slice(0, 20_000))
    assert first.mag_ut is not None
    turn = np.zeros((3, 3))
    rotation_matrix(np.array([0.5, -0.5, 0.1, 0.7]), turn)
    rotated = ImuBatch(
        first.t_ns, first.accel_mps2 @ turn.T, first.gyro_radps @ turn.T, first.mag_ut @ turn.T
    )
    one, other = run(description, first), run(description, rotated)
    for axis in (None, 2):
        ways_m = [
            np.linalg.norm(rows.position_n_m[:, :2], axis=1)
            if axis is None
            else rows.position_n_m[:, axis]
            for rows in (one, other)
        ]
        np.testing.assert_allclose(ways_m[0], ways_m[1], atol=1e-3)
