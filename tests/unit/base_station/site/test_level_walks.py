"""Level walks: the parts of a walk that give a storey's height, and landings of the site."""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import pytest

from base_station.site.learnt_floors import (
    APART_M,
    GROUND_NEAR_M,
    MOST_LANDINGS,
    Landing,
    LearntFloors,
    LevelWalk,
    ReportedFloor,
)
from shared.messages import Header, Position

A, B = "FF-01", "FF-02"
MakePosition = Callable[[], Position]
Walked = tuple[float, float]  # distance and down since the path began, in metres


@pytest.fixture
def follow(make_position: MakePosition) -> Callable[..., list[int]]:
    """Positions at which the wearer has walked far enough on the level."""

    def follow(walk: LevelWalk, *path: Walked, boot_id: int = 1) -> list[int]:
        reported = []
        for number, (distance_m, down_m) in enumerate(path):
            position = msgspec.structs.replace(
                make_position(),
                header=Header(A, boot_id, number, number),
                distance_m=distance_m,
                down_m=down_m,
            )
            if walk.follow(position):
                reported.append(number)
        return reported

    return follow


def test_six_metres_on_the_level_give_a_height_again_and_again(
    follow: Callable[..., list[int]],
) -> None:
    assert follow(LevelWalk(), *((float(metre), 0.0) for metre in range(14))) == [6, 12]


def test_stairs_ramp_and_ladder_give_no_height(follow: Callable[..., list[int]]) -> None:
    for climb_m in (0.17, -0.17, 0.11):
        path = [(float(metre), climb_m * metre) for metre in range(40)]
        assert follow(LevelWalk(), *path) == []
    level, up = [(5.0, 0.0)], [(5.5, -0.6), (11.0, -0.6), (11.6, -0.6)]
    assert follow(LevelWalk(), (0.0, 0.0), *level, *up) == [4], "six metres since the last step"


def test_steps_up_and_down_again_are_the_same_level(follow: Callable[..., list[int]]) -> None:
    assert follow(LevelWalk(), (0.0, 0.0), (2.0, -0.4), (4.0, 0.0), (6.0, 0.3)) == [3]


def test_stated_way_that_shrinks_gives_no_height(
    follow: Callable[..., list[int]],
) -> None:
    assert follow(LevelWalk(), (0.0, 0.0), (5.0, 0.0), (1.0, 0.0), (1.9, 0.0), (2.1, 0.0)) == [4]


def test_restart_of_the_program_is_no_way_and_no_climb(
    follow: Callable[..., list[int]],
) -> None:
    walk = LevelWalk()
    follow(walk, (0.0, 0.0), (3.0, -0.3))
    left = [walk.left_ground]
    assert follow(walk, (100.0, -50.0), (102.9, -50.0), boot_id=2) == []
    left.append(walk.left_ground)
    assert left == [False, True], "nobody knows what was climbed meanwhile"
    assert follow(walk, (103.1, -50.0), boot_id=2) == [0]


@pytest.mark.parametrize(
    ("down_m", "left"), [(-1.1, False), (1.1, False), (-1.3, True), (1.3, True)]
)
def test_wearer_who_climbed_more_than_some_steps_has_left_the_ground(
    follow: Callable[..., list[int]], down_m: float, left: bool
) -> None:
    walk = LevelWalk()
    follow(walk, (0.0, 0.0), (2.0, down_m / 2.0), (4.0, down_m), (9.0, 0.0))
    assert walk.left_ground is left


def landed(
    floors: LearntFloors,
    unit_id: str,
    place_m: tuple[float, float],
    down_m: float,
    *,
    std_m: float = 0.2,
    outside: bool = False,
    began_on_ground: bool = False,
    t_ns: int = 0,
) -> None:
    floors.walks.setdefault(unit_id, LevelWalk())
    landing = Landing(t_ns, unit_id, *place_m, down_m, std_m)
    floors.add_landing(landing, is_outside=outside, began_on_ground=began_on_ground)


def seen(floors: LearntFloors, north_m: float = 0.0, east_m: float = 0.0) -> dict[int, float]:
    return {one.floor: one.down_m for one in floors.storeys_at(north_m, east_m) if one.seen}


def test_begin_is_the_ground_until_a_climb() -> None:
    floors = LearntFloors()
    landed(floors, A, (0.0, 0.0), 2.0, began_on_ground=True)
    assert seen(floors) == {0: 2.0}
    floors.walks[A].left_ground = True
    landed(floors, A, (4.0, 0.0), -1.1, began_on_ground=True)
    assert seen(floors) == pytest.approx({0: 2.0, 1: -1.1})


def test_unit_that_began_upstairs_gives_no_ground() -> None:
    floors = LearntFloors()
    landed(floors, A, (0.0, 0.0), -6.2)
    assert floors.ground == []
    assert seen(floors) == pytest.approx({0: 0.0, 2: -6.2})


def test_level_walk_outside_at_ground_height_is_ground_and_a_slope_or_roof_is_not() -> None:
    floors = LearntFloors()
    landed(floors, A, (0.0, 0.0), 0.6, outside=True)
    landed(floors, A, (9.0, 0.0), -3.0, outside=True)
    landed(floors, A, (18.0, 0.0), 2.0, outside=True)
    assert [one.down_m for one in floors.ground] == [0.6]
    assert floors.buildings == []
    assert seen(floors, 500.0) == {0: 0.6}, "where nobody has been in any building"


def test_ground_of_a_building_is_the_one_beside_it() -> None:
    """On a hill one enters the second house three metres higher."""
    floors, far_m = LearntFloors(), 2.0 * GROUND_NEAR_M + 50.0
    for number in range(3):
        landed(floors, A, (5.0 * number, 0.0), 0.0, began_on_ground=True)
        landed(floors, B, (far_m + 5.0 * number, 0.0), -3.0, began_on_ground=True)
    for unit_id, north_m, down_m in ((A, 0.0, -3.1), (B, far_m, -6.1)):
        floors.walks[unit_id].left_ground = True
        landed(floors, unit_id, (north_m, 5.0), down_m)
    assert seen(floors, 0.0) == pytest.approx({0: 0.0, 1: -3.1})
    assert seen(floors, far_m) == pytest.approx({0: -3.0, 1: -6.1})


def test_place_has_the_storeys_of_the_nearest_building() -> None:
    floors = LearntFloors(ground=[Landing(0, A, 0.0, 0.0, 0.0, 0.2)])
    landed(floors, A, (0.0, 0.0), -3.0)
    landed(floors, A, (APART_M + 15.0, 0.0), -4.0)
    assert seen(floors, 19.0)[1] == -3.0
    assert seen(floors, 21.0)[1] == -4.0
    assert 1 not in seen(floors, 0.0, APART_M + 1.0)


def test_same_unit_at_the_same_place_counts_once_with_its_best_accuracy() -> None:
    floors = LearntFloors()
    for std_m, north_m, down_m in (
        (0.5, 0.0, -3.0),
        (0.7, 1.0, -3.1),
        (0.2, 2.0, -3.2),
        (0.4, 0.0, -3.1),
        (0.4, 2.0, -6.0),
        (0.4, 6.0, -3.1),
    ):
        landed(floors, A, (north_m, 0.0), down_m, std_m=std_m)
    landed(floors, B, (2.0, 0.0), -3.2)
    (building,) = floors.buildings
    kept = [(one.unit_id, one.north_m, one.std_m) for one in building.landings]
    assert kept == [(A, 2.0, 0.2), (A, 2.0, 0.4), (A, 6.0, 0.4), (B, 2.0, 0.2)]


def test_oldest_landings_of_the_densest_place_are_dropped_beyond_the_limit() -> None:
    floors = LearntFloors()
    landed(floors, A, (0.0, 0.0), -3.0, t_ns=1)
    for number in range(MOST_LANDINGS):
        landed(floors, A, (4.0 * number, 0.0), -6.0, t_ns=10 + number)
    (building,) = floors.buildings
    assert len(building.landings) < MOST_LANDINGS
    assert building.landings[0].t_ns == 1
    assert building.landings[1].t_ns > 10
    assert building.landings[-1].t_ns == 10 + MOST_LANDINGS - 1


def test_floors_of_one_building_do_not_apply_to_another() -> None:
    floors = LearntFloors()
    for east_m in (0.0, 100.0):
        landed(floors, A, (0.0, east_m), -6.2)
    assert floors.set_reported_floors([ReportedFloor(0.0, 0.0, -6.2, 1)])
    assert not floors.set_reported_floors([ReportedFloor(0.0, 0.0, -6.2, 1)])
    assert seen(floors, 0.0, 0.0)[1] == -6.2
    assert seen(floors, 0.0, 100.0)[2] == -6.2
    assert floors.set_reported_floors([])
    assert seen(floors, 0.0, 0.0)[2] == -6.2
    assert not floors.set_reported_floors([ReportedFloor(900.0, 0.0, -6.2, 1)]), "nobody was there"


def test_erased_or_distant_unit_has_reported_nothing() -> None:
    floors = LearntFloors()
    for unit_id, down_m in ((A, -3.0), (B, -6.0)):
        landed(floors, unit_id, (0.0, 0.0), down_m)
    floors.drop_learnt(A)
    assert seen(floors) == pytest.approx({0: 0.0, 2: -6.0})
    assert A in floors.walks, "it still knows that it has left the ground"
    floors.forget(B)
    assert floors.buildings == []
    assert B not in floors.walks


def test_landings_before_an_incident_are_dropped_and_its_frame_moves_them() -> None:
    floors = LearntFloors()
    landed(floors, A, (0.0, 0.0), -3.0, t_ns=5)
    landed(floors, A, (9.0, 0.0), -6.1, t_ns=10)
    floors.trim(10)
    assert seen(floors) == pytest.approx({0: 0.0, 2: -6.1})
    floors.reframe(0.0, 100.0, 200.0, 3.0)
    assert seen(floors, 109.0, 200.0)[1] == pytest.approx(-3.1)
    assert floors.buildings[0].box_m == (109.0, 200.0, 109.0, 200.0)
