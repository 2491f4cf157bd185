"""Walls as squares: the walls that a step crosses, and the reachable area."""

from __future__ import annotations

import json
import math

import msgspec
import numpy as np
import pytest

from base_station.site.floor_grid import CELL_M, FloorGrid
from base_station.site.plan import Ring, read_plan
from base_station.site.reachability import MOST_SQUARES, ring_about
from base_station.site.wall_crossing import BESIDE, FREE, OUTSIDE, WALL


def plan_of(*features: tuple[str, list[list[float]]]) -> bytes:
    """``features``: kind and points, [east, north]; all on floor 0."""
    return msgspec.json.encode(
        {
            "type": "FeatureCollection",
            "muster": {"frame": "site-m", "floors": [{"floor": 0, "down_m": 0.0}]},
            "features": [
                {
                    "type": "Feature",
                    "properties": {"kind": kind, "floor": 0},
                    "geometry": {
                        "type": "LineString" if kind == "wall" else "Polygon",
                        "coordinates": points if kind == "wall" else [points],
                    },
                }
                for kind, points in features
            ],
        }
    )


OUTLINE = [[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [0.0, 10.0], [0.0, 0.0]]
# Two rooms of 10 by 10 m, a door of 1 m between them at the north end; no way out.
ROOMS = plan_of(
    ("outline", OUTLINE),
    ("wall", OUTLINE),
    ("wall", [[10.0, 0.0], [10.0, 8.5]]),
    ("wall", [[10.0, 9.5], [10.0, 10.0]]),
    ("stairs", [[1.0, 1.0], [3.0, 1.0], [3.0, 4.0], [1.0, 4.0], [1.0, 1.0]]),
)


@pytest.fixture(scope="module")
def grid() -> FloorGrid:
    found = FloorGrid.of(read_plan(ROOMS))
    assert found is not None
    return found


def reach(grid: FloorGrid, floor: int, north_m: float, east_m: float, way_m: float) -> Ring:
    reachable_area = grid.reachable_area(floor, north_m, east_m)
    reach_m = None if reachable_area is None else reachable_area.reach_m(way_m)
    return () if reach_m is None else ring_about(north_m, east_m, reach_m)


def test_step_through_a_wall_is_detected_and_one_through_the_door_is_not(grid: FloorGrid) -> None:
    from_m = np.array([[5.0, 9.5], [9.0, 9.5], [5.0, 5.0], [5.0, 9.0]])
    to_m = np.array([[5.0, 10.5], [9.0, 10.5], [6.0, 5.0], [6.0, 9.8]])
    assert grid.crossings(0, from_m, to_m).tolist() == [WALL, FREE, FREE, BESIDE]


def test_wall_is_met_once_however_long_a_way_stays_in_it(grid: FloorGrid) -> None:
    """In it, along it and out of it again; then out of the one side and in from the other."""
    places_m = np.array([[5.0, 9.5], [5.0, 10.0], [6.0, 10.0], [6.0, 10.6], [6.0, 10.0]])
    met = grid.crossings(0, places_m[:-1], places_m[1:])
    moved = grid.crossings_shifted(0, places_m[:-1], places_m[1:], np.zeros((4, 1, 2)))
    assert met.tolist() == moved[:, 0].tolist() == [WALL, BESIDE, BESIDE, WALL]


@pytest.mark.parametrize(("floor", "kind"), [(-1, FREE), (0, FREE), (1, OUTSIDE)])
def test_only_above_the_ground_floor_there_is_air_outside(floor: int, kind: int) -> None:
    plan = json.loads(ROOMS)
    for feature in plan["features"]:
        feature["properties"]["floor"] = floor
    plan["muster"]["floors"] = [{"floor": floor, "down_m": -3.0 * floor}]
    found = FloorGrid.of(read_plan(json.dumps(plan).encode()))
    assert found is not None
    inside_m, outside_m = np.array([[5.0, 5.0]]), np.array([[5.0, 21.5]])
    step_m = np.array([[0.3, 0.0]])
    assert found.crossings(floor, outside_m, outside_m + step_m).tolist() == [kind]
    assert found.crossings(floor, inside_m, inside_m + step_m).tolist() == [FREE]


def test_way_leads_through_the_door(grid: FloorGrid) -> None:
    """From beside the wall at its south end the other side is 16 m of walk away."""
    near = area_m2(reach(grid, 0, 1.0, 9.0, 5.0))
    assert near < 0.6 * math.pi * 5.0**2
    assert furthest_east_m(reach(grid, 0, 1.0, 9.0, 6.0)) < 10.3
    assert furthest_east_m(reach(grid, 0, 1.0, 9.0, 14.0)) > 12.0


def test_house_without_a_door_has_no_exit(grid: FloorGrid) -> None:
    ring = reach(grid, 0, 5.0, 5.0, 200.0)
    assert all(-1.5 < east_m < 21.5 and -1.5 < north_m < 11.5 for east_m, north_m in ring)


def test_beyond_the_plan_there_are_no_obstacles(grid: FloorGrid) -> None:
    ring = reach(grid, 0, -2.0, 10.0, 50.0)
    assert min(north_m for _, north_m in ring) == pytest.approx(-52.0, abs=0.5)


def test_continued_walk_equals_a_new_one(grid: FloorGrid) -> None:
    going_on = grid.reachable_area(0, 1.0, 9.0)
    assert going_on is not None
    for way_m in (0.0, 2.0, 2.1, 6.0, 13.0, 14.0, 14.0, 60.0):
        anew = grid.reachable_area(0, 1.0, 9.0)
        assert anew is not None
        first, second = going_on.reach_m(way_m), anew.reach_m(way_m)
        assert first is not None
        assert second is not None
        assert first.tolist() == second.tolist()


def test_area_larger_than_a_floor_is_not_searched() -> None:
    """It would delay the station, and a circle is as good."""
    field = [[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0], [0.0, 0.0]]
    grid = FloorGrid.of(read_plan(plan_of(("outline", field), ("wall", field))))
    assert grid is not None
    reachable_area = grid.reachable_area(0, 50.0, 50.0)
    assert reachable_area is not None
    widest_m = math.sqrt(MOST_SQUARES / math.pi) * CELL_M
    reach_m = reachable_area.reach_m(0.9 * widest_m)
    assert reach_m is not None
    assert reach_m.max() == pytest.approx(0.9 * widest_m, abs=0.3)
    assert reachable_area.reach_m(1.2 * widest_m) is None
    assert reachable_area.reach_m(1.3 * widest_m) is None


def test_features_missing_in_the_plan_are_not_invented(grid: FloorGrid) -> None:
    assert reach(grid, 3, 5.0, 5.0, 10.0) == ()
    assert reach(grid, 0, 500.0, 5.0, 10.0) == ()
    assert FloorGrid.of(None) is None
    assert FloorGrid.of(read_plan(plan_of(("outline", OUTLINE)))) is None


def test_plan_larger_than_any_building_has_no_grid() -> None:
    far = [[0.0, 0.0], [1e5, 0.0], [1e5, 1e5], [0.0, 0.0]]
    assert FloorGrid.of(read_plan(plan_of(("outline", far), ("wall", far)))) is None


def test_stairs_are_where_the_plan_has_them(grid: FloorGrid) -> None:
    assert grid.has_stairs(0)
    places = np.array([[2.0, 2.0], [6.0, 2.0]])
    assert grid.on_stairs(0, places).tolist() == [True, False]


def furthest_east_m(ring: Ring) -> float:
    return max(east_m for east_m, _ in ring)


def area_m2(ring: Ring) -> float:
    east_m, north_m = np.array(ring).T
    return 0.5 * abs(float(east_m @ np.roll(north_m, 1) - north_m @ np.roll(east_m, 1)))
