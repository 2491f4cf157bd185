"""Stance or foot in the air: two hypotheses for the stillest moment of a slow swing.

The stillest moment of a stride is a stance where a stride fits into the window of the detector.  A
foot that is raised and put down slowly, or held in the air, fills the window with its swing alone:
then the stillest moment is in mid-air.  Evidence against a stance, after a slow swing, is

- a *vertical* velocity that the filter knows well and that is not zero, while the horizontal one is
  small.  An error of the tilt, of a bias or of samples that are missing shows along the floor
  first, so this is no filter that is wrong.  What the gains may have done is no evidence;
- a stillness unlike that of the wearer's stances before it: in the air a foot is less still by ten
  to a thousand times where the wearer rests in between.  It is outweighed where the filter says
  that the foot neither rises nor sinks, now and a moment later (at the top of its way it does so
  for an instant only).  For the same reason as above the velocity along the floor does not refuse.

After a fast swing there is no doubt: it is a stride, its strike may leave more vertical velocity
than those before, and a walk may become a run.  Nor is there where the foot lies as still as in a
stance for longer than any foot in the air.  A candidate that is not accepted is decided by what
follows: the swing goes on, at most for ``reject_longest_s``, and each later sample is a candidate
of its own.  While it is undecided whether the stance before was one (see stance_revision), the
velocity of either case may fit.

The memory takes a stiller stance at once and a less still one by a share, because a person who has
stood still can do so again.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import VELOCITY
from edge.tracker.foot.state import FilterState, Progress
from edge.tracker.foot.zupt.stance_consistency import swing_scale_error_mps
from edge.tracker.foot.zupt.zupt_residuals import scale_error_inflation
from edge.tracker.preprocessing.sample_ring import Ring, reach


@njit()
def is_accepted(
    ring: Ring, progress: Progress, state: FilterState, k: int, config: EskfConfig
) -> bool:
    """False where sample ``k``, which would begin a stance, is rather of a foot in the air."""
    slot = k & (len(ring) - 1)
    since_s = ring[slot].t_s - progress.last_stance_s
    if since_s < config.acceptance.stance_pause_s or since_s > config.acceptance.reject_longest_s:
        return True
    if state.swing_speed_mps < config.acceptance.stance_pause_mps:
        return True
    if state.swing_level_speed_mps > config.acceptance.slow_swing_mps:
        return True
    if _is_lasting_rest(ring, progress, k, config):
        return True
    velocity, error = state.velocity_n_mps, state.rival.error
    if _fits(ring, progress, state, k, velocity[0], velocity[1], velocity[2], config):
        return True
    return bool(
        state.rival.alive
        and _fits(
            ring,
            progress,
            state,
            k,
            velocity[0] - error[VELOCITY],
            velocity[1] - error[VELOCITY + 1],
            velocity[2] - error[VELOCITY + 2],
            config,
        )
    )


@njit()
def _is_lasting_rest(ring: Ring, progress: Progress, k: int, config: EskfConfig) -> bool:
    """True where the foot lies as still as in a stance for longer than any foot in the air."""
    mask = len(ring) - 1
    stop = min(progress.measured, reach(ring, k))
    bound = config.acceptance.unlike_ratio * progress.usual_stance_m2ps4
    i = k
    while i < stop and ring[i & mask].motion_m2ps4 <= bound:
        if ring[i & mask].t_s - progress.restless_s > config.acceptance.lasting_rest_s:
            return True
        i += 1
    return False


@njit()
def note_restlessness(ring: Ring, progress: Progress, slot: int, config: EskfConfig) -> None:
    """Keep the time of the last sample that is less still than the wearer's stances."""
    bound = config.acceptance.unlike_ratio * progress.usual_stance_m2ps4
    if progress.in_stance or ring[slot].motion_m2ps4 > bound:
        progress.restless_s = ring[slot].t_s


@njit()
def _fits(
    ring: Ring,
    progress: Progress,
    state: FilterState,
    k: int,
    north_mps: float,
    east_mps: float,
    down_mps: float,
    config: EskfConfig,
) -> bool:
    """True where sample ``k`` may be of a stance if the foot has this velocity by the filter."""
    slot = k & (len(ring) - 1)
    level_mps = math.hypot(north_mps, east_mps)
    since_s = ring[slot].t_s - progress.last_stance_s
    if _rises_or_sinks(state, since_s, level_mps, down_mps, config):
        return False
    usual = progress.usual_stance_m2ps4
    if usual == 0.0 or ring[slot].stride_minimum_m2ps4 <= config.acceptance.unlike_ratio * usual:
        return True
    return _stays_level(ring, progress, state, k, level_mps, down_mps, config)


@njit()
def _rises_or_sinks(
    state: FilterState, since_s: float, level_mps: float, down_mps: float, config: EskfConfig
) -> bool:
    """True where the foot goes up or down by more than the errors of its swing explain.

    The filter's own variance is that of hard strides on poor sensors; how this wearer's strides
    end is known better (see zupt_residuals), but for those with a fault.
    """
    if state.faulty_stride or level_mps > config.acceptance.sinking_level_mps:
        return False
    std_mps = config.acceptance.sinking_mps + config.acceptance.sinking_drift_mps2 * since_s
    std_mps += config.acceptance.sinking_strike_ratio * state.mean_strike_residual * state.swing_rad
    gains = math.sqrt(scale_error_inflation(state, config)) * swing_scale_error_mps(
        state, since_s, config
    )
    return bool(abs(down_mps) > config.acceptance.sinking_gate * math.hypot(std_mps, gains))


@njit()
def _stays_level(
    ring: Ring,
    progress: Progress,
    state: FilterState,
    k: int,
    level_mps: float,
    down_mps: float,
    config: EskfConfig,
) -> bool:
    """True where the filter says that the foot neither rises nor sinks, now and a moment later.

    A velocity along the floor is weak evidence, for there a tilt that is wrong shows: it makes the
    moment longer, because a foot that is carried stays level for an instant only.  The attitude is
    taken as constant: of the force upwards a foot that rolls on the floor loses what is of second
    order only.
    """
    mask = len(ring) - 1
    stop = min(progress.measured, reach(ring, k))
    now_s = ring[k & mask].t_s
    moving = level_mps > config.acceptance.rest_level_mps
    ahead_s = config.acceptance.rest_moving_ahead_s if moving else config.acceptance.rest_ahead_s
    i = k
    while abs(down_mps) <= config.acceptance.rest_down_mps:
        i += 1
        if i >= stop or ring[i & mask].t_s - now_s > ahead_s:
            return True
        dt_s = ring[i & mask].t_s - ring[(i - 1) & mask].t_s
        down_mps += config.gravity_mps2 * dt_s
        for j in range(3):
            force_mps2 = ring[i & mask].accel_mps2[j] - state.accel_bias_mps2[j]
            down_mps += state.rotation_nb[2, j] * force_mps2 * dt_s
    return False


@njit()
def note_stillness(progress: Progress, motion_m2ps4: float) -> None:
    """Keep the statistic of the stillest sample of a stance, which begins unless ``in_stance``."""
    if progress.in_stance:
        motion_m2ps4 = min(progress.stance_least_m2ps4, motion_m2ps4)
    progress.stance_least_m2ps4 = motion_m2ps4


@njit()
def remember_stance(progress: Progress, config: EskfConfig) -> None:
    """Learn from a stance that has ended; ``stance_least_m2ps4`` is of its stillest sample."""
    least = max(progress.stance_least_m2ps4, config.acceptance.usual_stance_min_m2ps4)
    usual = progress.usual_stance_m2ps4
    if usual == 0.0 or least < usual:
        progress.usual_stance_m2ps4 = least
    else:
        progress.usual_stance_m2ps4 = (
            usual * (least / usual) ** config.acceptance.usual_stance_share
        )
