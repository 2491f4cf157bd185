"""Losses without a gap of the timestamps, found by the field."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.preprocessing.unstamped_loss import unstamped_loss_s
from edge.tracker.foot.state import new_progress
from edge.tracker.preprocessing.sample_ring import RING

PERIOD_S = 0.01
SAMPLES = 60


def losses_s(kept, field_ut, late_s=0.0, lost_at=30):
    """Return what is found before each sample, where only samples ``kept`` arrive, stamped evenly.

    ``late_s``: by which the stamps show the loss before sample ``lost_at``.
    """
    n = len(kept)
    ring = np.zeros(256, RING)
    ring["t_s"][:n] = PERIOD_S * np.arange(n) + late_s * (np.arange(n) >= lost_at)
    ring["period_s"] = PERIOD_S
    ring["mag_ut"][:n] = field_ut[kept]
    progress = new_progress()
    progress["measured"] = n
    parameters = config_record(EskfConfig())[0]
    return np.array([unstamped_loss_s(ring, progress[0], k, parameters) for k in range(n)])


def turning_field_ut(rate_radps=5.0):
    """A field of 45 uT, seen by a foot that turns evenly."""
    angle_rad = rate_radps * PERIOD_S * np.arange(SAMPLES)
    return np.stack([45.0 * np.cos(angle_rad), 45.0 * np.sin(angle_rad), 0.0 * angle_rad], axis=1)


def without(first, count):
    return np.array([k for k in range(SAMPLES) if not first <= k < first + count])


@pytest.mark.slow
@pytest.mark.parametrize("count", [2, 5, 10])
def test_length_of_a_loss_follows_from_the_turn_of_the_field(count):
    found_s = losses_s(without(30, count), turning_field_ut())
    assert np.flatnonzero(found_s).tolist() == [30]
    assert found_s[30] == pytest.approx(count * PERIOD_S, rel=0.05)


@pytest.mark.slow
def test_nothing_is_found_where_nothing_is_lost():
    everything = np.arange(SAMPLES)
    field_ut = turning_field_ut()
    assert not losses_s(everything, field_ut).any()
    assert not losses_s(everything, np.full((SAMPLES, 3), np.nan)).any()
    every_third_ut = field_ut[everything // 3 * 3]  # a slow magnetometer that is read again
    assert not losses_s(everything, every_third_ut).any()
    switched_ut = np.where(everything[:, np.newaxis] < 30, [20.0, 0.0, 40.0], [35.0, 5.0, 40.0])
    assert not losses_s(everything, switched_ut).any()  # a foot at rest, a machine beside it


@pytest.mark.slow
def test_a_loss_that_the_stamps_show_is_left_to_them():
    assert not losses_s(without(30, 10), turning_field_ut(), late_s=10 * PERIOD_S).any()
