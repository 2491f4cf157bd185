"""Storeys from heights: levels, floor numbers, and their certainty."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.site.levels import Height, levels_of, number_levels
from base_station.site.storeys import Storey, floor_at, floor_probability, storey_of

GROUND = Height(0.0, 0.3)


def storeys_of(
    *downs_m: float, std_m: float = 0.2, reported: tuple[tuple[float, int], ...] = ()
) -> dict[int, Storey]:
    heights = [Height(down_m, std_m) for down_m in downs_m]
    return {one.floor: one for one in number_levels(levels_of(heights), GROUND, reported)}


def test_before_any_climb_there_is_a_ground_and_expected_storeys() -> None:
    storeys = storeys_of()
    assert storeys[0].seen
    assert not storeys[1].seen
    assert storeys[2].std_m > storeys[1].std_m > storeys[0].std_m
    assert floor_at(tuple(storeys.values()), -6.3, None) == 2


def test_heights_gather_in_levels() -> None:
    rng = np.random.default_rng(5)
    heights = [Height(-3.0 * (n % 4) + float(rng.normal(0.0, 0.3)), 0.3) for n in range(200)]
    assert [round(one.down_m) for one in levels_of(heights)] == [0, -3, -6, -9]


@pytest.mark.parametrize("storey_m", [2.5, 3.0, 3.6, 4.2])
def test_height_of_a_storey_is_that_of_its_landings(storey_m: float) -> None:
    storeys = storeys_of(0.0, -storey_m, -2.0 * storey_m)
    assert [one.floor for one in storeys.values() if one.seen] == [0, 1, 2]
    assert storeys[4].down_m == pytest.approx(-4.0 * storey_m, abs=1.0)


def test_storey_without_landings_is_counted() -> None:
    storeys = storeys_of(0.0, -3.1, -9.3)
    assert storeys[3].seen
    assert storeys[3].numbered > 0.9
    assert not storeys[2].seen
    assert storeys[2].down_m == pytest.approx(-6.2, abs=0.2)


def test_ambiguous_number_of_storeys_is_uncertain() -> None:
    assert storeys_of(-8.4, std_m=0.5)[3].numbered < 0.9
    assert storeys_of(-8.4, std_m=0.5)[3].numbered > 0.3


def test_high_hall_is_one_floor() -> None:
    storeys = storeys_of(0.0, -4.6, -7.6, -10.6)
    assert [one.floor for one in storeys.values() if one.seen] == [0, 1, 2, 3]


def test_basement_is_below_the_ground() -> None:
    storeys = storeys_of(0.0, 3.0, -3.1)
    assert storeys[-1].seen
    assert storeys[-1].down_m == pytest.approx(3.0)


def test_stated_floor_numbers_the_floors_between() -> None:
    """Without it they would be 1, 2 and 4."""
    heights = (-4.5, -7.6, -13.6)
    assert storeys_of(*heights)[4].seen
    storeys = storeys_of(*heights, reported=((-13.5, 3),))
    assert [one.floor for one in storeys.values() if one.seen] == [0, 1, 2, 3]
    assert storeys[3].numbered > 0.9


def test_impossible_floor_of_a_person_is_not_used() -> None:
    """The first floor cannot be on the ground, nor two floors between three levels."""
    assert storeys_of(-3.0, reported=((0.0, 1),))[1].down_m == pytest.approx(-3.0)
    above = storeys_of(-3.0, -6.0, reported=((-6.0, 1),))
    assert [one.floor for one in above.values() if one.seen] == [0, 1, 2]


def test_one_height_wrong_by_a_metre_makes_no_storey() -> None:
    storeys = storeys_of(0.0, -3.2, -3.2, -3.3, -4.9, -6.4, -6.4, -6.5)
    seen = [one for one in storeys.values() if one.seen]
    assert [one.floor for one in seen] == [0, 1, 2]
    assert seen[1].down_m == pytest.approx(-3.2, abs=0.15)


def test_level_is_no_surer_than_its_best_unit() -> None:
    """The same unit has the same error again and again."""
    heights = [Height(-3.2, 0.8)] * 100
    assert storeys_of(-3.2, std_m=0.8)[1].std_m == pytest.approx(levels_of(heights)[0].std_m)
    assert levels_of(heights)[0].std_m > 0.8


def test_probability_of_a_floor_includes_the_uncertainty_of_its_number() -> None:
    sure = (Storey(0, 0.0), Storey(1, -3.0), Storey(2, -6.0))
    doubted = (Storey(0, 0.0), Storey(1, -3.0, 0.0, 0.7), Storey(2, -6.0))
    assert floor_probability(sure, 1, -3.0, 0.3) > 0.99
    assert floor_probability(doubted, 1, -3.0, 0.3) == pytest.approx(0.7, abs=0.01)
    assert floor_probability(sure, 7, -3.0, 0.3) == 0.0
    assert math.isclose(sum(floor_probability(sure, floor, -4.4, 0.8) for floor in range(3)), 1.0)


def test_expected_storey_is_no_height_to_pin_to() -> None:
    storeys = tuple(storeys_of(-3.2).values())
    assert storey_of(storeys, 1) is not None
    assert storey_of(storeys, 2) is None
    assert storey_of(storeys, None) is None


def downs_m(*heights: tuple[float, int, float]) -> list[float]:
    """Levels of these landings (height, number, certainty)."""
    landings = [Height(down_m, std_m) for down_m, count, std_m in heights for _ in range(count)]
    return [round(one.down_m, 2) for one in levels_of(landings)]


def test_level_is_the_mean_of_its_landings() -> None:
    """Not where most came together by chance."""
    assert downs_m((-3.0, 3, 0.3), (-3.4, 2, 0.3), (-3.6, 2, 0.3), (-3.8, 2, 0.3)) == [-3.4]


def test_well_known_height_outweighs_several_poor_ones() -> None:
    assert downs_m((-3.0, 3, 0.2), (-4.2, 4, 1.5)) == [-3.0]


def test_scattered_heights_belong_to_the_nearest_storey() -> None:
    scattered = ((-2.6, 2, 0.3), (-3.0, 2, 0.3), (-3.4, 2, 0.3))
    above = ((-5.6, 2, 0.3), (-6.0, 2, 0.3), (-6.4, 2, 0.3))
    assert downs_m(*scattered, *above) == [-3.0, -6.0]


@pytest.mark.parametrize(
    ("counts", "kept"),
    [((5, 2, 5), [0.0, -4.0]), ((2, 5, 2), [-2.0]), ((5, 2, 1), [0.0, -4.0])],
)
def test_level_with_more_landings_remains_of_two_nearer_than_storeys(
    counts: tuple[int, int, int], kept: list[float]
) -> None:
    assert downs_m(*zip((0.0, -2.0, -4.0), counts, (0.3,) * 3, strict=True)) == kept


@pytest.mark.parametrize(
    ("down_m", "ground_m"), [(-1.2, -1.2), (0.9, 0.9), (-1.7, 0.0), (-2.2, 0.0), (1.9, 0.0)]
)
def test_raised_ground_floor_is_the_ground_floor_and_a_landing_of_stairs_is_none(
    down_m: float, ground_m: float
) -> None:
    seen = [one for one in storeys_of(down_m, -7.0).values() if one.seen]
    assert [one.floor for one in seen] == [0, 2]
    assert seen[0].down_m == pytest.approx(ground_m)
    assert seen[0].std_m < 0.4


def test_ground_is_at_its_own_height_and_not_at_the_frames() -> None:
    levels = levels_of([Height(-10.0, 0.2), Height(-13.1, 0.2), Height(-6.9, 0.2)])
    storeys = number_levels(levels, Height(-10.3, 0.3))
    assert {one.floor: one.down_m for one in storeys if one.seen} == {-1: -6.9, 0: -10.0, 1: -13.1}


def test_height_of_storeys_is_learnt_by_walking_on_some() -> None:
    before, after = storeys_of()[4].std_m, storeys_of(0.0, -3.0, -6.0, -9.0)[4].std_m
    assert 1.0 < before < 3.0
    assert after < 0.6


def test_stated_floor_that_is_known_changes_nothing() -> None:
    assert storeys_of(-4.6, -7.6, reported=((0.0, 0),)) == storeys_of(-4.6, -7.6)
    assert storeys_of(-4.6, -7.6, reported=((-20.0, 9),)) == storeys_of(-4.6, -7.6), (
        "nobody was there"
    )


@pytest.mark.parametrize(
    ("heights", "reported", "floors"),
    [
        ((6.2,), ((6.2, -1),), [-1, 0]),
        ((3.0,), ((3.0, 1),), [-1, 0]),
        ((3.0, 6.0), ((6.0, -1),), [-2, -1, 0]),
        ((-3.1, -6.2), ((-6.2, 3), (-3.1, 2)), [0, 2, 3]),
        ((-3.1, -6.2), ((-6.2, 3), (-3.1, 1)), [0, 1, 3]),
        ((-3.1, -6.2), ((-6.2, 2), (-3.1, 2)), [0, 1, 2]),
        ((-3.1, -6.2), ((-3.1, 2), (-6.2, 2)), [0, 2, 3]),
    ],
)
def test_stated_floors_are_used_in_turn_as_far_as_they_rise(
    heights: tuple[float, ...], reported: tuple[tuple[float, int], ...], floors: list[int]
) -> None:
    assert [
        one.floor for one in storeys_of(*heights, reported=reported).values() if one.seen
    ] == floors


def test_two_stated_floors_have_the_storeys_between_spread_evenly() -> None:
    storeys = storeys_of(-3.0, -12.0, reported=((-3.0, 1), (-12.0, 4)))
    assert storeys[2].down_m == pytest.approx(-6.0)
    assert storeys[3].down_m == pytest.approx(-9.0)
    assert not storeys[3].seen
    assert storeys[3].numbered > 0.9
    assert [one.floor for one in storeys.values()] == list(range(-3, 13))
