"""Movement of the torso at one sample: at rest, within a stride, or dead reckoning by steps."""

from __future__ import annotations

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.interface import Reason
from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.torso_shank.state import ShankState, StrideState, TorsoShankConfig
from edge.tracker.torso_shank.stride import begin_stride, end_stride, predict
from edge.tracker.torso_shank.torso_front import update_front_direction
from edge.tracker.torso_shank.torso_steps import advance_path, follow_steps
from edge.tracker.trunk.attitude import add_forward
from edge.tracker.trunk.dead_reckoning import begin_walk, place_row, state_errors

_SAMPLE_GAP, _NO_STANCE = int(Reason.SAMPLE_GAP), int(Reason.NO_STANCE)


@njit()
def move(
    ring: Ring,
    state: StrideState,
    shank: ShankState,
    k: int,
    scratch_n: Floats,
    config: TorsoShankConfig,
) -> None:
    """Take sample ``k`` of the torso, for which the shank has been followed."""
    trunk = state.waist.trunk
    row = ring[k & (len(ring) - 1)]
    silent_s = (row.t_ns - shank.walked_ns) * 1e-9
    is_gone = silent_s > config.silence_s or shank.trunk.walked == 0
    predict(ring, state, k, scratch_n, config)
    follow_steps(ring, state, k, config)
    if shank.has_instant:
        shank.has_instant = False
        _take_instant(ring, state, k, shank.instant_radps * state.leg_length_m, config)
    elif not is_gone and _stands(state, shank, row.t_s, config):
        _stand(ring, state, k, max(trunk.quiet_s, shank.trunk.quiet_s), config)
    elif state.walking and row.t_s - state.begin_s > config.longest_stride_s:
        _give_up_stride(ring, state, k, config)
    elif is_gone and not state.by_steps:
        state.walking, state.by_steps, state.counted_at = False, True, k
    elif not state.walking and not state.by_steps and state.steps_since >= config.steps_alone:
        begin_walk(trunk, config.trunk)
        state.by_steps, state.counted_at = True, trunk.released - 1
        advance_path(ring, state, k, state.steps_since_m, config)
    if state.by_steps:
        row.reasons |= _SAMPLE_GAP if is_gone else _NO_STANCE
        state_errors(trunk, row, config.trunk)


@njit()
def _stands(state: StrideState, shank: ShankState, now_s: float, config: TorsoShankConfig) -> bool:
    """True if torso or shank is quiet; a shank that stays so while the torso steps is lost."""
    quiet_s = shank.trunk.quiet_s
    if state.waist.trunk.still:
        return True
    steps = now_s - state.waist.step_s < config.waist.longest_period_s
    return bool(quiet_s >= config.quiet_s and not (steps and quiet_s > config.lost_quiet_s))


@njit()
def _take_instant(
    ring: Ring, state: StrideState, k: int, speed_mps: float, config: TorsoShankConfig
) -> None:
    """End the stride, the stand or the steps before sample ``k`` with a speed."""
    velocity_n_mps = np.zeros(2)
    add_forward(ring, state.waist.trunk, k, velocity_n_mps)
    for i in range(2):
        velocity_n_mps[i] *= speed_mps
    now_s = ring[k & (len(ring) - 1)].t_s
    if state.by_steps:
        since_s = now_s - ring[state.counted_at & (len(ring) - 1)].t_s
        if k > state.counted_at:
            advance_path(ring, state, k, speed_mps * min(since_s, config.first_stride_s), config)
        state.by_steps = False
    elif state.walking:
        end_stride(ring, state, k, velocity_n_mps, False, config)
    else:
        update_front_direction(state, velocity_n_mps, config)
        begin_walk(state.waist.trunk, config.trunk)
        _start(ring, state, k, speed_mps, config)
    begin_stride(ring, state, k, velocity_n_mps[0], velocity_n_mps[1])
    state.walking = True
    state.steps_since = 0


@njit()
def _start(
    ring: Ring, state: StrideState, k: int, speed_mps: float, config: TorsoShankConfig
) -> None:
    """Go the way since the stand: from rest to this speed evenly at first, and on as fast."""
    mask = len(ring) - 1
    now_s = ring[k & mask].t_s
    since_s = now_s - state.begin_s
    if state.steps_since > 0:
        since_s = min(since_s, now_s - state.first_step_s + config.first_step_s)
    state.counted_at = k
    while state.counted_at > state.begin_at:
        if now_s - ring[state.counted_at & mask].t_s >= since_s:
            break
        state.counted_at -= 1
    evenly_s = since_s - 0.5 * min(since_s, config.first_stride_s)
    if k > state.counted_at:
        advance_path(ring, state, k, speed_mps * evenly_s, config)


@njit()
def _stand(
    ring: Ring, state: StrideState, k: int, quiet_s: float, config: TorsoShankConfig
) -> None:
    """Stand since ``quiet_s``; a stride that was under way has ended then."""
    mask = len(ring) - 1
    trunk = state.waist.trunk
    if state.walking:
        end = k
        while end > max(state.begin_at, trunk.released):
            if ring[k & mask].t_s - ring[end & mask].t_s >= quiet_s:
                break
            end -= 1
        for i in range(2):
            trunk.position_n_m[i] = ring[end & mask].position_n_m[i]
            state.velocity_n_mps[i] = ring[end & mask].velocity_n_mps[i]
        end_stride(ring, state, end, np.zeros(2), True, config)
        for j in range(end + 1, k + 1):
            place_row(ring, trunk, j, config.trunk)
    state.walking = state.by_steps = False
    state.steps_since = 0
    begin_stride(ring, state, k, 0.0, 0.0)


@njit()
def _give_up_stride(ring: Ring, state: StrideState, k: int, config: TorsoShankConfig) -> None:
    """No instant has ended the stride: the torso's steps say whether the walk goes on."""
    now_s = ring[k & (len(ring) - 1)].t_s
    end_n_mps = np.zeros(2)
    goes_on = now_s - state.waist.step_s < config.waist.longest_period_s
    if goes_on:
        end_n_mps[0], end_n_mps[1] = state.velocity_n_mps[0], state.velocity_n_mps[1]
    end_stride(ring, state, k, end_n_mps, False, config)
    state.walking, state.by_steps, state.counted_at = False, goes_on, k
    state.steps_since = 0
    begin_stride(ring, state, k, 0.0, 0.0)
