"""Rejection of single-sample spikes of the rate: disturbed transfers.

A spike within the sensor's range would turn the foot for good, by a degree or more; one of the
accelerometer is corrected by the next stance.  The force of a strike may come and go in one sample,
too; a rate is an integral and may not.
"""

from __future__ import annotations

from numba import njit

from edge.tracker.preprocessing.preprocess import BAD_SAMPLES, SAMPLE_GAP
from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.preprocessing.saturation_detection import GYRO_SATURATED

SPIKE_NEIGHBOURS = 2  # samples on either side
RATE_MIN_RADPS = 1.5
SPIKE_RATIO = 4.0  # to any change around it; 2.5 at most in 46 recorded walks of 200 to 400 Hz


@njit()
def reject_spike(ring: Ring, k: int) -> None:
    """Mark sample ``k`` as bad where it is a spike between two good ones on either side, and give
    it the rate halfway between its neighbours.
    """
    mask = len(ring) - 1
    if k < SPIKE_NEIGHBOURS:
        return
    for i in range(k - SPIKE_NEIGHBOURS, k + SPIKE_NEIGHBOURS + 1):
        if ring[i & mask].flags & (BAD_SAMPLES | SAMPLE_GAP | GYRO_SATURATED):
            return
    slot = k & mask
    before, after = (k - 1) & mask, (k + 1) & mask
    off = 0.0
    across = 0.0
    earlier = 0.0
    later = 0.0
    for j in range(3):
        previous, following = ring[before].gyro_radps[j], ring[after].gyro_radps[j]
        off += (ring[slot].gyro_radps[j] - 0.5 * (previous + following)) ** 2
        across += (following - previous) ** 2
        earlier += (previous - ring[(k - 2) & mask].gyro_radps[j]) ** 2
        later += (ring[(k + 2) & mask].gyro_radps[j] - following) ** 2
    if off < RATE_MIN_RADPS**2 or off < SPIKE_RATIO**2 * max(across, earlier, later):
        return
    ring[slot].flags |= BAD_SAMPLES
    for j in range(3):
        ring[slot].gyro_radps[j] = 0.5 * (ring[before].gyro_radps[j] + ring[after].gyro_radps[j])
