"""Bodies of posted samples: JSON for simple nodes, or messages as on the bus, length-delimited."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError

from base_station.api.field_errors import error_sentence
from base_station.api.forms import Form
from base_station.core.events import MONOTONIC_MAX_NS, UTC_MAX_NS
from shared.channels import IMU
from shared.codec import decode
from shared.errors import ConfigError, WireError
from shared.messages import Header, RawImu

JSON_TYPE = "application/json"
PROTOBUF_TYPE = "application/x-protobuf"
MAX_BATCHES = 1000
MAX_SAMPLES = 1000  # of one batch: the bus takes messages of 64 kB
_MAX_SAFE_INTEGER = 2**53 - 1  # of JSON in JavaScript
_MAX_NUMBER = 2**63 - 1
_VARINT_BYTES = 5
_CUT_OFF = "the body ends within a message; each message comes after its length as a varint"

Value = Annotated[float, Field(ge=-1e6, le=1e6)] | None
Vector = Annotated[list[Value], Field(min_length=3, max_length=3)]  # x, y, z


class SampleBatch(Form):
    """Columns of equal length with one row for each sample, in sensor axes; a missing value is
    null.
    """

    seq: Annotated[int, Field(ge=1, le=_MAX_SAFE_INTEGER)]
    t_ns: Annotated[
        list[Annotated[int, Field(ge=0, le=_MAX_SAFE_INTEGER)]],
        Field(min_length=1, max_length=MAX_SAMPLES),
    ]
    accel_mps2: Annotated[list[Vector], Field(max_length=MAX_SAMPLES)]
    gyro_radps: Annotated[list[Vector], Field(max_length=MAX_SAMPLES)]
    mag_ut: Annotated[list[Vector], Field(max_length=MAX_SAMPLES)] | None = None
    pressure_pa: Annotated[list[Value], Field(max_length=MAX_SAMPLES)] | None = None
    imu_temperature_degc: Annotated[list[Value], Field(max_length=MAX_SAMPLES)] | None = None


class PostedSamples(Form):
    """Batches of one run of a node's program, in the order of their sequence numbers."""

    boot_id: Annotated[int, Field(ge=1, le=_MAX_SAFE_INTEGER)]
    batches: Annotated[list[SampleBatch], Field(min_length=1, max_length=MAX_BATCHES)]


def read_json(unit_id: str, body: bytes) -> Sequence[RawImu]:
    """Batches of a JSON body.  Raises ConfigError with a sentence about its fault."""
    try:
        posted = PostedSamples.model_validate_json(body)
    except ValidationError as error:
        raise ConfigError("; ".join(_sentences(error))) from None
    return _checked(unit_id, [_raw(unit_id, posted.boot_id, one) for one in posted.batches])


def read_protobuf(unit_id: str, body: bytes) -> Sequence[RawImu]:
    """Batches of a body of ``ImuBatch`` messages, each after its length as a varint.

    Raises ConfigError with a sentence about its fault.
    """
    batches: list[RawImu] = []
    for number, payload in enumerate(_payloads(body), start=1):
        try:
            message = decode(IMU, payload)
        except WireError as error:
            raise ConfigError(f"message {number}: {error}") from error
        assert isinstance(message, RawImu)
        batches.append(message)
    return _checked(unit_id, batches)


def _sentences(error: ValidationError) -> Iterator[str]:
    for one in error.errors()[:5]:  # a column of wrong values has as many errors
        if one["type"] == "json_invalid":
            yield f"the body is not JSON: {one['msg']}"
        else:
            yield error_sentence({**one, "loc": ("body", *one["loc"])})


def _raw(unit_id: str, boot_id: int, batch: SampleBatch) -> RawImu:
    t_ns = np.asarray(batch.t_ns, dtype=np.int64)
    return RawImu(
        # A node posts when its last sample has come: that gives the offset of its clock.
        header=Header(unit_id, boot_id, batch.seq, int(t_ns[-1])),
        t_ns=t_ns,
        accel_mps2=_floats(batch.accel_mps2),
        gyro_radps=_floats(batch.gyro_radps),
        mag_ut=None if batch.mag_ut is None else _floats(batch.mag_ut),
        pressure_pa=None if batch.pressure_pa is None else _floats(batch.pressure_pa),
        imu_temperature_degc=None
        if batch.imu_temperature_degc is None
        else _floats(batch.imu_temperature_degc),
    )


def _floats(column: Sequence[Value] | Sequence[Vector]) -> NDArray[np.float64]:
    return np.asarray(column, dtype=np.float64)


def _payloads(body: bytes) -> Iterator[bytes]:
    place = 0
    while place < len(body):
        size = shift = 0
        for byte in body[place : place + _VARINT_BYTES]:
            place += 1
            size |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                break
        else:
            raise ConfigError(_CUT_OFF)
        if place + size > len(body):
            raise ConfigError(_CUT_OFF)
        yield body[place : place + size]
        place += size


def _checked(unit_id: str, batches: Sequence[RawImu]) -> Sequence[RawImu]:
    """Return the batches if a unit on the bus could have sent them."""
    if not 1 <= len(batches) <= MAX_BATCHES:
        raise ConfigError(f"send 1 to {MAX_BATCHES} batches in one request, not {len(batches)}")
    seq, boot_id = 0, batches[0].header.boot_id
    for batch in batches:
        header = batch.header
        name = f"the batch with seq {header.seq}"
        if header.unit_id != unit_id:
            raise ConfigError(f"{name} is of unit {header.unit_id!r}, not of {unit_id}")
        if header.boot_id != boot_id:
            raise ConfigError(f"{name} has another boot_id; send each run in a request of its own")
        if not seq < header.seq <= _MAX_NUMBER or not 0 < boot_id <= _MAX_NUMBER:
            raise ConfigError(f"{name}: seq begins with 1 and rises within a request")
        _check_columns(name, batch)
        seq = header.seq
    return batches


def _check_columns(name: str, batch: RawImu) -> None:
    count = len(batch.t_ns)
    if count > MAX_SAMPLES:
        raise ConfigError(f"{name} has {count} samples; a batch has {MAX_SAMPLES} at most")
    aids = (batch.mag_ut, batch.pressure_pa, batch.imu_temperature_degc)
    for column in (batch.accel_mps2, batch.gyro_radps, *aids):
        if column is not None and len(column) != count:
            raise ConfigError(f"{name} has {count} times, and a column of {len(column)} values")
    header = batch.header
    times = (int(batch.t_ns[0]), int(batch.t_ns[-1]), header.t_mono_ns)
    if not all(0 <= t_ns < MONOTONIC_MAX_NS for t_ns in times) or not (
        0 <= header.t_utc_ns < UTC_MAX_NS
    ):
        raise ConfigError(f"{name}: its times are negative, or too large to be of a clock")
    if np.any(np.diff(batch.t_ns) <= 0):
        raise ConfigError(f"{name}: its times do not rise from sample to sample")
