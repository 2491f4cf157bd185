"""Routes as legs and in words."""

from __future__ import annotations

import math

from base_station.routing.interface import Waypoint
from base_station.routing.legs import legs_of
from base_station.routing.words import line_text, route_text

NORTH_RAD, EAST_RAD = 0.0, math.pi / 2


def words(places: list[tuple[float, float, int | None]], heading_rad: float | None) -> str:
    return route_text(legs_of([Waypoint(*place) for place in places], heading_rad))


def test_sentence_of_a_route() -> None:
    way: list[tuple[float, float, int | None]] = [
        (0, 0, 0),
        (14, 0, 0),
        (16, 0, 1),
        (16, -9, 1),
    ]
    assert words(way, NORTH_RAD) == "14 m to the stairs, up one floor, left, 9 m"
    assert words(way, EAST_RAD) == "left, 14 m to the stairs, up one floor, left, 9 m"
    assert words(way, None) == "north, 14 m to the stairs, up one floor, left, 9 m"
    assert words(way[::-1], EAST_RAD) == "9 m to the stairs, down one floor, right, 14 m"
    assert words(way[::-1], -EAST_RAD).startswith("turn back, 9 m")


def test_legs_behind_stairs_of_a_plan_have_compass_directions() -> None:
    """A plan does not state how its stairs turn."""
    assert (
        words([(0, 0, 0), (10, 0, 0), (10, 0, 1), (10, 8, 1), (2, 8, 1)], NORTH_RAD)
        == "10 m to the stairs, up one floor, east, 8 m, right, 8 m"
    )


def test_two_flights_are_one_climb_and_small_bends_are_no_turns() -> None:
    way: list[tuple[float, float, int | None]] = [
        (0, 0, 0),
        (10, 0, 0),
        (12, 0, 1),
        (14, 0, 1),
        (14, 1, 2),
        (24, 3, 2),
    ]
    assert words(way, NORTH_RAD) == "10 m to the stairs, up two floors, 10 m"
    assert words([(0, 0, 0), (5, 0, 0), (10, 1, 0)], NORTH_RAD) == "10 m"
    assert words([(0, 0, 0), (5, 0, 0), (5, 1, 0), (5, 1, 0), (9, 1, 0)], NORTH_RAD) == "9 m"


def test_unknown_floor_is_no_climb() -> None:
    assert words([(0, 0, None), (5, 0, None), (5, 0, 0), (9, 0, 0)], NORTH_RAD) == "9 m"
    assert words([(0, 0, 0), (0.5, 0, 0)], None) == "beside you"


def test_the_straight_line_in_words() -> None:
    begin = Waypoint(0.0, 0.0, 0)
    assert line_text(begin, Waypoint(16.3, 16.3, 1)) == (
        "no known way; 23 m to the north-east, one floor up"
    )
    assert line_text(begin, Waypoint(-5.0, 0.0, -2)) == (
        "no known way; 5 m to the south, two floors down"
    )
    assert line_text(begin, Waypoint(0.0, -5.0, 0)) == "no known way; 5 m to the west"
    assert line_text(begin, Waypoint(0.0, -5.0, None)) == (
        "no known way; 5 m to the west, floor unknown"
    )
