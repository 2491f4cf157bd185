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
    if assumed:
        return Quality.DEGRADED, "start not known: shown about the unit's own start"
    std_m = math.hypot(placed.std_north_m, placed.std_east_m)
    if std_m > kind.lost_m:
        return Quality.LOST, f"within {2.0 * std_m:.0f} m"
    if placed.turn_std_rad > kind.aligned_rad:
        return Quality.DEGRADED, "heading not known yet"
    if split:
        return Quality.DEGRADED, "walls leave more than one place open"
    if std_m > kind.unsure_m:
        return Quality.DEGRADED, f"within {2.0 * std_m:.0f} m"
    unsure = tracker is Quality.DEGRADED
    return (Quality.DEGRADED, "the unit's tracker is unsure") if unsure else (Quality.GOOD, "")
