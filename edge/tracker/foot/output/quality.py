"""Quality of each row (good, degraded, lost) and the reasons."""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import ATTITUDE
from edge.tracker.foot.filter.initial_gyro_bias import unobserved_heading_variance
from edge.tracker.foot.output.reported_covariance import stated_heading_variance
from edge.tracker.foot.state import FilterState, Progress
from edge.tracker.foot.zupt.stance_consistency import height_is_lost
from edge.tracker.foot.zupt.zupt_residuals import noise_inflation
from edge.tracker.interface import Quality, Reason
from edge.tracker.preprocessing.preprocess import BAD_SAMPLES, SAMPLE_GAP
from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.preprocessing.saturation_detection import ACCEL_SATURATED, GYRO_SATURATED

ALIGNING = int(Reason.ALIGNING)
NO_STANCE = int(Reason.NO_STANCE)
UNCERTAIN = int(Reason.UNCERTAIN)
UNSETTLED = int(Reason.UNSETTLED)
INCONSISTENT = int(Reason.INCONSISTENT)
GOOD = int(Quality.GOOD)
DEGRADED = int(Quality.DEGRADED)
LOST = int(Quality.LOST)


@njit()
def note_faults(ring: Ring, progress: Progress, slot: int) -> bool:
    """Record when a sample's own flags were last seen; return whether it has any."""
    flags = ring[slot].flags
    t_s = ring[slot].t_s
    if flags & GYRO_SATURATED:
        progress.gyro_saturated_s = t_s
    if flags & ACCEL_SATURATED:
        progress.accel_saturated_s = t_s
    if flags & SAMPLE_GAP:
        progress.gap_s = t_s
    return bool(flags != 0)


@njit()
def assign_quality(
    ring: Ring,
    progress: Progress,
    state: FilterState,
    slot: int,
    open_s: float,
    config: EskfConfig,
) -> None:
    """Write ``reasons``, ``quality`` and ``heading_std_rad`` of the row in ``slot``.

    ``open_s``: for how long no good sample has come.
    """
    t_s = ring[slot].t_s
    p = state.covariance
    reasons = ring[slot].flags & BAD_SAMPLES
    if t_s - progress.gyro_saturated_s <= config.output.fault_memory_s:
        reasons |= GYRO_SATURATED
    if t_s - progress.accel_saturated_s <= config.output.fault_memory_s:
        reasons |= ACCEL_SATURATED
    if t_s - progress.gap_s <= config.output.fault_memory_s:
        reasons |= SAMPLE_GAP
    height_lost = height_is_lost(state, config)
    if height_lost or t_s - progress.misfit_s <= config.output.fault_memory_s:
        reasons |= INCONSISTENT
    tilt_variance = max(p[ATTITUDE, ATTITUDE], p[ATTITUDE + 1, ATTITUDE + 1])
    if tilt_variance > config.output.aligned_tilt_std_rad**2:
        reasons |= ALIGNING
    unseen_s = t_s + open_s - progress.last_stance_s
    if unseen_s > config.output.no_stance_degraded_s:
        reasons |= NO_STANCE
    reported_m2 = ring[slot].position_cov_m2
    std_m = math.sqrt(max(reported_m2[0, 0], reported_m2[1, 1]))
    if std_m > config.output.degraded_std_m:
        reasons |= UNCERTAIN
    quality = GOOD if reasons == 0 else DEGRADED
    if unobserved_heading_variance(state) > config.output.settled_heading_std_rad**2:
        reasons |= UNSETTLED  # how far off that may be is in what is stated
    if unseen_s > config.output.no_stance_lost_s or std_m > config.output.lost_std_m or height_lost:
        quality = LOST
    ring[slot].reasons = reasons
    ring[slot].quality = quality
    heading_var = stated_heading_variance(state, noise_inflation(state, config), config)
    heading_var += (config.restart.turn_std_radps * open_s) ** 2
    ring[slot].heading_std_rad = math.sqrt(heading_var)
