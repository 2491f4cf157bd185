"""The default tracker: error-state filter, stride-adaptive stance, fixed-lag smoothing.

Samples pass through stages, each a few samples to half a second behind the one
before: admitted, cleaned of spikes, put in time, measured for stillness, filtered, smoothed and
released.  Every stage looks at sample numbers and sample times only, so the rows
do not depend on how the samples were batched.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.conditioning import admit_parts, limits_of, new_gate, regular_time
from edge.tracker.config import EskfConfig, config_record
from edge.tracker.filter import filter_sample
from edge.tracker.gaps import begins_anew, is_too_long
from edge.tracker.like_strides import seek_like_strides
from edge.tracker.past import hold_past
from edge.tracker.port import TrackBatch
from edge.tracker.rows import join_rows, rows_of
from edge.tracker.smoothing import smooth
from edge.tracker.spikes import AROUND, leave_out_spike
from edge.tracker.state import (
    RING,
    STEP,
    FilterState,
    Progress,
    Ring,
    Trail,
    new_filter_state,
    new_progress,
    reach,
    span,
)
from edge.tracker.zero_velocity import measure_motion, stride_minimum
from shared.earth_field import EarthField

RING_S = 8.0  # of samples in the ring at the described rate: some strides
MIN_RING_HZ = 200.0  # room for a description that understates the rate
KEEP_OF_LAG = 0.66  # a release in swing keeps rows younger than this share of the lag


class EskfTracker:
    """Error-state filter (error_model.py) for a sensor anywhere on the foot; see ``Tracker``."""

    def __init__(self, description: SensorDescription, config: EskfConfig | None = None) -> None:
        self.description = description
        self.config = config or EskfConfig()
        self._gate = new_gate(description, self.config.saturation_ratio)
        rate_hz = max(description.rate_hz, MIN_RING_HZ)
        slots = 1 << int(np.ceil(np.log2(RING_S * rate_hz)))
        self._ring = np.zeros(slots, RING)
        self._progress = new_progress()
        self._limits = limits_of(description)
        self._progress["rest_norm_mps2"] = self.config.gravity_mps2
        self._state = new_filter_state()
        self._trail = np.zeros(span(self._ring), STEP)
        self._parameters = config_record(self.config)
        self._state["gains"]["std"] = gain_std(description, self.config)
        self._state["unshown_bias_std_radps"] = unshown_bias_std_radps(description, self.config)
        self._state["compass"]["calibrated"] = description.mag_iron_std_ut is not None
        self._state["compass"]["iron_std_ut"] = iron_std_ut(description, self.config)

    def push(self, batch: ImuBatch) -> TrackBatch:
        """Take samples; return the rows that have become final."""
        released = []
        for gives_up in admit_parts(
            self._ring, self._progress, self._gate, self._limits, self.config.gap_s, batch
        ):
            rows = self._work(final=gives_up)
            if len(rows):
                released.append(rows)
        return join_rows(released)

    def learn_field(self, field: EarthField, t_ns: int) -> None:
        """Strength and dip tell how far the field around here is to be trusted.

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
    """How far scale and axes may be off."""
    left = description.gain_std
    return config.data_sheet_gain_std if left is None else left


def unshown_bias_std_radps(description: SensorDescription, config: EskfConfig) -> float:
    """How far the gyroscope's bias may be off before a rest, beyond what the filter expects."""
    return config.data_sheet_bias_std_radps if description.gain_std is None else 0.0


def iron_std_ut(description: SensorDescription, config: EskfConfig) -> float:
    """How much iron there may be on the foot; a calibration is not of today's shoe."""
    left_ut = description.mag_iron_std_ut
    return config.field_iron_std_ut if left_ut is None else max(left_ut, config.field_iron_least_ut)


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
    while memory.cleaned < memory.received - AROUND:
        leave_out_spike(ring, memory.cleaned)
        memory.cleaned += 1
    if final:
        memory.cleaned = memory.received
    while memory.timed < memory.cleaned:
        k = memory.timed
        if not final and not _has_arrived(ring, memory.cleaned, k, config):
            break
        slot = k & (len(ring) - 1)
        stop = min(memory.cleaned, reach(ring, k))
        ring[slot].t_s = regular_time(ring, k, stop, config.late_delivery_s)
        memory.timed = k + 1
    while memory.measured < memory.timed:
        k = memory.measured
        if not final and not _is_past(ring, memory.timed, k, config.half_window_s):
            break
        measure_motion(ring, memory, k, config)
        memory.measured = k + 1
    while memory.filtered < memory.measured:
        k = memory.filtered
        if is_too_long(ring, k, config):
            _release_all(ring, trail, memory, state[0])
        if not final and not _is_past(ring, memory.measured, k, config.lookahead_s):
            break
        seek_like_strides(ring, memory, k, config)
        begins = begins_anew(ring, memory, k, config)
        ahead_s = config.lookahead_s + config.lag_s
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
    """Whether all samples are there that can put the time of ``k`` right."""
    mask = len(ring) - 1
    since_s = ring[(count - 1) & mask].arrival_s - ring[k & mask].arrival_s
    return since_s > config.late_delivery_s or count >= reach(ring, k)


@njit()
def _is_past(ring: Ring, count: int, k: int, wait_s: float) -> bool:
    """Whether samples up to ``wait_s`` after ``k`` are there, or the ring cannot hold more."""
    mask = len(ring) - 1
    return ring[(count - 1) & mask].t_s - ring[k & mask].t_s > wait_s or count >= reach(ring, k)


@njit()
def _release_all(ring: Ring, trail: Trail, memory: Progress, state: FilterState) -> None:
    """Release every row that is filtered: what comes tells nothing of them."""
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
    if memory.in_stance and now_s - memory.stance_since_s >= config.stance_release_s:
        memory.stance_since_s = now_s
        stop = k + 1
    elif now_s - ring[first & mask].t_s >= config.lag_s or k - first >= len(trail) - 1:
        while stop <= k and now_s - ring[stop & mask].t_s >= KEEP_OF_LAG * config.lag_s:
            stop += 1
        stop = max(stop, first + 1)
    if stop > first:
        _finish(ring, trail, memory, state, stop, k)


@njit()
def _finish(
    ring: Ring, trail: Trail, memory: Progress, state: FilterState, stop: int, last: int
) -> None:
    """Smooth the rows before ``stop`` that are still held back, by all that ``last`` tells."""
    past = state.past
    for k in range(memory.released, stop):
        row = ring[k & (len(ring) - 1)]
        row.past_turn_rad = past.turn_rad
        for i in range(2):
            row.past_shift_n_m[i] = past.shift_n_m[i]
    if stop > last:
        hold_past(state)
    smooth(ring, trail, memory.released, stop, last)
    memory.released = stop
