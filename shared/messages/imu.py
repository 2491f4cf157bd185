"""Raw inertial samples: what the black box keeps and what a unit too weak to track sends."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np
from numpy.typing import NDArray

from shared.messages.header import Header
from shared.messages.muster.v1 import imu_pb2

_MISSED = -(2**31)
_ACCEL_PER_MPS2 = 1e5
_GYRO_PER_RADPS = 1e6
_MAG_PER_UT = 1e3
_PRESSURE_PER_PA = 1e2
_TEMPERATURE_PER_DEGC = 1e2

Floats = NDArray[np.float64]


class RawImu(msgspec.Struct, frozen=True, eq=False):
    """Columns as in ``edge.samples.ImuBatch``; NaN marks a missed value, None a missing sensor.

    A round trip through the wire quantises (1e-5 m/s^2, 1e-6 rad/s, 1 nT, 0.01 Pa, 0.01 degC);
    a second round trip changes nothing.  Without a sample it is no message.
    """

    header: Header
    t_ns: NDArray[np.int64]  # (n,)
    accel_mps2: Floats  # (n, 3)
    gyro_radps: Floats  # (n, 3)
    mag_ut: Floats | None = None  # (n, 3)
    pressure_pa: Floats | None = None  # (n,)
    imu_temperature_degc: Floats | None = None  # (n,)
    sensor: str = ""  # name in the unit's description; empty: its first or only one

    def to_wire(self) -> imu_pb2.ImuBatch:
        t0_ns = int(self.t_ns[0])
        return imu_pb2.ImuBatch(
            header=self.header.to_wire(),
            t0_ns=t0_ns,
            dt_ns=np.diff(self.t_ns, prepend=t0_ns).tolist(),
            accel_e5_mps2=_quantised(self.accel_mps2, _ACCEL_PER_MPS2),
            gyro_e6_radps=_quantised(self.gyro_radps, _GYRO_PER_RADPS),
            mag_nt=_quantised(self.mag_ut, _MAG_PER_UT),
            pressure_cpa=_quantised(self.pressure_pa, _PRESSURE_PER_PA),
            imu_temperature_cdegc=_quantised(self.imu_temperature_degc, _TEMPERATURE_PER_DEGC),
            sensor=self.sensor,
        )

    @staticmethod
    def from_wire(wire: imu_pb2.ImuBatch) -> RawImu:
        accel_mps2 = _vectors(wire.accel_e5_mps2, _ACCEL_PER_MPS2)
        gyro_radps = _vectors(wire.gyro_e6_radps, _GYRO_PER_RADPS)
        t_ns = wire.t0_ns + np.array(wire.dt_ns[:], dtype=np.int64).cumsum()
        batch = RawImu(
            header=Header.from_wire(wire.header),
            t_ns=t_ns,
            accel_mps2=accel_mps2,
            gyro_radps=gyro_radps,
            mag_ut=_vectors(wire.mag_nt, _MAG_PER_UT) if wire.mag_nt else None,
            pressure_pa=_scalars(wire.pressure_cpa, _PRESSURE_PER_PA),
            imu_temperature_degc=_scalars(wire.imu_temperature_cdegc, _TEMPERATURE_PER_DEGC),
            sensor=wire.sensor,
        )
        if len(t_ns) == 0:
            raise ValueError("no sample")
        aids = (batch.mag_ut, batch.pressure_pa, batch.imu_temperature_degc)
        columns = (accel_mps2, gyro_radps, *aids)
        if any(column is not None and len(column) != len(t_ns) for column in columns):
            raise ValueError("columns of different lengths")
        return batch


def _quantised(column: Floats | None, scale: float) -> list[int]:
    if column is None:
        return []
    with np.errstate(invalid="ignore"):
        scaled = np.clip(np.rint(column * scale), _MISSED + 1, -_MISSED - 1)
    integers = np.where(np.isnan(scaled), _MISSED, scaled).astype(np.int64)
    return integers.ravel().tolist()


def _scalars(numbers: Sequence[int], scale: float) -> Floats | None:
    integers = numbers[:]  # a list of Python's: NumPy reads it several times as quickly
    if not integers:
        return None
    column = np.array(integers, dtype=np.float64) / scale
    if _MISSED in integers:
        column[np.array(integers) == _MISSED] = np.nan
    return column


def _vectors(numbers: Sequence[int], scale: float) -> Floats:
    column = _scalars(numbers, scale)
    return np.empty((0, 3)) if column is None else column.reshape(-1, 3)
