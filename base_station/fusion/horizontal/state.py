"""Layout of the state of ``HorizontalFilter``, and Jacobians of its observations.

``[north, east, c, s, b_n, b_e, k_n, k_e, w]``; see ``horizontal``.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.kernels import DRIFT, STATES

Floats = NDArray[np.float64]

SLOW = slice(4, 8)  # of the fixes' errors
PLACE_AND_SLOW = [0, 1, 4, 5, 6, 7]
SCALE = 4  # column of particles, which are [north, east, turn, drift, scale]
PATH = [0, 1, 2, 3, DRIFT]  # of the path, in the order of ``port.Posterior``


def turn_and_std(mean: Floats, covariance: Floats) -> tuple[float, float]:
    """Heading correction of such a state and its standard deviation, pi where it is not known."""
    c, s = float(mean[2]), float(mean[3])
    scale2 = c * c + s * s
    if scale2 < 0.05:
        return 0.0, math.pi
    across = np.array([-s, c]) / scale2
    variance = float(across @ covariance[2:4, 2:4] @ across)
    return math.atan2(s, c), min(math.sqrt(max(variance, 0.0)), math.pi)


def place_jacobian(north_m: float, east_m: float) -> Floats:
    """(2, 9): the place before this much of own path was walked, by the present state."""
    observe = np.zeros((2, STATES))
    observe[0, :4] = 1.0, 0.0, -north_m, east_m
    observe[1, :4] = 0.0, 1.0, -east_m, -north_m
    return observe
