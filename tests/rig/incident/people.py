"""Plans of six people in an incident: outside, through the door, searching rooms, and out again.

All begin at the engine.  Half of them walk about outside first, the others go straight in.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tests.rig.incident.building import (
    STAIRWELL_M,
    STOREYS,
    Place,
    Room,
    SteelBuilding,
)

Floats = NDArray[np.float64]

PEOPLE = 6
LASTS_S = 1200.0
RATE_HZ = 2
OUT_AGAIN_S = 150.0  # the last so many seconds are spent outside
INSIDE_LEAST_S = 720.0
FAR_STAIRS = 0.4  # any stairs are taken, not the nearest
WALK_MPS, SEARCH_MPS, STAIRS_MPS = 1.2, 0.6, 0.45
ACROSS = 0.25  # corners from which the wall is left, for the middle of the room
BESIDE_ENGINE_M = 0.3  # each axis
ASIDE_M = 0.15  # people do not walk on lines


@dataclass(frozen=True)
class Truth:
    """One person, a row every ``1 / RATE_HZ`` seconds."""

    t_s: Floats
    place_m: Floats  # (n, 3) north, east, down
    from_engine: bool  # straight in
    goes_in_s: float
    comes_out_s: float

    @property
    def steps_m(self) -> Floats:
        """(n, 3), the first is zero."""
        return np.diff(self.place_m, axis=0, prepend=self.place_m[:1])


@dataclass(frozen=True)
class Move:
    """From where one is to there, or a rest where it is the same place."""

    to_m: tuple[float, float, float]  # north, east, down
    speed_mps: float
    lasts_s: float


class Script:
    """Movements of one person."""

    def __init__(self, rng: np.random.Generator, begin: Place, *, from_engine: bool) -> None:
        self._rng = rng
        self._t_s = [0.0]
        self._places: list[tuple[float, float, float]] = [(*begin, 0.0)]
        self.from_engine = from_engine
        self.moves: list[Move] = []
        self.goes_in_s = self.comes_out_s = 0.0

    @property
    def begin_m(self) -> Place:
        return self._places[0][:2]

    @property
    def now_s(self) -> float:
        return self._t_s[-1]

    @property
    def here(self) -> Place:
        return self._places[-1][:2]

    def go(self, to: Place, speed_mps: float, down_m: float | None = None) -> None:
        north_m, east_m, at_down_m = self._places[-1]
        aside_m = np.clip(self._rng.normal(0.0, ASIDE_M, 2), -2.0 * ASIDE_M, 2.0 * ASIDE_M)
        to_m = (to[0] + float(aside_m[0]), to[1] + float(aside_m[1]))
        down_m = at_down_m if down_m is None else down_m
        way_m = float(np.hypot(to_m[0] - north_m, to_m[1] - east_m))
        pace = speed_mps * float(self._rng.uniform(0.8, 1.2))
        self._move(Move((*to_m, down_m), speed_mps, max(way_m / pace, 0.05)))

    def rest(self, lasts_s: float) -> None:
        self._move(Move(self._places[-1], 0.0, max(lasts_s, 0.05)))

    def _move(self, move: Move) -> None:
        self.moves.append(move)
        self._t_s.append(self.now_s + move.lasts_s)
        self._places.append(move.to_m)

    def truth(self) -> Truth:
        """True path of a person who walks in straight lines at a constant speed."""
        t_s = np.arange(0.0, LASTS_S, 1.0 / RATE_HZ)
        places = np.array(self._places)
        columns = [np.interp(t_s, self._t_s, places[:, axis]) for axis in range(3)]
        place_m = np.stack(columns, axis=1)
        return Truth(t_s, place_m, self.from_engine, self.goes_in_s, self.comes_out_s)


def draw_engine(rng: np.random.Generator, building: SteelBuilding) -> Place:
    """Draws the position of the engine."""
    east_m = building.entrance_east_m + float(rng.uniform(-15.0, 15.0))
    return float(rng.uniform(-38.0, -25.0)), east_m


def live_through(
    rng: np.random.Generator, building: SteelBuilding, engine_m: Place, *, from_engine: bool
) -> Script:
    """One person's twenty minutes."""
    door_m = building.entrance_east_m
    beside_m = rng.normal(0.0, BESIDE_ENGINE_M, 2)
    begin = engine_m[0] + float(beside_m[0]), engine_m[1] + float(beside_m[1])
    script = Script(rng, begin, from_engine=from_engine)
    if from_engine:
        script.rest(float(rng.uniform(5.0, 20.0)))
    else:
        _walk_about(rng, script, building, until_s=float(rng.uniform(80.0, 130.0)))
    script.go((-1.5, door_m), WALK_MPS)
    script.goes_in_s = script.now_s
    script.go((1.5, door_m), WALK_MPS)
    script.go((building.corridor_north_m, door_m), WALK_MPS)
    _search(rng, script, building, until_s=max(script.goes_in_s + INSIDE_LEAST_S, LASTS_S - 330.0))
    script.go((building.corridor_north_m, door_m), WALK_MPS)
    script.go((1.5, door_m), WALK_MPS)
    script.go((-1.5, door_m), WALK_MPS)
    script.comes_out_s = script.now_s
    _walk_about(rng, script, building, until_s=LASTS_S)
    return script


def _walk_about(
    rng: np.random.Generator, script: Script, building: SteelBuilding, until_s: float
) -> None:
    """South of the building, now and then along its wall."""
    while script.now_s < until_s:
        near = rng.random() < 0.3
        north_m = rng.uniform(-4.0, -2.0) if near else rng.uniform(-45.0, -10.0)
        to = (float(north_m), float(rng.uniform(-15.0, building.length_m + 15.0)))
        if abs(to[0] - script.here[0]) + abs(to[1] - script.here[1]) < 8.0:
            continue
        script.go(to, WALK_MPS)
        if rng.random() < 0.25:
            script.rest(float(rng.uniform(3.0, 12.0)))


def _search(
    rng: np.random.Generator, script: Script, building: SteelBuilding, until_s: float
) -> None:
    """Room after room, now and then on another floor; at the end back down."""
    floor = 0
    while True:
        if rng.random() < 0.3:
            to_floor = int(rng.integers(STOREYS))
            floor = _climb(rng, script, building, floor, to_floor)
        rooms = [room for room in building.rooms if room.floor == floor]
        _search_room(rng, script, building, rooms[int(rng.integers(len(rooms)))])
        if script.now_s > until_s:
            _climb(rng, script, building, floor, 0)
            return


def _search_room(
    rng: np.random.Generator, script: Script, building: SteelBuilding, room: Room
) -> None:
    door_north_m, door_m = room.door
    into = 1.0 if door_north_m > building.corridor_north_m else -1.0
    script.go((building.corridor_north_m, door_m), WALK_MPS)
    script.go((door_north_m + 0.8 * into, door_m), SEARCH_MPS)
    (south_m, west_m), (north_m, east_m) = room.south_west, room.north_east
    inset_m = 0.9
    corners = [
        (south_m + inset_m, west_m + inset_m),
        (south_m + inset_m, east_m - inset_m),
        (north_m - inset_m, east_m - inset_m),
        (north_m - inset_m, west_m + inset_m),
    ]
    first = int(rng.integers(4))
    ring = [corners[(first + k) % 4] for k in range(int(rng.integers(2, 6)))]
    for corner in ring if rng.random() < 0.5 else ring[::-1]:
        script.go(corner, SEARCH_MPS)
        if rng.random() < ACROSS:
            inner = rng.uniform(south_m + inset_m, north_m - inset_m)
            script.go(
                (float(inner), float(rng.uniform(west_m + inset_m, east_m - inset_m))), SEARCH_MPS
            )
        if rng.random() < 0.3:
            script.rest(float(rng.uniform(2.0, 25.0)))
    script.go((door_north_m + 0.8 * into, door_m), SEARCH_MPS)
    script.go((building.corridor_north_m, door_m), SEARCH_MPS)


def _climb(
    rng: np.random.Generator, script: Script, building: SteelBuilding, floor: int, to_floor: int
) -> int:
    """Up one lane of a stairwell and on in the other, or the same way down."""
    if floor == to_floor:
        return floor
    stairs_m = min(building.stairs_east_m, key=lambda east_m: abs(east_m - script.here[1]))
    if rng.random() < FAR_STAIRS:
        stairs_m = building.stairs_east_m[int(rng.integers(len(building.stairs_east_m)))]
    near_m = building.corridor_north_m + 2.0
    far_m = building.depth_m - 0.8
    west_m = stairs_m + 0.25 * STAIRWELL_M
    east_m = stairs_m + 0.75 * STAIRWELL_M
    script.go((building.corridor_north_m, stairs_m + STAIRWELL_M / 2.0), WALK_MPS)
    step = 1 if to_floor > floor else -1
    lanes = (west_m, east_m) if step > 0 else (east_m, west_m)
    while floor != to_floor:
        half_m = 0.5 * (building.down_m(floor) + building.down_m(floor + step))
        script.go((near_m, lanes[0]), WALK_MPS)
        script.go((far_m, lanes[0]), STAIRS_MPS, half_m)
        script.go((far_m, lanes[1]), WALK_MPS)
        floor += step
        script.go((near_m, lanes[1]), STAIRS_MPS, building.down_m(floor))
    script.go((building.corridor_north_m, stairs_m + STAIRWELL_M / 2.0), WALK_MPS)
    return floor
