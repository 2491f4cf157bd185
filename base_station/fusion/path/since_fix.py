"""What lies between a fix and the present: the path walked since, and what it is worth."""

from __future__ import annotations

import math

import msgspec

from base_station.fusion.parameters import Parameters
from base_station.fusion.path.recent_path import OwnPlace
from shared.clock import NS_PER_S
from shared.messages import Position


class Since(msgspec.Struct, frozen=True):
    """In the unit's own frame."""

    north_m: float
    east_m: float
    way_m: float
    lasted_s: float

    def doubt_m2(self, kind: Parameters, drift_std_radps: float) -> float:
        """Variance, each axis, by which the path since may be wrong beyond its present turn."""
        turn_var = kind.turn_rad_per_sqrt_m**2 * self.way_m + (drift_std_radps * self.lasted_s) ** 2
        apart_m2 = self.north_m**2 + self.east_m**2
        return kind.walk_m_per_sqrt_m**2 * self.way_m + turn_var * apart_m2


def since_then(then: OwnPlace, last: Position | None) -> Since:
    if last is None:
        return Since(0.0, 0.0, 0.0, 0.0)
    return Since(
        last.north_m - then.north_m,
        last.east_m - then.east_m,
        abs(last.distance_m - then.distance_m),
        max(0.0, (last.header.t_mono_ns - then.t_ns) / NS_PER_S),
    )


def walls_std_m(kind: Parameters, outside_m: float) -> float:
    """What the building does to a fix taken beside or in it."""
    if outside_m < -1.0:
        return kind.inside_std_m
    return kind.wall_std_m * math.exp(-max(outside_m, 0.0) / kind.wall_reach_m)


def unguided_m2(kind: Parameters, t_mono_ns: int, heard_ns: int | None) -> float:
    """How far a wearer may have got by then, when the own path was last heard of before."""
    if heard_ns is None or t_mono_ns - heard_ns < NS_PER_S:
        return 0.0
    return (kind.unguided_mps * (t_mono_ns - heard_ns) / NS_PER_S) ** 2
