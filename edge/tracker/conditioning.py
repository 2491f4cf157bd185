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
from edge.tracker.plateaus import LEAST_RADPS, seek_plateau
from edge.tracker.port import Reason
from edge.tracker.state import Ring
from shared.errors import ConfigError

ACCEL_SATURATED = int(Reason.ACCEL_SATURATED)
BAD_SAMPLES = int(Reason.BAD_SAMPLES)
GYRO_SATURATED = int(Reason.GYRO_SATURATED)
SAMPLE_GAP = int(Reason.SAMPLE_GAP)

NEW_CLOCK_SAMPLES = 25  # so many stamps in a row before the last one: the clock was set back
STUCK_SAMPLES = 8  # so many equal samples in a row that are not rest: the sensor hangs
MARK_BACK_S = 0.4  # less than the filter's look-ahead
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
        # By axis; see plateaus.
        ("clip_radps", np.float64, 3),  # from which a rate has clipped, as plateaus show
        ("highest_radps", np.float64, 3),  # rate so far
        ("flat_radps", np.float64, 3),  # first of the last rates that hardly differ
        ("flat_samples", np.int64, 3),  # how many
        ("plateau_samples", np.int64, 3),  # the same of a plateau that is yet to be judged
        ("plateau_stop", np.int64, 3),  # one past its last sample
        ("plateau_radps", np.float64, 3),  # top of the last one that was right
        ("watching", np.bool_),  # a rate was high, or a plateau is yet to be judged
        ("started", np.bool_),
        (SOURCES, np.bool_),  # not used; see kernel_cache
    ]
)


class Limits(NamedTuple):
    """Readings at which a sensor clips, and readings that cannot be true."""

    accel_clip_mps2: float
    gyro_clip_radps: float
    accel_absurd_mps2: float
    gyro_absurd_radps: float


def limits_of(description: SensorDescription, saturation_ratio: float) -> Limits:
    """Return the limits of a described sensor; without a full scale nothing clips."""
    accel = description.accel_full_scale_mps2
    gyro = description.gyro_full_scale_radps
    return Limits(
        accel_clip_mps2=saturation_ratio * accel if accel else np.inf,
        gyro_clip_radps=saturation_ratio * gyro if gyro else np.inf,
        accel_absurd_mps2=1.5 * accel if accel else 4000.0,
        gyro_absurd_radps=1.5 * gyro if gyro else 150.0,
    )


def new_gate(description: SensorDescription) -> NDArray[Any]:
    """Return one record of ``GATE``; ``ConfigError`` when the described rate is none."""
    if not 0.0 < description.rate_hz < np.inf:
        raise ConfigError(
            f"sensor '{description.name}' is described with {description.rate_hz:g} samples per "
            "second; give its rate"
        )
    gate = np.zeros(1, GATE)
    gate["period_s"] = 1.0 / description.rate_hz
    gate["clip_radps"] = np.inf
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
            _heed_plateaus(ring, received + i, gate, limits, gyro_radps[i])
            for j in range(3):
                gate[0].accel_mps2[j] = accel_mps2[i, j]
                gate[0].gyro_radps[j] = gyro_radps[i, j]
        sample = ring[(received + i) & mask]
        sample.t_ns = t_ns[i]
        _write_good(sample, gate[0], limits, flags)
        for j in range(3):
            sample.mag_ut[j] = mag_ut[i, j] if len(mag_ut) else np.nan
        sample.pressure_pa = pressure_pa[i] if len(pressure_pa) else np.nan
        sample.temperature_degc = temperature_degc[i] if len(temperature_degc) else np.nan


@njit()
def _write_good(sample: Any, gate: Any, limits: Limits, flags: int) -> None:
    """Write the last good readings and their time into a record of the ring."""
    for j in range(3):
        rate_radps = abs(gate.gyro_radps[j])
        clipped = rate_radps >= limits.gyro_clip_radps or rate_radps >= gate.clip_radps[j]
        if clipped and flags & BAD_SAMPLES == 0:
            flags |= GYRO_SATURATED
        sample.clipped[j] = clipped
        sample.force_clipped[j] = abs(gate.accel_mps2[j]) >= limits.accel_clip_mps2
        sample.accel_mps2[j] = gate.accel_mps2[j]
        sample.gyro_radps[j] = gate.gyro_radps[j]
        sample.hidden_noise[j] = 0.0
        sample.hidden_force_noise[j] = 0.0
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
        if abs(a) >= limits.accel_clip_mps2:
            flags |= ACCEL_SATURATED
        same = same and a == gate[0].accel_mps2[j] and w == gate[0].gyro_radps[j]
        accel_square += a * a
        rate_square += w * w
    gate[0].repeats = gate[0].repeats + 1 if same else 0
    resting = 81.0 < accel_square < 115.0 and rate_square < 0.04
    if gate[0].repeats >= STUCK_SAMPLES and not resting:
        return BAD_SAMPLES
    return flags


@njit()
def _heed_plateaus(
    ring: Ring, k: int, gate: NDArray[Any], limits: Limits, gyro_radps: Floats
) -> None:
    """Look for a full scale that nobody told.

    It shows when a plateau is over, so what has clipped is marked afterwards, as far back as no
    filter has come yet however the samples are batched.
    """
    fastest_radps = max(abs(gyro_radps[0]), abs(gyro_radps[1]), abs(gyro_radps[2]))
    if fastest_radps < LEAST_RADPS and not gate[0].watching:
        return  # as half of the time
    gate[0].watching = False
    mask = len(ring) - 1
    for j in range(3):
        before_radps = gate[0].clip_radps[j]
        seek_plateau(ring, k, gate, j, abs(gyro_radps[j]))
        if gate[0].clip_radps[j] < before_radps:
            limit_radps = min(limits.gyro_clip_radps, gate[0].clip_radps[j])
            for i in range(k - 1, max(-1, k - mask // 8), -1):
                if gate[0].arrival_s - ring[i & mask].arrival_s > MARK_BACK_S:
                    break
                if abs(ring[i & mask].gyro_radps[j]) >= limit_radps:
                    ring[i & mask].clipped[j] = 1
                    ring[i & mask].flags |= GYRO_SATURATED


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
