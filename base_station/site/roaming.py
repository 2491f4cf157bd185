"""Where somebody can be who is not heard: as far as people walk, from where that was last known."""

from __future__ import annotations

import math

RADII_95 = math.sqrt(-2.0 * math.log(0.05))  # of a plane's normal distribution
SILENT_S = 10.0  # until then a position is as good as new
ROAMING_MPS = 1.0  # how fast the region widens (ours)
ROAMING_MOST_M = 250.0


def roamed_m(age_s: float) -> float:
    """How far a wearer may have got who has not been heard for a while."""
    return 0.0 if age_s < SILENT_S else min(ROAMING_MPS * age_s, ROAMING_MOST_M)
