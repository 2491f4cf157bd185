"""Quality of an estimate, with a reason for a person."""

from __future__ import annotations

import math

from base_station.fusion.kernels import HorizontalEstimate
from base_station.fusion.parameters import Parameters
from shared.messages import Position
from shared.quality import DEGRADED, GOOD, LOST, NOT_OF_STEPS, Quality, Reason, in_words


def quality_of(
    kind: Parameters,
    placed: HorizontalEstimate,
    last: Position | None,
    *,
    assumed: bool,
    split: bool,
) -> tuple[Quality, str]:
    """Quality and the first reason against it.

    ``last``: the unit's own position; ``assumed``: nothing ties the own frame to the incident
    frame; ``split``: walls leave more than one place open.
    """
    tracker = GOOD if last is None else last.path_quality
    if tracker is LOST:
        return LOST, f"the unit's tracker is lost{_why(last)}"
    std_m, reason = math.hypot(placed.std_north_m, placed.std_east_m), ""
    if std_m > kind.lost_m and not assumed:
        return LOST, f"within {2.0 * std_m:.0f} m"
    if assumed:
        reason = "start not known: shown about the unit's own start"
    elif placed.turn_std_rad > kind.aligned_rad:
        reason = "heading not known yet"
    elif split:
        reason = "walls leave more than one place open"
    elif std_m > kind.unsure_m:
        reason = f"within {2.0 * std_m:.0f} m"
    elif tracker is DEGRADED:
        reason = f"the unit's tracker is unsure{_why(last)}"
    elif last is not None and last.reasons & Reason.UNSETTLED:
        reason = in_words(Reason.UNSETTLED)
    return (DEGRADED, reason) if reason else (GOOD, "")


def _why(last: Position | None) -> str:
    reasons = Reason.NONE if last is None else last.reasons & ~NOT_OF_STEPS
    return f": {in_words(reasons)}" if reasons else ""
