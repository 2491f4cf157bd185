"""Motion in which no step is found: a crawl, a foot felt ahead, a vehicle.

The wearer moves on at a velocity that is not known and keeps its direction for a while
(Gauss-Markov), so that the place is lost faster than by chance alone.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit


class UnseenMotion(NamedTuple):
    """Velocity of an axis, and for how long it keeps its direction."""

    std_mps: float = 0.25
    lasting_s: float = 5.0
    after_s: float = 1.6  # without a step: longer than one lasts
    rest_s: float = 2.0  # quiet for so long ends it; who feels their way halts for less


@njit()
def unseen_m2(moving_s: float, dt_s: float, unseen: UnseenMotion) -> float:
    """Return by what the variance of an axis grows in ``dt_s``, ``moving_s`` after the last step.

    0 until a step has had its time.
    """
    if moving_s <= unseen.after_s:
        return 0.0
    correlated_s = unseen.lasting_s * (1.0 - math.exp(-moving_s / unseen.lasting_s))
    return 2.0 * unseen.std_mps**2 * correlated_s * dt_s
