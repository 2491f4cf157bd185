"""Storeys of each building, learnt from walks on the level.

A wearer who walks some metres without climbing is on a storey, or on the ground outside; that
height is kept as a *landing*. Landings beside each other belong to one building; its storeys are
computed again with new landings (``levels``), for all units alike. Only heights without pins count,
so that a removed pin leaves nothing behind.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from statistics import median

import msgspec

from base_station.site.levels import Height, levels_of, number_levels
from base_station.site.storeys import Storey
from shared.geo import rotate
from shared.messages import Position

LEVEL_WALK_M = 6.0  # walked without climbing: on a storey
CLIMB_M = 0.5  # net, that is a climb
GROUND_RANGE_M = 1.2  # a wearer within this distance of the first height has not left the ground
APART_M = 25.0  # buildings
GROUND_NEAR_M = 60.0  # of a building: that ground gives the height of its ground floor
GROUND_STD_M = 0.4  # steps at the door, a kerb, a slope
MOST_LANDINGS = 300  # of a building, and on the ground
ROOM = 30  # of them go at once
RELEARN_EVERY = 16  # one new one of so many is enough to work the storeys out anew
SAME_PLACE_M = 3.0  # of the same unit: no new information
SAME_HEIGHT_M = 0.25


class Landing(msgspec.Struct, frozen=True):
    """Place and height of a walk on the level; incident frame."""

    t_ns: int
    unit_id: str
    north_m: float
    east_m: float
    down_m: float
    std_m: float


class ReportedFloor(msgspec.Struct, frozen=True):
    """Floor that a person reports for a unit, with the unit's height."""

    north_m: float
    east_m: float
    down_m: float
    floor: int


class LevelWalk(msgspec.Struct):
    """Progress of a unit's walk since its last climb."""

    boot_id: int = 0
    distance_m: float = 0.0  # by its last position
    down_m: float = 0.0
    walked_m: float = 0.0
    climbed_m: float = 0.0
    since_start_m: float = 0.0  # net climb since the path began
    left_ground: bool = False

    def follow(self, position: Position) -> bool:
        """True where the wearer has just walked far enough on the level."""
        if position.header.boot_id == self.boot_id:
            walked_m = max(0.0, position.distance_m - self.distance_m)
            climbed_m = position.down_m - self.down_m
        else:
            self.left_ground = self.left_ground or self.boot_id != 0
            walked_m, climbed_m = 0.0, 0.0
        self.boot_id, self.distance_m = position.header.boot_id, position.distance_m
        self.down_m = position.down_m
        self.walked_m += walked_m
        self.climbed_m += climbed_m
        self.since_start_m += climbed_m
        self.left_ground = self.left_ground or abs(self.since_start_m) > GROUND_RANGE_M
        if abs(self.climbed_m) > CLIMB_M:
            self.walked_m = self.climbed_m = 0.0
        if self.walked_m < LEVEL_WALK_M:
            return False
        self.walked_m = 0.0
        return True


class LandingGroup(msgspec.Struct):
    """Landings beside each other, with the storeys learnt from them."""

    landings: list[Landing]
    box_m: tuple[float, float, float, float]  # south, west, north, east of all landings
    storeys: tuple[Storey, ...] = ()
    pending_landings: int = 0  # landings since the storeys were worked out

    def away_m(self, north_m: float, east_m: float) -> float:
        """Distance to the box, 0 in it."""
        south, west, north, east = self.box_m
        to_north_m = max(south - north_m, north_m - north, 0.0)
        return max(to_north_m, west - east_m, east_m - east)

    def add(self, landing: Landing) -> None:
        self.pending_landings += _add_landing(self.landings, landing)
        self._widen(landing.north_m, landing.east_m, landing.north_m, landing.east_m)

    def merge(self, other: LandingGroup) -> None:
        """The storeys are to be worked out anew, of both."""
        self.landings = sorted([*self.landings, *other.landings], key=lambda one: one.t_ns)
        while len(self.landings) > MOST_LANDINGS:
            _drop_oldest(self.landings)
        self.pending_landings += len(self.landings)
        self._widen(*other.box_m)

    def _widen(self, south: float, west: float, north: float, east: float) -> None:
        box = self.box_m
        self.box_m = min(box[0], south), min(box[1], west), max(box[2], north), max(box[3], east)


class LearntFloors(msgspec.Struct):
    """Buildings and ground of the site."""

    ground: list[Landing] = msgspec.field(default_factory=list)
    buildings: list[LandingGroup] = msgspec.field(default_factory=list)
    walks: dict[str, LevelWalk] = msgspec.field(default_factory=dict)
    reported_floors: tuple[ReportedFloor, ...] = ()
    open: tuple[Storey, ...] = ()  # outside of all known buildings
    ground_down_m: float = 0.0
    pending_landings: int = 0  # landings on the ground since all storeys were worked out

    def follow(self, position: Position, unit_id: str) -> bool:
        """A unit's own path went on; True where its wearer walks on the level."""
        walk = self.walks.get(unit_id)
        if walk is None:
            walk = self.walks[unit_id] = LevelWalk()
        return walk.follow(position)

    def add_landing(self, landing: Landing, *, is_outside: bool, began_on_ground: bool) -> None:
        """Add a landing; outside it counts for the ground, except on a slope or a roof."""
        walk = self.walks[landing.unit_id]
        apart_m = abs(landing.down_m - self.ground_down_m)
        if (began_on_ground and not walk.left_ground) or (is_outside and apart_m < GROUND_RANGE_M):
            self.pending_landings += _add_landing(self.ground, landing)
            if _is_due(self.pending_landings, self.ground):
                self._learn_all()
        if not is_outside:
            building = self._building_of(landing)
            building.add(landing)
            if _is_due(building.pending_landings, building.landings):
                self._learn(building)

    def storeys_at(self, north_m: float, east_m: float) -> tuple[Storey, ...]:
        """Storeys at a place, lowest first; empty before anyone has walked."""
        storeys, nearest_m = self.open, APART_M
        for building in self.buildings:
            away_m = building.away_m(north_m, east_m)
            if away_m < nearest_m:
                storeys, nearest_m = building.storeys, away_m
        return storeys

    @property
    def numbers(self) -> list[list[int]]:
        """Floor numbers of each building, lowest first."""
        return [[storey.floor for storey in building.storeys] for building in self.buildings]

    @property
    def storeys(self) -> list[tuple[Storey, ...]]:
        """Storeys of each building."""
        return [building.storeys for building in self.buildings]

    def set_reported_floors(self, reported_floors: Sequence[ReportedFloor]) -> bool:
        """Replace the reported floors; True where that changes storeys."""
        if self.reported_floors == tuple(reported_floors):
            return False
        before = self.storeys
        self.reported_floors = tuple(reported_floors)
        self._learn_all()
        return before != self.storeys

    def forget(self, unit_id: str) -> None:
        self.walks.pop(unit_id, None)
        self.drop_learnt(unit_id)

    def drop_learnt(self, unit_id: str) -> None:
        """Drop the landings of a unit that was elsewhere."""
        self._keep_only(lambda landing: landing.unit_id != unit_id)

    def trim(self, before_ns: int) -> None:
        """Drop landings before a time."""
        self._keep_only(lambda landing: landing.t_ns >= before_ns)

    def reframe(self, turn_rad: float, north_m: float, east_m: float, down_m: float) -> None:
        """The incident frame was moved: turned clockwise, then shifted."""

        def moved(one: Landing) -> Landing:
            north, east = rotate(one.north_m, one.east_m, turn_rad)
            return msgspec.structs.replace(
                one, north_m=north + north_m, east_m=east + east_m, down_m=one.down_m + down_m
            )

        self._rebuild(map(moved, self.ground), map(moved, self._inside()))

    def _inside(self) -> list[Landing]:
        return [one for building in self.buildings for one in building.landings]

    def _keep_only(self, wanted: Callable[[Landing], bool]) -> None:
        self._rebuild(filter(wanted, self.ground), filter(wanted, self._inside()))

    def _rebuild(self, ground: Iterable[Landing], inside: Iterable[Landing]) -> None:
        self.ground, self.buildings = list(ground), []
        for landing in sorted(inside, key=lambda one: one.t_ns):
            self._building_of(landing).add(landing)
        self._learn_all()

    def _building_of(self, landing: Landing) -> LandingGroup:
        """The one that it is in or beside; where it lies between several, they are one."""
        place = landing.north_m, landing.east_m
        beside = [one for one in self.buildings if one.away_m(*place) < APART_M]
        if not beside:
            self.buildings.append(LandingGroup([], (*place, *place)))
            return self.buildings[-1]
        first, *others = beside
        for other in others:
            first.merge(other)
            self.buildings.remove(other)
        return first

    def _learn_all(self) -> None:
        self.pending_landings = 0
        ground = self._ground_of(self.ground)
        self.ground_down_m = ground.down_m
        self.open = number_levels((), ground) if self.ground else ()
        for building in self.buildings:
            self._learn(building)

    def _learn(self, building: LandingGroup) -> None:
        building.pending_landings = 0
        near = [
            one for one in self.ground if building.away_m(one.north_m, one.east_m) < GROUND_NEAR_M
        ]
        ground = self._ground_of(near or self.ground)
        reported_floors = [
            (one.down_m, one.floor)
            for one in self.reported_floors
            if building.away_m(one.north_m, one.east_m) < APART_M
        ]
        heights = [Height(one.down_m, one.std_m) for one in building.landings]
        building.storeys = number_levels(levels_of(heights), ground, reported_floors)

    def _ground_of(self, landings: Sequence[Landing]) -> Height:
        """Height of the ground; without landings outside, the origin of the frame."""
        if not landings:
            return Height(0.0, GROUND_STD_M)
        return Height(median(one.down_m for one in landings), GROUND_STD_M)


def _is_due(pending_landings: int, landings: Sequence[Landing]) -> bool:
    """Every new landing of a few counts; of hundreds some must come together."""
    return pending_landings * RELEARN_EVERY > len(landings)


def _add_landing(landings: list[Landing], landing: Landing) -> bool:
    """Add a landing, in place of one of the same unit at the same place; False where it adds
    nothing.
    """
    for row, one in enumerate(landings):
        if (
            one.unit_id == landing.unit_id
            and abs(one.down_m - landing.down_m) < SAME_HEIGHT_M
            and abs(one.north_m - landing.north_m) < SAME_PLACE_M
            and abs(one.east_m - landing.east_m) < SAME_PLACE_M
        ):
            if landing.std_m >= one.std_m:
                return False
            landings[row] = landing
            return True
    landings.append(landing)
    if len(landings) > MOST_LANDINGS:
        _drop_oldest(landings)
    return True


def _drop_oldest(landings: list[Landing]) -> None:
    """Again and again, at the height at which there are most, the oldest one goes."""
    heights = [round(one.down_m) for one in landings]
    counts = Counter(heights)
    for _ in range(ROOM):
        fullest = max(counts, key=lambda height: (counts[height], height))
        row = heights.index(fullest)
        del landings[row], heights[row]
        counts[fullest] -= 1
