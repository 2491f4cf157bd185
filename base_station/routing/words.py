"""Routes in words, for a member's unit and for the console."""

from __future__ import annotations

import math
from collections.abc import Sequence

from base_station.routing.interface import Waypoint
from base_station.routing.legs import SHORTEST_M, RouteLeg

_COMPASS = (
    "north",
    "north-east",
    "east",
    "south-east",
    "south",
    "south-west",
    "west",
    "north-west",
)
_NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
_TURNS = {"ahead": "", "left": "left", "right": "right", "back": "turn back"}


def route_text(legs: Sequence[RouteLeg]) -> str:
    """Legs as in "14 m to the stairs, up one floor, left, 9 m"; where it is not known how the
    rescuer stands, the way is named by the compass.
    """
    return ", ".join(part for leg in legs for part in _parts(leg)) or "beside you"


def line_text(begin: Waypoint, end: Waypoint) -> str:
    """Straight line as in "no known way; 23 m to the north-east, one floor up"."""
    north_m, east_m = end.north_m - begin.north_m, end.east_m - begin.east_m
    distance_m = math.hypot(north_m, east_m)
    text = f"no known way; {_metres(distance_m)} to the {compass(math.atan2(east_m, north_m))}"
    if begin.floor is None or end.floor is None:
        return f"{text}, floor unknown"
    floors = end.floor - begin.floor
    if floors == 0:
        return text
    return f"{text}, {_floors(floors)} {'up' if floors > 0 else 'down'}"


def compass(bearing_rad: float) -> str:
    """Point of the compass nearest to a bearing."""
    return _COMPASS[round(bearing_rad / math.tau * 8.0) % 8]


def _parts(leg: RouteLeg) -> list[str]:
    """Parts of a sentence: turn, way and climb."""
    parts: list[str] = []
    if leg.distance_m >= SHORTEST_M:
        turn = compass(leg.bearing_rad) if leg.turn is None else _TURNS[leg.turn]
        parts += [turn] if turn else []
        parts.append(_metres(leg.distance_m) + (" to the stairs" if leg.floors else ""))
    if leg.floors:
        parts.append(f"{'up' if leg.floors > 0 else 'down'} {_floors(leg.floors)}")
    return parts


def _metres(distance_m: float) -> str:
    return f"{max(1, round(distance_m))} m"


def _floors(floors: int) -> str:
    count = abs(floors)
    number = _NUMBERS[count] if count < len(_NUMBERS) else str(count)
    return f"{number} floor" if count == 1 else f"{number} floors"
