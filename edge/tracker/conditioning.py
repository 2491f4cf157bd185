"""What enters the ring: samples checked one by one, the bad ones marked and left out.

A bad sample keeps its row: it holds the values and the time of the last good
one, so that the filter stands still over it and the next good sample spans the
hole.  Times are put right in ``regular_time``.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import Floats, ImuBatch, SensorDescription
from edge.tracker.kernel_cache import SOURCES
from edge.tracker.plateaus import (
    ACCEL_SATURATED,
    FULL_SCALE,
    GYRO_SATURATED,
    know_full_scale,
    seek_full_scale,
)
from edge.tracker.port import Reason
from edge.tracker.state import Ring
from shared.errors import ConfigError

BAD_SAMPLES = int(Reason.BAD_SAMPLES)
SAMPLE_GAP = int(Reason.SAMPLE_GAP)

NEW_CLOCK_SAMPLES = 25  # so many stamps in a row before the last one: the clock was set back
STUCK_SAMPLES = 8  # so many equal samples in a row that are not rest: the sensor hangs
PERIOD_WEIGHT = 0.005  # of one interval in the mean period

_NO_VALUES: Floats = np.zeros(0)
_NO_VECTORS: Floats = np.zeros((0, 3))

GATE = np.dtype(
    [
        ("last_ns", np.int64),
        ("arrival_s", np.float64),
        ("period_s", np.float64),  # mean time between samples
        ("accel_mps2", np.float64, 3),
        ("gyro_radps", np.float64, 3),
        ("backward", np.int64),  # stamps before the last one, in a row
        ("repeats", np.int64),  # equal samples in a row
        ("accel_scale", FULL_SCALE),
        ("gyro_scale", FULL_SCALE),
        ("started", np.bool_),
        (SOURCES, np.bool_),  # not used; see kernel_cache
    ]
)


class Limits(NamedTuple):
    """Readings that cannot be true."""

    accel_absurd_mps2: float
    gyro_absurd_radps: float


def limits_of(description: SensorDescription) -> Limits:
    """Return the limits of a described sensor."""
    accel = description.accel_full_scale_mps2
    gyro = description.gyro_full_scale_radps
    return Limits(
        accel_absurd_mps2=1.5 * accel if accel else 4000.0,
        gyro_absurd_radps=1.5 * gyro if gyro else 150.0,
    )


def new_gate(description: SensorDescription, saturation_ratio: float) -> NDArray[Any]:
    """Return one record of ``GATE``; ``ConfigError`` when the described rate is none."""
    if not 0.0 < description.rate_hz < np.inf:
        raise ConfigError(
            f"sensor '{description.name}' is described with {description.rate_hz:g} samples per "
            "second; give its rate"
        )
    gate = np.zeros(1, GATE)
    gate["period_s"] = 1.0 / description.rate_hz
    accel_mps2 = description.accel_full_scale_mps2 or np.inf
    gyro_radps = description.gyro_full_scale_radps or np.inf
    know_full_scale(gate["accel_scale"], saturation_ratio * accel_mps2, forces=True)
    know_full_scale(gate["gyro_scale"], saturation_ratio * gyro_radps, forces=False)
    return gate


def admit_batch(
    ring: Ring, received: int, gate: NDArray[Any], limits: Limits, gap_s: float, batch: ImuBatch
) -> None:
    """Append a batch to the ring that has taken ``received`` samples before."""
    admit(
        ring,
        received,
        gate,
        limits,
        gap_s,
        _plain(batch.t_ns, np.int64),
        _plain(batch.accel_mps2, np.float64),
        _plain(batch.gyro_radps, np.float64),
        _optional(batch.mag_ut, _NO_VECTORS),
        _optional(batch.pressure_pa, _NO_VALUES),
        _optional(batch.imu_temperature_degc, _NO_VALUES),
    )


def _optional(values: Floats | None, absent: Floats) -> Floats:
    return absent if values is None else _plain(values, np.float64)


def _plain(values: NDArray[Any], dtype: type) -> NDArray[Any]:
    """Return ``values`` in the one layout that ``admit`` is compiled for."""
    flags = values.flags
    if flags.c_contiguous and flags.writeable and values.dtype == dtype:
        return values
    return np.array(values, dtype, order="C")


@njit(cache=True)
def admit(
    ring: Ring,
    received: int,
    gate: NDArray[Any],
    limits: Limits,
    gap_s: float,
    t_ns: NDArray[np.int64],
    accel_mps2: Floats,
    gyro_radps: Floats,
    mag_ut: Floats,
    pressure_pa: Floats,
    temperature_degc: Floats,
) -> None:
    """Append samples (n,), (n, 3), (n, 3) to the ring of ``received`` with flags and times.

    Of the other sensors (n, 3), (n,), (n,) the column is empty where there is none.
    """
    mask = len(ring) - 1
    for i in range(len(t_ns)):
        flags = _reading_flags(gate, limits, accel_mps2[i], gyro_radps[i])
        if flags & BAD_SAMPLES == 0:
            flags |= _time_flags(gate, t_ns[i], gap_s)
        if flags & BAD_SAMPLES == 0:
            now_s, period_s = gate[0].arrival_s, gate[0].period_s
            k = received + i
            seek_full_scale(ring, k, gate[0].gyro_scale, gyro_radps[i], now_s, period_s)
            seek_full_scale(ring, k, gate[0].accel_scale, accel_mps2[i], now_s, period_s)
            for j in range(3):
                gate[0].accel_mps2[j] = accel_mps2[i, j]
                gate[0].gyro_radps[j] = gyro_radps[i, j]
        sample = ring[(received + i) & mask]
        sample.t_ns = t_ns[i]
        _write_good(sample, gate[0], flags)
        for j in range(3):
            sample.mag_ut[j] = mag_ut[i, j] if len(mag_ut) else np.nan
        sample.pressure_pa = pressure_pa[i] if len(pressure_pa) else np.nan
        sample.temperature_degc = temperature_degc[i] if len(temperature_degc) else np.nan


@njit()
def _write_good(sample: Any, gate: Any, flags: int) -> None:
    """Write the last good readings and their time into a record of the ring."""
    rate_clipped = False
    force_clipped = False
    for j in range(3):
        sample.clipped[j] = abs(gate.gyro_radps[j]) >= gate.gyro_scale.clip[j]
        sample.force_clipped[j] = abs(gate.accel_mps2[j]) >= gate.accel_scale.clip[j]
        rate_clipped = rate_clipped or sample.clipped[j]
        force_clipped = force_clipped or sample.force_clipped[j]
        sample.accel_mps2[j] = gate.accel_mps2[j]
        sample.gyro_radps[j] = gate.gyro_radps[j]
        sample.hidden_noise[j] = 0.0
        sample.hidden_force_noise[j] = 0.0
    if flags & BAD_SAMPLES == 0:
        if rate_clipped:
            flags |= GYRO_SATURATED
        if force_clipped:
            flags |= ACCEL_SATURATED
    sample.arrival_s = gate.arrival_s
    sample.period_s = gate.period_s
    sample.flags = flags


@njit()
def _reading_flags(gate: NDArray[Any], limits: Limits, accel: Floats, gyro: Floats) -> int:
    flags = 0
    same = gate[0].started
    accel_square = 0.0
    rate_square = 0.0
    for j in range(3):
        a, w = accel[j], gyro[j]
        if not (abs(a) <= limits.accel_absurd_mps2 and abs(w) <= limits.gyro_absurd_radps):
            return BAD_SAMPLES  # also when not finite
        same = same and a == gate[0].accel_mps2[j] and w == gate[0].gyro_radps[j]
        accel_square += a * a
        rate_square += w * w
    gate[0].repeats = gate[0].repeats + 1 if same else 0
    resting = 81.0 < accel_square < 115.0 and rate_square < 0.04
    if gate[0].repeats >= STUCK_SAMPLES and not resting:
        return BAD_SAMPLES
    return flags


@njit()
def _time_flags(gate: NDArray[Any], t_ns: int, gap_s: float) -> int:
    if not gate[0].started:
        gate[0].started = True
        gate[0].last_ns = t_ns
        return 0
    step_s = 1e-9 * (t_ns - gate[0].last_ns)
    flags = 0
    if step_s < 0.0:
        gate[0].backward += 1
        if gate[0].backward < NEW_CLOCK_SAMPLES:
            return BAD_SAMPLES
        flags = SAMPLE_GAP  # of unknown length
        step_s = NEW_CLOCK_SAMPLES * gate[0].period_s
    elif step_s == 0.0 and gate[0].repeats > 0:
        return BAD_SAMPLES  # the same sample twice
    gate[0].backward = 0
    gate[0].last_ns = t_ns
    gate[0].arrival_s += step_s
    if step_s > gap_s:
        return SAMPLE_GAP
    gate[0].period_s += PERIOD_WEIGHT * (step_s - gate[0].period_s)
    return flags


@njit()
def regular_time(ring: Ring, k: int, stop: int, late_s: float) -> float:
    """Return the time of sample ``k`` without late delivery, in s since the first sample.

    A stamp may be late (polled or quantised transport) but not early, so samples
    that follow on time, counted back by the mean period, bound when ``k`` was taken.
    """
    mask = len(ring) - 1
    arrival_s = ring[k & mask].arrival_s
    period_s = ring[k & mask].period_s
    best_s = arrival_s
    back_s = 0.0
    for j in range(k + 1, stop):
        slot = j & mask
        if ring[slot].arrival_s - arrival_s > late_s:
            break
        if ring[slot].flags & (BAD_SAMPLES | SAMPLE_GAP) == 0:
            back_s += period_s
            best_s = min(best_s, ring[slot].arrival_s - back_s)
    if k > 0:
        best_s = max(best_s, ring[(k - 1) & mask].t_s)
    return float(best_s)
