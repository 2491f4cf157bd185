"""Route as legs that a person can follow without sight: turns, metres and floors."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Literal

import msgspec

from base_station.routing.interface import Waypoint

Turn = Literal["ahead", "left", "right", "back"]

AHEAD_RAD = math.radians(35.0)  # less is no turn for a hand along a wall (own choice)
BACK_RAD = math.radians(145.0)
SHORTEST_M = 1.5  # a shorter leg is the corner between two others, or the place of a wearer at rest
LANDING_M = 4.0  # a shorter way between two flights is their landing


class RouteLeg(msgspec.Struct, frozen=True):
    """Leg of a route: a turn, a straight way, and the floors that are climbed at its end."""

    # From the leg before, at first from the rescuer's heading; None where it is not known how the
    # rescuer stands then: at a begin without a heading, and behind stairs that a plan shows.
    turn: Turn | None
    bearing_rad: float  # of the leg, clockwise from north
    distance_m: float
    floors: int  # climbed at its end, negative: down; 0: it leads on, or to the member


def legs_of(places: Sequence[Waypoint], heading_rad: float | None) -> tuple[RouteLeg, ...]:
    """Legs between a route's corners; ``heading_rad`` is the rescuer's, None if it is not known."""
    return tuple(_with_turns(list(_without_landings(list(_stretches(places)))), heading_rad))


class _Stretch(msgspec.Struct):
    north_m: float
    east_m: float
    floors: int = 0
    is_behind_plan_stairs: bool = False

    @property
    def length_m(self) -> float:
        return math.hypot(self.north_m, self.east_m)

    @property
    def bearing_rad(self) -> float:
        return math.atan2(self.east_m, self.north_m)


def _stretches(places: Sequence[Waypoint]) -> Iterator[_Stretch]:
    """Straight parts; a change of floor belongs to the part before it."""
    leg, is_plan_climb = _Stretch(0.0, 0.0), False
    for before, place in pairwise(places):
        part = _Stretch(place.north_m - before.north_m, place.east_m - before.east_m)
        if before.floor != place.floor:
            climbed = _climbed(before.floor, place.floor)
            leg.floors += climbed
            is_plan_climb = climbed != 0 and part.length_m == 0.0  # a trail continues meanwhile
        elif leg.floors == 0 and _is_one(leg, part):
            leg.north_m, leg.east_m = leg.north_m + part.north_m, leg.east_m + part.east_m
        else:
            yield leg
            leg = part
            leg.is_behind_plan_stairs, is_plan_climb = is_plan_climb, False
    yield leg


def _is_one(leg: _Stretch, part: _Stretch) -> bool:
    if min(leg.length_m, part.length_m) < SHORTEST_M:
        return True
    return _turn(leg.bearing_rad, part.bearing_rad) == "ahead"


def _climbed(before: int | None, floor: int | None) -> int:
    return 0 if before is None or floor is None else floor - before


def _without_landings(legs: list[_Stretch]) -> Iterator[_Stretch]:
    """Flights of one staircase as one climb; a flight that is walked back at once is none."""
    held: _Stretch | None = None
    for leg in legs:
        if held is not None and held.floors and leg.floors and leg.length_m < LANDING_M:
            held.floors += leg.floors
        else:
            if held is not None:
                yield held
            held = leg
    if held is not None:
        yield held


def _with_turns(legs: list[_Stretch], heading_rad: float | None) -> Iterator[RouteLeg]:
    facing_rad = heading_rad
    for leg in legs:
        if leg.is_behind_plan_stairs:
            facing_rad = None
        if leg.length_m < SHORTEST_M:
            yield RouteLeg("ahead", leg.bearing_rad, leg.length_m, leg.floors)
            continue
        turn = None if facing_rad is None else _turn(facing_rad, leg.bearing_rad)
        yield RouteLeg(turn, leg.bearing_rad, leg.length_m, leg.floors)
        facing_rad = leg.bearing_rad


def _turn(facing_rad: float, bearing_rad: float) -> Turn:
    turned_rad = math.remainder(bearing_rad - facing_rad, math.tau)
    if abs(turned_rad) < AHEAD_RAD:
        return "ahead"
    if abs(turned_rad) > BACK_RAD:
        return "back"
    return "right" if turned_rad > 0.0 else "left"
