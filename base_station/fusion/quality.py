"""How far a place can be trusted, in words for a person."""

from __future__ import annotations

import msgspec

from base_station.fusion.parameters import Parameters
from shared.quality import Quality


class Knowledge(msgspec.Struct, frozen=True):
    std_m: float  # of the place
    turn_std_rad: float  # of the own frame's heading
    tracker: Quality  # as the unit says of its own path
    assumed: bool  # nothing ties the own frame to the incident frame


def judge(kind: Parameters, known: Knowledge) -> tuple[Quality, str]:
    """Quality and the first reason against it."""
    within = f"within {2.0 * known.std_m:.0f} m"
    causes = (
        (known.tracker is Quality.LOST, Quality.LOST, "the unit's tracker is lost"),
        (known.assumed, Quality.DEGRADED, "start not known: shown about the unit's own start"),
        (known.std_m > kind.lost_m, Quality.LOST, within),
        (known.turn_std_rad > kind.aligned_rad, Quality.DEGRADED, "heading not known yet"),
        (known.std_m > kind.unsure_m, Quality.DEGRADED, within),
        (known.tracker is Quality.DEGRADED, Quality.DEGRADED, "the unit's tracker is unsure"),
    )
    return next(((quality, why) for holds, quality, why in causes if holds), (Quality.GOOD, ""))
