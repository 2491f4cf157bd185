"""``muster bench routes``: time to find the nearest rescuers among many people with long trails."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

import msgspec
import numpy as np
import typer
from rich.console import Console as Terminal

from base_station.api.route_finder import KEPT_S, RouteFinder
from base_station.core.state import UnitState
from base_station.core.state.trail import extend_trail
from base_station.engine.ports import Trails
from base_station.engine.trail_encoder import TrailEncoder
from base_station.routing.interface import Waypoint
from base_station.views import wire
from shared.bench_figures import FiguresFile, write_figures
from shared.clock import NS_PER_S
from shared.messages import STATION_ID, Header
from tests.e2e import scenes
from tests.rig import message_factory

FLOORS, ROOMS, ROOM_M, DOOR_M = 5, 10, 6.0, 0.9
CORRIDOR_M = 18.0, 22.0  # north, from wall to wall
HOUSE_M = 40.0, ROOMS * ROOM_M  # north and east
WALK_MPS = 1.2
_RUNS = 5


@dataclass(frozen=True)
class RouteReport:
    """Figures of one run, medians."""

    people: int
    minutes: int
    with_plan: bool
    known: int  # rescuers with a known way
    first_ms: float  # of a station that has not been asked before: the plan is read
    fresh_ms: float  # with the graph of known ways made anew
    kept_ms: float  # with the one of a moment ago


def bench_routes(
    people: Annotated[int, typer.Option(min=2, help="People with units.")] = 200,
    minutes: Annotated[int, typer.Option(min=1, help="Duration of their walks.")] = 60,
    json_file: FiguresFile = None,
) -> None:
    """Measure the time of a request for the routes to a member who is down, with a plan and
    without.
    """
    picture, trails = walked_picture(people, minutes)
    unplanned = msgspec.structs.replace(picture, plan=None)
    reports = [measure(one, trails, minutes) for one in (picture, unplanned)]
    for report in reports:
        Terminal().print(report)
    write_figures(json_file, reports)


def measure(picture: wire.Snapshot, trails: Trails, minutes: int) -> RouteReport:
    """Routes of all to the first one."""
    finder = RouteFinder()
    ids = [unit.unit_id for unit in picture.units]

    def ask() -> tuple[float, int]:
        begin_ns = time.perf_counter_ns()
        _, routes = finder.routes(lambda: (picture, trails), ids[0], lambda _: ids[1:])
        return (time.perf_counter_ns() - begin_ns) / 1e6, len(routes)

    first_ms, known = ask()
    fresh_ms, kept_ms = [], []
    for _ in range(_RUNS):
        kept_ms.append(ask()[0])
        time.sleep(KEPT_S)
        fresh_ms.append(ask()[0])
    return RouteReport(
        people=len(ids),
        minutes=minutes,
        with_plan=picture.plan is not None,
        known=known,
        first_ms=round(first_ms, 1),
        fresh_ms=round(float(np.median(fresh_ms)), 1),
        kept_ms=round(float(np.median(kept_ms)), 1),
    )


def walked_picture(people: int, minutes: int) -> tuple[wire.Snapshot, Trails]:
    """People who came in at one door of an office block and have been from room to room since."""
    random = np.random.default_rng(1)
    units, walkers = [], []
    for number in range(people):
        walker = UnitState(scenes.unit_id(number))
        for second, place in zip(range(minutes * 60), _walk(random), strict=False):
            header = Header(STATION_ID, 1, second, 0, t_utc_ns=second * NS_PER_S)
            fused = message_factory.fused(
                header,
                walker.unit_id,
                north_m=place.north_m,
                east_m=place.east_m,
                floor=place.floor,
            )
            extend_trail(walker.trails.shown, fused)
        last = walker.trails.shown[-1]
        position = msgspec.structs.replace(
            scenes.position(number), north_m=last.north_m, east_m=last.east_m, floor=last.floor
        )
        units.append(msgspec.structs.replace(scenes.unit(number), position=position))
        walkers.append(walker)
    picture = msgspec.structs.replace(scenes.picture(units), plan=msgspec.Raw(_office_block()))
    return picture, TrailEncoder().all(walkers)


def _walk(random: np.random.Generator) -> Iterator[Waypoint]:
    """A place a second, without end: through doors, along the corridor, and up and down."""
    at = Waypoint(20.0, HOUSE_M[1] - 1.0, 0)
    while True:
        room, side, floor = random.integers(1, ROOMS), random.integers(2), random.integers(FLOORS)
        door_m = float(room + 0.5) * ROOM_M
        inside_m = random.uniform(2.0, 15.0)
        north_m = inside_m if side else HOUSE_M[0] - inside_m
        corners = [Waypoint(20.0, at.east_m, at.floor)]
        if floor != at.floor:
            step = 1 if floor > (at.floor or 0) else -1
            stairs = range(at.floor or 0, int(floor) + step, step)
            corners += [Waypoint(20.0, 2.0, level) for level in stairs]
        corners += [Waypoint(20.0, door_m, int(floor)), Waypoint(north_m, door_m, int(floor))]
        for corner in corners:
            yield from _straight(at, corner)
            at = corner


def _straight(begin: Waypoint, end: Waypoint) -> Iterator[Waypoint]:
    way_m = np.array([end.north_m - begin.north_m, end.east_m - begin.east_m])
    seconds = max(1, round(float(np.hypot(*way_m)) / WALK_MPS))
    for second in range(1, seconds + 1):
        north_m, east_m = way_m * second / seconds
        yield Waypoint(begin.north_m + float(north_m), begin.east_m + float(east_m), end.floor)


def _office_block() -> bytes:
    """Rooms on both sides of a corridor on each floor, with stairs at its end."""
    north_m, east_m = HOUSE_M
    outline = [[0.0, 0.0], [east_m, 0.0], [east_m, north_m], [0.0, north_m], [0.0, 0.0]]
    features = [_feature("outline", 0, outline)]
    for floor in range(FLOORS):
        features.append(_feature("wall", floor, outline))
        for wall_m in CORRIDOR_M:
            for room in range(ROOMS):
                begin, end = room * ROOM_M, (room + 1) * ROOM_M
                door = (begin + end - DOOR_M) / 2, (begin + end + DOOR_M) / 2
                features.append(_feature("wall", floor, [[begin, wall_m], [door[0], wall_m]]))
                features.append(_feature("wall", floor, [[door[1], wall_m], [end, wall_m]]))
        for room in range(1, ROOMS):
            at = room * ROOM_M
            features.append(_feature("wall", floor, [[at, 0.0], [at, CORRIDOR_M[0]]]))
            features.append(_feature("wall", floor, [[at, CORRIDOR_M[1]], [at, north_m]]))
        ring = [[1.0, 18.5], [3.0, 18.5], [3.0, 21.5], [1.0, 21.5], [1.0, 18.5]]
        features.append(_feature("stairs", floor, ring))
    floors = [{"floor": floor, "down_m": -3.2 * floor} for floor in range(FLOORS)]
    site = {"frame": "site-m", "floors": floors}
    plan = {"type": "FeatureCollection", "muster": site, "features": features}
    return msgspec.json.encode(plan)


def _feature(kind: str, floor: int, line: list[list[float]]) -> dict[str, object]:
    return {
        "type": "Feature",
        "properties": {"kind": kind, "floor": floor},
        "geometry": {"type": "LineString", "coordinates": line},
    }
