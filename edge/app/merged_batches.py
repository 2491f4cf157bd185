"""Batches of a recording, put together to about a second each: a pipeline takes them in a quarter
of the time.

What the pipeline does once a batch, it does once a second of the samples' clock.  So each merged
batch ends with the first batch that reaches another second: statuses come at the same samples.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice

import numpy as np

from edge.samples import Floats, ImuBatch, SensorBatch
from shared.clock import NS_PER_S

_GAP_NS = NS_PER_S // 4  # between two batches that are not put together

LoggedBatch = tuple[int, SensorBatch]  # log time, batch


def merged(batches: Iterable[LoggedBatch]) -> Iterator[LoggedBatch]:
    """Yield the batches of one sensor put together, each with the log time of its last part."""
    group: list[LoggedBatch] = []
    batches = iter(batches)
    yield from islice(batches, 1)  # with which the first status comes
    for logged in batches:
        if group and not _follows(group[-1][1].imu, logged[1].imu):
            yield _joined(group)
            group = []
        group.append(logged)
        first, last = group[0][1].imu, logged[1].imu
        if not len(last) or first.t_ns[0] // NS_PER_S != last.t_ns[-1] // NS_PER_S:
            yield _joined(group)
            group = []
    if group:
        yield _joined(group)


def _follows(before: ImuBatch, after: ImuBatch) -> bool:
    """Return True where two batches have samples of the same kinds, without a gap between them."""
    if not (len(before) and len(after)) or _kinds(before) != _kinds(after):
        return False
    return 0 < int(after.t_ns[0]) - int(before.t_ns[-1]) < _GAP_NS


def _kinds(imu: ImuBatch) -> tuple[bool, ...]:
    optional = imu.mag_ut, imu.pressure_pa, imu.imu_temperature_degc
    return tuple(column is not None for column in optional)


def _joined(group: list[LoggedBatch]) -> LoggedBatch:
    if len(group) == 1:
        return group[0]
    parts = [batch.imu for _, batch in group]

    def column(columns: list[Floats | None]) -> Floats | None:
        known = [one for one in columns if one is not None]
        return np.concatenate(known) if known else None

    imu = ImuBatch(
        t_ns=np.concatenate([part.t_ns for part in parts]),
        accel_mps2=np.concatenate([part.accel_mps2 for part in parts]),
        gyro_radps=np.concatenate([part.gyro_radps for part in parts]),
        mag_ut=column([part.mag_ut for part in parts]),
        pressure_pa=column([part.pressure_pa for part in parts]),
        imu_temperature_degc=column([part.imu_temperature_degc for part in parts]),
    )
    others = tuple(sample for _, batch in group for sample in batch.others)
    return group[-1][0], SensorBatch(imu, others, group[0][1].sensor)
