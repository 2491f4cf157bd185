"""The building's plan as far as the station itself uses it: storeys, outlines, walls and stairs.

A plan is GeoJSON in site metres: coordinates are ``[east_m, north_m]`` in the incident frame,
and the member ``muster`` declares that and lists the storeys::

    {"type": "FeatureCollection",
     "muster": {"frame": "site-m", "floors": [{"floor": 0, "down_m": 0.0},
                                              {"floor": 1, "down_m": -3.2}]},
     "features": [{"type": "Feature", "properties": {"kind": "outline", "floor": 0}, ...}]}

A feature of kind ``wall`` is a line that cannot be crossed (doors are its gaps), one of kind
``stairs`` the ring within which people change floor.  Of several parts, each is one.  The member
``pictures`` of ``muster`` has pictures of floors (``plan_pictures``).
"""

from __future__ import annotations

import math
from collections import Counter
from itertools import pairwise
from typing import Any

import msgspec

from base_station.site.plan_features import Floor, Metres, read_feature, require_strict
from base_station.site.plan_pictures import require_pictures
from base_station.site.storeys import Storey, floor_at, floor_probability
from shared.coded_text import Measure, coded, text_of_error
from shared.errors import UserError

OUTLINE_HYSTERESIS_M = 1.5
MOST_OUTLINE_POINTS = 1000  # looked at for every position: half a millisecond
MOST_STAIRS = 1000
MOST_WALLS_M = 200_000.0

Ring = tuple[tuple[float, float], ...]  # (east_m, north_m)


class Wall(msgspec.Struct, frozen=True, array_like=True):
    floor: int
    line: Ring  # not closed


class Stairs(msgspec.Struct, frozen=True, array_like=True):
    floor: int
    ring: Ring


class Plan(msgspec.Struct, frozen=True):
    """Plan that was read; ``geojson`` is the text that consoles draw."""

    geojson: bytes
    storeys: tuple[Storey, ...]  # by height, lowest first
    outlines: tuple[Ring, ...]
    walls: tuple[Wall, ...] = ()
    stairs: tuple[Stairs, ...] = ()
    damage: str = ""  # for a person: parts that cannot be read, and are left out
    read_whole: bool = False  # each of its features was looked at: before, only some were

    @property
    def walls_m(self) -> float:
        """Total length of the walls."""
        return sum(math.dist(*ends) for one in self.walls for ends in pairwise(one.line))

    @property
    def storeys_down_m(self) -> tuple[float, ...]:
        return tuple(storey.down_m for storey in self.storeys)

    def floor_probability(self, floor: int, down_m: float, std_down_m: float) -> float:
        """Probability of a floor, among all floors of the plan."""
        return floor_probability(self.storeys, floor, down_m, std_down_m)

    def floor_at(self, down_m: float, floor: int | None) -> int | None:
        """Number of the nearest storey; stays at ``floor`` until another is clearly nearer."""
        return floor_at(self.storeys, down_m, floor)

    def is_inside(self, north_m: float, east_m: float, inside: bool) -> bool:
        """True if a position is in the building; near an outer wall the previous answer is kept."""
        depth_m = self.depth_m(north_m, east_m)
        return depth_m > (-OUTLINE_HYSTERESIS_M if inside else OUTLINE_HYSTERESIS_M)

    def depth_m(self, north_m: float, east_m: float) -> float:
        """Depth within the outer walls, negative outside of them; 0 if there is no outline."""
        return max((_depth_m(ring, east_m, north_m) for ring in self.outlines), default=0.0)

    def away_m(self, north_m: float, east_m: float) -> float:
        """Distance of a position to the nearest outline; 0 inside, or if there is no outline."""
        return max(
            0.0, min((-_depth_m(ring, east_m, north_m) for ring in self.outlines), default=0.0)
        )


def read_plan(geojson: bytes) -> Plan:
    """Read a plan.  Raises UserError with the wrong feature and the expected form."""
    plan, faults = _read_plan(geojson)
    if faults:
        raise UserError(faults[0])
    return plan


def salvage_plan(geojson: bytes) -> Plan:
    """Read a plan that was accepted before; unreadable features are left out and listed in
    ``damage``.
    """
    return _read_plan(geojson)[0]


def _read_plan(geojson: bytes) -> tuple[Plan, list[str]]:
    """Read a plan, and return it with the faults of the features that cannot be read."""
    document = _document(geojson)
    outlines: list[Ring] = []
    walls: list[Wall] = []
    stairs: list[Stairs] = []
    sound: list[msgspec.Raw] = []
    faults: list[str] = []
    for number, encoded in enumerate(document.features):
        try:
            feature = read_feature(number, encoded)
        except UserError as error:
            faults.append(str(error))
            continue
        if feature.is_typed:
            sound.append(encoded)
        else:
            faults.append(f'the plan\'s {feature.name} does not say "type": "Feature"')
        match feature.kind:
            case "outline":
                outlines += feature.lines()
            case "wall":
                walls += [Wall(feature.floor, line) for line in feature.lines()]
            case "stairs":
                stairs += [Stairs(feature.floor, line) for line in feature.lines()]
    damage = _damage(faults)
    plan = Plan(
        _drawn(document, sound, damage) if faults else geojson,
        _storeys(document.muster),
        tuple(outlines),
        tuple(walls),
        tuple(stairs),
        damage,
        read_whole=True,
    )
    return plan, faults


def check_plan(geojson: bytes) -> Plan:
    """Read a plan that is set now; it refuses more than ``read_plan``.

    Refused: walls or stairs on a floor without a height, as nobody can be located there, and more
    walls than the station can check for every position.
    """
    plan = read_plan(geojson)
    document = _document(geojson)
    for number, encoded in enumerate(document.features):
        require_strict(read_feature(number, encoded))
    if not isinstance(document.muster.get("name", ""), str):
        raise UserError(
            coded("plan-name", 'the plan\'s name must be a string: "name" of its member "muster"')
        )
    require_pictures(document.muster.get("pictures", []))
    listed = {storey.floor for storey in plan.storeys}
    drawn = {wall.floor for wall in plan.walls} | {one.floor for one in plan.stairs}
    if missing := sorted(drawn - listed):
        raise UserError(
            coded(
                "plan-floor-without-height",
                "the plan has walls or stairs on floor {floor}, whose height is missing: "
                '"floors" of its member "muster" must list {{"floor": {floor}, "down_m": '
                "...}}",
                floor=missing[0],
            )
        )
    points = sum(map(len, plan.outlines))
    if points > MOST_OUTLINE_POINTS:
        raise UserError(
            coded(
                "plan-outlines-too-fine",
                "the plan's outlines have {points} points: more than {most} are too many "
                "to look at for every position; draw them with fewer",
                points=points,
                most=MOST_OUTLINE_POINTS,
            )
        )
    if len(plan.stairs) > MOST_STAIRS:
        raise UserError(
            coded(
                "plan-stairs-too-many",
                "the plan has {stairs} stairs: more than {most}",
                stairs=len(plan.stairs),
                most=MOST_STAIRS,
            )
        )
    if plan.walls_m > MOST_WALLS_M:
        raise UserError(
            coded(
                "plan-walls-too-long",
                "the plan's walls are {walls_m} long: more than {most_m} are in no building",
                walls_m=Measure(plan.walls_m, f"{plan.walls_m / 1000.0:.0f} km"),
                most_m=Measure(MOST_WALLS_M, f"{MOST_WALLS_M / 1000.0:.0f} km"),
            )
        )
    return plan


class _Floor(msgspec.Struct):
    floor: Floor
    down_m: Metres


class _Document(msgspec.Struct):
    type: Any = None
    muster: Any = None
    features: list[msgspec.Raw] = []


def _document(geojson: bytes) -> _Document:
    try:
        msgspec.json.decode(geojson, type=msgspec.Raw)
        document = msgspec.json.decode(geojson, type=_Document)
    except msgspec.ValidationError as error:
        raise UserError(
            coded(
                "plan-no-collection",
                "the plan is no GeoJSON FeatureCollection: {error}",
                error=text_of_error(error),
            )
        ) from error
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise UserError(
            coded("plan-no-json", "the plan is no JSON: {error}", error=text_of_error(error))
        ) from error
    if document.type != "FeatureCollection":
        raise UserError(coded("plan-not-geojson", "the plan is no GeoJSON FeatureCollection"))
    if not isinstance(document.muster, dict) or document.muster.get("frame") != "site-m":
        raise UserError(
            coded(
                "plan-no-scale",
                'the plan has no scale: its member "muster" must say {{"frame": "site-m", '
                "...}}, and coordinates must be [east_m, north_m] in metres",
            )
        )
    return document


def _drawn(document: _Document, features: list[msgspec.Raw], damage: str) -> bytes:
    """GeoJSON of the readable features, for consoles, which show the faults beside it."""
    muster = {**document.muster, "damage": damage}
    return msgspec.json.encode(
        {"type": "FeatureCollection", "muster": muster, "features": features}
    )


def _damage(faults: list[str]) -> str:
    """Text of the faults for a person; empty without any."""
    if not faults:
        return ""
    others = f"; {len(faults) - 1} more cannot either" if len(faults) > 1 else ""
    return f"The plan is damaged and not shown whole: {faults[0]}{others}. Lay a sound plan"


def _storeys(site: dict[str, Any]) -> tuple[Storey, ...]:
    """Lowest first."""
    try:
        listed = msgspec.convert(site.get("floors", ()), list[_Floor])
    except msgspec.ValidationError as error:
        raise UserError(
            coded(
                "plan-floors-unreadable",
                "the plan has a list of floors that cannot be read: {error}",
                error=text_of_error(error),
            )
        ) from error
    numbers = Counter(one.floor for one in listed)
    twice = [floor for floor, count in numbers.items() if count > 1]
    if twice:
        raise UserError(
            coded("plan-floor-twice", "the plan lists floor {floor} more than once", floor=twice[0])
        )
    lowest_first = sorted(listed, key=lambda one: -one.down_m)
    return tuple(Storey(one.floor, one.down_m) for one in lowest_first)


def _depth_m(ring: Ring, x_m: float, y_m: float) -> float:
    """Distance to the ring, negative outside of it."""
    inside = False
    nearest_m = math.inf
    for (x0_m, y0_m), (x1_m, y1_m) in zip(ring, ring[1:] + ring[:1], strict=True):
        if (y0_m > y_m) != (y1_m > y_m):
            inside ^= x_m < x0_m + (y_m - y0_m) * (x1_m - x0_m) / (y1_m - y0_m)
        from_start_m = complex(x_m - x0_m, y_m - y0_m)
        nearest_m = min(nearest_m, _to_segment_m(from_start_m, complex(x1_m - x0_m, y1_m - y0_m)))
    return nearest_m if inside else -nearest_m


def _to_segment_m(point_m: complex, segment_m: complex) -> float:
    """Distance of a point to a segment from the origin, both as east + north * i."""
    length2_m2 = abs(segment_m) ** 2
    if length2_m2 == 0.0:
        return abs(point_m)
    part = (point_m * segment_m.conjugate()).real / length2_m2
    return abs(point_m - min(1.0, max(0.0, part)) * segment_m)
