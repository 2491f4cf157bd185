"""Default tracker: the loop that takes every sample through all stages, as far as each can go.

Stages follow each other at a distance of some samples to half a second: input checks
(``preprocess``), spike rejection, regular times, stillness statistic, filter (``stages``),
smoothing and release.  Every stage looks at sample numbers and sample times only, so the rows do
not depend on how samples arrive in batches.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.filter.correction_tracking import clone_reference
from edge.tracker.foot.filter.reinitialisation import is_long_gap, needs_reinitialisation
from edge.tracker.foot.output.smoothing import smooth
from edge.tracker.foot.preprocessing.similar_strides import find_similar_strides
from edge.tracker.foot.preprocessing.spike_rejection import SPIKE_NEIGHBOURS, reject_spike
from edge.tracker.foot.stages import filter_sample
from edge.tracker.foot.state import (
    STEP,
    FilterState,
    Progress,
    Trail,
    new_filter_state,
    new_progress,
)
from edge.tracker.foot.zupt.stance_detection import add_readings, measure_motion, stride_minimum
from edge.tracker.interface import TrackBatch
from edge.tracker.preprocessing.preprocess import limits_of, new_input_state, preprocess_batch
from edge.tracker.preprocessing.sample_ring import Ring, new_ring, reach, span
from edge.tracker.preprocessing.sample_times import regular_time
from edge.tracker.track_rows import join_rows, rows_of
from shared.earth_field import EarthField
from shared.path_noise import PathNoise

KEPT_LAG_SHARE = 0.66  # a release in swing keeps rows younger than this share of the lag


class EskfTracker:
    """Error-state filter (error_model.py) for a sensor anywhere on the foot; see ``Tracker``."""

    path_noise: PathNoise | None = None  # a foot's, which is the usual one

    def __init__(self, description: SensorDescription, config: EskfConfig | None = None) -> None:
        self.description = description
        self.config = config or EskfConfig()
        self._gate = new_input_state(description, self.config.output.saturation_ratio)
        self._ring = new_ring(description.rate_hz)
        self._progress = new_progress()
        self._limits = limits_of(description)
        self._progress["rest_norm_mps2"] = self.config.gravity_mps2
        self._state = new_filter_state()
        self._trail = np.zeros(span(self._ring), STEP)
        self._parameters = config_record(self.config)
        self._state["scale_errors"]["std"] = gain_std(description, self.config)
        self._state["scale_errors"]["least_share"] = least_gain_share(description, self.config)
        self._state["unobserved_bias_std_radps"] = unobserved_bias_std_radps(
            description, self.config
        )
        self._state["compass"]["calibrated"] = description.mag_iron_std_ut is not None
        self._state["compass"]["iron_std_ut"] = iron_std_ut(description, self.config)

    def push(self, batch: ImuBatch) -> TrackBatch:
        """Take samples; return the rows that have become final."""
        released = []
        for lacks_good_samples in preprocess_batch(
            self._ring, self._progress, self._gate, self._limits, self.config.timing.gap_s, batch
        ):
            rows = self._work(final=lacks_good_samples)
            if len(rows):
                released.append(rows)
        return join_rows(released)

    def set_earth_field(self, field: EarthField, t_ns: int) -> None:
        """Set the earth's field, whose strength and dip show how distorted the field around here
        is.

        A calibrated magnetometer knows directions; its scale is that of its calibration.
        """
        earth_ut = math.hypot(field.horizontal_ut, field.down_ut)
        shown_ut = self.description.mag_earth_ut
        scale = 1.0 if shown_ut is None else shown_ut / earth_ut
        compass = self._state["compass"]
        compass["earth_known"], compass["earth_from_ns"] = True, t_ns
        compass["earth_horizontal_ut"] = scale * field.horizontal_ut
        compass["earth_down_ut"] = scale * field.down_ut

    def finish(self) -> TrackBatch:
        """Return the rows still held back; the tracker is used up."""
        return self._work(final=True)

    def _work(self, *, final: bool) -> TrackBatch:
        first = int(self._progress["released"][0])
        stop = work(self._ring, self._trail, self._progress, self._state, self._parameters, final)
        return rows_of(self._ring, first, stop)


def gain_std(description: SensorDescription, config: EskfConfig) -> float:
    """Standard deviation of scale and axis errors: as described, else that of a data sheet."""
    left = description.gain_std
    return config.start.data_sheet_gain_std if left is None else left


def least_gain_share(description: SensorDescription, config: EskfConfig) -> float:
    """Share of the gains' variance that is reported of the best sensor: all where described."""
    described = description.gain_std is not None
    return (
        1.0
        if described
        else (config.residuals.least_gain_std / config.start.data_sheet_gain_std) ** 2
    )


def unobserved_bias_std_radps(description: SensorDescription, config: EskfConfig) -> float:
    """Standard deviation of the gyroscope's bias before a rest, beyond what the filter expects."""
    described_radps = description.gyro_bias_std_radps
    if described_radps is not None:
        return described_radps if described_radps > config.start.gyro_bias_std_radps else 0.0
    return config.start.data_sheet_bias_std_radps if description.gain_std is None else 0.0


def iron_std_ut(description: SensorDescription, config: EskfConfig) -> float:
    """Standard deviation of the field of iron on the foot; a calibration does not know today's
    shoe.
    """
    left_ut = description.mag_iron_std_ut
    return config.field.iron_std_ut if left_ut is None else max(left_ut, config.field.iron_least_ut)


@njit(cache=True)
def work(
    ring: Ring,
    trail: Trail,
    progress: NDArray[Any],
    state: NDArray[Any],
    parameters: NDArray[Any],
    final: bool,
) -> int:
    """Take every sample as far as it can go; return one past the last released row."""
    memory, config = progress[0], parameters[0]
    while memory.cleaned < memory.received - SPIKE_NEIGHBOURS:
        reject_spike(ring, memory.cleaned)
        memory.cleaned += 1
    if final:
        memory.cleaned = memory.received
    while memory.timed < memory.cleaned:
        k = memory.timed
        if not final and not _has_arrived(ring, memory.cleaned, k, config):
            break
        slot = k & (len(ring) - 1)
        stop = min(memory.cleaned, reach(ring, k))
        ring[slot].t_s = regular_time(ring, k, stop, config.timing.late_delivery_s)
        add_readings(ring, k)
        memory.timed = k + 1
    while memory.measured < memory.timed:
        k = memory.measured
        if not final and not _is_past(ring, memory.timed, k, config.detection.half_window_s):
            break
        measure_motion(ring, memory, k, config)
        memory.measured = k + 1
    while memory.filtered < memory.measured:
        k = memory.filtered
        if is_long_gap(ring, k, config):
            _release_all(ring, trail, memory, state[0])
        if not final and not _is_past(ring, memory.measured, k, config.timing.lookahead_s):
            break
        find_similar_strides(ring, memory, k, config)
        begins = needs_reinitialisation(ring, memory, k, config)
        ahead_s = config.timing.lookahead_s + config.timing.lag_s
        if begins and not final and not _is_past(ring, memory.measured, k, ahead_s):
            break
        slot = k & (len(ring) - 1)
        if begins:
            _release_all(ring, trail, memory, state[0])
            memory.began_at, memory.began_s = k, ring[slot].t_s
        ring[slot].stride_minimum_m2ps4 = stride_minimum(ring, memory, k, config)
        filter_sample(ring, trail, memory, state[0], k, config)
        memory.filtered = k + 1
        _release(ring, trail, memory, state[0], k, config)
    if final:
        _release_all(ring, trail, memory, state[0])
    return int(memory.released)


@njit()
def _has_arrived(ring: Ring, count: int, k: int, config: EskfConfig) -> bool:
    """True when all samples are there that can correct the time of ``k``."""
    mask = len(ring) - 1
    since_s = ring[(count - 1) & mask].arrival_s - ring[k & mask].arrival_s
    return since_s > config.timing.late_delivery_s or count >= reach(ring, k)


@njit()
def _is_past(ring: Ring, count: int, k: int, wait_s: float) -> bool:
    """True when samples up to ``wait_s`` after ``k`` are there, or the ring cannot hold more."""
    mask = len(ring) - 1
    return ring[(count - 1) & mask].t_s - ring[k & mask].t_s > wait_s or count >= reach(ring, k)


@njit()
def _release_all(ring: Ring, trail: Trail, memory: Progress, state: FilterState) -> None:
    """Release every filtered row: later samples cannot improve it."""
    if memory.released < memory.filtered:
        _finish(ring, trail, memory, state, memory.filtered, memory.filtered - 1)


@njit()
def _release(
    ring: Ring, trail: Trail, memory: Progress, state: FilterState, k: int, config: EskfConfig
) -> None:
    """Smooth and release rows once sample ``k`` is filtered.

    Firm stance adds little to what is known of the rows before it, so they go at
    once; a long swing is released from its old end when the lag is used up.
    """
    mask = len(ring) - 1
    now_s = ring[k & mask].t_s
    first = memory.released
    stop = first
    if memory.in_stance and now_s - memory.stance_since_s >= config.timing.stance_release_s:
        memory.stance_since_s = now_s
        stop = k + 1
    elif now_s - ring[first & mask].t_s >= config.timing.lag_s or k - first >= len(trail) - 1:
        while stop <= k and now_s - ring[stop & mask].t_s >= KEPT_LAG_SHARE * config.timing.lag_s:
            stop += 1
        stop = max(stop, first + 1)
    if stop > first:
        _finish(ring, trail, memory, state, stop, k)


@njit()
def _finish(
    ring: Ring, trail: Trail, memory: Progress, state: FilterState, stop: int, last: int
) -> None:
    """Smooth the rows before ``stop`` that are still held back, with everything measured up to
    ``last``.
    """
    clone = state.clone
    for k in range(memory.released, stop):
        row = ring[k & (len(ring) - 1)]
        row.past_turn_rad = clone.turn_rad
        for i in range(2):
            row.past_shift_n_m[i] = clone.shift_n_m[i]
    if stop > last:
        clone_reference(state)
    smooth(ring, trail, memory.released, stop, last)
    memory.released = stop
