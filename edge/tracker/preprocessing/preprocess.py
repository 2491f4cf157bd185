"""Input checks: samples enter the ring one by one; bad ones are marked and left out.

Bad is what is not finite, beyond the range, repeated where nothing can repeat, or stamped backward.
A bad sample keeps its row: it holds the values and the time of the last good one, so that the
filter stands still over it and the next good sample spans the gap.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import Floats, ImuBatch, SensorDescription
from edge.tracker.interface import Reason
from edge.tracker.kernel_cache import SOURCES
from edge.tracker.preprocessing.sample_ring import Ring, span
from edge.tracker.preprocessing.saturation_detection import (
    ACCEL_SATURATED,
    FULL_SCALE,
    GYRO_SATURATED,
    detect_full_scale,
    set_declared_range,
)
from shared.errors import ConfigError

BAD_SAMPLES = int(Reason.BAD_SAMPLES)
SAMPLE_GAP = int(Reason.SAMPLE_GAP)

NEW_CLOCK_SAMPLES = 25  # so many stamps in a row before the last one: the clock was set back
STUCK_SAMPLES = 8  # so many equal readings in a row that are not rest: the sensor hangs
STUCK_S = 0.05  # as long at least: one of the two may be slower than the other
SATURATED_S = 0.4  # longer than any swing clips
SWINGS_RAD2PS2 = 1.0  # square of a rate; a foot that turns so feels something on every axis
SWINGS_M2PS4 = (64.0, 144.0)  # squares of forces; so does one that feels less or more
BAD_RUN_S = 0.35  # of bad samples: no hole as long is bridged, and no good one is waited for
PERIOD_WEIGHT = 0.005  # of one interval in the mean periods
USUAL_TOLERANCE = (
    0.5  # of a period, within which intervals are, and of all intervals, that then are most
)

_NO_VALUES: Floats = np.zeros(0)
_NO_VECTORS: Floats = np.zeros((0, 3))

INPUT_STATE = np.dtype(
    [
        ("last_ns", np.int64),
        ("arrival_s", np.float64),
        ("declared_period_s", np.float64),  # as described
        ("period_s", np.float64),  # from one sample that the sensor took to the next
        ("mean_interval_s", np.float64),  # of all intervals between stamps
        ("usual_interval_s", np.float64),  # ... and of those that are like most
        ("usual_share", np.float64),
        ("accel_mps2", np.float64, 3),
        ("gyro_radps", np.float64, 3),
        ("bad_run", np.int64),  # bad samples in a row
        ("backward", np.int64),  # stamps before the last one, in a row
        ("accel_repeats", np.int64, 3),  # equal readings in a row, by axis
        ("gyro_repeats", np.int64, 3),
        ("has_rotated", np.bool_),  # the gyroscope has shown a rate
        ("stuck", np.bool_),  # a sensor or an axis, for as long as it repeats itself
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
    """Return the limits of a described sensor: one and a half times its range."""
    accel = description.accel_full_scale_mps2
    gyro = description.gyro_full_scale_radps
    return Limits(
        accel_absurd_mps2=1.5 * accel if accel else 4000.0,
        gyro_absurd_radps=1.5 * gyro if gyro else 150.0,
    )


def new_input_state(description: SensorDescription, saturation_ratio: float) -> NDArray[Any]:
    """Return one record of ``INPUT_STATE``; ``ConfigError`` when the described rate is none."""
    if not 0.0 < description.rate_hz < np.inf:
        raise ConfigError(
            f"sensor '{description.name}' is described with {description.rate_hz:g} samples per "
            "second; give its rate"
        )
    input_state = np.zeros(1, INPUT_STATE)
    for name in ("declared_period_s", "period_s", "mean_interval_s", "usual_interval_s"):
        input_state[name] = 1.0 / description.rate_hz
    input_state["usual_share"] = 1.0
    accel_mps2 = description.accel_full_scale_mps2 or np.inf
    gyro_radps = description.gyro_full_scale_radps or np.inf
    set_declared_range(input_state["accel_scale"], saturation_ratio * accel_mps2, forces=True)
    set_declared_range(input_state["gyro_scale"], saturation_ratio * gyro_radps, forces=False)
    return input_state


def preprocess_batch(
    ring: Ring,
    progress: NDArray[Any],
    input_state: NDArray[Any],
    limits: Limits,
    gap_s: float,
    batch: ImuBatch,
) -> Iterator[bool]:
    """Append a batch to the ring, of which ``progress`` counts the samples ``received``.

    Gives, after each part that the ring has room for, whether no good sample has come for so long
    that none is to be waited for.  That depends on the samples alone, not on how they come.
    """
    first = 0
    while first < len(batch):
        part = batch.part(slice(first, first + span(ring)))
        taken = preprocess(
            ring,
            int(progress["received"][0]),
            input_state,
            limits,
            gap_s,
            _plain(part.t_ns, np.int64),
            _plain(part.accel_mps2, np.float64),
            _plain(part.gyro_radps, np.float64),
            _optional(part.mag_ut, _NO_VECTORS),
            _optional(part.pressure_pa, _NO_VALUES),
            _optional(part.imu_temperature_degc, _NO_VALUES),
        )
        first += taken
        progress["received"] += taken
        yield bool(_lacks_good_samples(input_state))


def _optional(values: Floats | None, absent: Floats) -> Floats:
    return absent if values is None else _plain(values, np.float64)


def _plain(values: NDArray[Any], dtype: type) -> NDArray[Any]:
    """Return ``values`` in the one layout that ``preprocess`` is compiled for."""
    flags = values.flags
    if flags.c_contiguous and flags.writeable and values.dtype == dtype:
        return values
    return np.array(values, dtype, order="C")


@njit(cache=True)
def preprocess(
    ring: Ring,
    received: int,
    input_state: NDArray[Any],
    limits: Limits,
    gap_s: float,
    t_ns: NDArray[np.int64],
    accel_mps2: Floats,
    gyro_radps: Floats,
    mag_ut: Floats,
    pressure_pa: Floats,
    temperature_degc: Floats,
) -> int:
    """Append samples (n,), (n, 3), (n, 3) to the ring of ``received`` with flags and times.

    Of the other sensors (n, 3), (n,), (n,) the column is empty where there is none.  Returns how
    many were taken: no more than up to where it gives up waiting for a good one.
    """
    mask = len(ring) - 1
    for i in range(len(t_ns)):
        flags = _reading_flags(input_state, limits, accel_mps2[i], gyro_radps[i])
        if flags & BAD_SAMPLES == 0:
            flags |= _time_flags(input_state, t_ns[i], gap_s)
        if flags & BAD_SAMPLES == 0:
            now_s, period_s = input_state[0].arrival_s, input_state[0].period_s
            k = received + i
            detect_full_scale(ring, k, input_state[0].gyro_scale, gyro_radps[i], now_s, period_s)
            detect_full_scale(ring, k, input_state[0].accel_scale, accel_mps2[i], now_s, period_s)
            for j in range(3):
                input_state[0].accel_mps2[j] = accel_mps2[i, j]
                input_state[0].gyro_radps[j] = gyro_radps[i, j]
        sample = ring[(received + i) & mask]
        sample.t_ns = t_ns[i]
        _write_good(sample, input_state[0], flags)
        for j in range(3):
            sample.mag_ut[j] = mag_ut[i, j] if len(mag_ut) else np.nan
        sample.pressure_pa = pressure_pa[i] if len(pressure_pa) else np.nan
        sample.temperature_degc = temperature_degc[i] if len(temperature_degc) else np.nan
        input_state[0].bad_run = input_state[0].bad_run + 1 if flags & BAD_SAMPLES else 0
        if _lacks_good_samples(input_state):
            return i + 1
    return len(t_ns)


@njit(cache=True)
def _lacks_good_samples(input_state: NDArray[Any]) -> bool:
    if input_state[0].bad_run == 0:
        return False
    every = max(1, int(BAD_RUN_S / input_state[0].period_s))
    return bool(input_state[0].bad_run % every == 0)


@njit()
def _write_good(sample: Any, input_state: Any, flags: int) -> None:
    """Write the last good readings and their time into a record of the ring."""
    any_rate_saturated = False
    force_saturated = False
    for j in range(3):
        sample.rate_saturated[j] = abs(input_state.gyro_radps[j]) >= input_state.gyro_scale.clip[j]
        sample.force_saturated[j] = (
            abs(input_state.accel_mps2[j]) >= input_state.accel_scale.clip[j]
        )
        any_rate_saturated = any_rate_saturated or sample.rate_saturated[j]
        force_saturated = force_saturated or sample.force_saturated[j]
        sample.accel_mps2[j] = input_state.accel_mps2[j]
        sample.gyro_radps[j] = input_state.gyro_radps[j]
        sample.bridge_radps[j] = 0.0
        sample.hidden_noise[j] = 0.0
        sample.hidden_force_noise[j] = 0.0
    if flags & BAD_SAMPLES == 0:
        if any_rate_saturated:
            flags |= GYRO_SATURATED
        if force_saturated:
            flags |= ACCEL_SATURATED
    sample.arrival_s = input_state.arrival_s
    sample.period_s = input_state.period_s
    sample.flags = flags


@njit()
def _reading_flags(input_state: NDArray[Any], limits: Limits, accel: Floats, gyro: Floats) -> int:
    for j in range(3):
        if not (
            abs(accel[j]) <= limits.accel_absurd_mps2 and abs(gyro[j]) <= limits.gyro_absurd_radps
        ):
            return BAD_SAMPLES  # also when not finite
    return BAD_SAMPLES if _is_stuck(input_state[0], accel, gyro) else 0


@njit()
def _is_stuck(input_state: Any, accel: Floats, gyro: Floats) -> bool:
    """True when a sensor repeats itself though it does not rest, or one axis does in a swing.

    What may be saturated is left to ``saturation_detection``.  An axis of exactly zero was made so,
    and so was a gyroscope that never showed anything else.
    """
    accel_square = 0.0
    rate_square = 0.0
    axis_repeats = 0
    for j in range(3):
        a, w = accel[j], gyro[j]
        same = input_state.started and a == input_state.accel_mps2[j]
        input_state.accel_repeats[j] = input_state.accel_repeats[j] + 1 if same else 0
        same = input_state.started and w == input_state.gyro_radps[j]
        input_state.gyro_repeats[j] = input_state.gyro_repeats[j] + 1 if same else 0
        below = abs(a) < input_state.accel_scale.floor[j]
        if a != 0.0 and (
            below or input_state.accel_repeats[j] * input_state.period_s > SATURATED_S
        ):
            axis_repeats = max(axis_repeats, input_state.accel_repeats[j])
        below = abs(w) < input_state.gyro_scale.floor[j]
        if w != 0.0 and (below or input_state.gyro_repeats[j] * input_state.period_s > SATURATED_S):
            axis_repeats = max(axis_repeats, input_state.gyro_repeats[j])
        accel_square += a * a
        rate_square += w * w
    input_state.has_rotated = input_state.has_rotated or rate_square > 0.0
    sensor_repeats = _smallest(input_state.accel_repeats)
    if input_state.has_rotated:
        sensor_repeats = max(sensor_repeats, _smallest(input_state.gyro_repeats))
    resting = 81.0 < accel_square < 115.0 and rate_square < 0.04
    swings = rate_square > SWINGS_RAD2PS2
    swings = swings or not SWINGS_M2PS4[0] < accel_square < SWINGS_M2PS4[1]
    input_state.stuck = (
        _lasts(input_state, sensor_repeats) and (input_state.stuck or not resting)
    ) or (_lasts(input_state, axis_repeats) and (input_state.stuck or swings))
    return bool(input_state.stuck)


@njit()
def _smallest(repeats: NDArray[np.int64]) -> int:
    return int(min(repeats[0], repeats[1], repeats[2]))


@njit()
def _lasts(input_state: Any, repeats: int) -> bool:
    return bool(repeats >= STUCK_SAMPLES and repeats * input_state.period_s >= STUCK_S)


@njit()
def _time_flags(input_state: NDArray[Any], t_ns: int, gap_s: float) -> int:
    if not input_state[0].started:
        input_state[0].started = True
        input_state[0].last_ns = t_ns
        return 0
    step_s = 1e-9 * (t_ns - input_state[0].last_ns)
    flags = 0
    if step_s < 0.0:
        input_state[0].backward += 1
        if input_state[0].backward < NEW_CLOCK_SAMPLES:
            return BAD_SAMPLES
        flags = SAMPLE_GAP  # of unknown length
        step_s = NEW_CLOCK_SAMPLES * input_state[0].period_s
    elif (
        step_s == 0.0
        and min(_smallest(input_state[0].accel_repeats), _smallest(input_state[0].gyro_repeats)) > 0
    ):
        return BAD_SAMPLES  # the same sample twice
    input_state[0].backward = 0
    input_state[0].last_ns = t_ns
    input_state[0].arrival_s += step_s
    if step_s > gap_s:
        return SAMPLE_GAP
    _learn_period(input_state[0], step_s)
    return flags


@njit()
def _learn_period(input_state: Any, interval_s: float) -> None:
    """Take an interval between two stamps.

    Late or coarse stamps make most intervals wrong, and leave the mean as it is.  Samples that get
    lost make the mean too long, and leave most intervals as they are: near the declared period.
    """
    input_state.mean_interval_s += PERIOD_WEIGHT * (interval_s - input_state.mean_interval_s)
    is_usual = (
        abs(interval_s - input_state.usual_interval_s)
        < USUAL_TOLERANCE * input_state.usual_interval_s
    )
    input_state.usual_share += PERIOD_WEIGHT * (
        (1.0 if is_usual else 0.0) - input_state.usual_share
    )
    if input_state.usual_share < USUAL_TOLERANCE:
        input_state.usual_interval_s = input_state.mean_interval_s
    elif is_usual:
        input_state.usual_interval_s += PERIOD_WEIGHT * (interval_s - input_state.usual_interval_s)
    between_s = 0.5 * (input_state.mean_interval_s + input_state.usual_interval_s)
    lost = input_state.usual_interval_s < between_s and input_state.declared_period_s < between_s
    input_state.period_s = input_state.usual_interval_s if lost else input_state.mean_interval_s
