"""Training house with two storeys: one plan for the walks, the magnetic field, GPS and the
console.

``building.geojson`` is a GeoJSON FeatureCollection in metres: coordinates are
[east, north] in the site frame whose origin is the anchor in the foreign
member ``muster``.  The console reads the same file as the incident's plan.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from edge.samples import Floats
from edge.simulation.legs import Leg, Point, StairsLeg, Walk
from shared.geo import Anchor

_INSET_M = 1.0  # how far from the walls a room is searched


@dataclass(frozen=True, slots=True)
class Room:
    """A rectangle on a floor, with the middle of its door where it has one."""

    name: str
    floor: int
    south_west: Point
    north_east: Point
    door: Point | None


@dataclass(frozen=True, slots=True)
class Flight:
    """A straight flight of stairs, from the edge below to the edge above."""

    bottom: Point
    top: Point
    rise_m: float
    risers: int


@dataclass(frozen=True, slots=True)
class Building:
    anchor: Anchor
    floors_down_m: tuple[float, ...]  # down coordinate of each floor's surface
    rooms: tuple[Room, ...]
    flights: tuple[Flight, ...]  # in climbing order
    walls: tuple[tuple[int, Point, Point], ...]  # floor and both ends
    south_west: Point
    north_east: Point

    def room(self, name: str, floor: int = 0) -> Room:
        return next(room for room in self.rooms if (room.name, room.floor) == (name, floor))

    def depth_inside_m(self, north_m: Floats, east_m: Floats) -> Floats:
        """Distance (n,) to the nearest outer wall, positive inside, negative outside."""
        inward = np.minimum.reduce(
            (
                north_m - self.south_west[0],
                self.north_east[0] - north_m,
                east_m - self.south_west[1],
                self.north_east[1] - east_m,
            )
        )
        return np.asarray(inward, dtype=np.float64)

    def search(self, name: str, floor: int = 0) -> Walk:
        """From the corridor along the walls of a room and out again."""
        room = self.room(name, floor)
        if room.door is None:
            raise ValueError(f"room {name!r} has no door")
        door_n, door_e = room.door
        into = 1.0 if room.south_west[0] >= door_n - 0.01 else -1.0
        near, far = (
            (room.south_west[0] + _INSET_M, room.north_east[0] - _INSET_M)
            if into > 0.0
            else (room.north_east[0] - _INSET_M, room.south_west[0] + _INSET_M)
        )
        west, east = room.south_west[1] + _INSET_M, room.north_east[1] - _INSET_M
        outside = (door_n - into, door_e)
        inside = (near, door_e)
        ring = ((near, west), (far, west), (far, east), (near, east))
        return Walk((outside, inside, *ring, inside, outside), pace="search")

    def climb(self) -> tuple[Leg, ...]:
        """From before the first flight to the upper floor's corridor."""
        first, second = self.flights
        return (
            Walk((first.bottom,)),
            StairsLeg(first.top, first.rise_m, first.risers),
            Walk(((first.top[0] + 1.2, first.top[1]), (second.bottom[0] + 1.2, second.bottom[1]))),
            Walk((second.bottom,)),
            StairsLeg(second.top, second.rise_m, second.risers),
            Walk(((second.top[0] - 1.5, second.top[1]),)),
        )

    def descend(self) -> tuple[Leg, ...]:
        """The way of ``climb`` back."""
        first, second = self.flights
        return (
            Walk((second.top,)),
            StairsLeg(second.bottom, -second.rise_m, second.risers),
            Walk(((second.bottom[0] + 1.2, second.bottom[1]), (first.top[0] + 1.2, first.top[1]))),
            Walk((first.top,)),
            StairsLeg(first.bottom, -first.rise_m, first.risers),
            Walk(((first.bottom[0] - 1.5, first.bottom[1]),)),
        )


def plan_path() -> Path:
    """Return the path of the plan file."""
    return Path(str(resources.files("edge.simulation") / "building.geojson"))


def load_building() -> Building:
    plan: dict[str, Any] = msgspec.json.decode(plan_path().read_bytes())
    features = plan["features"]
    doors = {_place(door): _middle(_ends(door)) for door in _of_kind(features, "door")}
    outline = _room(_of_kind(features, "outline")[0], doors)
    return Building(
        anchor=msgspec.convert(plan["muster"]["anchor"], Anchor),
        floors_down_m=tuple(float(floor["down_m"]) for floor in plan["muster"]["floors"]),
        rooms=tuple(_room(room, doors) for room in _of_kind(features, "room")),
        flights=tuple(
            Flight(
                _swap(stairs["properties"]["bottom"]),
                _swap(stairs["properties"]["top"]),
                stairs["properties"]["rise_m"],
                stairs["properties"]["risers"],
            )
            for stairs in _of_kind(features, "stairs")
            if stairs["properties"]["floor"] == 0
        ),
        walls=tuple(
            (wall["properties"]["floor"], *_ends(wall)) for wall in _of_kind(features, "wall")
        ),
        south_west=outline.south_west,
        north_east=outline.north_east,
    )


def _of_kind(features: list[dict[str, Any]], kind: str) -> list[dict[str, Any]]:
    return [feature for feature in features if feature["properties"]["kind"] == kind]


def _place(feature: dict[str, Any]) -> tuple[str, int]:
    return feature["properties"]["name"], feature["properties"]["floor"]


def _swap(east_north: list[float]) -> Point:
    return float(east_north[1]), float(east_north[0])


def _ends(line: dict[str, Any]) -> tuple[Point, Point]:
    first, last = line["geometry"]["coordinates"]
    return _swap(first), _swap(last)


def _middle(ends: tuple[Point, Point]) -> Point:
    return (ends[0][0] + ends[1][0]) / 2.0, (ends[0][1] + ends[1][1]) / 2.0


def _room(feature: dict[str, Any], doors: dict[tuple[str, int], Point]) -> Room:
    corners = [_swap(corner) for corner in feature["geometry"]["coordinates"][0]]
    name, floor = _place(feature)
    return Room(
        name=name,
        floor=floor,
        south_west=(min(n for n, _ in corners), min(e for _, e in corners)),
        north_east=(max(n for n, _ in corners), max(e for _, e in corners)),
        door=doors.get((name, floor)),
    )
