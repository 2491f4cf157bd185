"""Stance or none: the hypothesis that a brief stance was none is kept until the next one decides.

A foot that is raised slowly, or dragged, may be as still for an instant as one that stands.  Taken
for a stance its velocity is lost, and the next stance finds the opposite: what the one has taken
away is missing at the other.  Errors of a swing do no such thing.

So beside the state the correction is kept that a brief stance after a slow swing has made, and
carried on: its negative leads to where the foot is if that stance was none.  At the next stance the
two innovations, ``a`` and ``b`` with variances ``A`` and ``B``, decide.  If both stances are true
each is noise; if the first was none, only what ``b`` differs from the correction's velocity ``e``
is.  Twice the logarithm of the ratio of the likelihoods, ::

    a^2/A + b^2/B - (b + e)^2/(A + B)

is chi-square with three degrees of freedom at most where both are true.  Together with a share of
what the last such decision has found (who raises a foot slowly does it again) it gives the
probability that the first was none.  If that is the more probable, the correction is taken back;
in either case the way of the other hypothesis, times its probability, is reported as uncertainty
of the position (decision among hypotheses: Bar-Shalom, Li and Kirubarajan, "Estimation with
Applications to Tracking and Navigation", 2001, section 11.6).

The variances are those of this wearer's strides, which end better than the filter expects (see
zupt_residuals), and of the gains.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import (
    ACCEL_BIAS,
    ATTITUDE,
    GYRO_BIAS,
    LEVER,
    POSITION,
    SIZE,
    VELOCITY,
)
from edge.tracker.foot.state import FilterState, Progress
from edge.tracker.foot.zupt.zupt_residuals import scale_error_inflation
from edge.tracker.mechanization.strapdown import dot, rotate_navigation, rotation_matrix


@njit()
def weigh_stance(progress: Progress, state: FilterState, t_s: float, config: EskfConfig) -> None:
    """Decide on the stance before, and begin to doubt the one that begins at ``t_s``.

    ``stance_off_n_mps`` is what that is about to take away.
    """
    rival = state.rival
    if rival.alive and _was_none(state, config):
        _undo_stance(state, config)
        progress.misfit_s = t_s
    slow = state.swing_level_speed_mps <= config.acceptance.slow_swing_mps
    rival.alive = slow and state.stance_after_s > config.acceptance.stance_pause_s
    rival.began_s = t_s
    rival.recent_nis = state.recent_nis
    rival.mean_zupt_residual = state.mean_zupt_residual
    rival.mean_strike_residual = state.mean_strike_residual
    rival.mean_scale_residual = state.mean_scale_residual
    rival.mean_gain_residual = state.mean_gain_residual
    rival.gain_residual = state.gain_residual
    for i in range(SIZE):
        rival.error[i] = 0.0
    for i in range(3):
        rival.off_n_mps[i] = state.stance_off_n_mps[i]
        rival.variance_m2ps2[i] = _swing_variance(state, i, config)
        rival.misfit_n_m[i] = 0.0


@njit()
def _swing_variance(state: FilterState, axis: int, config: EskfConfig) -> float:
    """Return the variance of a velocity after this swing, as this wearer's strides end."""
    share = 1.0
    if not state.faulty_stride:
        share = min((state.mean_zupt_residual / config.residuals.zupt_residual_poor) ** 2, 1.0)
    gains = scale_error_inflation(state, config) * state.stance_scale_error_mps**2
    return float(share * state.covariance[VELOCITY + axis, VELOCITY + axis] + gains)


@njit()
def _was_none(state: FilterState, config: EskfConfig) -> bool:
    """True where the stance before was rather none; report the way of the other hypothesis."""
    rival = state.rival
    each, together = 0.0, 0.0
    for i in range(3):
        before, now = rival.off_n_mps[i], state.stance_off_n_mps[i]
        before_var, now_var = rival.variance_m2ps2[i], _swing_variance(state, i, config)
        each += before * before / before_var + now * now / now_var
        together += (now + rival.error[VELOCITY + i]) ** 2 / (before_var + now_var)
    evidence = each - together
    against = config.revision.evidence - evidence - rival.recent_evidence
    probability = 1.0 / (1.0 + math.exp(0.5 * against))
    none = together < config.revision.together_nis and probability > 0.5
    found = min(evidence, config.revision.evidence) if none else rival.recent_evidence
    rival.recent_evidence = config.revision.memory * found
    doubt = max(1.0 - probability, config.revision.least_doubt) if none else probability
    for i in range(3):
        state.misfit_n_m[i] += doubt * abs(rival.error[POSITION + i])
    return bool(none)


@njit()
def _undo_stance(state: FilterState, config: EskfConfig) -> None:
    """Undo what the stance before has done, to the state and to what was learned from it."""
    rival = state.rival
    error = rival.error
    for i in range(3):
        state.position_n_m[i] -= error[POSITION + i]
        state.velocity_n_mps[i] -= error[VELOCITY + i]
        state.stance_off_n_mps[i] += error[VELOCITY + i]
        state.gyro_bias_radps[i] -= error[GYRO_BIAS + i]
        state.accel_bias_mps2[i] -= error[ACCEL_BIAS + i]
        state.lever_b_m[i] -= error[LEVER + i]
        state.misfit_n_m[i] -= rival.misfit_n_m[i]
        # The swing was the longer one, of which the filter has forgotten the first part.
        state.covariance[VELOCITY + i, VELOCITY + i] += rival.variance_m2ps2[i]
    rotate_navigation(
        state.quaternion_nb, -error[ATTITUDE], -error[ATTITUDE + 1], -error[ATTITUDE + 2]
    )
    rotation_matrix(state.quaternion_nb, state.rotation_nb)
    state.recent_nis = config.consistency.memory * rival.recent_nis
    state.mean_zupt_residual = rival.mean_zupt_residual
    state.mean_strike_residual = rival.mean_strike_residual
    state.mean_scale_residual = rival.mean_scale_residual
    state.mean_gain_residual = rival.mean_gain_residual
    state.gain_residual = rival.gain_residual


@njit()
def note_correction(state: FilterState, t_s: float, config: EskfConfig) -> None:
    """Add what a sample of the doubted stance has corrected; one that lasts is no doubt."""
    rival = state.rival
    if not rival.alive:
        return
    rival.alive = t_s - rival.began_s <= config.revision.longest_stance_s
    for i in range(SIZE):
        rival.error[i] += state.error[i]


@njit()
def propagate_correction(state: FilterState, dt_s: float) -> None:
    """Carry the kept correction over an interval, as ``error_model.propagate`` does an error."""
    rival = state.rival
    if not rival.alive:
        return
    error, rotation_nb, force_n_mps2 = rival.error, state.rotation_nb, state.force_n_mps2
    x, y, z = error[ATTITUDE], error[ATTITUDE + 1], error[ATTITUDE + 2]
    for i in range(3):
        error[POSITION + i] += dt_s * error[VELOCITY + i]
    error[VELOCITY] += dt_s * (force_n_mps2[2] * y - force_n_mps2[1] * z)
    error[VELOCITY + 1] += dt_s * (force_n_mps2[0] * z - force_n_mps2[2] * x)
    error[VELOCITY + 2] += dt_s * (force_n_mps2[1] * x - force_n_mps2[0] * y)
    for i in range(3):
        error[VELOCITY + i] -= dt_s * dot(rotation_nb[i], error[ACCEL_BIAS : ACCEL_BIAS + 3])
        error[ATTITUDE + i] -= dt_s * dot(rotation_nb[i], error[GYRO_BIAS : GYRO_BIAS + 3])
