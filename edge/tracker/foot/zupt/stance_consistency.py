"""Innovation monitor of stances: stances that contradict the motion between them.

A stance is the stillest of its stride, which need not be still: a foot that is raised and put down
slowly is at its stillest in mid-air.  Taken for a stance, its velocity is lost, and so is the
distance that it would have moved.  Nothing in the samples of that moment shows it, but the filter
does: it knows the variance of the velocity after a swing.  What a stance takes away of that, by its
variance and summed over the samples of the stance, is the normalised innovation squared (NIS); of
true stances it is chi-square with three degrees of freedom at most, the filter's noise being that
of hard strides (Bar-Shalom, Li and Kirubarajan, "Estimation with Applications to Tracking and
Navigation", 2001, section 5.4).  The effect of scale errors on a swing is no noise of the filter
(see scale_misalignment), so it comes on top: their share of the swing's speed, and of the velocity
that gravity adds while the attitude is off.

What is left of the sum of the stances before is added, so that a series of contradictions counts
that are each below the bound.

Which of the two is wrong, stance or velocity, is not known.  So neither is left out; the distance
that the rejected velocity would have covered since the stance before is reported as uncertainty of
the position.  These distances add up one to one and not by their squares, for a person who raises a
foot slowly does it again, the same way.
"""

from __future__ import annotations

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.state import FilterState, Progress, Step
from edge.tracker.foot.zupt.zupt import lever_velocity_row
from edge.tracker.mechanization.strapdown import dot
from edge.tracker.preprocessing.sample_ring import Ring


@njit()
def begin_stance(
    ring: Ring, step: Step, progress: Progress, state: FilterState, slot: int, config: EskfConfig
) -> None:
    """Record what the first still sample after a swing takes away, before it does."""
    state.recent_nis = config.consistency.memory * (state.recent_nis + _unexplained_nis(state))
    state.stance_nis = 0.0
    state.stance_misfits = False
    state.stance_after_s = ring[slot].t_s - progress.last_stance_s
    state.stance_scale_error_mps = swing_scale_error_mps(state, state.stance_after_s, config)
    for i in range(3):
        state.gyro_radps[i] = ring[slot].gyro_radps[i] - state.gyro_bias_radps[i]
    row = step.lever_row[0]
    for i in range(3):
        lever_velocity_row(state.rotation_nb, state.gyro_radps, i, row)
        state.stance_off_n_mps[i] = dot(row, state.lever_b_m) - state.velocity_n_mps[i]


@njit()
def swing_scale_error_mps(state: FilterState, since_s: float, config: EskfConfig) -> float:
    """Return by how much the gains may have put the velocity off since the last stance."""
    rotated_rad = min(state.swing_rad, 1.0)
    gravity_leak_mps = config.gravity_mps2 * rotated_rad * since_s
    return float(state.scale_errors.std * (state.swing_speed_mps + gravity_leak_mps))


@njit()
def inflate_for_misfit(
    progress: Progress, state: FilterState, t_s: float, config: EskfConfig
) -> None:
    """Widen the position at a stance once its samples have contradicted the filter's velocity."""
    if state.stance_misfits or not _contradicts(state, config):
        return
    state.stance_misfits = True
    progress.misfit_s = t_s
    for i in range(3):
        misfit_m = abs(state.stance_off_n_mps[i]) * state.stance_after_s
        state.misfit_n_m[i] += misfit_m
        state.rival.misfit_n_m[i] += misfit_m


@njit()
def _contradicts(state: FilterState, config: EskfConfig) -> bool:
    """True where this stance, or the last few, take away more velocity than noise explains."""
    nis = _unexplained_nis(state)
    return bool(
        nis > config.consistency.single_nis and nis + state.recent_nis > config.consistency.nis
    )


@njit()
def _unexplained_nis(state: FilterState) -> float:
    """Return the stance's NIS so far, beyond what the gains may have done to its swing."""
    nis = state.stance_nis
    off = state.stance_off_n_mps
    square = dot(off, off)  # by the variance of the filter it is nis
    if nis == 0.0 or square == 0.0:
        return 0.0
    return float(square / (square / nis + state.stance_scale_error_mps**2))


@njit()
def height_is_lost(state: FilterState, config: EskfConfig) -> bool:
    """True where the floor can no longer be known; nothing later brings it back."""
    return bool(state.misfit_n_m[2] > config.consistency.height_m)
