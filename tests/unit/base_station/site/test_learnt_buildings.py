"""Buildings learnt from landings: which landings belong to one building, and its own storeys."""

from __future__ import annotations

import pytest

from base_station.site.learnt_floors import APART_M, MOST_LANDINGS, Landing, LearntFloors, LevelWalk

STOREY_M = 3.0
UNIT = "FF-01"


@pytest.fixture
def floors() -> LearntFloors:
    return LearntFloors(walks={UNIT: LevelWalk(left_ground=True)})


def walk(floors: LearntFloors, t_ns: int, place_m: tuple[float, float], floor: int) -> None:
    landing = Landing(t_ns, UNIT, *place_m, -STOREY_M * floor, 0.2)
    floors.add_landing(landing, is_outside=False, began_on_ground=False)


def walked_on(floors: LearntFloors, north_m: float, east_m: float) -> list[int]:
    return [one.floor for one in floors.storeys_at(north_m, east_m) if one.seen]


def test_distant_buildings_have_storeys_of_their_own(floors: LearntFloors) -> None:
    for t_ns in range(3):
        walk(floors, t_ns, (0.0, 0.0), t_ns)
    walk(floors, 10, (0.0, 2.0 * APART_M), 0)
    assert walked_on(floors, 0.0, 0.0) == [0, 1, 2]
    assert walked_on(floors, 0.0, 2.0 * APART_M) == [0]


def test_landings_between_two_buildings_join_them_at_once(floors: LearntFloors) -> None:
    """Each has so many landings that one more would not suffice to learn anew."""
    for number in range(40):
        walk(floors, number, (4.0 * number, 0.0), number % 2)
        walk(floors, number, (4.0 * number, 1.5 * APART_M), 2 + number % 2)
    walk(floors, 50, (80.0, 0.75 * APART_M), 0)
    assert len(floors.buildings) == 1
    assert walked_on(floors, 80.0, 0.0) == [0, 1, 2, 3]


def test_two_full_buildings_are_both_kept(floors: LearntFloors) -> None:
    for number in range(MOST_LANDINGS - 1):
        walk(floors, number, (4.0 * number, 0.0), 0)
        walk(floors, number, (4.0 * number, 1.5 * APART_M), 1)
    walk(floors, 1000, (4.0, 0.75 * APART_M), 0)
    (building,) = floors.buildings
    assert len(building.landings) <= MOST_LANDINGS
    assert walked_on(floors, 0.0, 0.0) == [0, 1]
