"""The gyroscope's bias follows the sensor's temperature.

How much a kelvin adds is learned wherever the bias is: rests at two temperatures tell it.
The temperature moves slowly, so the bias follows in small steps.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.config import EskfConfig
from edge.tracker.error_model import warm
from edge.tracker.past import warm_past
from edge.tracker.state import FilterState, Progress, Ring, Step

COLDEST_DEGC = -60.0  # what is said beyond these is no temperature
WARMEST_DEGC = 150.0


@njit()
def follow_warmth(
    ring: Ring, step: Step, progress: Progress, state: FilterState, slot: int, config: EskfConfig
) -> None:
    """Move the gyroscope bias by what the warming up to the sample in ``slot`` adds."""
    step.warmed_k = 0.0
    said_degc = ring[slot].temperature_degc
    if not COLDEST_DEGC < said_degc < WARMEST_DEGC:
        return
    if not math.isfinite(progress.temperature_degc):
        progress.temperature_degc = said_degc
        progress.warmed_degc = said_degc
        progress.temperature_s = ring[slot].t_s
    share = (ring[slot].t_s - progress.temperature_s) / config.temperature_smoothing_s
    progress.temperature_s = ring[slot].t_s
    progress.temperature_degc += min(share, 1.0) * (said_degc - progress.temperature_degc)
    step_k = progress.temperature_degc - progress.warmed_degc
    if abs(step_k) < config.temperature_step_k:
        return
    progress.warmed_degc = progress.temperature_degc
    step.warmed_k = step_k
    for i in range(3):
        state.gyro_bias_radps[i] += step_k * state.gyro_bias_per_k[i]
    warm(state.covariance, step_k)
    warm_past(state, step_k)
