"""Routes on made trails, and on a plan of two storeys."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np
import pytest

from base_station.routing.interface import NO_FLOOR, Route, WalkedTrail
from base_station.routing.plan_lattice import NO_LATTICE, PlanLattice, plan_lattice
from base_station.routing.search import routes_to
from base_station.routing.way_graph import CELL_M, WayGraph
from base_station.site.floor_grid import FloorGrid
from base_station.site.plan import read_plan

Points = Sequence[tuple[float, float, int | None]]  # north and east, m; floor

DOOR_M = 0.9
RISE_M = 3.2


def walked(
    unit_id: str, points: Points, std_m: float = 0.3, gaps: Sequence[int] = ()
) -> WalkedTrail:
    after_gap = np.zeros(len(points), dtype=np.bool_)
    after_gap[list(gaps)] = True
    return WalkedTrail(
        unit_id,
        np.array([point[:2] for point in points], dtype=np.float64),
        np.array([NO_FLOOR if floor is None else floor for *_, floor in points]),
        after_gap,
        std_m,
    )


def route(*trails: WalkedTrail, lattice: PlanLattice = NO_LATTICE) -> Route | None:
    """Route from the second unit to the first."""
    graph = WayGraph(trails, lattice)
    return routes_to(graph, trails[0].unit_id, [trails[1].unit_id]).get(trails[1].unit_id)


def built(door_m: float) -> PlanLattice:
    """A building of 20 m by 12 m; a wall along 6 m north with one door at its east end; stairs in
    the west.
    """
    outline = [[0.0, 0.0], [20.0, 0.0], [20.0, 12.0], [0.0, 12.0], [0.0, 0.0]]
    features: list[tuple[str, int, list[list[float]]]] = [("outline", 0, outline)]
    for floor in (0, 1):
        features += [
            ("wall", floor, outline),
            ("wall", floor, [[0, 6], [20 - door_m - 0.3, 6]]),
            ("wall", floor, [[20 - 0.3, 6], [20, 6]]),
            ("stairs", floor, [[1, 8], [3, 8], [3, 11], [1, 11], [1, 8]]),
        ]
    plan = {
        "type": "FeatureCollection",
        "muster": {
            "frame": "site-m",
            "floors": [{"floor": 0, "down_m": 0.0}, {"floor": 1, "down_m": -RISE_M}],
        },
        "features": [
            {
                "type": "Feature",
                "properties": {"kind": kind, "floor": floor},
                "geometry": {"type": "LineString", "coordinates": line},
            }
            for kind, floor, line in features
        ],
    }
    return plan_lattice(FloorGrid.of(read_plan(msgspec.json.encode(plan))))


@pytest.fixture(scope="module")
def house() -> PlanLattice:
    return built(DOOR_M)


def test_route_back_along_the_own_trails() -> None:
    """Both came in at one place: back to it, and on along the trail of the member."""
    member = walked("M", [(0, 0, 0), (0, 12, 0), (8, 12, 0)])
    found = route(member, walked("R", [(0, 0, 0), (10, 0, 0)]))
    assert found is not None
    assert found.distance_m == pytest.approx(30.0, abs=3 * CELL_M)
    assert (found.places[0].north_m, found.places[0].east_m) == (10, 0)
    assert (found.places[-1].north_m, found.places[-1].east_m) == (8, 12)
    assert not found.crosses_walls
    assert found.std_m == pytest.approx(0.3 * np.sqrt(2.0))


def test_route_over_the_trail_of_a_third() -> None:
    """The member's own way in is long; another unit has found a short one."""
    member = walked("M", [(0, 0, 0), (40, 0, 0), (40, 20, 0), (0, 20, 0)])
    rescuer = walked("R", [(0, 0, 0), (0, 0.4, 0)])
    own = route(member, rescuer)
    graph = WayGraph([member, rescuer, walked("T", [(0, 0, 0), (0, 19, 0)])], NO_LATTICE)
    shorter = routes_to(graph, "M", ["R"])["R"]
    assert own is not None
    assert own.distance_m == pytest.approx(100.0, abs=5 * CELL_M)
    assert shorter.distance_m == pytest.approx(20.0, abs=3 * CELL_M)


def test_floors_are_counted_not_passed_through() -> None:
    """3 m above the member in a straight line, but the stairs are 20 m away."""
    member = walked("M", [(0, 0, 0), (20, 0, 0), (20, 3, 1), (0, 3, 1)])
    near_above = walked("R", [(0, 0, 0), (0, 2, 0)])
    near_by_way = walked("S", [(0, 0, 0), (20, 0, 0), (20, 3, 1), (10, 3, 1)])
    routes = routes_to(WayGraph([member, near_above, near_by_way], NO_LATTICE), "M", ["R", "S"])
    assert list(routes) == ["S", "R"], "the nearest by way is first"
    assert routes["S"].distance_m == pytest.approx(10.0, abs=2 * CELL_M)
    assert routes["R"].distance_m == pytest.approx(46.0, abs=6 * CELL_M)
    assert {place.floor for place in routes["R"].places} == {0, 1}


def test_trails_that_do_not_meet_are_joined_within_their_doubt() -> None:
    member, rescuer = [(0, 0, 0), (30, 0, 0)], [(0, 5, 0), (30, 5, 0)]
    assert route(walked("M", member, 0.5), walked("R", rescuer, 0.5)) is None
    found = route(walked("M", member, 2.0), walked("R", rescuer, 2.0))
    assert found is not None
    assert found.distance_m == pytest.approx(5.0, abs=2 * CELL_M)
    assert found.std_m == pytest.approx(4.0), "the bridge doubles the variance"


def test_no_route_over_a_gap_or_to_another_place() -> None:
    rescuer = walked("R", [(0, 0, 0), (0, 5, 0)])
    assert route(walked("M", [(0, 0, 0), (50, 0, 0)], gaps=[1]), rescuer) is None
    assert route(walked("M", [(90, 90, 0), (91, 90, 0)]), rescuer) is None
    above = walked("M", [(0, 0, 1), (0, 5, 1)])
    assert route(above, rescuer) is None, "nobody has found stairs"


def test_unit_without_a_position_has_no_route() -> None:
    graph = WayGraph([walked("R", [(0, 0, 0)])], NO_LATTICE)
    assert routes_to(graph, "M", ["R"]) == {}
    assert routes_to(graph, "R", ["R", "M"]) == {}
    assert routes_to(WayGraph([], NO_LATTICE), "M", ["R"]) == {}


def test_unknown_floor_is_no_climb() -> None:
    member = walked("M", [(0, 0, None), (10, 0, None), (20, 0, 0)])
    found = route(member, walked("R", [(0, 0, None), (1, 0, None)]))
    assert found is not None
    assert found.distance_m == pytest.approx(19.0, abs=2 * CELL_M)


def test_route_leads_through_the_door_of_a_plan_not_through_its_wall(house: PlanLattice) -> None:
    """2 m apart across the wall; the one door is at the other end."""
    member, rescuer = walked("M", [(7.0, 1.0, 0)]), walked("R", [(5.0, 1.0, 0)])
    found = route(member, rescuer, lattice=house)
    assert found is not None
    assert found.distance_m == pytest.approx(2 * 18.3, abs=2.0)
    assert any(place.east_m > 18.5 for place in found.places), "the door"
    assert len(found.places) <= 5, "straight where there is no wall"
    assert not found.crosses_walls


def test_route_uses_stairs_of_a_plan(house: PlanLattice) -> None:
    found = route(walked("M", [(9.5, 9.0, 1)]), walked("R", [(9.5, 9.0, 0)]), lattice=house)
    assert found is not None
    assert found.distance_m == pytest.approx(2 * 6.0 + 2 * RISE_M, abs=1.5)
    floors = [place.floor or 0 for place in found.places]
    assert floors == sorted(floors), "up once"


def test_trail_through_a_wall_is_the_last_choice_and_is_named(house: PlanLattice) -> None:
    """A door that the plan lacks: it is taken only where the plan's own way is far longer."""
    through = [(5.0, 1.0, 0), (7.0, 1.0, 0)]
    short = route(walked("M", through), walked("R", [(5.0, 1.0, 0)]), lattice=house)
    assert short is not None
    assert not short.crosses_walls
    only = route(walked("M", through), walked("R", [(5.0, 1.0, 0)]), lattice=built(0.0))
    assert only is not None
    assert only.crosses_walls
    assert only.distance_m == pytest.approx(2.0, abs=0.5)


def test_ground_around_a_plan_is_open_but_not_without_end(house: PlanLattice) -> None:
    member = walked("M", [(7.0, 18.5, 0)])
    found = route(member, walked("R", [(8.0, 45.0, 0)]), lattice=house)
    assert found is None, "no door leads in"
    outside = walked("M", [(-2.0, 10.0, 0)])
    found = route(outside, walked("R", [(-40.0, 10.0, 0)]), lattice=house)
    assert found is not None
    assert found.distance_m == pytest.approx(38.0, abs=2 * CELL_M)
    assert route(outside, walked("R", [(-140.0, 10.0, 0)]), lattice=house) is None


def test_route_from_outside_the_plan_enters_on_a_trail(house: PlanLattice) -> None:
    rescuer = walked("R", [(-30.0, 2.0, 0), (-30.0, 3.0, 0)])
    member = walked("M", [(-30.0, 2.0, 0), (-3.0, 2.0, 0), (-2.8, 2.0, 0)])
    found = route(member, rescuer, lattice=house)
    assert found is not None
    assert found.distance_m == pytest.approx(28.0, abs=3 * CELL_M)
