"""Turns legs into the movements of a body, stride by stride."""

from __future__ import annotations

from math import atan2, ceil, cos, hypot, pi, radians, remainder, sin

import numpy as np

from edge.simulation.body_plan import BodyPlan
from edge.simulation.gait import PACES, STAIRS_PACES, TURN, Gait
from edge.simulation.idle_movements import raise_foot, sit, stay_kneeling, wait
from edge.simulation.legs import (
    Kneel,
    Leg,
    Lie,
    Point,
    RaiseFoot,
    Ride,
    Sit,
    Spiral,
    StairsLeg,
    Stand,
    Turn,
    Wait,
    Walk,
)
from edge.simulation.movements import kneel, lie, pull, ride, rise, stand, stride, unwrapped
from edge.simulation.polyline import Polyline, arc, split_at_sharp_turns

HALF_TRACK_M = 0.09  # from the body's middle to the foot
_SHARP_RAD = radians(100)  # from here on a person stops and turns
_AROUND_RAD = radians(50)  # before walking off further aside, a person turns on the spot


class Planner:
    """Walks through legs, keeping the place and the heading."""

    def __init__(
        self, rng: np.random.Generator, start: Point, down_m: float, heading_rad: float
    ) -> None:
        self._rng = rng
        self._middle = start
        self._heading_rad = heading_rad
        north_m, east_m = _foothold(start, heading_rad)
        self.plan = BodyPlan(north_m, east_m, down_m, heading_rad)

    def do(self, leg: Leg) -> None:
        if isinstance(leg, Walk):
            self._walk(leg)
        elif isinstance(leg, StairsLeg | Spiral):
            self._climb(leg)
        elif isinstance(leg, Stand):
            stand(self.plan, leg.duration_s)
        elif isinstance(leg, Wait):
            wait(self.plan, self._rng, leg.duration_s)
        elif isinstance(leg, Kneel):
            stay_kneeling(self.plan, self._rng, leg.duration_s)
        elif isinstance(leg, Sit):
            sit(self.plan, self._rng, leg.duration_s)
        elif isinstance(leg, RaiseFoot):
            for _ in range(leg.times):
                raise_foot(self.plan, self._rng, leg.height_m)
        elif isinstance(leg, Ride):
            ride(self.plan, leg.rise_m, leg.speed_mps)
        elif isinstance(leg, Turn):
            self._face(radians(leg.heading_deg))
        elif isinstance(leg, Lie):
            lie(self.plan, leg.duration_s, leg.fall)
        else:
            self._crawl(leg.to)

    def _face(self, heading_rad: float, at_least_rad: float = radians(5)) -> None:
        """Turn on the spot in as many strides as a person needs."""
        turn_rad = remainder(heading_rad - self._heading_rad, 2.0 * pi)
        if abs(turn_rad) < at_least_rad:
            return
        strides = ceil(abs(turn_rad) / radians(65))
        for _ in range(strides):
            self._stride(TURN, self._middle, self._heading_rad + turn_rad / strides)

    def _walk(self, walk: Walk) -> None:
        gait = PACES[walk.pace]
        lines = split_at_sharp_turns(self._middle, walk.to, _SHARP_RAD)
        slope = walk.rise_m / max(sum(line.length_m for line in lines), 0.01)
        for line in lines:
            self._face(line.heading_rad(0.0, 0.1) + gait.facing_rad, _AROUND_RAD)
            strides = max(1, round(line.length_m / gait.stride_m))
            reach_m = 0.35 * gait.stride_m
            begin_down_m = self.plan.down.last
            for k in range(1, strides + 1):
                along_m = line.length_m * k / strides
                if k < strides:
                    along_m += self._rng.normal(0.0, 0.03) * gait.stride_m
                heading_rad = line.heading_rad(along_m, reach_m) + gait.facing_rad
                down_m = begin_down_m - slope * along_m if walk.rise_m else None
                if gait.uneven_m:
                    pile_m = abs(self._rng.normal(0.0, gait.uneven_m)) if k < strides else 0.0
                    down_m = begin_down_m - slope * along_m - float(pile_m)
                self._stride(gait, line.point(along_m), heading_rad, down_m)

    def _climb(self, stairs: StairsLeg | Spiral) -> None:
        line = self._way_up(stairs)
        self._face(line.heading_rad(0.0, 0.1))
        gait = STAIRS_PACES[stairs.pace][stairs.rise_m > 0.0]
        floor_down_m = self.plan.down.last
        stride = 2 * stairs.at_once
        for tread in [*range(stride, stairs.risers, stride), stairs.risers]:
            # A foot stands in the middle of a tread; the last riser leads to the landing.
            along_m = line.length_m * min((tread - 0.5) / (stairs.risers - 0.5), 1.0)
            down_m = floor_down_m - stairs.rise_m * tread / stairs.risers
            self._stride(gait, line.point(along_m), line.heading_rad(along_m, 0.1), down_m)

    def _way_up(self, stairs: StairsLeg | Spiral) -> Polyline:
        if isinstance(stairs, StairsLeg):
            return Polyline((self._middle, stairs.to))
        north_m = self._middle[0] - stairs.middle[0]
        east_m = self._middle[1] - stairs.middle[1]
        from_rad, turn_rad = atan2(east_m, north_m), radians(stairs.turn_deg)
        around = arc(stairs.middle, hypot(north_m, east_m), from_rad, from_rad + turn_rad)
        return Polyline((self._middle, *around))

    def _stride(
        self, gait: Gait, middle: Point, heading_rad: float, down_m: float | None = None
    ) -> None:
        yaw_rad = unwrapped(heading_rad, self.plan.yaw.last)
        yaw_rad += float(self._rng.normal(0.0, radians(2)))
        stride(self.plan, self._rng, gait, _foothold(middle, yaw_rad), yaw_rad, down_m)
        self._middle, self._heading_rad = middle, heading_rad

    def _crawl(self, to: tuple[Point, ...]) -> None:
        for line in split_at_sharp_turns(self._middle, to, _SHARP_RAD):
            self._face(line.heading_rad(0.0, 0.1), _AROUND_RAD)
            kneel(self.plan)
            pulls = max(1, round(line.length_m / 0.45))
            for k in range(1, pulls + 1):
                along_m = line.length_m * k / pulls
                middle, heading_rad = line.point(along_m), line.heading_rad(along_m, 0.2)
                yaw_rad = unwrapped(heading_rad, self.plan.yaw.last)
                pull(self.plan, self._rng, _foothold(middle, yaw_rad), yaw_rad)
                self._middle, self._heading_rad = middle, heading_rad
            rise(self.plan)


def _foothold(middle: Point, yaw_rad: float) -> Point:
    """The right foot stands beside the body's middle."""
    return middle[0] - HALF_TRACK_M * sin(yaw_rad), middle[1] + HALF_TRACK_M * cos(yaw_rad)
