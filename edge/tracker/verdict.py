"""How far each row can be trusted, and why not further."""

from __future__ import annotations

import math
from typing import Any

from numba import njit
from numpy.typing import NDArray

from edge.tracker.conditioning import (
    ACCEL_SATURATED,
    BAD_SAMPLES,
    GYRO_SATURATED,
    SAMPLE_GAP,
)
from edge.tracker.config import EskfConfig
from edge.tracker.error_model import ATTITUDE
from edge.tracker.port import Quality, Reason
from edge.tracker.state import FilterState, Ring

ALIGNING = int(Reason.ALIGNING)
NO_STANCE = int(Reason.NO_STANCE)
UNCERTAIN = int(Reason.UNCERTAIN)
GOOD = int(Quality.GOOD)
DEGRADED = int(Quality.DEGRADED)
LOST = int(Quality.LOST)


@njit()
def note_faults(ring: Ring, progress: NDArray[Any], slot: int) -> None:
    """Remember when a sample's own flags were last seen."""
    flags = ring.flags[slot]
    t_s = ring.t_s[slot]
    memory = progress[0]
    if flags & GYRO_SATURATED:
        memory.gyro_saturated_s = t_s
    if flags & ACCEL_SATURATED:
        memory.accel_saturated_s = t_s
    if flags & SAMPLE_GAP:
        memory.gap_s = t_s


@njit()
def judge(
    ring: Ring, progress: NDArray[Any], state: FilterState, slot: int, config: EskfConfig
) -> None:
    """Write ``reasons``, ``quality`` and ``heading_std_rad`` of the row in ``slot``."""
    t_s = ring.t_s[slot]
    memory = progress[0]
    p = state.covariance
    reasons = ring.flags[slot] & BAD_SAMPLES
    if t_s - memory.gyro_saturated_s <= config.fault_memory_s:
        reasons |= GYRO_SATURATED
    if t_s - memory.accel_saturated_s <= config.fault_memory_s:
        reasons |= ACCEL_SATURATED
    if t_s - memory.gap_s <= config.fault_memory_s:
        reasons |= SAMPLE_GAP
    tilt_variance = max(p[ATTITUDE, ATTITUDE], p[ATTITUDE + 1, ATTITUDE + 1])
    if tilt_variance > config.aligned_tilt_std_rad**2:
        reasons |= ALIGNING
    unseen_s = t_s - memory.last_stance_s
    if unseen_s > config.no_stance_degraded_s:
        reasons |= NO_STANCE
    std_m = math.sqrt(max(p[0, 0], p[1, 1]))
    if std_m > config.degraded_std_m:
        reasons |= UNCERTAIN
    quality = GOOD if reasons == 0 else DEGRADED
    if unseen_s > config.no_stance_lost_s or std_m > config.lost_std_m:
        quality = LOST
    ring.reasons[slot] = reasons
    ring.quality[slot] = quality
    ring.heading_std_rad[slot] = math.sqrt(p[ATTITUDE + 2, ATTITUDE + 2])
