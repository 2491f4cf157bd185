"""Readings of the accelerometer at rest are learned at rest only."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.foot.eskf import EskfTracker

RATE_HZ = 200.0
GRAVITY_MPS2 = 9.80665


def rest_norm_mps2(shown_mps2: float, turning_radps: float) -> float:
    """Return what is learned from a force that does not change, of a foot that turns evenly."""
    count = round(1.5 * RATE_HZ)
    force_mps2 = np.tile([0.0, 0.0, -shown_mps2], (count, 1))
    rate_radps = np.tile([0.0, turning_radps, 0.0], (count, 1))
    tracker = EskfTracker(SensorDescription("synthetic", RATE_HZ))
    t_ns = np.rint(np.arange(count) / RATE_HZ * 1e9).astype(np.int64)
    tracker.push(ImuBatch(t_ns, force_mps2, rate_radps))
    return float(tracker._progress["rest_norm_mps2"][0])


@pytest.mark.parametrize("bias_radps", [0.0, 0.02, 0.05])
def test_a_rest_shows_the_scale_of_the_accelerometer_whatever_the_bias(bias_radps):
    assert rest_norm_mps2(GRAVITY_MPS2 + 0.4, bias_radps) == pytest.approx(10.2, abs=0.02)


def test_a_foot_that_slows_down_evenly_while_it_turns_does_not_rest():
    assert rest_norm_mps2(GRAVITY_MPS2 - 0.8, 0.3) == GRAVITY_MPS2
