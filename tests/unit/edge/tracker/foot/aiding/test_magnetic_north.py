"""North from a calibrated compass: when it is stated, and its uncertainty."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.mechanization.strapdown import rotation_matrix
from edge.tracker.track_rows import join_rows
from shared.earth_field import EarthField
from tests.bench.tracker.walk_errors import rms
from tests.rig.compass_walk import DURATION_S, SEEDS, bent, searched

DECLINATION_RAD = np.arctan2(1.48, 16.07)  # of the simulated field
EARTH = EarthField(DECLINATION_RAD, 0.007, float(np.hypot(1.48, 16.07)), 48.56, 0.133, 0.141)


def north_errors_rad(seed, bend=None, earth=EARTH, left_ut=0.5):
    """Error of the reported magnetic north, and its stated deviation."""
    description, imu, truth = searched(seed)
    imu = replace(imu, mag_ut=calibrated_ut(seed))
    if bend is not None:
        imu = bend(imu, truth)
    tracker = EskfTracker(replace(description, mag_iron_std_ut=left_ut))
    if earth is not None:
        tracker.set_earth_field(earth, 0)
    rows = join_rows([tracker.push(imu), tracker.finish()])
    known = np.flatnonzero(np.isfinite(rows.magnetic_north_std_rad))[::200]
    rotation, errors = np.zeros((3, 3)), []
    for k in known:
        rotation_matrix(rows.quaternion_nb[k], rotation)
        turn = rotation @ truth.rotation_nb[k].T
        frame_rad = np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1])
        errors.append(rows.magnetic_north_rad[k] - DECLINATION_RAD - frame_rad)
    return np.angle(np.exp(1j * np.array(errors))), rows.magnetic_north_std_rad[known]


@cache
def calibrated_ut(seed):
    """Noise-free reading of a magnetometer without iron or scale errors."""
    _, imu, truth = searched(seed)
    field_n_ut = np.array([16.07, 1.48, 48.56])
    noise = np.random.default_rng(seed).normal(0.0, 0.4, (len(imu), 3))
    return np.einsum("nji,j->ni", truth.rotation_nb, field_n_ut) + noise


@pytest.mark.slow
def test_a_calibrated_compass_on_open_ground_knows_north():
    for seed in SEEDS:
        errors_rad, stds_rad = north_errors_rad(seed)
        assert len(errors_rad) > 0.8 * DURATION_S
        half = len(errors_rad) // 2
        assert np.degrees(rms(errors_rad[half:])) < 2.0
        assert 1.0 < np.degrees(np.median(stds_rad[half:])) < 7.0


@pytest.mark.slow
def test_a_field_that_is_bent_all_over_shows_by_strength_and_dip():
    for seed in SEEDS:
        bend_n_ut = np.random.default_rng(seed).normal(0.0, 6.0, 3)

        def bend(imu, truth, bend_n_ut=bend_n_ut):
            return replace(
                imu, mag_ut=imu.mag_ut + truth.rotation_nb.transpose(0, 2, 1) @ bend_n_ut
            )

        errors_rad, stds_rad = north_errors_rad(seed, bend)
        assert rms(errors_rad / stds_rad) < 2.5
        clean_rad = north_errors_rad(seed)[1]
        assert np.median(stds_rad) > 1.5 * np.median(clean_rad)


def test_unknown_field_of_the_earth_increases_the_uncertainty_of_north():
    known, unknown = (np.median(north_errors_rad(0, earth=earth)[1]) for earth in (EARTH, None))
    assert unknown > 2.0 * known


def test_among_heavy_steel_north_is_not_stated():
    def bend(imu, truth):
        return bent(imu, truth, 0, wave_m=(1.0, 3.0), bend_ut=25.0)

    errors_rad, _ = north_errors_rad(0, bend)
    assert len(errors_rad) < 0.1 * DURATION_S


def test_without_a_calibration_north_is_never_stated():
    assert len(north_errors_rad(0, left_ut=None)[0]) == 0


def test_the_earths_field_holds_from_the_sample_that_was_named():
    description, imu, _ = searched(0)
    described = replace(description, mag_iron_std_ut=0.5)
    first = replace(imu.part(slice(0, 16_000)), mag_ut=calibrated_ut(0)[:16_000])

    def rows_with(cut):
        tracker = EskfTracker(described)
        before = tracker.push(first.part(slice(0, cut)))
        tracker.set_earth_field(EARTH, int(imu.t_ns[12_000]))
        parts = before, tracker.push(first.part(slice(cut, None))), tracker.finish()
        return join_rows(parts).magnetic_north_std_rad

    whole, late = rows_with(0), rows_with(11_990)
    assert np.array_equal(whole, late)
    assert whole[11_000] > 1.5 * whole[15_000]
