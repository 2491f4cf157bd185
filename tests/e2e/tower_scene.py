"""A building of six floors with a hundred people and more: for what shows people by height."""

from __future__ import annotations

import math

import msgspec

from base_station.views import wire
from tests.e2e import scenes

FLOORS = range(-1, 5)
STOREY_M = 3.2
LONG_M, WIDE_M = 48.0, 14.0
HEADING_RAD = math.radians(60)  # of the longer side
STAIRS = 4.0, 8.0  # along the longer side


def _corner(along_m: float, across_m: float) -> tuple[float, float]:
    sin, cos = math.sin(HEADING_RAD), math.cos(HEADING_RAD)
    return along_m * sin - across_m * cos, along_m * cos + across_m * sin


def _ring(from_m: float, to_m: float) -> list[list[tuple[float, float]]]:
    corners = [(from_m, 0.0), (to_m, 0.0), (to_m, WIDE_M), (from_m, WIDE_M), (from_m, 0.0)]
    return [[_corner(*one) for one in corners]]


def plan() -> msgspec.Raw:
    def feature(kind: str, floor: int, from_m: float, to_m: float) -> dict[str, object]:
        ring = _ring(from_m, to_m)
        return {
            "type": "Feature",
            "properties": {"kind": kind, "floor": floor},
            "geometry": {"type": "Polygon", "coordinates": ring},
        }

    features = [feature("outline", floor, 0.0, LONG_M) for floor in FLOORS]
    features += [feature("stairs", floor, *STAIRS) for floor in FLOORS if floor < max(FLOORS)]
    floors = [{"floor": floor, "down_m": -STOREY_M * floor} for floor in FLOORS]
    muster = {"frame": "site-m", "name": "Harbour house", "floors": floors}
    return msgspec.Raw(
        msgspec.json.encode({"type": "FeatureCollection", "muster": muster, "features": features})
    )


def member(index: int, floor: int, along_m: float, **change: object) -> wire.UnitView:
    """Somebody at work on a floor."""
    east_m, north_m = _corner(along_m, 2.0 + index % 5)
    place = msgspec.structs.replace(
        scenes.position(index),
        east_m=east_m,
        north_m=north_m,
        down_m=-STOREY_M * floor,
        floor=floor,
        std_down_m=0.2 + 0.1 * (index % 4),
        floor_down_m=-STOREY_M * floor,
        **change,
    )
    return msgspec.structs.replace(scenes.unit(index), position=place)


def tower(count: int, *, with_plan: bool = True) -> wire.Snapshot:
    """One is down, others are in the heat, not received, on an uncertain floor, on the stairs, not
    located and far outside; all others are spread over the floors.
    """
    units = [
        member(i, FLOORS[i * 7 % len(FLOORS)], 1.0 + i * 29 % 46 + i % 3 / 3) for i in range(count)
    ]
    fall = scenes.alarm(1, "fall", 1, "Jonas Bergman may have fallen", 50)
    heat = scenes.alarm(2, "heat", 2, "Mira Okafor: equipment at 186 °C", 55)
    lost = scenes.alarm(3, "link-lost", 2, "Tomas Novak: signal lost", 41)
    units[1] = scenes.with_alarms(member(1, 3, 30.0), fall)
    units[2] = scenes.with_alarms(member(2, 1, 30.0), heat, heat_level="warning")
    old = member(3, 2, 20.0, t_ms=scenes.NOW_MS - 71_000)
    units[3] = scenes.with_alarms(old, lost, link="lost", last_heard_ms=scenes.NOW_MS - 71_000)
    units[4] = member(4, 2, 40.0, floor_probability=0.4)
    stairs = member(5, 0, 6.0)
    assert stairs.position is not None
    halfway = msgspec.structs.replace(stairs.position, down_m=-STOREY_M / 2)
    units[5] = msgspec.structs.replace(stairs, position=halfway)
    units[6] = msgspec.structs.replace(units[6], position=None)
    units[7] = member(7, 0, -400.0)
    shown = scenes.picture(units, fall, heat, lost)
    return msgspec.structs.replace(shown, plan=plan() if with_plan else None)
