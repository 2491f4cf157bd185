"""Attitude of the trunk: gravity levels it, rests show the bias, a calibrated compass north."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.samples import ImuBatch
from edge.tracker.interface import Reason
from edge.tracker.mechanization.strapdown import rotation_matrix
from edge.tracker.track_rows import join_rows
from edge.tracker.waist.tracker import WaistTracker
from tests.rig.trunk_walk import DESCRIPTION, UPRIGHT, bobbing

EARTH_UT = np.array([16.0, 0.0, 48.0])  # north, east, down


def headings_rad(rows):
    rotation, headings = np.zeros((3, 3)), []
    for quaternion in rows.quaternion_nb[::20]:
        rotation_matrix(quaternion, rotation)
        headings.append(np.arctan2(rotation[1, 0], rotation[0, 0]))
    return np.unwrap(headings)


def standing(duration_s, gyro_radps=(0.0, 0.0, 0.0), heading_rad=None):
    t_s = np.arange(0.0, duration_s, 0.01)
    imu = ImuBatch(
        np.rint(t_s * 1e9).astype(np.int64),
        np.tile(UPRIGHT, (len(t_s), 1)),
        np.tile(gyro_radps, (len(t_s), 1)),
    )
    if heading_rad is None:
        return imu
    c, s = np.cos(heading_rad), np.sin(heading_rad)
    to_sensor = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return replace(imu, mag_ut=np.tile(to_sensor @ EARTH_UT, (len(t_s), 1)))


def tracked(imu, description=DESCRIPTION):
    tracker = WaistTracker(description)
    return join_rows([tracker.push(imu), tracker.finish()])


def test_a_rest_shows_the_bias_and_the_heading_stops_to_drift():
    rows = tracked(standing(20.0, (0.0, 0.0, 0.02)))
    headings = headings_rad(rows)
    assert headings[-1] - headings[len(headings) // 4] == pytest.approx(0.0, abs=2e-3)
    assert rows.reasons[50] & Reason.UNSETTLED
    assert not rows.reasons[-1] & Reason.UNSETTLED
    assert rows.heading_std_rad[-1] < 0.05


def test_a_walk_without_a_rest_states_a_heading_that_gets_worse():
    rows = tracked(bobbing(60, 1.8, stands_s=0.1))
    assert rows.reasons[-1] & Reason.UNSETTLED
    assert rows.heading_std_rad[-1] > 0.4


def test_a_tilt_that_is_off_is_levelled():
    imu = standing(20.0)
    imu.accel_mps2[:30] = np.array([3.0, 0.0, -9.3])  # pushed as it was switched on
    rotation = np.zeros((3, 3))
    rotation_matrix(tracked(imu).quaternion_nb[-1], rotation)
    assert rotation[2, 2] == pytest.approx(1.0, abs=1e-3)


def test_a_calibrated_compass_holds_the_heading_and_another_is_left_out():
    turning = standing(120.0, (0.0, 0.0, 0.004), heading_rad=0.7)
    turning.gyro_radps[::2, 2] += 0.15  # no rest, so nothing shows the bias
    turning.gyro_radps[1::2, 2] -= 0.15
    calibrated = replace(DESCRIPTION, mag_present=True, mag_iron_std_ut=0.5)
    held = headings_rad(tracked(turning, calibrated))
    assert held[-1] == pytest.approx(0.7, abs=0.05)
    free = headings_rad(tracked(turning, replace(DESCRIPTION, mag_present=True)))
    assert free[-1] - free[0] == pytest.approx(0.004 * 120.0, rel=0.1)
