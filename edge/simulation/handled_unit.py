"""Unit that a person handles on a table: laid on its sides, turned about, warming up.

Every movement is a turn about one axis of the sensor with a smooth start and end, so rates
and attitudes are exact; the sensor stays in one place.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from edge.samples import Floats, ImuBatch, SensorBatch, SensorDescription
from edge.simulation.environment import MagneticField, SimulatedMagnetometer
from edge.simulation.imu import Imu
from edge.simulation.kinematics import Motion
from edge.simulation.simulation import CONSUMER_SENSORS, SensorErrors, Simulation

SIDES = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
EDGES = np.array(
    [[1, 1, 0], [1, -1, 0], [0, 1, 1], [0, -1, 1], [1, 0, 1], [-1, 0, 1], [-1, -1, 0]], float
)
_ROOM_DEGC = 24.0
_FRIDGE_DEGC = 6.0
_WARMS_IN_S = 150.0


class HandledUnit:
    """Unit with its sensors' errors drawn from the seed; its time goes on from call to call."""

    def __init__(
        self,
        seed: int = 0,
        sensors: SensorErrors = CONSUMER_SENSORS,
        rate_hz: float = 200.0,
        worn_in: Simulation | None = None,
    ) -> None:
        """``worn_in``: it is the unit of that walk, with the sensors and errors it has there."""
        imu_rng, mag_rng, self._hand = (
            np.random.default_rng(part) for part in np.random.SeedSequence(seed).spawn(3)
        )
        if worn_in is not None:
            sensors = worn_in.sensors
            imu_rng, mag_rng, *_ = worn_in.sensor_rngs()
        self.imu = Imu(sensors.imu, np.eye(3), rate_hz, imu_rng)
        self.mag = SimulatedMagnetometer(sensors.mag, MagneticField(None, mag_rng), mag_rng)
        self._rotation_ns = np.eye(3)
        self._row = 0
        self._rate_hz = rate_hz
        self.description = SensorDescription(
            name="simulated on a table",
            rate_hz=rate_hz,
            accel_full_scale_mps2=_or_none(sensors.imu.accel.full_scale),
            gyro_full_scale_radps=_or_none(sensors.imu.gyro.full_scale),
            mag_present=True,
            gain_std=sensors.imu.gain_std,
        )

    def calibrated_by_the_book(self) -> Iterator[ImuBatch]:
        """Yield all that a calibration asks for, one step after the other."""
        yield self.rest(14.0)
        yield from self.poses(np.vstack((SIDES, EDGES)))
        yield from self.turning(45)
        yield from self.warm_up(400.0)

    def rest(self, duration_s: float) -> ImuBatch:
        return self.turn(np.zeros(3), duration_s)

    def poses(self, up_s: Floats, hold_s: float = 3.5) -> Iterator[ImuBatch]:
        """Lie with each of the directions ``up_s`` (n, 3, sensor axes) pointing up."""
        for direction in up_s:
            yield self.turn(self._to_raise(direction), 1.5)
            yield self.rest(hold_s)

    def turning(self, turns: int) -> Iterator[ImuBatch]:
        """Turn about random axes, two seconds each."""
        for _ in range(turns):
            axis = self._hand.normal(0.0, 1.0, 3)
            angle_rad = self._hand.uniform(1.5, 3.0)
            yield self.turn(angle_rad * axis / np.linalg.norm(axis), 2.0)

    def warm_up(self, duration_s: float, from_degc: float = _FRIDGE_DEGC) -> Iterator[ImuBatch]:
        """Lie still while the sensor comes to room temperature."""
        for second in range(round(duration_s)):
            ends_s = np.array([second, second + 1.0])
            degc = _ROOM_DEGC + (from_degc - _ROOM_DEGC) * np.exp(-ends_s / _WARMS_IN_S)
            yield self.turn(np.zeros(3), 1.0, (float(degc[0]), float(degc[1])))

    def turn(
        self,
        by_rad: Floats,
        duration_s: float,
        degc: tuple[float, float] = (_ROOM_DEGC, _ROOM_DEGC),
    ) -> ImuBatch:
        """Turn about the fixed axis ``by_rad`` (3,) by its length; ``degc`` at both ends."""
        index = self._row + np.arange(round(duration_s * self._rate_hz))
        self._row += len(index)
        share = (np.arange(len(index)) + 1.0) / len(index)
        eased = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
        rate = 30.0 * (share * (1.0 - share)) ** 2 / duration_s
        rotations = self._rotation_ns @ _rotations(eased[:, None] * by_rad)
        self._rotation_ns = rotations[-1]
        t_s = index / self._rate_hz
        zero = np.zeros((len(index), 3))
        motion = Motion(t_s, zero, zero, zero, rotations, rate[:, None] * by_rad)
        temperature_degc = degc[0] + share * (degc[1] - degc[0])
        accel_mps2, gyro_radps = self.imu.measure(motion, temperature_degc)
        return ImuBatch(
            t_ns=np.rint(t_s * 1e9).astype(np.int64),
            accel_mps2=accel_mps2,
            gyro_radps=gyro_radps,
            mag_ut=self.mag.measure(int(index[0]), zero, rotations),
            imu_temperature_degc=temperature_degc,
        )

    def _to_raise(self, direction_s: Floats) -> Floats:
        """The turn after which ``direction_s`` points up."""
        wanted = direction_s / np.linalg.norm(direction_s)
        up = -self._rotation_ns[2]
        axis = np.cross(wanted, up)
        length = float(np.linalg.norm(axis))
        if length < 1e-6:  # up already, or down: any axis across will do
            axis = np.cross(wanted, np.eye(3)[int(np.argmin(np.abs(wanted)))])
            length = float(np.linalg.norm(axis))
        angle_rad = np.arccos(np.clip(wanted @ up, -1.0, 1.0))
        return np.asarray(angle_rad * axis / length)


def cut(batches: Iterator[ImuBatch], rows: int = 10) -> Iterator[SensorBatch]:
    """Yield batches as a source delivers them."""
    for batch in batches:
        for start in range(0, len(batch), rows):
            yield SensorBatch(batch.part(slice(start, start + rows)))


def _rotations(vectors_rad: Floats) -> Floats:
    """Matrices (n, 3, 3) of rotation vectors (n, 3), by Rodrigues."""
    angle = np.linalg.norm(vectors_rad, axis=1)[:, None, None]
    axis = vectors_rad / np.maximum(angle[:, :, 0], 1e-12)
    cross = np.zeros((len(vectors_rad), 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -axis[:, 2], axis[:, 1], -axis[:, 0]
    cross -= cross.transpose(0, 2, 1)
    turned = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)
    return np.asarray(turned)


def _or_none(full_scale: float) -> float | None:
    return full_scale if np.isfinite(full_scale) else None
