"""Initial alignment: attitude from gravity in the stillest window at hand.

No wearer stands still on command, and a unit may be switched on while its wearer runs.  The
attitude comes from the mean specific force of the stillest short window, and its standard deviation
from how still that window was.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from edge.samples import Floats
from edge.tracker.foot.config import EskfConfig
from edge.tracker.mechanization.quasi_static import turn_upright
from edge.tracker.mechanization.strapdown import rotate_attitude
from edge.tracker.preprocessing.sample_ring import Ring


@njit()
def stillest_window(ring: Ring, first: int, stop: int, window_s: float) -> tuple[int, int]:
    """Return the first sample and one past the last of the window with the least motion."""
    mask = len(ring) - 1
    best = np.inf
    best_first = first
    best_stop = first + 1
    end = first
    total = 0.0
    for begin in range(first, stop):
        while end < stop and ring[end & mask].t_s - ring[begin & mask].t_s <= window_s:
            total += ring[end & mask].motion_m2ps4
            end += 1
        mean = total / (end - begin)
        if mean < best:
            best, best_first, best_stop = mean, begin, end
        if end == stop:
            break
        total -= ring[begin & mask].motion_m2ps4
    return best_first, best_stop


@njit()
def level(
    ring: Ring,
    first: int,
    stop: int,
    ahead_s: float,
    config: EskfConfig,
    quaternion_nb: Floats,
) -> float:
    """Turn ``quaternion_nb`` (in place) so that it is level at sample ``first``.

    Looks at samples before ``stop`` and at most ``ahead_s`` after ``first``.  The smallest
    turn that does it is taken, so the heading stays as good as it was.
    Returns the tilt's standard deviation in rad.
    """
    mask = len(ring) - 1
    while stop > first + 1 and ring[(stop - 1) & mask].t_s - ring[first & mask].t_s > ahead_s:
        stop -= 1
    begin, end = stillest_window(ring, first, stop, config.start.window_s)
    middle = (begin + end) // 2
    mean_b = np.zeros(3)
    motion = 0.0
    for i in range(begin, end):
        motion += ring[i & mask].motion_m2ps4 / (end - begin)
        for j in range(3):
            mean_b[j] += ring[i & mask].accel_mps2[j] / (end - begin)
    turn_by_gyro(ring, first, middle, quaternion_nb)
    turn_upright(quaternion_nb, mean_b)
    turn_by_gyro(ring, middle, first, quaternion_nb)
    return config.start.tilt_std_rad + config.start.tilt_per_motion * min(math.sqrt(motion), 5.0)


@njit()
def turn_by_gyro(ring: Ring, first: int, last: int, quaternion_nb: Floats) -> None:
    """Carry an attitude from sample ``first`` to ``last``, forward or backward, in place."""
    mask = len(ring) - 1
    angle_rad = np.zeros(3)
    step = 1 if last > first else -1
    for k in range(first, last, step):
        here, there = k & mask, (k + step) & mask
        dt_s = ring[there].t_s - ring[here].t_s
        for j in range(3):
            angle_rad[j] = 0.5 * dt_s * (ring[here].gyro_radps[j] + ring[there].gyro_radps[j])
        rotate_attitude(quaternion_nb, angle_rad)
