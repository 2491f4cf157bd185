"""Time from one sample to the next, from timestamps."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.foot.eskf import EskfTracker

PERIOD_S = 0.005
TAKEN_S = PERIOD_S * np.arange(4000)


def tracker_of(stamps_s, reported_hz=200.0):
    rng = np.random.default_rng(3)
    tracker = EskfTracker(SensorDescription("sensor", reported_hz))
    gravity_mps2 = np.array([0.0, 0.0, 9.8])
    readings = rng.normal(scale=0.01, size=(len(stamps_s), 3))
    t_ns = np.rint(1e9 * np.asarray(stamps_s)).astype(np.int64)
    tracker.push(ImuBatch(t_ns, gravity_mps2 + readings, readings))
    return tracker


def period_s(stamps_s, reported_hz=200.0):
    return float(tracker_of(stamps_s, reported_hz)._gate[0]["period_s"])


def without(share):
    return TAKEN_S[np.random.default_rng(5).random(len(TAKEN_S)) >= share]


@pytest.mark.parametrize("share", [0.0, 0.01, 0.1, 0.3])
@pytest.mark.parametrize("reported_hz", [200.0, 205.0, 400.0])
def test_lost_samples_make_no_period_longer(share, reported_hz):
    assert period_s(without(share), reported_hz) == pytest.approx(PERIOD_S, rel=1e-3)


def test_a_sample_is_not_brought_forward_by_others_that_got_lost():
    stamps_s = without(0.2)
    tracker = tracker_of(stamps_s)
    timed = int(tracker._progress[0]["timed"])
    ring = tracker._ring
    last = np.arange(timed - 200, timed)
    given_s = stamps_s[last] - stamps_s[0]
    np.testing.assert_allclose(ring["t_s"][last & (len(ring) - 1)], given_s, atol=1e-6)


def test_late_stamps_leave_the_mean():
    """Most come 6 ms after the one before, and each sixth right behind it."""
    late_s = TAKEN_S + 0.001 * (np.arange(len(TAKEN_S)) % 6)
    for reported_hz in (200.0, 1.0 / 0.006):
        assert period_s(late_s, reported_hz) == pytest.approx(PERIOD_S, rel=0.01)


def test_coarse_stamps_leave_the_mean():
    coarse_s = np.ceil(TAKEN_S * 256.0) / 256.0
    assert period_s(coarse_s) == pytest.approx(PERIOD_S, rel=0.02)


@pytest.mark.parametrize("reported_hz", [60.0, 100.0, 150.0, 400.0, 800.0])
def test_a_rate_that_was_reported_wrong_is_put_right(reported_hz):
    assert period_s(TAKEN_S, reported_hz) == pytest.approx(PERIOD_S, rel=1e-3)
