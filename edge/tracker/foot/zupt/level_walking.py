"""Level constraint: a footfall that rises less than a stair is on the level of the one before.

People in buildings walk on level floors most of the time, and an inertial height drifts by a
centimetre or two a stride.  A long stride may rise more, as far as no stairs are that shallow.  A
stride that rises more than that is a stair or a kerb and starts a new level.  Strides that all rise
a little, by more than the filter can explain itself, are a ramp: then the constraint stops and
gives back what it took out.

On the level, strides of recorded walks seem to rise or sink by up to 2 cm, by a bias of each person
and sensor, and more the less the sensor is calibrated.  What of that remains on stairs is not known
(simulated, a correction by it does more harm than good), and it adds up from stride to stride, and
so does the reported height.  Nor is it known whether what the constraint takes out all the time is
bias or a gentle ramp, so a part of that is reported too, unless a barometer shows which.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import POSITION, SIZE
from edge.tracker.foot.filter.correction_tracking import decorrelate_clone
from edge.tracker.foot.filter.measurement_update import remember
from edge.tracker.foot.state import FilterState, Progress, Step
from edge.tracker.preprocessing.sample_ring import Ring, reach, span

DOWN = POSITION + 2


@njit()
def is_due(ring: Ring, progress: Progress, k: int, config: EskfConfig) -> bool:
    """True at the stillest sample of a stance, unless the floor has just been looked at."""
    mask = len(ring) - 1
    now_s, motion_m2ps4 = ring[k & mask].t_s, ring[k & mask].motion_m2ps4
    if progress.on_floor and now_s - progress.footfall_s < config.floor.pause_s:
        return False
    reach_s = 0.5 * config.floor.pause_s
    for i in range(k + 1, min(progress.measured, reach(ring, k))):
        if ring[i & mask].t_s - now_s > reach_s:
            break
        if ring[i & mask].motion_m2ps4 < motion_m2ps4:
            return False
    for i in range(k - 1, max(k - span(ring), -1), -1):
        if now_s - ring[i & mask].t_s > reach_s:
            break
        if ring[i & mask].motion_m2ps4 < motion_m2ps4:
            return False
    return True


@njit()
def apply_level_constraint(
    ring: Ring, step: Step, progress: Progress, state: FilterState, slot: int, config: EskfConfig
) -> None:
    """Apply the constraint at a stance; see ``is_due``."""
    if not progress.on_floor:
        progress.on_floor = True
        _enter_level(progress, state)
    elif _is_flat(progress, state, config):
        _hold_height(step, progress, state, config)
    else:
        _climb(progress, state, config)
    for i in range(3):
        progress.footfall_n_m[i] = state.position_n_m[i]
    progress.footfall_s = ring[slot].t_s
    progress.footfall_variance_m2 = state.covariance[DOWN, DOWN]
    if not state.barometer.started:
        state.ramp_var_m2 = progress.past_ramps_m2 + _ramp_variance(progress, config)


@njit()
def _is_flat(progress: Progress, state: FilterState, config: EskfConfig) -> bool:
    north_m = state.position_n_m[0] - progress.footfall_n_m[0]
    east_m = state.position_n_m[1] - progress.footfall_n_m[1]
    stride_m = math.sqrt(north_m * north_m + east_m * east_m)
    sink_m = state.position_n_m[2] - progress.footfall_n_m[2]
    std_m = _rise_std_m(progress, state)
    least_m = max(config.floor.gate_m, config.floor.gate_stds * std_m)  # that is no error
    if abs(sink_m) >= max(least_m, config.floor.gate_slope * stride_m):
        if progress.ramp_evidence_m * sink_m < 0.0:
            progress.ramp_withheld_m = 0.0
        progress.ramp_evidence_m = 0.0
        progress.mean_sink_m = 0.0
        return False
    if stride_m <= config.floor.gate_m and not progress.level_constraint_suspended:
        return True  # a foot that stays where it is shows no ramp
    progress.mean_sink_m += (sink_m - progress.mean_sink_m) / config.floor.ramp_strides
    if _is_ramp(progress, sink_m, 0.5 * least_m, config):
        return False
    if progress.level_constraint_suspended:
        progress.ramp_withheld_m = progress.withheld_m
        return False
    progress.flat_strides = min(progress.flat_strides + 1.0, config.floor.rise_bias_strides)
    progress.rise_bias_m += (sink_m - progress.rise_bias_m) / progress.flat_strides
    return True


@njit()
def _rise_std_m(progress: Progress, state: FilterState) -> float:
    """Return how well the filter knows the rise of the stride before this stance."""
    return math.sqrt(max(state.covariance[DOWN, DOWN] - progress.footfall_variance_m2, 0.0))


@njit()
def _is_ramp(progress: Progress, sink_m: float, usual_m: float, config: EskfConfig) -> bool:
    """True where the strides up to this one sink or rise by more than ``usual_m`` each.

    Page's cumulative sum ("Continuous inspection schemes", 1954): a ramp began where the sum was
    last nought.  The sum goes no higher than it has to, or the floor after a ramp would be one.
    """
    total_m = progress.ramp_evidence_m + sink_m
    evidence_m = max(abs(total_m) - usual_m, 0.0)
    enough_m = config.floor.ramp_strides * usual_m
    progress.ramp_evidence_m = math.copysign(min(evidence_m, enough_m), total_m)
    if evidence_m == 0.0:
        progress.ramp_withheld_m = 0.0
    return bool(evidence_m >= enough_m)


@njit()
def _hold_height(step: Step, progress: Progress, state: FilterState, config: EskfConfig) -> None:
    off_m = progress.level_m - state.position_n_m[2]
    variance_m2 = config.floor.std_m**2 + progress.level_variance_m2
    taken_m = _measure_height_only(step, state, off_m, variance_m2)
    if off_m * progress.withheld_m < 0.0:
        progress.past_ramps_m2 += _ramp_variance(progress, config)
        progress.withheld_m = 0.0
    progress.withheld_m += taken_m
    progress.ramp_withheld_m += taken_m
    # The floor is no better known than when it was entered.
    state.covariance[DOWN, DOWN] = max(state.covariance[DOWN, DOWN], progress.level_variance_m2)


@njit()
def _ramp_variance(progress: Progress, config: EskfConfig) -> float:
    """Return the variance of what the constraint takes out: a bias of the strides, or a ramp."""
    ramp_std_m = config.floor.ramp_std_ratio * min(
        abs(progress.withheld_m), config.floor.ramp_max_m
    )
    return float(ramp_std_m * ramp_std_m)


@njit()
def _climb(progress: Progress, state: FilterState, config: EskfConfig) -> None:
    """Enter a new level, with what a ramp had lost to the one before given back.

    What was taken out before the ramp began was the habit of the strides, as likely as not.
    """
    if state.faulty_stride:
        state.hidden_rise_m += config.clipping.hidden_rise_share * _rise_std_m(progress, state)
    returned_m = progress.ramp_withheld_m
    if returned_m != 0.0:
        progress.withheld_m -= returned_m
        progress.past_ramps_m2 += _ramp_variance(progress, config)
    state.position_n_m[2] -= returned_m
    progress.climbed += 1.0
    more = 2.0 * progress.climbed - 1.0  # that one stride more adds to their square
    rise_bias_m2 = progress.rise_bias_m**2 + config.floor.rise_bias_std_m**2
    rise_bias_m2 += (config.floor.rise_bias_per_gain_m * state.scale_errors.std) ** 2
    state.covariance[DOWN, DOWN] += returned_m**2 + more * rise_bias_m2
    progress.withheld_m = 0.0
    progress.ramp_withheld_m = 0.0
    _enter_level(progress, state)


@njit()
def _enter_level(progress: Progress, state: FilterState) -> None:
    progress.level_m = state.position_n_m[2]
    progress.level_variance_m2 = state.covariance[DOWN, DOWN]


@njit()
def _measure_height_only(step: Step, state: FilterState, off_m: float, variance_m2: float) -> float:
    """Correct the height and nothing else (Schmidt's consider filter); return by how much.

    Were a gentle ramp allowed to teach the biases that it is flat, it would never show.
    """
    p = state.covariance
    weight = 1.0 / (p[DOWN, DOWN] + variance_m2)
    gain = p[DOWN, DOWN] * weight
    kept = p[DOWN, DOWN] * (1.0 - gain)
    for j in range(SIZE):
        p[DOWN, j] *= 1.0 - gain
        p[j, DOWN] = p[DOWN, j]
    p[DOWN, DOWN] = kept
    decorrelate_clone(state, DOWN, 1.0 - gain)
    state.position_n_m[2] += gain * off_m
    u = step.updates
    for j in range(SIZE):
        step.update_gain[u, j] = 0.0
    step.update_gain[u, DOWN] = gain
    remember(step, DOWN, weight * off_m)
    return float(gain * off_m)
