"""Tracker of a sensor on lower back, hip, chest, in a pocket or a hand (body).

Steps come from the vertical motion, their length from duration and vertical swing, their direction
from the gyroscope, which an optional compass keeps; a covariance of thirteen errors says how far
off all that may be.  See ``steps``, ``step_length``, ``walking_direction`` and ``path_filter``.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.body_places import PLACES, UPPER_BODY
from edge.samples import ImuBatch, SensorDescription
from edge.tracker.body.attitude import learn_bias, step_attitude
from edge.tracker.body.config import HAND, POCKET, TRUNK, UNKNOWN_PLACE, BodyConfig
from edge.tracker.body.height import low_pass_pressure, take_height
from edge.tracker.body.path_filter import (
    low_pass_field,
    propagate_heading,
    propagate_step,
    start_path,
    step_std,
    update_by_compass,
    widen_by_unseen_motion,
)
from edge.tracker.body.released_rows import release_to, spread_step
from edge.tracker.body.state import (
    BODY,
    HEADING,
    SCALE,
    TICK,
    TICK_S,
    TICKS,
    TRAIL,
    BodyState,
    Ticks,
    Trail,
)
from edge.tracker.body.step_doubt import step_doubt_m, take_doubt
from edge.tracker.body.step_length import step_length
from edge.tracker.body.steps import begins_to_rise
from edge.tracker.body.thigh_swing import recognise_thigh, swing_rate
from edge.tracker.body.ticks import low_pass, next_tick
from edge.tracker.body.walking_direction import take_direction
from edge.tracker.interface import StepScale, TrackBatch
from edge.tracker.preprocessing.preprocess import limits_of, new_input_state, preprocess_batch
from edge.tracker.preprocessing.sample_ring import Ring, new_ring, reach, span
from edge.tracker.preprocessing.sample_times import regular_time
from edge.tracker.track_rows import join_rows, rows_of
from shared.earth_field import EarthField
from shared.path_noise import PathNoise

_PLACES = {"waist": TRUNK, "hip": TRUNK, "chest": TRUNK, "hand": HAND, "pocket": POCKET}


class BodyTracker:
    """Tracker by steps and heading, for any place but the foot; see ``Tracker``."""

    def __init__(self, description: SensorDescription, config: BodyConfig | None = None) -> None:
        self.description = description
        self.config = config or BodyConfig(place=_place_of(description))
        self._gate = new_input_state(description, self.config.saturation_ratio)
        self._ring = new_ring(description.rate_hz)
        self._trail = np.zeros(len(self._ring), TRAIL)
        self._ticks = np.zeros(TICKS, TICK)
        self._limits = limits_of(description)
        self._state = np.zeros(1, BODY)
        self._state["quaternion_nb"][0, 0] = 1.0
        self._state["event_s"] = self._state["fault_s"] = -np.inf
        self._state["in_hand"] = self.config.place == HAND
        self._state["in_pocket"] = self.config.place == POCKET
        gain_std, bias_std_radps = description.gain_std, description.gyro_bias_std_radps
        start_path(
            self._state[0],
            _iron_std_ut(description, self.config),
            self.config.gain_std if gain_std is None else gain_std,
            self.config.first_bias_std_radps if bias_std_radps is None else bias_std_radps,
            self.config,
        )
        self._scale_std = self.config.scale_std

    def set_step_scale(self, scale: StepScale) -> None:
        """Start with the scale of a person; see ``ScaledByPerson``."""
        self._scale_std = scale.std
        self._state["estimate"][0, SCALE] = scale.factor - 1.0
        self._state["covariance"][0, SCALE, SCALE] = scale.std**2

    @property
    def path_noise(self) -> PathNoise:
        """Process noise as of ``path_filter``, whose random walks go by steps and by time."""
        config = self.config
        return PathNoise(
            scale_std=self._scale_std,
            place_std_m_per_sqrt_m=step_std(self._state[0], config)
            * math.sqrt(config.usual_step_m),
            turn_std_rad_per_sqrt_m=config.heading_walk_rad / math.sqrt(config.usual_speed_mps),
        )

    def push(self, batch: ImuBatch) -> TrackBatch:
        """Take samples; return the rows that have become final."""
        parts = preprocess_batch(
            self._ring, self._state, self._gate, self._limits, self.config.gap_s, batch
        )
        return join_rows([self._work(final=lacks_good_samples) for lacks_good_samples in parts])

    def set_earth_field(self, field: EarthField, t_ns: int) -> None:
        """From then on a field that is not as strong as the earth's is not used for the heading."""
        strength_ut = math.hypot(field.horizontal_ut, field.down_ut)
        self._state["learned_ut"], self._state["learned_from_ns"] = strength_ut, t_ns

    def finish(self) -> TrackBatch:
        """Return the rows still held back; the tracker is used up."""
        return self._work(final=True)

    def _work(self, *, final: bool) -> TrackBatch:
        first = int(self._state["released"][0])
        stop = walk(self._ring, self._trail, self._ticks, self._state, self.config, final)
        return rows_of(self._ring, first, stop)


def _place_of(description: SensorDescription) -> int:
    """Return the place by the description; by motion only upper body and leg are distinguished."""
    if description.place == UPPER_BODY:
        return UNKNOWN_PLACE
    return _PLACES.get(PLACES.get(description.place, ""), UNKNOWN_PLACE)


def _iron_std_ut(description: SensorDescription, config: BodyConfig) -> float:
    """Iron on the person, an axis: by the calibration, or by what is usual without one."""
    left_ut = description.mag_iron_std_ut
    return config.iron_std_ut if left_ut is None else max(left_ut, config.iron_least_ut)


@njit(cache=True)
def walk(
    ring: Ring,
    trail: Trail,
    ticks: Ticks,
    states: NDArray[Any],
    config: BodyConfig,
    final: bool,
) -> int:
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
        _take(ring, trail, ticks, state, k, config)
        state.walked = k + 1
        _release_old(ring, trail, state, k, config)
    if final:
        release_to(ring, trail, state, state.walked, config)
    return int(state.released)


@njit()
def _take(
    ring: Ring, trail: Trail, ticks: Ticks, state: BodyState, k: int, config: BodyConfig
) -> None:
    slot = k & (len(ring) - 1)
    sample = ring[slot]
    if state.learned_ut != state.earth_ut and sample.t_ns >= state.learned_from_ns:
        state.earth_ut = state.learned_ut
    state.before_rad = state.heading_rad
    dt_s = step_attitude(ring, state, k, config)
    state.sample_swing_radps = swing_rate(state, sample)
    low_pass(state, dt_s, config)
    low_pass_field(state, sample.mag_ut, dt_s, config)
    low_pass_pressure(state, sample.pressure_pa, dt_s)
    before_s = ring[(k - 1) & (len(ring) - 1)].t_s if k else 0.0
    while next_tick(ticks, state, before_s, sample.t_s, config):
        learn_bias(ring, state, k, config)
        propagate_heading(state, config)
        began_s = begins_to_rise(ticks, state, config)
        if began_s >= 0.0:
            _end_swing(ring, trail, ticks, state, k, began_s, config)
        _watch_motion(state, sample.t_s, config)
    update_by_compass(state, sample.t_s, config)
    take_height(state)
    for i in range(4):
        sample.quaternion_nb[i] = state.quaternion_nb[i]
    trail[slot].heading_rad = state.heading_rad - state.estimate[HEADING]
    trail[slot].speed_mps = 0.0
    trail[slot].down_m = state.down_m
    if sample.flags:
        state.fault_s, state.faults = sample.t_s, sample.flags


@njit()
def _end_swing(
    ring: Ring,
    trail: Trail,
    ticks: Ticks,
    state: BodyState,
    k: int,
    now_s: float,
    config: BodyConfig,
) -> None:
    """Count the swing that ends now as a step, unless it stands alone; two begin a walk."""
    from_s, state.event_s = state.event_s, now_s
    step_s = now_s - from_s
    if step_s > config.longest_step_s:
        state.swings = 0
        return
    take_direction(ticks, state, from_s, now_s, config)
    recognise_thigh(ticks, state, from_s, now_s, config)
    scale = 1.0 + state.estimate[SCALE]
    length_m = scale * step_length(ticks, state, from_s, now_s, config)
    doubt_m = step_doubt_m(state, step_s, length_m, config)
    # The first foot goes before the first swing; how far is known when the walk goes on.
    state.swings += 1
    steps = 2 if state.swings == 2 else 1
    state.moving_s = 0.0
    state.step_count += steps
    heading_rad = trail[(k - 1) & (len(ring) - 1)].heading_rad if k else 0.0
    for _ in range(steps):
        propagate_step(state, length_m, heading_rad, config)
        take_doubt(state, doubt_m, heading_rad)
    spread_step(ring, trail, state, k, from_s, now_s, steps * length_m)
    release_to(ring, trail, state, k, config)


@njit()
def _watch_motion(state: BodyState, now_s: float, config: BodyConfig) -> None:
    """Motion for longer than a step may last, and no step: a crawl, a climb, or a vehicle."""
    if now_s - state.event_s > config.longest_step_s:
        state.swings = 0
    if state.quiet_s >= config.unseen.rest_s:
        state.moving_s = 0.0
    if state.quiet_s >= config.rest_s:
        return
    state.moving_s += TICK_S
    widen_by_unseen_motion(state, config)


@njit()
def _release_old(ring: Ring, trail: Trail, state: BodyState, k: int, config: BodyConfig) -> None:
    """Let go what has waited for a step for too long."""
    mask = len(ring) - 1
    stop = state.released
    now_s = ring[k & mask].t_s
    while stop <= k and (now_s - ring[stop & mask].t_s >= config.hold_s or k - stop >= span(ring)):
        stop += 1
    release_to(ring, trail, state, stop, config)
