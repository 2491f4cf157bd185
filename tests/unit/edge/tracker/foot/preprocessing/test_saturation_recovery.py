"""Replacement of forces and rates that have clipped."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.preprocessing.saturation_recovery import recover_forces, recover_rates
from edge.tracker.foot.state import BRIDGE
from edge.tracker.preprocessing.sample_ring import RING

PERIOD_S = 0.004
FULL_SCALE_MPS2 = 20.0


def hidden_mps(force_mps2):
    """Return the velocity that is put in the place of what ``force_mps2`` (n,) hid, and its doubt.

    Clipped at the full scale, along the second axis.
    """
    ring = np.zeros(256, RING)
    n = len(force_mps2)
    clipped_mps2 = np.clip(force_mps2, -FULL_SCALE_MPS2, FULL_SCALE_MPS2)
    ring["t_s"][:n] = PERIOD_S * np.arange(n)
    ring["period_s"] = PERIOD_S
    ring["accel_mps2"][:n, 1] = clipped_mps2
    ring["force_saturated"][:n, 1] = np.abs(clipped_mps2) >= FULL_SCALE_MPS2
    parameters = config_record(EskfConfig())[0]
    for k in range(n):
        recover_forces(ring, k, n, parameters)
    added_mps2 = ring["accel_mps2"][:n, 1] - clipped_mps2
    doubt_m2ps2 = PERIOD_S * ring["hidden_force_noise"][:n, 1].sum()
    return PERIOD_S * added_mps2.sum(), np.sqrt(doubt_m2ps2)


def swing_mps2(peak_mps2, length_s=0.2):
    u = np.arange(0.0, 1.0, PERIOD_S / length_s)
    return peak_mps2 * 4.0 * u * (1.0 - u)


def cut_off_mps(force_mps2):
    over_mps2 = np.maximum(np.abs(force_mps2) - FULL_SCALE_MPS2, 0.0)
    return PERIOD_S * (np.sign(force_mps2) * over_mps2).sum()


@pytest.mark.slow
@pytest.mark.parametrize("peak_mps2", [25.0, 30.0, 40.0, -30.0])
def test_clipped_part_of_a_swing_is_recovered_from_its_slopes(peak_mps2):
    force_mps2 = swing_mps2(peak_mps2)
    bridged_mps, doubt_mps = hidden_mps(force_mps2)
    assert bridged_mps == pytest.approx(cut_off_mps(force_mps2), rel=0.5)
    assert abs(bridged_mps - cut_off_mps(force_mps2)) < doubt_mps


@pytest.mark.slow
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_strike_is_no_slope_of_a_plateau_that_it_ends(side):
    """It falls by 30 m/s^2 in one sample, which the tenth of a second before knows nothing of."""
    swing = swing_mps2(25.0)
    over = np.flatnonzero(swing > FULL_SCALE_MPS2)
    struck = swing.copy()
    struck[over[-1] + 1] = FULL_SCALE_MPS2 - 1.0
    struck[over[-1] + 2 :] = FULL_SCALE_MPS2 - 31.0
    true_mps = side * cut_off_mps(struck)
    bridged_mps, doubt_mps = hidden_mps(side * struck)
    assert abs(bridged_mps - true_mps) < 4.0 * abs(true_mps)
    assert doubt_mps < 3.0


def test_a_force_that_swings_from_limit_to_limit_is_bridged_on_either_side():
    force_mps2 = np.concatenate(
        [np.zeros(10), [15.0], np.full(6, 30.0), np.full(6, -30.0), [-15.0]]
    )
    force_mps2 = np.concatenate([force_mps2, np.zeros(10)])
    bridged_mps, _ = hidden_mps(force_mps2)
    assert abs(bridged_mps) < 0.05  # what is hidden below is worth what is hidden above


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_bridged_rate_and_its_noise_follow_the_scale_estimated_at_landings(side):
    rate_radps = side * swing_mps2(12.0)
    n, full_scale = len(rate_radps), 8.0
    clipped_radps = np.clip(rate_radps, -full_scale, full_scale)
    bridge = np.zeros(1, BRIDGE)
    bridge["scale"] = 1.0
    bridge["scale"][0, 2 if side > 0.0 else 3] = 0.5
    clipping = EskfConfig().clipping
    ring = np.zeros(256, RING)
    ring["t_s"][:n] = PERIOD_S * np.arange(n)
    ring["period_s"] = PERIOD_S
    ring["gyro_radps"][:n, 1] = clipped_radps
    ring["rate_saturated"][:n, 1] = np.abs(clipped_radps) >= full_scale
    for k in np.flatnonzero(ring["rate_saturated"][:n, 1]):
        recover_rates(ring, bridge[0], int(k), n, config_record(EskfConfig())[0])
    hidden_rad = PERIOD_S * (rate_radps - clipped_radps).sum()
    bridged_rad = PERIOD_S * ring["bridge_radps"][:n, 1].sum()
    added_rad = PERIOD_S * (ring["gyro_radps"][:n, 1] - clipped_radps).sum()
    assert bridged_rad == pytest.approx(hidden_rad, rel=0.15)  # a parabola it was
    assert added_rad == pytest.approx(0.5 * bridged_rad)
    duration_s = PERIOD_S * ring["rate_saturated"][:n, 1].sum()
    doubt_rad = np.sqrt(PERIOD_S * ring["hidden_noise"][:n, 1].sum())
    floor_rad = clipping.hidden_rate_floor_radps * duration_s
    peak_rad = 1.5 * abs(bridged_rad)  # of the parabola, all the time
    assert doubt_rad == pytest.approx(
        floor_rad + clipping.hidden_rate_std_ratio * 0.5 * peak_rad, rel=0.02
    )
