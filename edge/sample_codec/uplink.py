"""Uplink of a unit that does not track: its inertial samples as messages at the channel's rate.

Pure, as the pipeline it belongs to.  What is sent has been through the wire's rounding once,
so a tracker elsewhere computes the same result as one on the unit.
"""

from __future__ import annotations

import numpy as np

from edge.clocks.timeline import Timeline
from edge.sample_codec.codec import raw_imu
from edge.samples import Floats, ImuBatch
from shared.channels import IMU
from shared.clock import NS_PER_S
from shared.header_factory import HeaderFactory
from shared.messages import RawImu


class RawUplink:
    """Collector of batches until they span a period; ``finish`` gives what is left."""

    def __init__(self, header_factory: HeaderFactory) -> None:
        self._period_ns = round(NS_PER_S / IMU.regular_rate_hz)
        self._header_factory = header_factory
        self._pending: dict[str, list[ImuBatch]] = {}  # by sensor; none is empty

    def push(self, imu: ImuBatch, timeline: Timeline, sensor: str = "") -> list[RawImu]:
        if not len(imu):
            return []
        messages = []
        if sensor in self._pending and not self._continues(self._pending[sensor], imu):
            messages.append(self._send(sensor, timeline))
        pending = self._pending.setdefault(sensor, [])
        pending.append(imu)
        first_ns, last_ns = int(pending[0].t_ns[0]), int(imu.t_ns[-1])
        rows = sum(map(len, pending))
        # One more sample would reach the period's end.
        if rows > 1 and (last_ns - first_ns) * rows >= self._period_ns * (rows - 1):
            messages.append(self._send(sensor, timeline))
        return messages

    def finish(self, timeline: Timeline) -> list[RawImu]:
        return [self._send(sensor, timeline) for sensor in list(self._pending)]

    def _send(self, sensor: str, timeline: Timeline) -> RawImu:
        imu = _joined(self._pending.pop(sensor))
        header = self._header_factory.header(timeline.to_mono_ns(int(imu.t_ns[0])))
        return raw_imu(header, imu, sensor)

    def _continues(self, pending: list[ImuBatch], imu: ImuBatch) -> bool:
        """Return True without a gap in time, and with the same columns."""
        apart_ns = int(imu.t_ns[0]) - int(pending[0].t_ns[0])
        return 0 <= apart_ns <= self._period_ns and _columns(pending[-1]) == _columns(imu)


def _columns(imu: ImuBatch) -> tuple[bool, ...]:
    return tuple(c is not None for c in (imu.mag_ut, imu.pressure_pa, imu.imu_temperature_degc))


def _joined(batches: list[ImuBatch]) -> ImuBatch:
    def of(columns: list[Floats | None]) -> Floats | None:
        present = [column for column in columns if column is not None]
        return np.concatenate(present) if present else None

    return ImuBatch(
        t_ns=np.concatenate([imu.t_ns for imu in batches]),
        accel_mps2=np.concatenate([imu.accel_mps2 for imu in batches]),
        gyro_radps=np.concatenate([imu.gyro_radps for imu in batches]),
        mag_ut=of([imu.mag_ut for imu in batches]),
        pressure_pa=of([imu.pressure_pa for imu in batches]),
        imu_temperature_degc=of([imu.imu_temperature_degc for imu in batches]),
    )
