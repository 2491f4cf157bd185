"""Samples sent for tracking elsewhere: each once, at the channel's rate."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from edge.clocks.timeline import Timeline
from edge.sample_codec.uplink import RawUplink
from edge.samples import ImuBatch
from shared.channels import IMU
from shared.clock import NS_PER_S, ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import RawImu
from tests.rig.calibration_steps import known

PERIOD_NS = round(NS_PER_S / known(IMU.rate_hz))
LIVE = Timeline()


def samples(count: int, rate_hz: float, from_s: float = 0.0) -> ImuBatch:
    t_ns = np.rint((from_s + np.arange(count) / rate_hz) * NS_PER_S).astype(np.int64)
    rows = np.arange(6.0 * count).reshape(count, 6)
    return ImuBatch(t_ns, rows[:, :3], rows[:, 3:], pressure_pa=rows[:, 0])


def sent(imu: ImuBatch, at_once: int) -> list[RawImu]:
    uplink = RawUplink(HeaderFactory("u1", 1, ManualClock()))
    messages = []
    for first in range(0, len(imu), at_once):
        messages += uplink.push(imu.part(slice(first, first + at_once)), LIVE)
    return messages + uplink.finish(LIVE)


@pytest.mark.parametrize("rate_hz", [60.0, 100.0, 200.0, 400.0, 820.0])
@pytest.mark.parametrize("at_once", [1, 7])
def test_each_sample_is_sent_once_in_messages_of_a_period(rate_hz: float, at_once: int) -> None:
    imu = samples(round(10.0 * rate_hz), rate_hz)
    messages = sent(imu, at_once)
    assert np.concatenate([one.t_ns for one in messages]).tolist() == imu.t_ns.tolist()
    assert np.vstack([one.gyro_radps for one in messages]).tolist() == imu.gyro_radps.tolist()
    pressures = [one.pressure_pa for one in messages if one.pressure_pa is not None]
    assert np.concatenate(pressures).tolist() == (6.0 * np.arange(len(imu))).tolist()
    longest_ns = PERIOD_NS + at_once * NS_PER_S / rate_hz
    assert all(one.t_ns[-1] - one.t_ns[0] < longest_ns for one in messages)
    assert len(messages) <= 10.0 * NS_PER_S / PERIOD_NS + 1
    assert [one.header.t_mono_ns for one in messages] == [one.t_ns[0] for one in messages]


def test_two_samples_that_fill_a_period_are_a_message() -> None:
    assert [len(one.t_ns) for one in sent(samples(10, 2.0 * NS_PER_S / PERIOD_NS), 1)] == [2] * 5


@pytest.mark.parametrize("from_s", [0.5, -0.5])
def test_no_message_goes_across_a_hole_or_a_clock_that_was_set(from_s: float) -> None:
    uplink = RawUplink(HeaderFactory("u1", 1, ManualClock()))
    first, second = samples(3, 200.0), samples(3, 200.0, from_s)
    messages = [*uplink.push(first, LIVE), *uplink.push(second, LIVE), *uplink.finish(LIVE)]
    assert [one.t_ns.tolist() for one in messages] == [first.t_ns.tolist(), second.t_ns.tolist()]


def test_a_sensor_that_falls_silent_begins_a_message() -> None:
    uplink = RawUplink(HeaderFactory("u1", 1, ManualClock()))
    parts = samples(3, 200.0), replace(samples(3, 200.0, 0.015), pressure_pa=None)
    messages = [message for part in parts for message in uplink.push(part, LIVE)]
    messages += uplink.finish(LIVE)
    assert [one.pressure_pa is None for one in messages] == [False, True]
    assert all(before.t_ns[-1] < after.t_ns[0] for before, after in pairwise(messages))
