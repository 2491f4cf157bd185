"""Samples are rounded once in a message, and unchanged in every later one."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from edge.sample_codec.codec import SampleEncoder, batch_of
from edge.sample_codec.descriptions import sensors_of, unit_sensor
from edge.samples import (
    AmbientSample,
    BatterySample,
    ButtonPress,
    GpsSample,
    ImuBatch,
    SensorBatch,
    SensorDescription,
    SightingSample,
)
from shared.channels import channel_of
from shared.codec import decode, encode

TIMES = st.integers(0, 2**62)
ANY = st.floats(allow_nan=True, allow_infinity=True)
MISSABLE = st.one_of(st.just(math.nan), st.floats(-1000.0, 1000.0))
COUNT = st.integers(0, 6)


@st.composite
def imu_batches(draw) -> ImuBatch:
    n = draw(COUNT)

    def columns(*shape: int):
        return draw(hnp.arrays(np.float64, shape, elements=MISSABLE))

    t_ns = draw(hnp.arrays(np.int64, n, elements=st.integers(0, 10**15)))
    with_extras = draw(st.booleans()) and n > 0
    return ImuBatch(
        t_ns,
        columns(n, 3),
        columns(n, 3),
        mag_ut=columns(n, 3) if with_extras else None,
        pressure_pa=columns(n) if with_extras else None,
    )


OTHERS = st.one_of(
    st.builds(AmbientSample, TIMES, ANY),
    st.builds(BatterySample, TIMES, ANY),
    st.builds(
        SightingSample, TIMES, st.sampled_from(["beacon", "tag", "unit", "ghost"]),
        st.text(max_size=8), ANY, ANY,
    ),
    st.builds(ButtonPress, TIMES, st.sampled_from(["mayday", "cancel", "acknowledge", "unknown"])),
    st.builds(
        GpsSample, TIMES, st.one_of(ANY, st.floats(-90, 90)), st.one_of(ANY, st.floats(-180, 180)),
        ANY, ANY, ANY, st.integers(0, 4), st.integers(0, 60), ANY, ANY,
    ),
)  # fmt: skip
BATCHES = st.builds(SensorBatch, imu_batches(), st.lists(OTHERS, max_size=4).map(tuple))


def through(batch: SensorBatch) -> SensorBatch:
    """The samples as a black box returns them: encoded to bytes and decoded."""
    raw = SampleEncoder("u1", 1).messages(batch)
    return batch_of(tuple(decode(channel_of(message), encode(message)) for message in raw))


def text_of(batch: SensorBatch) -> str:
    imu = batch.imu
    return repr((imu.t_ns, imu.accel_mps2, imu.gyro_radps, imu.mag_ut, imu.pressure_pa)) + repr(
        batch.others
    )


@given(BATCHES)
def test_encoded_samples_are_unchanged_when_encoded_again(batch):
    once = through(batch)
    assert text_of(through(once)) == text_of(once)


@given(BATCHES)
def test_batch_of_the_agent_equals_that_of_the_black_box(batch):
    own = batch_of(SampleEncoder("u1", 1).messages(batch))
    assert text_of(own) == text_of(through(batch))


@given(BATCHES)
def test_inertial_samples_keep_times_and_values_within_rounding(batch):
    imu, kept = batch.imu, through(batch).imu
    assert kept.t_ns.tolist() == imu.t_ns.tolist()
    np.testing.assert_allclose(kept.accel_mps2, imu.accel_mps2, atol=0.51e-5)
    np.testing.assert_allclose(kept.gyro_radps, imu.gyro_radps, atol=0.51e-6)


@given(
    st.floats(1.0, 4000.0),
    st.one_of(st.none(), st.floats(1.0, 1000.0)),
    st.booleans(),
    st.one_of(st.none(), st.floats(0.0, 0.2)),
    st.one_of(st.none(), st.floats(0.0, 0.2)),
)
def test_encoded_description_is_unchanged_when_encoded_again(
    rate_hz, full_scale, mag, gain_std, gyro_bias_std_radps
):
    def passed(sensor: SensorDescription) -> SensorDescription:
        sent = (unit_sensor("left", sensor),)
        description = SampleEncoder("u1", 1).description(0, sent, source="", tracker="")
        return sensors_of(description)["left"]

    sensor = SensorDescription(
        "s",
        rate_hz,
        full_scale,
        full_scale,
        mag,
        gain_std=gain_std,
        gyro_bias_std_radps=gyro_bias_std_radps,
    )
    once = passed(sensor)
    assert passed(once) == once
    for sent, stated in (
        (once.gain_std, gain_std),
        (once.gyro_bias_std_radps, gyro_bias_std_radps),
    ):
        assert (sent is None) == (stated is None)  # a perfect quality is not an unknown one
        assert stated is None or abs((sent or 0.0) - stated) <= 1e-6
