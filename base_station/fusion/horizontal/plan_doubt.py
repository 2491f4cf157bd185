"""Doubt of the plan: what walls cost a cloud of late speaks for the estimate that uses no walls.

Two hypotheses: the plan holds for the person, and the cloud is right; or it does not (they left an
upper floor by a window, or walls are drawn that are not there), and the filter without walls is.
Under the second a wall costs nothing. So the odds of the second are its prior odds times the
likelihood that walls have cost the cloud, and the estimate is the mixture of both. A plan that is
right costs something as well, as particles are pruned by it; the prior probability is therefore
left out, as what the cloud states was measured without it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Moments = tuple[Floats, Floats]

PRIOR_WITHOUT_PLAN = 0.02  # that the plan does not hold for a stretch of the way
MIN_PART = 1e-3  # below, the cloud alone is stated


def part_without_plan(log_loss: float) -> float:
    """Probability that the plan does not hold beyond its prior, by the logarithm (0 or more) of the
    likelihood that walls have cost.
    """
    log_odds = log_loss + math.log(PRIOR_WITHOUT_PLAN / (1.0 - PRIOR_WITHOUT_PLAN))
    posterior = 1.0 / (1.0 + math.exp(-log_odds))
    part = (posterior - PRIOR_WITHOUT_PLAN) / (1.0 - PRIOR_WITHOUT_PLAN)
    return part if part > MIN_PART else 0.0


def mixture(part: float, one: Moments, other: Moments) -> Moments:
    """Mean (n,) and covariance (n, n) of a mixture of ``one`` by ``part`` and the ``other``."""
    apart = one[0] - other[0]
    spread = part * one[1] + (1.0 - part) * other[1]
    return other[0] + part * apart, spread + part * (1.0 - part) * np.outer(apart, apart)
