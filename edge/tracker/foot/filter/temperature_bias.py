"""Dependence of the gyroscope's bias on the sensor's temperature.

The bias follows the smoothed temperature in small steps: ``bias += k dT``.  The coefficient ``k``
(rad/s/K) is estimated with the bias: rests at two temperatures show it.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.filter.correction_tracking import warm_clone
from edge.tracker.foot.filter.error_model import propagate_temperature
from edge.tracker.foot.state import FilterState, Progress, Step
from edge.tracker.preprocessing.sample_ring import Ring

COLDEST_DEGC = -60.0  # readings beyond these are no temperature
WARMEST_DEGC = 150.0


@njit()
def update_temperature_bias(
    ring: Ring, step: Step, progress: Progress, state: FilterState, slot: int, config: EskfConfig
) -> None:
    """Move the gyroscope bias by the change of temperature up to the sample in ``slot``."""
    step.bias_step_k = 0.0
    reading_degc = ring[slot].temperature_degc
    if not COLDEST_DEGC < reading_degc < WARMEST_DEGC:
        return
    if not math.isfinite(progress.temperature_degc):
        progress.temperature_degc = reading_degc
        progress.bias_degc = reading_degc
        progress.temperature_s = ring[slot].t_s
    share = (ring[slot].t_s - progress.temperature_s) / config.process.temperature_smoothing_s
    progress.temperature_s = ring[slot].t_s
    progress.temperature_degc += min(share, 1.0) * (reading_degc - progress.temperature_degc)
    step_k = progress.temperature_degc - progress.bias_degc
    if abs(step_k) < config.process.temperature_step_k:
        return
    progress.bias_degc = progress.temperature_degc
    step.bias_step_k = step_k
    for i in range(3):
        state.gyro_bias_radps[i] += step_k * state.gyro_bias_per_k[i]
    propagate_temperature(state.covariance, step_k)
    warm_clone(state, step_k)
