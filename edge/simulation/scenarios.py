"""Built-in scenarios: working days in the training house, measured paths, and hard motions."""

from __future__ import annotations

from math import pi

from edge.simulation.beacons import BeaconPlace
from edge.simulation.building import load_building
from edge.simulation.hard_motions import HARD_MOTIONS
from edge.simulation.legs import Crawl, Leg, Lie, Point, Ride, Stand, Turn, Walk
from edge.simulation.polyline import arc
from edge.simulation.scenario import Scenario

_HOUSE = load_building()
_ENTRANCE = _HOUSE.room("hall").south_west[0], 12.0  # in the middle of the outer door
_CORRIDOR_N = 7.0
_STOREY_M = _HOUSE.floors_down_m[0] - _HOUSE.floors_down_m[1]

_TO_AND_FRO = Walk(((8.0, 0.0), (8.0, 6.0), (0.0, 0.0)))


def _enter() -> tuple[Leg, ...]:
    """From the engine through the door to the corridor."""
    north, east = _ENTRANCE
    return Stand(3.0), Walk(((north - 1.5, east), (north + 1.0, east), (_CORRIDOR_N, east)))


def _track(straight_m: float = 84.39, radius_m: float = 36.8) -> tuple[Point, ...]:
    """Return one round of a standard athletic track, anticlockwise, on its measuring line."""
    first = arc((straight_m, -radius_m), radius_m, pi / 2, -pi / 2)
    second = arc((0.0, -radius_m), radius_m, -pi / 2, -3 * pi / 2)
    return ((straight_m, 0.0), *first, (0.0, -2.0 * radius_m), *second)


def _path(name: str, summary: str, *legs: Leg) -> Scenario:
    """A measured path on open ground, with still seconds before and after."""
    return Scenario(name, summary, (Stand(5.0), *legs, Stand(5.0)))


SCENARIOS: tuple[Scenario, ...] = (
    Scenario(
        name="search-ground-floor",
        summary="walks in and searches the rooms on the ground floor",
        legs=_enter(),
        loop=tuple(
            _HOUSE.search(room)
            for room in ("office", "store", "kitchen", "canteen", "laboratory", "workshop")
        ),
        start=(-9.0, 12.5),
        building=True,
        acknowledges_every_s=10,
    ),
    Scenario(
        name="climbs-stairs",
        summary="climbs to the upper floor, searches it and comes down again",
        legs=_enter(),
        loop=(
            *_HOUSE.climb(),
            _HOUSE.search("library", 1),
            _HOUSE.search("bedroom 3", 1),
            _HOUSE.search("bedroom 2", 1),
            _HOUSE.search("dormitory", 1),
            Walk(((_CORRIDOR_N, 14.25),)),
            *_HOUSE.descend(),
            _HOUSE.search("canteen"),
            Walk(((_CORRIDOR_N, 12.0),)),
        ),
        start=(-8.0, 13.0),
        building=True,
        acknowledges_every_s=8,
        battery_start=0.88,
    ),
    Scenario(
        name="goes-down",
        summary="walks in, falls after 20 seconds and does not move again",
        legs=(*_enter(), Walk(((_CORRIDOR_N, 7.5),)), Lie(3600.0, fall=True)),
        start=(-8.0, 11.0),
        building=True,
        battery_start=0.71,
    ),
    Scenario(
        name="gets-hot",
        summary="works his way to a fire in the boiler room; the heat passes 260 degrees",
        legs=(
            *_enter(),
            Walk(((_CORRIDOR_N, 21.5),)),
            Crawl(((4.0, 21.5),)),
            Stand(12.0),
            Walk(((_CORRIDOR_N, 21.5),), pace="hurry"),
        ),
        loop=(
            _HOUSE.search("archive"),
            _HOUSE.search("laboratory"),
            _HOUSE.search("workshop"),
            Stand(8.0),
        ),
        start=(-9.0, 11.5),
        building=True,
        acknowledges_every_s=12,
        ambient_degc=(
            (0.0, 19.0),
            (18.0, 30.0),
            (25.0, 105.0),
            (32.0, 165.0),
            (40.0, 268.0),
            (50.0, 290.0),
            (75.0, 150.0),
            (110.0, 70.0),
            (180.0, 35.0),
        ),
        battery_start=0.97,
    ),
    Scenario(
        name="holds-line",
        summary="walks in and holds the line still for 26 seconds, again and again",
        legs=_enter(),
        loop=(_HOUSE.search("office"), Stand(26.0), _HOUSE.search("store"), Stand(26.0)),
        start=(-9.0, 12.5),
        building=True,
    ),
    Scenario(
        name="loses-radio",
        summary="searches rooms; the radio is gone from 22 seconds on, for 45 seconds",
        legs=_enter(),
        loop=tuple(
            _HOUSE.search(room) for room in ("canteen", "kitchen", "store", "office", "laboratory")
        ),
        start=(-8.5, 12.0),
        building=True,
        acknowledges_every_s=15,
        radio_outages_s=((22.0, 45.0), (240.0, 60.0), (480.0, 45.0)),
        battery_start=0.64,
    ),
    _path("straight", "50 m straight north", Walk(((50.0, 0.0),))),
    _path(
        "square-60m",
        "a square of 15 m sides, clockwise",
        Walk(((15.0, 0.0), (15.0, 15.0), (0.0, 15.0), (0.0, 0.0))),
        Turn(0.0),
    ),
    _path(
        "rectangle",
        "a rectangle of 17.5 m by 14 m, clockwise",
        Walk(((17.5, 0.0), (17.5, 14.0), (0.0, 14.0), (0.0, 0.0))),
        Turn(0.0),
    ),
    _path(
        "j-shape",
        "40 m north, 36 m back south, then an arc to the west and back to its east",
        Walk(((40.0, 0.0), (4.0, 0.0), *arc((4.0, -6.0), 6.0, pi / 2, 3 * pi / 2))),
        Walk(((8.0, -12.0), (8.0, -2.0))),
    ),
    _path("track-400m", "one round of an athletic track", Walk(_track())),
    Scenario(
        name="lift",
        summary="takes a lift to the upper floor, searches it and takes the lift down again",
        legs=_enter(),
        loop=(
            Walk(((_CORRIDOR_N, 14.25),)),
            Ride(_STOREY_M),
            _HOUSE.search("library", 1),
            _HOUSE.search("bedroom 3", 1),
            Walk(((_CORRIDOR_N, 14.25),)),
            Ride(-_STOREY_M),
            _HOUSE.search("canteen"),
        ),
        start=(-8.0, 13.0),
        building=True,
    ),
    Scenario(
        name="passes-beacons",
        summary="searches both floors with a receiver of the beacons on the way",
        legs=_enter(),
        loop=(
            _HOUSE.search("office"),
            Walk(((_CORRIDOR_N, 12.0),)),
            *_HOUSE.climb(),
            _HOUSE.search("library", 1),
            Walk(((_CORRIDOR_N, 14.25),)),
            *_HOUSE.descend(),
            _HOUSE.search("workshop"),
            Walk(((_CORRIDOR_N, 12.0),)),
        ),
        start=(-8.0, 13.0),
        building=True,
        beacons=(
            BeaconPlace("entrance", 0.5, 12.0),
            BeaconPlace("corridor-west", 7.0, 3.0),
            BeaconPlace("corridor-east", 7.0, 17.0),
            BeaconPlace("stairs-1", 8.0, 13.5, -_STOREY_M),
        ),
    ),
    Scenario(
        name="tower",
        summary="a lift up six storeys, and down two at a time, with a walk on each landing",
        legs=(
            Stand(5.0),
            _TO_AND_FRO,
            Ride(6 * _STOREY_M, 2.5),
            _TO_AND_FRO,
            Ride(-2 * _STOREY_M, 1.0),
            _TO_AND_FRO,
            Ride(-2 * _STOREY_M, 0.6),
            _TO_AND_FRO,
            Ride(-2 * _STOREY_M, 1.6),
            _TO_AND_FRO,
            Stand(5.0),
        ),
    ),
    Scenario(
        name="stairs",
        summary="up two flights of stairs and down again, three times",
        legs=(
            Stand(5.0),
            *(
                leg
                for _ in range(3)
                for leg in (*_HOUSE.climb(), Turn(0.0), *_HOUSE.descend(), Turn(0.0))
            ),
            Stand(5.0),
        ),
        start=(7.0, 12.75),
        building=True,
    ),
    _path(
        "gaits",
        "walks, runs, sprints, crawls and lies on open ground",
        Walk(((20.0, 0.0),)),
        Walk(((50.0, 0.0),), pace="run"),
        Walk(((0.0, 0.0),), pace="sprint"),
        Crawl(((5.0, 0.0),)),
        Lie(10.0),
        Walk(((0.0, 0.0),), pace="search"),
    ),
    *HARD_MOTIONS,
)
