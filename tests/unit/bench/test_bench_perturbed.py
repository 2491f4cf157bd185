"""Worse sensors made from a recording, and the criterion of a silent failure."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import SensorDescription
from tests.bench.tracker.perturbations import (
    PERTURBATIONS,
    gyro_clipped,
    gyro_scale_of_all_axes,
    other_mount,
    slower,
)
from tests.bench.tracker.perturbed_walks import Outcome, perturbed_table
from tests.rig.exact_strides import walk

WALK = walk(strides=4)


def seed():
    return np.random.default_rng(7)


@pytest.mark.parametrize("perturbation", PERTURBATIONS, ids=lambda entry: entry.name)
def test_every_perturbation_gives_a_recording_and_the_same_each_time(perturbation):
    before = WALK.imu.gyro_radps.copy()
    description, imu = perturbation.apply(WALK.description, WALK.imu, seed())
    _, again = perturbation.apply(WALK.description, WALK.imu, seed())
    assert len(imu) == len(imu.accel_mps2) == len(imu.gyro_radps)
    assert np.isfinite(imu.accel_mps2).all()
    assert (np.diff(imu.t_ns) >= 0).all()
    lasts_s = 1e-9 * (imu.t_ns[-1] - imu.t_ns[0])
    assert len(imu) == pytest.approx(lasts_s * description.rate_hz, rel=0.12)
    assert np.array_equal(imu.gyro_radps, again.gyro_radps)
    assert np.array_equal(WALK.imu.gyro_radps, before)


@pytest.mark.parametrize("full_scale", [None, 9.0])
def test_changed_mount_is_a_rotation(full_scale):
    reported = SensorDescription("walk", 200.0, gyro_full_scale_radps=full_scale)
    _, imu = other_mount(reported, WALK.imu, seed())
    turn = np.linalg.lstsq(WALK.imu.gyro_radps, imu.gyro_radps, rcond=None)[0]
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(turn) == pytest.approx(1.0)
    if full_scale is not None:
        assert set(np.round(np.abs(turn), 9).ravel()) == {0.0, 1.0}


def test_a_scale_of_all_axes_is_one_factor_and_goes_up_and_down():
    before = WALK.imu.gyro_radps
    seen = set()
    for number in range(20):
        change = gyro_scale_of_all_axes(0.03)
        _, imu = change(WALK.description, WALK.imu, np.random.default_rng(number))
        (factor,) = set(np.round(imu.gyro_radps[before != 0.0] / before[before != 0.0], 9))
        seen.add(float(factor))
    assert seen == {0.97, 1.03}


def test_slow_filtered_sensor_turns_by_as_much():
    description, slow = slower(66.0, filtered=True)(WALK.description, WALK.imu, seed())
    assert description.rate_hz == pytest.approx(200.0 / 3)
    turned = slow.gyro_radps.sum(axis=0) / description.rate_hz
    np.testing.assert_allclose(turned, WALK.imu.gyro_radps.sum(axis=0) / 200.0, atol=0.05)


def test_clipping_is_reported_with_its_scale():
    description, imu = gyro_clipped(WALK.description, WALK.imu, seed())
    assert np.abs(imu.gyro_radps).max() == description.gyro_full_scale_radps


def test_silent_failure_is_a_large_error_without_a_low_quality():
    def outcome(right, stated):
        return Outcome("noise x 3", "made", "straight", 1.0, right, stated)

    assert outcome(right=False, stated=False).silent
    assert not outcome(right=False, stated=True).silent
    assert not outcome(right=True, stated=False).silent
    table = perturbed_table([outcome(True, True), outcome(False, True), outcome(False, False)])
    cells = [next(iter(column.cells)) for column in table.columns]
    assert cells == ["noise x 3", "1.000", "1", "1", "1"]
