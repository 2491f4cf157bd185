"""A four-storey steel building that a seed draws: rooms on both sides of a corridor, one stairwell
or two, and one way in.

All floors have the stairwells at the same places; the other partitions differ.  North and east in
metres; the south wall lies on north 0 and the west wall on east 0.  The plan that is loaded is not
the building: it lies some decimetres aside, and some doors were made after it was drawn.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import msgspec
import numpy as np

STOREYS = 4
CORRIDOR_M = 2.0
DOOR_M = 1.0
STAIRWELL_M = 3.0
TWO_STAIRWELLS, APART_M = 0.5, 8.0
WAY_IN_M = 1.6
PLAN_OFF_M = 0.25  # standard deviation, each axis
NEW_DOORS = 0.04  # of the doors: on the plan there is a wall

Place = tuple[float, float]  # (north_m, east_m)
Wall = tuple[int, Place, Place]  # floor and both ends


@dataclass(frozen=True, slots=True)
class Room:
    floor: int
    south_west: Place
    north_east: Place
    door: Place  # its middle, in the corridor's wall


@dataclass(frozen=True, slots=True)
class SteelBuilding:
    length_m: float  # west to east
    depth_m: float  # south to north
    storey_m: float
    stairs_east_m: tuple[float, ...]  # of each stairwell's west wall
    entrance_east_m: float  # of the middle of the south entrance
    rooms: tuple[Room, ...]
    walls: tuple[Wall, ...]
    drawn_walls: tuple[Wall, ...]  # on the plan
    plan_off_m: Place

    @property
    def corridor_north_m(self) -> float:
        """North coordinate of the middle of the corridor."""
        return self.depth_m / 2.0

    def down_m(self, floor: int) -> float:
        return -self.storey_m * floor

    def depth_inside_m(self, north_m: float, east_m: float) -> float:
        """Distance to the nearest outer wall, negative outside (there a lower bound of it)."""
        return min(north_m, self.depth_m - north_m, east_m, self.length_m - east_m)

    def geojson(self) -> bytes:
        """The plan as a commander would load it."""
        floors = [{"floor": k, "down_m": self.down_m(k)} for k in range(STOREYS)]
        ring = [(0.0, 0.0), (0.0, self.length_m), (self.depth_m, self.length_m)]
        ring += [(self.depth_m, 0.0), (0.0, 0.0)]
        features = [_feature("outline", 0, "Polygon", ring)]
        features += [
            _feature("stairs", k, "Polygon", self._stairwell(west_m))
            for k in range(STOREYS)
            for west_m in self.stairs_east_m
        ]
        features += [
            _feature("wall", k, "LineString", [one, other]) for k, one, other in self.drawn_walls
        ]
        site = {"frame": "site-m", "floors": floors}
        for feature in features:
            self._shift(feature["geometry"]["coordinates"])
        plan = {"type": "FeatureCollection", "muster": site, "features": features}
        return msgspec.json.encode(plan)

    def _stairwell(self, west_m: float) -> list[Place]:
        south_m, east_m = self.corridor_north_m + CORRIDOR_M / 2.0, west_m + STAIRWELL_M
        north_m = self.depth_m
        return [(south_m, west_m), (south_m, east_m), (north_m, east_m), (north_m, west_m),
                (south_m, west_m)]  # fmt: skip

    def _shift(self, coordinates: list[Any]) -> None:
        """Put a line or polygon where the plan has it."""
        if isinstance(coordinates[0], list):
            for part in coordinates:
                self._shift(part)
        else:
            coordinates[0] += self.plan_off_m[1]
            coordinates[1] += self.plan_off_m[0]


@dataclass
class _Drawn:
    """Drawn features of a building."""

    rooms: list[Room] = field(default_factory=list)
    walls: list[Wall] = field(default_factory=list)  # but for the corridor's
    on_corridor: list[Wall] = field(default_factory=list)
    on_plan: list[Wall] = field(default_factory=list)  # the corridor's, without the new doors

    def add_side(
        self,
        rng: np.random.Generator,
        floor: int,
        length_m: float,
        north_m: tuple[float, float],
        kept: list[tuple[float, float]],
    ) -> None:
        """Rooms on one side of the corridor; ``north_m``: of the corridor's wall and of the outer
        one; ``kept``: west and east of what is no room.
        """
        side_m, outer_m = north_m
        low_m, high_m = sorted(north_m)
        gaps = known = [(0.5 * (west_m + east_m), CORRIDOR_M) for west_m, east_m in kept]
        for west_m, east_m in _partition(rng, length_m, kept):
            door_m = float(rng.uniform(west_m + 1.0, east_m - 1.0))
            gaps = [*gaps, (door_m, DOOR_M)]
            known = [*known, *([(door_m, DOOR_M)] if rng.random() > NEW_DOORS else [])]
            self.rooms.append(Room(floor, (low_m, west_m), (high_m, east_m), (side_m, door_m)))
            if east_m < length_m:
                self.walls.append((floor, (low_m, east_m), (high_m, east_m)))
        for span in kept:
            self.walls += [(floor, (side_m, end_m), (outer_m, end_m)) for end_m in span[1:]]
        self.on_corridor += _along_east(floor, side_m, length_m, gaps)
        self.on_plan += _along_east(floor, side_m, length_m, known)


def draw_building(rng: np.random.Generator) -> SteelBuilding:
    length_m = round(float(rng.uniform(30.0, 44.0)), 1)
    depth_m = round(float(rng.uniform(14.0, 18.0)), 1)
    stairs_m = _draw_stairs_m(rng, length_m)
    hall_m = round(float(rng.uniform(0.3, 0.6)) * length_m, 1)
    south_m, north_m = depth_m / 2.0 - CORRIDOR_M / 2.0, depth_m / 2.0 + CORRIDOR_M / 2.0
    drawn = _Drawn()
    for floor in range(STOREYS):
        hall = [(hall_m, hall_m + STAIRWELL_M)] if floor == 0 else []
        stairwells = [(west_m, west_m + STAIRWELL_M) for west_m in stairs_m]
        drawn.add_side(rng, floor, length_m, (south_m, 0.0), hall)
        drawn.add_side(rng, floor, length_m, (north_m, depth_m), stairwells)
        way_in = [(hall_m + STAIRWELL_M / 2.0, WAY_IN_M)] if floor == 0 else []
        drawn.walls += _along_east(floor, 0.0, length_m, way_in)
        drawn.walls += _along_east(floor, depth_m, length_m, [])
        drawn.walls += [(floor, (0.0, east_m), (depth_m, east_m)) for east_m in (0.0, length_m)]
        for stairwell_m in stairs_m:
            banister_m = stairwell_m + STAIRWELL_M / 2.0
            drawn.walls.append((floor, (north_m + 1.7, banister_m), (depth_m - 1.3, banister_m)))
    return SteelBuilding(
        length_m=length_m,
        depth_m=depth_m,
        storey_m=round(float(rng.uniform(2.9, 3.6)), 2),
        stairs_east_m=stairs_m,
        entrance_east_m=hall_m + STAIRWELL_M / 2.0,
        rooms=tuple(drawn.rooms),
        walls=(*drawn.walls, *drawn.on_corridor),
        drawn_walls=(*drawn.walls, *drawn.on_plan),
        plan_off_m=(float(rng.normal(0.0, PLAN_OFF_M)), float(rng.normal(0.0, PLAN_OFF_M))),
    )


def _draw_stairs_m(rng: np.random.Generator, length_m: float) -> tuple[float, ...]:
    """One stairwell, or a second one nearer the other end."""
    one_m = round(float(rng.uniform(0.25, 0.7)) * length_m, 1)
    two = rng.random() < TWO_STAIRWELLS
    end_m = float(rng.uniform(5.0, 8.0))
    other_m = round(length_m - end_m - STAIRWELL_M if one_m < length_m / 2.0 else end_m, 1)
    return tuple(sorted((one_m, other_m))) if two and abs(one_m - other_m) > APART_M else (one_m,)


def _partition(
    rng: np.random.Generator, length_m: float, kept: list[tuple[float, float]]
) -> list[tuple[float, float]]:
    """West and east of rooms from 4 to 8 m wide that fill what is not kept for something else."""
    ends_m = [0.0, *(end_m for span in kept for end_m in span), length_m]
    rooms: list[tuple[float, float]] = []
    for west_m, east_m in zip(ends_m[::2], ends_m[1::2], strict=True):
        count = max(1, round((east_m - west_m) / 5.5))
        shares = np.cumsum([0.0, *rng.uniform(0.8, 1.25, count)])
        cuts_m = west_m + (east_m - west_m) * shares / shares[-1]
        rooms += [(float(a), float(b)) for a, b in pairwise(cuts_m)]
    return rooms


def _along_east(
    floor: int, north_m: float, length_m: float, gaps: list[tuple[float, float]]
) -> list[Wall]:
    """A wall from west to east with gaps, each by its middle and width."""
    ends_m = [0.0]
    for middle_m, width_m in sorted(gaps):
        ends_m += [middle_m - width_m / 2.0, middle_m + width_m / 2.0]
    ends_m.append(length_m)
    return [
        (floor, (north_m, west_m), (north_m, east_m))
        for west_m, east_m in zip(ends_m[::2], ends_m[1::2], strict=True)
    ]


def _feature(kind: str, floor: int, shape: str, places: list[Place]) -> dict[str, Any]:
    line = [[east_m, north_m] for north_m, east_m in places]
    coordinates = [line] if shape == "Polygon" else line
    return {
        "type": "Feature",
        "properties": {"kind": kind, "floor": floor},
        "geometry": {"type": shape, "coordinates": coordinates},
    }
