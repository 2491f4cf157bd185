"""Every message survives encoding and decoding, and no bytes break the decoder."""

from __future__ import annotations

import math
import types
import typing

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shared.channels import CHANNELS, IMU, POSITION, TEMPERATURE
from shared.codec import decode, encode
from shared.errors import UnknownSchemaError, WireError
from shared.messages import SCHEMA_REVISION, Header, RawImu, Temperature

HEADERS = st.builds(
    Header,
    unit_id=st.text(min_size=1, max_size=16),
    boot_id=st.integers(0, 2**64 - 1),
    seq=st.integers(0, 2**64 - 1),
    t_mono_ns=st.integers(-(2**63), 2**63 - 1),
    t_utc_ns=st.integers(-(2**63), 2**63 - 1),
    utc_std_s=st.integers(0, 2**32 - 1).map(lambda ms: ms * 1e-3),
    schema=st.just(SCHEMA_REVISION),
)
FLOATS = st.floats(-1e5, 1e5, allow_nan=False)
COUNTS = st.integers(0, 2**31 - 1)


def strategy_of(annotation: object) -> st.SearchStrategy[object]:
    """Values for a field of a message, from its annotation."""
    if annotation is Header:
        return HEADERS
    if annotation is float:
        return FLOATS
    if annotation is int:
        return COUNTS
    if isinstance(annotation, type) and issubclass(annotation, msgspec.Struct):
        return struct_strategy(annotation)
    if typing.get_origin(annotation) is tuple and typing.get_args(annotation)[1:] == (...,):
        return st.lists(strategy_of(typing.get_args(annotation)[0]), max_size=4).map(tuple)
    if typing.get_origin(annotation) is dict:
        keys, values = (strategy_of(part) for part in typing.get_args(annotation))
        return st.dictionaries(keys, values, max_size=4)
    if isinstance(annotation, types.UnionType):
        return st.one_of(*(strategy_of(part) for part in typing.get_args(annotation)))
    return st.from_type(annotation)  # type: ignore[arg-type]  # any other type of field


def struct_strategy(struct: type[msgspec.Struct]) -> st.SearchStrategy[typing.Any]:
    hints = typing.get_type_hints(struct)
    return st.builds(
        struct, **{name: strategy_of(hints[name]) for name in struct.__struct_fields__}
    )


PLAIN_CHANNELS = [channel for channel in CHANNELS if channel is not IMU]


@pytest.mark.parametrize("channel", PLAIN_CHANNELS, ids=lambda channel: channel.name)
@given(data=st.data())
def test_wire_quantises_once_and_changes_nothing_afterwards(channel, data):
    message = data.draw(struct_strategy(channel.message))
    once = decode(channel, encode(message))
    twice = decode(channel, encode(once))
    assert twice == once
    assert once.header == message.header


@given(
    st.integers(1, 50).flatmap(
        lambda n: st.tuples(
            *(
                st.lists(st.one_of(st.floats(-500, 500), st.just(math.nan)), min_size=k, max_size=k)
                for k in (3 * n, 3 * n, n)
            )
        )
    )
)
def test_raw_samples_survive_with_their_missing_values(columns):
    accel, gyro, pressure = (np.array(column) for column in columns)
    batch = RawImu(
        header=Header("FF-01", 1, 1, 0),
        t_ns=np.cumsum(np.full(len(pressure), 5_000_000)),
        accel_mps2=accel.reshape(-1, 3),
        gyro_radps=gyro.reshape(-1, 3),
        pressure_pa=pressure,
    )
    back = decode(IMU, encode(batch))
    assert isinstance(back, RawImu)
    np.testing.assert_array_equal(back.t_ns, batch.t_ns)
    np.testing.assert_allclose(back.accel_mps2, batch.accel_mps2, atol=0.5e-5 + 1e-12)
    np.testing.assert_allclose(back.gyro_radps, batch.gyro_radps, atol=0.5e-6 + 1e-12)
    again = decode(IMU, encode(back))
    assert isinstance(again, RawImu)
    np.testing.assert_array_equal(again.accel_mps2, back.accel_mps2)
    np.testing.assert_array_equal(again.gyro_radps, back.gyro_radps)


def raw_imu(samples: int) -> RawImu:
    t_ns, vectors, scalars = np.arange(samples), np.ones((samples, 3)), np.ones(samples)
    return RawImu(Header("FF-01", 1, 1, 0), t_ns, vectors, vectors, vectors, scalars, scalars)


@pytest.mark.parametrize(
    "column",
    ["accel_e5_mps2", "gyro_e6_radps", "mag_nt", "pressure_cpa", "imu_temperature_cdegc"],
)
def test_raw_samples_of_columns_of_different_length_are_refused(column):
    wire = raw_imu(samples=4).to_wire()
    getattr(wire, column).extend([1, 1, 1])
    with pytest.raises(WireError, match="different lengths"):
        decode(IMU, wire.SerializeToString())


def test_message_without_sample_is_refused():
    wire = raw_imu(samples=1).to_wire()
    for column in ("dt_ns", "accel_e5_mps2", "gyro_e6_radps", "mag_nt", "pressure_cpa"):
        wire.ClearField(column)
    wire.ClearField("imu_temperature_cdegc")
    with pytest.raises(WireError, match="no sample"):
        decode(IMU, wire.SerializeToString())


@pytest.mark.parametrize("channel", CHANNELS, ids=lambda channel: channel.name)
@given(payload=st.binary(max_size=200))
def test_any_bytes_are_a_message_or_a_wire_error(channel, payload):
    try:
        message = decode(channel, payload)
    except WireError:
        return
    assert isinstance(message, channel.message)


@given(FLOATS)
def test_value_beyond_wire_range_saturates(value):
    hot = Temperature(Header("FF-01", 1, 1, 0), ambient_degc=math.copysign(1e12, value))
    back = decode(TEMPERATURE, encode(hot))
    assert isinstance(back, Temperature)
    assert back.ambient_degc == pytest.approx(math.copysign(21_474_836.47, value))


def test_newer_schema_is_named_in_the_error(make_position):
    position = make_position()
    newer = msgspec.structs.replace(
        position, header=msgspec.structs.replace(position.header, schema=SCHEMA_REVISION + 1)
    )
    with pytest.raises(UnknownSchemaError, match="update it"):
        decode(POSITION, encode(newer))
