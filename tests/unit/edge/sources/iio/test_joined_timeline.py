"""Accelerometer and gyroscope of two devices on one timeline."""

from __future__ import annotations

import numpy as np
import pytest

from edge.sources.iio.block import Block
from edge.sources.iio.conversion import ACCEL, GYRO
from edge.sources.iio.joined_timeline import JoinedTimeline

MS = 1_000_000


def block(kind: str, times_ms, degc: float | None = None) -> Block:
    """Values that are a line over time, which interpolation keeps."""
    t_ns = np.array([round(each * MS) for each in times_ms], np.int64)
    values = np.stack([t_ns / MS, -t_ns / MS, np.ones(len(t_ns))], axis=1)
    return Block(t_ns, {kind: values}, None if degc is None else np.full(len(t_ns), degc))


def taken(joined: JoinedTimeline, *blocks: Block) -> Block:
    parts = []
    for one in blocks:
        joined.push(one)
        parts.append(joined.take())
    full = [part for part in parts if len(part)]
    if not full:
        return Block()
    return Block(
        np.concatenate([part.t_ns for part in full]),
        {kind: np.concatenate([part.values[kind] for part in full]) for kind in (ACCEL, GYRO)},
    )


@pytest.mark.parametrize("shift_ms", [0.0, 0.7, 2.4])
@pytest.mark.parametrize("chunk", [1, 7, 40])
def test_rotation_stays_and_acceleration_is_interpolated(shift_ms: float, chunk: int) -> None:
    joined = JoinedTimeline(400.0)
    accel_ms, gyro_ms = np.arange(40) * 2.5, np.arange(40) * 2.5 + shift_ms
    blocks = [
        block(kind, times_ms[k : k + chunk])
        for k in range(0, 40, chunk)
        for kind, times_ms in ((GYRO, gyro_ms), (ACCEL, accel_ms))
    ]
    result = taken(joined, *blocks)
    assert len(result) == (40 if shift_ms == 0.0 else 39)  # the last one waits
    expected = block(GYRO, gyro_ms[: len(result)])
    assert result.t_ns.tolist() == expected.t_ns.tolist()
    assert result.values[GYRO] == pytest.approx(expected.values[GYRO])
    assert result.values[ACCEL] == pytest.approx(expected.values[GYRO])
    assert joined.take_left_out() == 0


def test_different_rates() -> None:
    joined = JoinedTimeline(100.0)
    result = taken(joined, block(ACCEL, np.arange(11) * 10.0), block(GYRO, np.arange(0, 100, 2.4)))
    assert len(result) == 42
    assert result.values[ACCEL] == pytest.approx(result.values[GYRO])


def test_nothing_is_made_up_for_a_hole_or_before_the_first_acceleration() -> None:
    joined = JoinedTimeline(400.0)
    accel_ms = [10.0, 12.5, 15.0, 60.0, 62.5]
    result = taken(joined, block(ACCEL, accel_ms), block(GYRO, [5.0, 11.0, 14.0, 40.0, 61.0, 70.0]))
    assert (result.t_ns / MS).tolist() == [11.0, 14.0, 61.0]
    assert np.isfinite(result.values[ACCEL]).all()
    assert joined.take_left_out() == 2


def test_a_device_that_is_gone_is_not_waited_for_for_ever() -> None:
    joined = JoinedTimeline(400.0)
    assert not len(taken(joined, block(GYRO, np.arange(0, 5000, 2.5))))
    assert joined.take_left_out() == pytest.approx(1600, abs=2)


def test_the_temperature_of_either_goes_along() -> None:
    joined = JoinedTimeline(400.0)
    joined.push(block(ACCEL, [0.0, 2.5, 5.0], degc=31.0))
    joined.push(block(GYRO, [0.1, 2.6]))
    temperature_degc = joined.take().temperature_degc
    assert temperature_degc is not None
    assert temperature_degc.tolist() == [31.0, 31.0]
