"""Tracker by the method of the thesis the project began with (Huang 2009, sections 3.4 to 3.7).

Stance is detected by the rate about the foot's pitch axis with a minimum phase time (3.4); the
orientation in stance comes from the low-passed acceleration and the magnetometer, whose north is
true where the place is known (3.5, see ``quasi_static``); each stance resets velocity and
orientation and removes the drift from the swing before it (3.6 and 3.7, see ``swing``).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.huang.stance import follow_pitch_axis, is_stance, pitch_rate
from edge.tracker.huang.state import HUANG, HuangConfig, HuangState
from edge.tracker.huang.swing import (
    keep_row,
    mark_reset,
    remove_swing_drift,
    step,
    turn_to_true_north,
)
from edge.tracker.interface import Quality, Reason, TrackBatch
from edge.tracker.mechanization.quasi_static import static_orientation
from edge.tracker.preprocessing.preprocess import limits_of, new_input_state, preprocess_batch
from edge.tracker.preprocessing.sample_ring import Ring, new_ring, reach, span
from edge.tracker.preprocessing.sample_times import regular_time
from edge.tracker.track_rows import join_rows, rows_of
from shared.earth_field import EarthField
from shared.path_noise import PathNoise

GOOD, DEGRADED, LOST = int(Quality.GOOD), int(Quality.DEGRADED), int(Quality.LOST)
NO_STANCE = int(Reason.NO_STANCE)


class HuangTracker:
    """The original method beside the default tracker, for comparison; see ``Tracker``."""

    path_noise: PathNoise | None = None  # a foot's, which is the usual one

    def __init__(self, description: SensorDescription, config: HuangConfig | None = None) -> None:
        self.description = description
        self.config = config or HuangConfig()
        self._gate = new_input_state(description, self.config.saturation_ratio)
        self._ring = new_ring(description.rate_hz)
        self._limits = limits_of(description)
        self._state = np.zeros(1, HUANG)
        self._state["quaternion_nb"][0, 0] = self._state["reset_quaternion_nb"][0, 0] = 1.0
        self._state["pitch_axis_b"][0] = np.full(3, 3.0**-0.5)

    def push(self, batch: ImuBatch) -> TrackBatch:
        """Take samples; return the rows that have become final."""
        parts = preprocess_batch(
            self._ring, self._state, self._gate, self._limits, self.config.gap_s, batch
        )
        return join_rows([self._work(final=lacks_good_samples) for lacks_good_samples in parts])

    def set_earth_field(self, field: EarthField, t_ns: int) -> None:
        """From then on headings are true; what was walked before stays as it was."""
        self._state["learned_rad"], self._state["learned_from_ns"] = field.declination_rad, t_ns

    def finish(self) -> TrackBatch:
        """Return the rows still held back; the tracker is used up."""
        return self._work(final=True)

    def _work(self, *, final: bool) -> TrackBatch:
        first = int(self._state["released"][0])
        stop = walk(self._ring, self._state, self.config, final)
        return rows_of(self._ring, first, stop)


@njit(cache=True)
def walk(ring: Ring, states: NDArray[Any], config: HuangConfig, final: bool) -> int:
    """Take every sample as far as it can go; return one past the last released row."""
    state = states[0]
    mask = len(ring) - 1
    while state.timed < state.received:
        k = state.timed
        since_s = ring[(state.received - 1) & mask].arrival_s - ring[k & mask].arrival_s
        if not final and since_s <= config.late_delivery_s and state.received < reach(ring, k):
            break
        stop = min(state.received, reach(ring, k))
        ring[k & mask].t_s = regular_time(ring, k, stop, config.late_delivery_s)
        state.timed = k + 1
    while state.walked < state.timed:
        k = state.walked
        since_s = ring[(state.timed - 1) & mask].t_s - ring[k & mask].t_s
        if not final and since_s <= config.lookahead_s and state.timed < reach(ring, k):
            break
        _take(ring, state, k, config)
        state.walked = k + 1
        _release(ring, state, k, config)
    if final:
        state.released = state.walked
    return int(state.released)


@njit()
def _take(ring: Ring, state: HuangState, k: int, config: HuangConfig) -> None:
    slot = k & (len(ring) - 1)
    follow_pitch_axis(ring, state, k, config)
    ring[slot].motion_m2ps4 = pitch_rate(ring, state, k)
    stance = is_stance(ring, state, k, config)
    if state.learned_rad != state.declination_rad and ring[slot].t_ns >= state.learned_from_ns:
        turn_to_true_north(state)
    if k == 0:
        static_orientation(ring, state.timed, k, config.low_pass_s, state.declination_rad, state)
        mark_reset(state, k)
        state.settled = True
        state.in_stance = stance
    if stance and not state.in_stance:
        state.stance_from = k
        state.settled = False
    if not stance and state.in_stance:
        if not state.settled:
            remove_swing_drift(ring, state, k - 1, config)
        state.swing_from = k - 1
    state.in_stance = stance
    step(ring, state, k, stance, np.zeros(3), np.zeros(3), config)
    if stance:
        state.last_stance_s = ring[slot].t_s
        wait_from = state.reset_at if state.settled else state.stance_from
        wait_s = config.rest_s if state.settled else config.settle_s
        if ring[slot].t_s - ring[wait_from & (len(ring) - 1)].t_s >= wait_s:
            remove_swing_drift(ring, state, k, config)
    _write(ring, state, slot, config)


@njit()
def _write(ring: Ring, state: HuangState, slot: int, config: HuangConfig) -> None:
    row = ring[slot]
    keep_row(ring, state, slot)
    std_m = 0.05 + config.error_per_distance * state.distance_m
    for i in range(3):
        for j in range(3):
            row.position_cov_m2[i, j] = std_m**2 if i == j else 0.0
    row.heading_std_rad = config.heading_std_rad
    row.magnetic_north_rad = state.declination_rad
    row.magnetic_north_std_rad = np.inf  # used as it is, and never evaluated
    row.stationary = state.in_stance
    row.distance_m = state.distance_m
    row.steps = state.steps
    reasons = row.flags
    unseen_s = row.t_s - state.last_stance_s
    if unseen_s > config.no_stance_s:
        reasons |= NO_STANCE
    row.reasons = reasons
    row.quality = GOOD if reasons == 0 else DEGRADED
    if unseen_s > 3.0 * config.no_stance_s:
        row.quality = LOST


@njit()
def _release(ring: Ring, state: HuangState, k: int, config: HuangConfig) -> None:
    """Rows go once their stance is settled, or when they have been held too long."""
    mask = len(ring) - 1
    if state.in_stance and state.settled:
        state.released = k + 1
        return
    now_s = ring[k & mask].t_s
    while state.released <= k and (
        now_s - ring[state.released & mask].t_s >= config.hold_s or k - state.released >= span(ring)
    ):
        state.released += 1
