"""How a unit's own path grows, and its errors with it: by way, turns and climbs, not by time
standing still.
"""

from __future__ import annotations

import math

import msgspec

from base_station.fusion.parameters import Parameters
from shared.clock import NS_PER_S
from shared.geo import wrap_pi
from shared.messages import Position
from shared.quality import Quality

MOVING_MPS = 0.1
TURN_SEEN_M = 0.1  # of way that has a direction
LEARNT_S = 10.0  # moved, after which the unit's own heading says how fast it drifts
SUDDEN = 3.0  # so much faster than that, a heading's uncertainty has grown by something else


class Stretch(msgspec.Struct, frozen=True):
    """From one position to the next, in the unit's own frame."""

    north_m: float
    east_m: float
    down_m: float
    length_m: float
    moving_s: float
    place_var_m2: float  # what it added, each axis
    turn_var: float


class OwnPath(msgspec.Struct):
    """What has to be remembered to judge the next stretch."""

    last_step_rad: float | None = None  # direction of the last increment
    first_heading_std_rad: float = 0.0
    moving_s: float = 0.0

    def stretch(self, kind: Parameters, last: Position | None, position: Position) -> Stretch:
        """From ``last``, or from the frame's origin, to ``position``."""
        north_m, east_m, down_m = position.north_m, position.east_m, position.down_m
        duration_s = sudden_var = doubt_m2 = 0.0
        if last is None:
            self.first_heading_std_rad, self.moving_s = position.heading_std_rad, 0.0
        else:
            north_m, east_m, down_m = (
                north_m - last.north_m,
                east_m - last.east_m,
                down_m - last.down_m,
            )
            duration_s = max(0.0, (position.header.t_mono_ns - last.header.t_mono_ns) / NS_PER_S)
            if position.heading_std_rad > last.heading_std_rad:
                sudden_var = self._sudden_var(kind, last, position, duration_s)
            if position.quality is not Quality.GOOD:
                furthest_m = kind.fastest_mps * duration_s
                doubt_m2 = min(_added_m2(last, position), furthest_m**2)
        length_m = math.hypot(north_m, east_m)
        moving_s = duration_s if length_m > MOVING_MPS * duration_s else 0.0
        self.moving_s += moving_s
        turned_rad = self._turned(north_m, east_m) if length_m >= TURN_SEEN_M else 0.0
        return Stretch(
            north_m,
            east_m,
            down_m,
            length_m,
            moving_s,
            kind.walk_m_per_sqrt_m**2 * length_m + doubt_m2,
            kind.turn_rad_per_sqrt_m**2 * length_m
            + sudden_var
            + (kind.turn_part * turned_rad) ** 2,
        )

    def drift_radps(self, kind: Parameters, position: Position) -> float:
        """How fast its heading may drift, by what the unit itself says."""
        if self.moving_s < LEARNT_S:
            return kind.drift_radps
        grown_rad = max(0.0, position.heading_std_rad - self.first_heading_std_rad)
        stated_radps = kind.drift_doubt * grown_rad / self.moving_s
        return min(max(stated_radps, kind.drift_least_radps), kind.drift_most_radps)

    def _sudden_var(
        self, kind: Parameters, last: Position, position: Position, duration_s: float
    ) -> float:
        """What the unit says of its heading beyond its drift."""
        grown = position.heading_std_rad**2 - last.heading_std_rad**2
        usual_rad = SUDDEN * self.drift_radps(kind, last) * duration_s
        return max(0.0, grown - 2.0 * position.heading_std_rad * usual_rad)

    def _turned(self, north_m: float, east_m: float) -> float:
        step_rad = math.atan2(east_m, north_m)
        last_rad, self.last_step_rad = self.last_step_rad, step_rad
        return 0.0 if last_rad is None else abs(wrap_pi(step_rad - last_rad))


def _added_m2(last: Position, position: Position) -> float:
    """By how much the unit calls its place less sure."""
    before_m, now_m = (max(one.std_north_m, one.std_east_m) for one in (last, position))
    return max(0.0, now_m**2 - before_m**2)
