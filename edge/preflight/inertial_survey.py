"""Survey of an inertial sensor that lies still for some seconds: rate, gaps, gravity and noise.

Limits are those beyond which the tracker cannot do its work, not those of a good sensor.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from edge.agent.sensor_health import SensorHealth
from edge.calibration.rest_detector import RestDetector, RestWindow, mean_of, seconds
from edge.preflight.finding import NO_READING, CheckFinding, Severity, subject_of
from edge.samples import Floats, ImuBatch, SensorDescription
from shared.clock import NS_PER_S
from shared.coded_text import coded

# Codes of the subjects, and their words.
_SENSOR = "inertial_sensor", "inertial sensor"
_RATE = "sample_rate", "sample rate"
_RANGE = "measuring_range", "measuring range"
_ACCELEROMETER = "accelerometer", "accelerometer"
_GYROSCOPE = "gyroscope", "gyroscope"
_FIELD = "magnetic_field", "magnetic field"
_PRESSURE = "air_pressure", "air pressure"

_RATE_TOLERANCE = 0.05  # of the rate that is stated
_RATE_MIN_HZ = 50.0  # a stance of a quick walk lasts 0.15 s
_GAP_MAX_S = 0.1  # a swing of the foot lasts 0.4 s
_REST_MIN_S = 1.0
_GRAVITY_MPS2 = 9.81
_GRAVITY_TOLERANCE_MPS2 = 0.3  # more than the scale and bias of a working sensor
_RATE_AT_REST_MAX_RADPS = 0.1  # 6 degrees a second: more than any bias
_ACCEL_RANGE_MIN_MPS2 = 8 * _GRAVITY_MPS2  # a foot that lands passes it with every step
_GYRO_RANGE_MIN_RADPS = np.radians(1000.0)  # a running foot swings as fast
_FIELD_UT = (15.0, 90.0)  # of the earth, with what a unit's own iron may add or take
_PRESSURE_PA = (60_000.0, 110_000.0)  # 4,000 m up to a deep mine
_CALIBRATE = "calibrate it with `muster edge calibrate`"


class InertialSurvey:
    """Takes in consecutive batches; ``findings`` then judges them."""

    def __init__(self, sensor: SensorDescription, name: str = "") -> None:
        """``name``: of the sensor in its unit, for the findings; empty: the unit's only one."""
        self._sensor = sensor
        self._name = name
        self._health = SensorHealth()
        self._rests = RestDetector()
        self._faults: list[str] = []
        self._count = 0
        self._first_ns = self._last_ns = 0
        self._longest_gap_ns = 0
        self._field_ut: list[Floats] = []
        self._pressure_pa: list[Floats] = []

    def push(self, imu: ImuBatch) -> None:
        if not len(imu):
            return
        self._faults += self._health.push(imu)
        self._rests.push(imu)
        self._note_times(imu)
        if imu.mag_ut is not None:
            self._field_ut.append(np.linalg.norm(imu.mag_ut, axis=1))
        if imu.pressure_pa is not None:
            self._pressure_pa.append(imu.pressure_pa)

    def findings(self, *, asks_rest: bool = True) -> Iterator[CheckFinding]:
        """``asks_rest``: a person was requested to lay the unit down."""
        yield from self._findings(asks_rest=asks_rest)

    def _subject(self, code: str, words: str) -> str:
        return subject_of(code, words, self._name)

    def _findings(self, *, asks_rest: bool) -> Iterator[CheckFinding]:
        if self._count < 2:  # two times make a rate
            yield CheckFinding(
                self._subject(*_SENSOR),
                Severity.FAILED,
                coded(
                    "check-no-samples",
                    "{source} gave no samples",
                    source=self._sensor.name or "the source",
                ),
                "check its power and cable; without it the wearer is not tracked",
            )
            return
        yield from (
            CheckFinding(self._subject(*_SENSOR), Severity.FAILED, one) for one in self._faults
        )
        yield self._rate()
        yield from self._ranges()
        yield from self._at_rest(asks_rest=asks_rest)
        yield from _quantity(
            self._subject(*_FIELD), self._field_ut, _FIELD_UT, 1.0, "uT",
            "iron or a magnet is near it, or it is not calibrated: headings drift",
        )  # fmt: skip
        yield from _quantity(
            self._subject(*_PRESSURE), self._pressure_pa, _PRESSURE_PA, 100.0, "hPa",
            "the barometer is broken or closed: heights rest on the steps alone",
        )  # fmt: skip

    def _note_times(self, imu: ImuBatch) -> None:
        if not self._count:
            self._first_ns = self._last_ns = int(imu.t_ns[0])
        times_ns = np.concatenate(([self._last_ns], imu.t_ns))
        self._longest_gap_ns = max(self._longest_gap_ns, int(np.diff(times_ns).max()))
        self._count += len(imu)
        self._last_ns = int(imu.t_ns[-1])

    def _rate(self) -> CheckFinding:
        elapsed_s = max((self._last_ns - self._first_ns) / NS_PER_S, 1e-9)
        rate_hz, gap_s = (self._count - 1) / elapsed_s, self._longest_gap_ns / NS_PER_S
        stated_hz = self._sensor.rate_hz
        subject = self._subject(*_RATE)
        text = coded(
            "check-rate",
            "{rate_hz:.1f} samples/s of {stated_hz:g}, longest gap {gap_ms:.0f} ms",
            rate_hz=round(rate_hz, 1),
            stated_hz=stated_hz,
            gap_ms=round(1e3 * gap_s),
        )
        if rate_hz < _RATE_MIN_HZ:
            return CheckFinding(
                subject,
                Severity.FAILED,
                text,
                f"the tracker needs {_RATE_MIN_HZ:g}; set a higher rate",
            )
        if abs(rate_hz - stated_hz) > _RATE_TOLERANCE * stated_hz or gap_s > _GAP_MAX_S:
            return CheckFinding(
                subject,
                Severity.WARNING,
                text,
                "samples are lost on the way: check cable, radio, load",
            )
        return CheckFinding(subject, Severity.OK, text)

    def _ranges(self) -> Iterator[CheckFinding]:
        accel_mps2 = self._sensor.accel_full_scale_mps2
        gyro_radps = self._sensor.gyro_full_scale_radps
        if accel_mps2 is None or gyro_radps is None:
            return
        subject = self._subject(*_RANGE)
        text = coded(
            "check-range",
            "{accel_g:.0f} g and {gyro_degps:.0f} deg/s",
            accel_g=round(accel_mps2 / _GRAVITY_MPS2),
            gyro_degps=round(np.degrees(gyro_radps)),
        )
        if accel_mps2 < _ACCEL_RANGE_MIN_MPS2 or gyro_radps < _GYRO_RANGE_MIN_RADPS:
            yield CheckFinding(
                subject, Severity.WARNING, text, "steps go beyond it: set 16 g and 2000 deg/s"
            )
        else:
            yield CheckFinding(subject, Severity.OK, text)

    def _at_rest(self, *, asks_rest: bool) -> Iterator[CheckFinding]:
        rest = self._longest_rest()
        if seconds(rest) < _REST_MIN_S:
            if not asks_rest:
                return
            yield CheckFinding(
                self._subject("rest", "rest"),
                Severity.WARNING,
                coded("check-never-still", "it was never still for a second"),
                "lay the unit down and check again: gravity, bias and noise were not seen",
            )
            return
        mean = mean_of(rest)
        force_mps2 = float(np.linalg.norm(mean.accel_mps2))
        rate_degps = float(np.degrees(np.linalg.norm(mean.gyro_radps)))
        is_gravity = abs(force_mps2 - _GRAVITY_MPS2) <= _GRAVITY_TOLERANCE_MPS2
        yield CheckFinding(
            self._subject(*_ACCELEROMETER),
            Severity.OK if is_gravity else Severity.FAILED,
            coded(
                "check-gravity",
                "{force_mps2:.2f} m/s2 at rest, gravity is {gravity_mps2}",
                force_mps2=round(force_mps2, 2),
                gravity_mps2=_GRAVITY_MPS2,
            ),
            "" if is_gravity else f"its scale or bias is wrong: {_CALIBRATE}, or replace it",
        )
        is_slow = rate_degps <= np.degrees(_RATE_AT_REST_MAX_RADPS)
        yield CheckFinding(
            self._subject(*_GYROSCOPE),
            Severity.OK if is_slow else Severity.FAILED,
            coded(
                "check-turn-at-rest",
                "{rate_degps:.2f} deg/s at rest",
                rate_degps=round(rate_degps, 2),
            ),
            "" if is_slow else f"its bias is too large to be found while walking: {_CALIBRATE}",
        )

    def _longest_rest(self) -> list[RestWindow]:
        return max(self._rests.rests, key=len, default=[])


def _quantity(
    subject: str,
    columns: list[Floats],
    limits: tuple[float, float],
    per_unit: float,
    unit: str,
    remedy: str,
) -> Iterator[CheckFinding]:
    """Yield a finding on the median of a quantity that the sensor has; none where it has not."""
    if not columns:
        return
    values = np.concatenate(columns)
    values = values[np.isfinite(values)]
    if not len(values):
        yield CheckFinding(subject, Severity.WARNING, NO_READING, remedy)
        return
    median = float(np.median(values))
    is_plausible = limits[0] <= median <= limits[1]
    text = f"{median / per_unit:.1f} {unit}"
    yield CheckFinding(
        subject,
        Severity.OK if is_plausible else Severity.WARNING,
        text,
        "" if is_plausible else remedy,
    )
