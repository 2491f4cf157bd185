"""Kinds of motion by the samples of a foot."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import ImuBatch, SensorDescription
from edge.simulation.hard_motions import HARD_MOTIONS
from tests.bench.tracker.constant_walks import RECORDED, Walk
from tests.bench.tracker.motion_kinds import SCENARIOS, motion_of, stride_s

RATE_HZ = 100.0


def foot(peak_radps, stride):
    """A foot that turns by a sine wave for a part of each stride (s), and rests otherwise."""
    t_s = np.arange(3000) / RATE_HZ
    phase = (t_s / stride) % 1.0
    rate = np.where(phase < 0.5, peak_radps * np.sin(2.0 * np.pi * phase), 0.0)
    gyro = np.column_stack((0.0 * rate, rate, 0.0 * rate))
    imu = ImuBatch(
        t_ns=np.asarray(1e9 * t_s, np.int64),
        accel_mps2=np.tile([0.0, 0.0, -9.8], (len(t_s), 1)),
        gyro_radps=gyro,
    )
    return Walk(RECORDED, "foot", SensorDescription("foot", RATE_HZ), imu, None)


@pytest.mark.parametrize(
    ("peak_radps", "stride", "motion"),
    [
        (1.0, 2.0, "raised feet"),
        (4.5, 1.3, "turning on the spot"),
        (7.0, 1.1, "walking"),
        (7.0, 1.6, "crawling"),
        (9.0, 0.8, "running"),
        (13.0, 0.7, "sprinting"),
    ],
)
def test_a_recorded_motion_is_reported_by_rate_and_stride(peak_radps, stride, motion):
    walk = foot(peak_radps, stride)
    assert stride_s(walk.imu) == pytest.approx(stride, abs=0.02)
    assert motion_of(walk) == motion


def test_every_simulated_hard_motion_has_a_kind():
    assert set(SCENARIOS) == {scenario.name for scenario in HARD_MOTIONS}
