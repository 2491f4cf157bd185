"""Own path between a fix and the present, with its error."""

from __future__ import annotations

import math

import msgspec

from base_station.fusion.odometry.recent_path import PathPoint
from base_station.fusion.parameters import Parameters
from shared.clock import NS_PER_S
from shared.messages import Position


class PathSinceFix(msgspec.Struct, frozen=True):
    """In the unit's own frame."""

    north_m: float
    east_m: float
    way_m: float
    lasted_s: float

    def error_m2(self, kind: Parameters, drift_std_radps: float) -> float:
        """Variance, each axis, by which the path since may be wrong beyond its present turn."""
        turn_var = kind.turn_rad_per_sqrt_m**2 * self.way_m + (drift_std_radps * self.lasted_s) ** 2
        apart_m2 = self.north_m**2 + self.east_m**2
        return kind.walk_m_per_sqrt_m**2 * self.way_m + turn_var * apart_m2


def path_since_fix(then: PathPoint, last: Position | None) -> PathSinceFix:
    if last is None:
        return PathSinceFix(0.0, 0.0, 0.0, 0.0)
    return PathSinceFix(
        last.north_m - then.north_m,
        last.east_m - then.east_m,
        abs(last.distance_m - then.distance_m),
        max(0.0, (last.header.t_mono_ns - then.t_ns) / NS_PER_S),
    )


def walls_std_m(kind: Parameters, outside_m: float) -> float:
    """Deviation that a building adds to a fix beside or in it."""
    if outside_m < -1.0:
        return kind.inside_std_m
    return kind.wall_std_m * math.exp(-max(outside_m, 0.0) / kind.wall_reach_m)


def unguided_m2(kind: Parameters, t_mono_ns: int, last_ns: int | None) -> float:
    """Variance of the movement since the last position of the own path."""
    if last_ns is None or t_mono_ns - last_ns < NS_PER_S:
        return 0.0
    return (kind.unguided_mps * (t_mono_ns - last_ns) / NS_PER_S) ** 2
