"""A rate that jumps far off and back within one sample: a disturbed transfer, and no motion.

A spike within the sensor's range turns the foot for good, by a degree or more, where one of the
accelerometer is taken back by the next stance.  A strike's force may come and go in one sample,
too; a rate is an integral and may not.
"""

from __future__ import annotations

from numba import njit

from edge.tracker.conditioning import BAD_SAMPLES, SAMPLE_GAP
from edge.tracker.plateaus import GYRO_SATURATED
from edge.tracker.state import Ring

AROUND = 2  # samples on either side
LEAST_RADPS = 1.5
RATIO = 4.0  # to any change around it; 2.5 at most in 46 recorded walks of 200 to 400 Hz


@njit()
def leave_out_spike(ring: Ring, k: int) -> None:
    """Mark sample ``k`` as bad where it is a spike between two good ones on either side, and give
    it the rate halfway between its neighbours.
    """
    mask = len(ring) - 1
    if k < AROUND:
        return
    for i in range(k - AROUND, k + AROUND + 1):
        if ring[i & mask].flags & (BAD_SAMPLES | SAMPLE_GAP | GYRO_SATURATED):
            return
    slot = k & mask
    before, after = (k - 1) & mask, (k + 1) & mask
    off = 0.0
    across = 0.0
    earlier = 0.0
    later = 0.0
    for j in range(3):
        was, will = ring[before].gyro_radps[j], ring[after].gyro_radps[j]
        off += (ring[slot].gyro_radps[j] - 0.5 * (was + will)) ** 2
        across += (will - was) ** 2
        earlier += (was - ring[(k - 2) & mask].gyro_radps[j]) ** 2
        later += (ring[(k + 2) & mask].gyro_radps[j] - will) ** 2
    if off < LEAST_RADPS**2 or off < RATIO**2 * max(across, earlier, later):
        return
    ring[slot].flags |= BAD_SAMPLES
    for j in range(3):
        ring[slot].gyro_radps[j] = 0.5 * (ring[before].gyro_radps[j] + ring[after].gyro_radps[j])
