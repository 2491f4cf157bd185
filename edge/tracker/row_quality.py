"""How far each row can be trusted, and why not further."""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.conditioning import BAD_SAMPLES, SAMPLE_GAP
from edge.tracker.config import EskfConfig
from edge.tracker.error_model import ATTITUDE, TURN, heading_variance
from edge.tracker.first_rest import unshown_heading_variance
from edge.tracker.landing import gain_scale, noise_scale
from edge.tracker.plateaus import ACCEL_SATURATED, GYRO_SATURATED
from edge.tracker.port import Quality, Reason
from edge.tracker.state import FilterState, Progress, Ring

ALIGNING = int(Reason.ALIGNING)
NO_STANCE = int(Reason.NO_STANCE)
UNCERTAIN = int(Reason.UNCERTAIN)
UNSETTLED = int(Reason.UNSETTLED)
GOOD = int(Quality.GOOD)
DEGRADED = int(Quality.DEGRADED)
LOST = int(Quality.LOST)


@njit()
def note_faults(ring: Ring, progress: Progress, slot: int) -> bool:
    """Remember when a sample's own flags were last seen; return whether it has any."""
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
def judge(
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
    if t_s - progress.gyro_saturated_s <= config.fault_memory_s:
        reasons |= GYRO_SATURATED
    if t_s - progress.accel_saturated_s <= config.fault_memory_s:
        reasons |= ACCEL_SATURATED
    if t_s - progress.gap_s <= config.fault_memory_s:
        reasons |= SAMPLE_GAP
    tilt_variance = max(p[ATTITUDE, ATTITUDE], p[ATTITUDE + 1, ATTITUDE + 1])
    if tilt_variance > config.aligned_tilt_std_rad**2:
        reasons |= ALIGNING
    unseen_s = t_s + open_s - progress.last_stance_s
    if unseen_s > config.no_stance_degraded_s:
        reasons |= NO_STANCE
    stated_m2 = ring[slot].position_cov_m2
    std_m = math.sqrt(max(stated_m2[0, 0], stated_m2[1, 1]))
    if std_m > config.degraded_std_m:
        reasons |= UNCERTAIN
    quality = GOOD if reasons == 0 else DEGRADED
    if unshown_heading_variance(state) > config.settled_heading_std_rad**2:
        reasons |= UNSETTLED  # how far off that may be is in what is stated
    if unseen_s > config.no_stance_lost_s or std_m > config.lost_std_m:
        quality = LOST
    ring[slot].reasons = reasons
    ring[slot].quality = quality
    yaw = ATTITUDE + 2
    heading_var = heading_variance(p) + (noise_scale(state, config) - 1.0) * p[yaw, yaw]
    heading_var += (gain_scale(state, config) - 1.0) * p[TURN, TURN]
    heading_var += unshown_heading_variance(state) + (config.gap_turn_std_radps * open_s) ** 2
    ring[slot].heading_std_rad = math.sqrt(heading_var)
