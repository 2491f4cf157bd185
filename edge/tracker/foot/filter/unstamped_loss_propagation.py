"""Propagation over samples that were lost without a trace in the stamps.

The sample after the loss is taken for the mean over it: what a sensor sends that adds up its
increments, and no worse than a straight line for others.  How long the loss lasted is known by half
only.  That is one unknown number: position, velocity and attitude are off together, each by its
rate of change, so the next stance that shows the velocity corrects the attitude and the position as
well.

A link that loses samples in a swing loses others that nothing shows.  Every one of them makes the
stride shorter, so what is reported widens by the way of those that were seen, one to one.
"""

from __future__ import annotations

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import ATTITUDE, POSITION, SIZE, VELOCITY
from edge.tracker.foot.filter.integration import accel_scale
from edge.tracker.foot.state import FilterState
from edge.tracker.preprocessing.sample_ring import Ring


@njit()
def hold_readings(ring: Ring, state: FilterState, slot: int, config: EskfConfig) -> None:
    """Write rate and force of the sample in ``slot``, free of bias, as those of the interval."""
    scale = accel_scale(ring[slot].rest_norm_mps2, config)
    for i in range(3):
        state.gyro_radps[i] = ring[slot].gyro_radps[i] - state.gyro_bias_radps[i]
        state.accel_mps2[i] = scale * ring[slot].accel_mps2[i] - state.accel_bias_mps2[i]
    state.gyro_curvature_var = 0.0
    state.force_curvature_var = 0.0


@njit()
def inflate_for_loss(state: FilterState, lost_s: float, config: EskfConfig) -> None:
    """Add to the covariance what an unknown duration of the loss does, as one error."""
    std_s = config.loss.std_share * lost_s + config.loss.std_s
    off = state.column  # as scratch
    for i in range(SIZE):
        off[i] = 0.0
    for i in range(3):
        off[POSITION + i] = std_s * state.velocity_n_mps[i]
        off[VELOCITY + i] = std_s * state.force_n_mps2[i]
        for j in range(3):
            off[ATTITUDE + i] += std_s * state.rotation_nb[i, j] * state.gyro_radps[j]
        state.misfit_n_m[i] += config.loss.unseen_ratio * lost_s * abs(state.velocity_n_mps[i])
    off[VELOCITY + 2] += std_s * config.gravity_mps2
    for i in range(POSITION, ATTITUDE + 3):
        for j in range(POSITION, ATTITUDE + 3):
            state.covariance[i, j] += off[i] * off[j]
