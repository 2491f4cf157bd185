"""How far a place can be trusted, in words for a person."""

from __future__ import annotations

import math

from base_station.fusion.kernels import Placed
from base_station.fusion.parameters import Parameters
from shared.quality import Quality


def quality_of(
    kind: Parameters, placed: Placed, tracker: Quality, *, assumed: bool, split: bool
) -> tuple[Quality, str]:
    """Quality and the first reason against it.

    ``tracker``: as the unit says of its own path; ``assumed``: nothing ties the own frame to the
    incident frame; ``split``: walls leave more than one place open.
    """
    if tracker is Quality.LOST:
        return Quality.LOST, "the unit's tracker is lost"
    std_m, reason = math.hypot(placed.std_north_m, placed.std_east_m), ""
    if std_m > kind.lost_m and not assumed:
        return Quality.LOST, f"within {2.0 * std_m:.0f} m"
    if assumed:
        reason = "start not known: shown about the unit's own start"
    elif placed.turn_std_rad > kind.aligned_rad:
        reason = "heading not known yet"
    elif split:
        reason = "walls leave more than one place open"
    elif std_m > kind.unsure_m:
        reason = f"within {2.0 * std_m:.0f} m"
    elif tracker is Quality.DEGRADED:
        reason = "the unit's tracker is unsure"
    return (Quality.DEGRADED, reason) if reason else (Quality.GOOD, "")
