"""Model of one unit's sensor errors, and their correction.

    force = gain (reading - bias - bias_per_degc (temperature - at_degc))
    rate  = reading - bias - bias_per_degc (temperature - at_degc) - per_force (force reading)
    field = gain (reading - hard_iron)

Beyond the temperatures of the warm-up the bias is taken to stay as it was at the nearest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import msgspec
import numpy as np

from edge.samples import Floats, ImuBatch, SensorDescription

OLD_AFTER = timedelta(days=180)

_POOR_FORCE_MPS2 = 0.05
_POOR_RATE_RADPS = 5e-4  # 0.03 degrees a second
_POOR_FIELD_SHARE = 0.03
_SCALE_AND_BIAS = 6  # unknowns: so many poses fit whatever they show
# The first is the time of a machine whose clock was never set.
_MADE = datetime(1970, 1, 1, tzinfo=UTC), datetime(3000, 1, 1, tzinfo=UTC)
_DEGC = (-60.0, 150.0)  # in which sensors work
_FIELD_UT = (10.0, 120.0)  # the earth's, with what a unit's own iron may add or take
_CLIPPED_SHARE = 0.98  # of full scale: from here on a reading says no more than "too much"

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]


class Accelerometer(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    gain: Matrix
    gain_std: Matrix  # 0 where it was not looked for
    bias_mps2: Vector
    bias_std_mps2: Vector
    at_degc: float | None = None  # None: the unit does not tell its temperature
    poses: int
    residual_mps2: float  # root mean square over the poses

    @property
    def is_checked(self) -> bool:
        """True when there were more poses than unknowns: else nothing shows that one was wrong."""
        return self.poses > _SCALE_AND_BIAS


class Gyroscope(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    bias_radps: Vector
    bias_std_radps: Vector
    per_force: Matrix | None = None  # rad/s of each m/s2; None: there were no poses
    per_force_std: Matrix | None = None
    at_degc: float | None = None
    residual_radps: float  # root mean square of half-second means


class Magnetometer(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    gain: Matrix  # against soft iron; its determinant is 1
    gain_std: Matrix
    hard_iron_ut: Vector
    hard_iron_std_ut: Vector
    field_ut: float  # of the earth, as it was measured
    residual_ut: float

    @property
    def left_ut(self) -> float:
        """Standard deviation, an axis, of what is left uncorrected."""
        gain = float(np.sqrt(np.mean(np.square(self.gain_std)))) * self.field_ut
        iron = float(np.sqrt(np.mean(np.square(self.hard_iron_std_ut))))
        return math.hypot(gain, iron, self.residual_ut)


class Warmth(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Dependence of the biases on the sensor's temperature."""

    accel_bias_per_degc_mps2: Vector
    accel_std_mps2: Vector  # of the line above, for one degree
    gyro_bias_per_degc_radps: Vector
    gyro_std_radps: Vector
    from_degc: float
    to_degc: float
    residual_mps2: float
    residual_radps: float


class Calibration(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """``apply`` gives samples rid of the errors that were found; parts may be missing."""

    unit: str
    sensor: str
    made: datetime  # UTC
    accelerometer: Accelerometer | None = None
    gyroscope: Gyroscope | None = None
    magnetometer: Magnetometer | None = None
    warmth: Warmth | None = None

    def apply(self, imu: ImuBatch, sensor: SensorDescription) -> ImuBatch:
        """Correct readings; those at the end of ``sensor``'s range are left as they are."""
        return ImuBatch(
            t_ns=imu.t_ns,
            accel_mps2=_unless_clipped(
                imu.accel_mps2, self._force(imu), sensor.accel_full_scale_mps2
            ),
            gyro_radps=_unless_clipped(
                imu.gyro_radps, self._rate(imu), sensor.gyro_full_scale_radps
            ),
            mag_ut=self._field(imu.mag_ut),
            pressure_pa=imu.pressure_pa,
            imu_temperature_degc=imu.imu_temperature_degc,
        )

    def described(self, sensor: SensorDescription) -> SensorDescription:
        """``sensor`` as it is once its readings are corrected."""
        part = self.magnetometer
        if part is None:
            return sensor
        return replace(sensor, mag_iron_std_ut=part.left_ut, mag_earth_ut=part.field_ut)

    def faults(self) -> tuple[str, ...]:
        """Return what is poor about it, for a person; empty where all residuals are as they
        should be.
        """
        found = []
        if self.accelerometer and not self.accelerometer.is_checked:
            found.append(
                f"accelerometer of {self.accelerometer.poses} poses only: nothing checks it"
            )
        if self.accelerometer and self.accelerometer.residual_mps2 > _POOR_FORCE_MPS2:
            found.append(f"accelerometer off by {self.accelerometer.residual_mps2:.3f} m/s2")
        if self.gyroscope and self.gyroscope.residual_radps > _POOR_RATE_RADPS:
            found.append(f"gyroscope off by {np.degrees(self.gyroscope.residual_radps):.3f} deg/s")
        magnetometer = self.magnetometer
        if magnetometer and magnetometer.residual_ut > _POOR_FIELD_SHARE * magnetometer.field_ut:
            found.append(f"magnetometer off by {magnetometer.residual_ut:.1f} uT")
        return tuple(found)

    def impossible(self) -> str | None:
        """Return an error that no intact sensor has, or None: with one, the file is damaged, or
        the samples were of other movements than those of the calibration.
        """
        if not _MADE[0] <= self.made < _MADE[1]:
            return f"made in {self.made.year}"
        for name, values, most in self._off_by():
            if not np.all(np.abs(values) <= most):
                return f"{name} is off by more than {most:g}"
        for name, value, (least, most) in self._surroundings():
            if value is not None and not least <= value <= most:
                return f"{name} is not from {least:g} to {most:g}"
        return None

    def _off_by(self) -> Iterator[tuple[str, Floats, float]]:
        """Each part's name in the file, by what it is off, and the most of that."""
        if part := self.accelerometer:
            yield "accelerometer.gain", np.array(part.gain) - np.eye(3), 0.3
            yield "accelerometer.bias_mps2", np.array(part.bias_mps2), 3.0
        if gyroscope := self.gyroscope:
            yield "gyroscope.bias_radps", np.array(gyroscope.bias_radps), 0.2
            yield "gyroscope.per_force", np.array(gyroscope.per_force or 0.0), 0.02
        if magnetometer := self.magnetometer:
            yield "magnetometer.gain", np.array(magnetometer.gain) - np.eye(3), 3.0
            yield "magnetometer.hard_iron_ut", np.array(magnetometer.hard_iron_ut), 5000.0
        if warmth := self.warmth:
            slope = np.array(warmth.accel_bias_per_degc_mps2)
            yield "warmth.accel_bias_per_degc_mps2", slope, 0.2
            slope = np.array(warmth.gyro_bias_per_degc_radps)
            yield "warmth.gyro_bias_per_degc_radps", slope, 0.02

    def _surroundings(self) -> Iterator[tuple[str, float | None, tuple[float, float]]]:
        """Yield measured properties of the surroundings: name in the file, value, and bounds."""
        if part := self.accelerometer:
            yield "accelerometer.at_degc", part.at_degc, _DEGC
        if gyroscope := self.gyroscope:
            yield "gyroscope.at_degc", gyroscope.at_degc, _DEGC
        if magnetometer := self.magnetometer:
            yield "magnetometer.field_ut", magnetometer.field_ut, _FIELD_UT
        if warmth := self.warmth:
            yield "warmth.from_degc", warmth.from_degc, _DEGC
            yield "warmth.to_degc", warmth.to_degc, _DEGC

    def is_old(self, now: datetime) -> bool:
        return now - self.made > OLD_AFTER

    def _force(self, imu: ImuBatch) -> Floats:
        part, warmth = self.accelerometer, self.warmth
        if part is None:
            return imu.accel_mps2
        slope = None if warmth is None else warmth.accel_bias_per_degc_mps2
        biased = imu.accel_mps2 - np.array(part.bias_mps2)
        return _turned(part.gain, biased - self._drift(imu, slope, part.at_degc))

    def _rate(self, imu: ImuBatch) -> Floats:
        part, warmth = self.gyroscope, self.warmth
        if part is None:
            return imu.gyro_radps
        slope = None if warmth is None else warmth.gyro_bias_per_degc_radps
        drift = self._drift(imu, slope, part.at_degc)
        rate_radps = imu.gyro_radps - np.array(part.bias_radps) - drift
        if part.per_force is not None:
            rate_radps = rate_radps - _turned(part.per_force, imu.accel_mps2)
        return np.asarray(rate_radps)

    def _field(self, mag_ut: Floats | None) -> Floats | None:
        part = self.magnetometer
        if part is None or mag_ut is None:
            return mag_ut
        return _turned(part.gain, mag_ut - np.array(part.hard_iron_ut))

    def _drift(self, imu: ImuBatch, slope: Vector | None, at_degc: float | None) -> Floats:
        """Return the effect of temperature on the bias (n, 3); zero where the temperature is not
        known.
        """
        degc = imu.imu_temperature_degc
        if slope is None or at_degc is None or degc is None or self.warmth is None:
            return np.zeros(3)
        low, high = min(self.warmth.from_degc, at_degc), max(self.warmth.to_degc, at_degc)
        within = np.clip(degc, low, high)
        return np.asarray(np.nan_to_num(within - at_degc)[:, None] * np.array(slope))


def _turned(gain: Matrix, vectors: Floats) -> Floats:
    """``gain`` times each row (n, 3).

    Not by matrix product, whose last bit depends on how many rows there are: samples must
    come out the same however they are batched.
    """
    x, y, z = np.array(gain).T
    return np.asarray(vectors[:, :1] * x + vectors[:, 1:2] * y + vectors[:, 2:] * z)


def _unless_clipped(reading: Floats, corrected: Floats, full_scale: float | None) -> Floats:
    """A tracker must still see that the sensor had come to its end."""
    if full_scale is None:
        return corrected
    return np.where(np.abs(reading) >= _CLIPPED_SHARE * full_scale, reading, corrected)
