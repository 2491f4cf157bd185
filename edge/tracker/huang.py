"""The method of the thesis the project began with (Huang 2009, sections 3.4 to 3.7).

Stance is found by the rate about the foot's pitch axis with a least phase time (3.4);
the orientation in stance comes from the low-passed acceleration and the magnetometer, whose
north is true where the place is known (3.5, see ``quasi_static``); velocity and orientation
are reset in stance (3.6); and what is left of velocity and angle at the end of a swing is
taken out of the swing as if constant biases had caused it (3.7).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import Floats, ImuBatch, SensorDescription
from edge.tracker.conditioning import admit_batch, limits_of, new_gate, regular_time
from edge.tracker.huang_stance import follow_pitch_axis, is_stance, pitch_rate
from edge.tracker.huang_state import HUANG, HuangConfig, HuangState
from edge.tracker.port import Quality, Reason, TrackBatch
from edge.tracker.quasi_static import static_orientation, turn_heading
from edge.tracker.rows import join_rows, rows_of
from edge.tracker.state import RING, Ring, reach
from edge.tracker.strapdown import advance, rotation_matrix
from shared.earth_field import EarthField

SLOTS_S = 4.0
MIN_RATE_HZ = 200.0
MIN_STRIDE_M = 0.15
GOOD, DEGRADED, LOST = int(Quality.GOOD), int(Quality.DEGRADED), int(Quality.LOST)
NO_STANCE = int(Reason.NO_STANCE)


class HuangTracker:
    """The original method beside the default tracker, for comparison; see ``Tracker``."""

    def __init__(self, description: SensorDescription, config: HuangConfig | None = None) -> None:
        self.description = description
        self.config = config or HuangConfig()
        self._gate = new_gate(description)
        rate_hz = max(description.rate_hz, MIN_RATE_HZ)
        self._ring = np.zeros(1 << int(np.ceil(np.log2(SLOTS_S * rate_hz))), RING)
        self._limits = limits_of(description, self.config.saturation_ratio)
        self._state = np.zeros(1, HUANG)
        self._state["quaternion_nb"][0, 0] = self._state["reset_quaternion_nb"][0, 0] = 1.0
        self._state["pitch_axis_b"][0] = np.full(3, 3.0**-0.5)
        self._block = len(self._ring) // 4

    def push(self, batch: ImuBatch) -> TrackBatch:
        """Take samples; return the rows that have become final."""
        released = []
        for first in range(0, len(batch), self._block):
            part = batch.part(slice(first, first + self._block))
            received = int(self._state["received"][0])
            admit_batch(self._ring, received, self._gate, self._limits, self.config.gap_s, part)
            self._state["received"] += len(part)
            released.append(self._work(final=False))
        return join_rows(released)

    def learn_field(self, field: EarthField, t_ns: int) -> None:
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
        _turn_to_true_north(state)
    if k == 0:
        static_orientation(ring, state.timed, k, config.low_pass_s, state.declination_rad, state)
        _mark_reset(state, k)
        state.settled = True
        state.in_stance = stance
    if stance and not state.in_stance:
        state.stance_from = k
        state.settled = False
    if not stance and state.in_stance:
        if not state.settled:
            _settle(ring, state, k - 1, config)
        state.swing_from = k - 1
    state.in_stance = stance
    _step(ring, state, k, stance, np.zeros(3), np.zeros(3), config)
    if stance:
        state.last_stance_s = ring[slot].t_s
        wait_from = state.reset_at if state.settled else state.stance_from
        wait_s = config.rest_s if state.settled else config.settle_s
        if ring[slot].t_s - ring[wait_from & (len(ring) - 1)].t_s >= wait_s:
            _settle(ring, state, k, config)
    _write(ring, state, slot, config)


@njit()
def _step(
    ring: Ring,
    state: HuangState,
    k: int,
    still: bool,
    gyro_bias_radps: Floats,
    drift_n_mps2: Floats,
    config: HuangConfig,
) -> None:
    """Strapdown (2.17, 2.20 to 2.24) to sample ``k`` without two biases; a still foot stays."""
    if k == 0:
        return
    mask = len(ring) - 1
    here, before = ring[k & mask], ring[(k - 1) & mask]
    dt_s = here.t_s - before.t_s
    if dt_s <= 0.0 or dt_s > config.gap_s:
        return
    held_n_m = state.position_n_m.copy()
    advance(
        state.position_n_m,
        state.velocity_n_mps,
        state.quaternion_nb,
        state.rotation_nb,
        0.5 * (here.accel_mps2 + before.accel_mps2),
        0.5 * (here.gyro_radps + before.gyro_radps) - gyro_bias_radps,
        config.gravity_mps2,
        dt_s,
        np.zeros(3),
        np.zeros(3),
    )
    for i in range(3):
        if still:
            state.position_n_m[i] = held_n_m[i]
            state.velocity_n_mps[i] = 0.0
        else:
            state.position_n_m[i] -= 0.5 * drift_n_mps2[i] * dt_s * dt_s
            state.velocity_n_mps[i] -= drift_n_mps2[i] * dt_s


@njit()
def _settle(ring: Ring, state: HuangState, k: int, config: HuangConfig) -> None:
    """Reset in the middle of a stance (3.6), and go over the swing again (3.7).

    In the middle the low-passed acceleration sees as much of the braking before as of
    the pushing off after, and they cancel.
    """
    mask = len(ring) - 1
    since_s = ring[k & mask].t_s - ring[state.reset_at & mask].t_s
    tracked = state.quaternion_nb.copy()
    static_orientation(ring, state.timed, k, config.low_pass_s, state.declination_rad, state)
    static = state.quaternion_nb.copy()
    swung = not state.settled and state.stance_from > state.swing_from >= state.reset_at
    if swung and since_s > 0.0 and k - state.reset_at < mask // 2:
        bias_radps = _turn_between(static, tracked) / since_s
        still = np.zeros(3)
        drift_mps = _replay(ring, state, k, bias_radps, still, config)
        swing_s = ring[state.stance_from & mask].t_s - ring[state.swing_from & mask].t_s
        _replay(ring, state, k, bias_radps, drift_mps / swing_s, config)
        _count_stride(state)
    for i in range(4):
        state.quaternion_nb[i] = static[i]
    rotation_matrix(state.quaternion_nb, state.rotation_nb)
    _mark_reset(state, k)
    state.settled = True


@njit()
def _replay(
    ring: Ring,
    state: HuangState,
    last: int,
    gyro_bias_radps: Floats,
    drift_n_mps2: Floats,
    config: HuangConfig,
) -> Floats:
    """Walk again from the last reset to ``last``; return the velocity when the foot came down.

    Rows that are not released yet are written again.
    """
    for i in range(3):
        state.position_n_m[i] = state.reset_position_n_m[i]
        state.velocity_n_mps[i] = 0.0
    for i in range(4):
        state.quaternion_nb[i] = state.reset_quaternion_nb[i]
    down_n_mps = np.zeros(3)
    for k in range(state.reset_at + 1, last + 1):
        still = not state.swing_from < k <= state.stance_from
        _step(ring, state, k, still, gyro_bias_radps, drift_n_mps2, config)
        if k == state.stance_from:
            for i in range(3):
                down_n_mps[i] = state.velocity_n_mps[i]
        if k >= state.released:
            _keep(ring, state, k)
    for i in range(3):
        state.velocity_n_mps[i] = 0.0
    return down_n_mps


@njit()
def _turn_to_true_north(state: HuangState) -> None:
    """Take the declination that was learned; it is no drift of the swing it comes in."""
    turn_rad = state.learned_rad - state.declination_rad
    state.declination_rad = state.learned_rad
    turn_heading(state.quaternion_nb, turn_rad)
    turn_heading(state.reset_quaternion_nb, turn_rad)
    rotation_matrix(state.quaternion_nb, state.rotation_nb)
    north_mps, east_mps = state.velocity_n_mps[0], state.velocity_n_mps[1]
    cosine, sine = np.cos(turn_rad), np.sin(turn_rad)
    state.velocity_n_mps[0] = cosine * north_mps - sine * east_mps
    state.velocity_n_mps[1] = sine * north_mps + cosine * east_mps


@njit()
def _mark_reset(state: HuangState, k: int) -> None:
    state.reset_at = k
    for i in range(3):
        state.reset_position_n_m[i] = state.position_n_m[i]
    for i in range(4):
        state.reset_quaternion_nb[i] = state.quaternion_nb[i]


@njit()
def _turn_between(quaternion_nb: Floats, tracked_nb: Floats) -> Floats:
    """Return the rotation vector (3,), sensor axes, from an attitude to a tracked one."""
    a = quaternion_nb
    b = tracked_nb
    w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
    side = 2.0 if w >= 0.0 else -2.0
    return np.array(
        [
            side * (a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2]),
            side * (a[0] * b[2] + a[1] * b[3] - a[2] * b[0] - a[3] * b[1]),
            side * (a[0] * b[3] - a[1] * b[2] + a[2] * b[1] - a[3] * b[0]),
        ]
    )


@njit()
def _count_stride(state: HuangState) -> None:
    north_m = state.position_n_m[0] - state.foothold_n_m[0]
    east_m = state.position_n_m[1] - state.foothold_n_m[1]
    moved_m = np.sqrt(north_m * north_m + east_m * east_m)
    if moved_m > MIN_STRIDE_M:
        state.steps += 1
        state.distance_m += moved_m
        for i in range(3):
            state.foothold_n_m[i] = state.position_n_m[i]


@njit()
def _keep(ring: Ring, state: HuangState, k: int) -> None:
    """Put position, velocity and attitude into the row of ``k``."""
    row = ring[k & (len(ring) - 1)]
    for i in range(3):
        row.position_n_m[i] = state.position_n_m[i]
        row.velocity_n_mps[i] = state.velocity_n_mps[i]
    for i in range(4):
        row.quaternion_nb[i] = state.quaternion_nb[i]


@njit()
def _write(ring: Ring, state: HuangState, slot: int, config: HuangConfig) -> None:
    row = ring[slot]
    _keep(ring, state, slot)
    std_m = 0.05 + config.error_per_distance * state.distance_m
    for i in range(3):
        for j in range(3):
            row.covariance[i, j] = std_m**2 if i == j else 0.0
    row.heading_std_rad = config.heading_std_rad
    row.magnetic_north_rad = state.declination_rad
    row.magnetic_north_std_rad = np.inf  # believed as it is, and never judged
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
        now_s - ring[state.released & mask].t_s >= config.hold_s
        or k - state.released >= len(ring) // 4
    ):
        state.released += 1
