"""Bound of the distance that a member without contact can have walked."""

from __future__ import annotations

import math

RADII_95 = math.sqrt(-2.0 * math.log(0.05))  # of a plane's normal distribution
SILENT_S = 10.0  # until then a position is as good as new
MAX_TRAVEL_MPS = 1.0  # how fast the region widens (ours)
MAX_TRAVEL_M = 250.0


def max_travel_m(age_s: float) -> float:
    """Longest distance walked in a time without contact."""
    return 0.0 if age_s < SILENT_S else min(MAX_TRAVEL_MPS * age_s, MAX_TRAVEL_M)
