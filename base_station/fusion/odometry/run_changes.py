"""Changes of a unit's own path that no walking explains: it jumps, or its program starts again."""

from __future__ import annotations

import math

from base_station.fusion.parameters import Parameters
from shared.clock import NS_PER_S
from shared.messages import Position


def jump_m(kind: Parameters, last: Position, position: Position, duration_s: float) -> float:
    """Distance to a position that is out of a wearer's reach in that time; 0 of others."""
    apart_m = math.hypot(position.north_m - last.north_m, position.east_m - last.east_m)
    return apart_m if apart_m > kind.fastest_mps * max(duration_s, 0.2) + 1.0 else 0.0


def strayed_m(kind: Parameters, jumped_m: float, duration_s: float) -> float:
    """Standard deviation, each axis, of the movement that a jump of the own path hides."""
    return min(max(kind.unguided_mps * duration_s, kind.restart_m), jumped_m)


def set_back_ns(last_ns: int, t_ns: int, outage_s: float) -> int:
    """Times of the run before are this much later than in the clock of the run that begins.

    ``last_ns``, ``t_ns``: monotonic times of the last position of that run and the first one of
    this; with an unknown outage the clock went on or went back.
    """
    if 0.0 < outage_s < math.inf:
        return last_ns + round(outage_s * NS_PER_S) - t_ns
    return max(0, last_ns - t_ns)
