"""Storeys out of heights: levels, the numbers of floors, and how sure they are."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.site.levels import Height, levels_of, number_levels
from base_station.site.storeys import Storey, floor_at, storey_of, sureness

GROUND = Height(0.0, 0.3)


def storeys_of(
    *downs_m: float, std_m: float = 0.2, said: tuple[tuple[float, int], ...] = ()
) -> dict[int, Storey]:
    heights = [Height(down_m, std_m) for down_m in downs_m]
    return {one.floor: one for one in number_levels(levels_of(heights), GROUND, said)}


def test_before_anybody_climbed_there_is_a_ground_and_storeys_to_be_expected() -> None:
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
def test_a_storey_is_as_high_as_it_is(storey_m: float) -> None:
    storeys = storeys_of(0.0, -storey_m, -2.0 * storey_m)
    assert [one.floor for one in storeys.values() if one.seen] == [0, 1, 2]
    assert storeys[4].down_m == pytest.approx(-4.0 * storey_m, abs=1.0)


def test_a_storey_that_nobody_walked_on_is_counted() -> None:
    storeys = storeys_of(0.0, -3.1, -9.3)
    assert storeys[3].seen
    assert storeys[3].numbered > 0.9
    assert not storeys[2].seen
    assert storeys[2].down_m == pytest.approx(-6.2, abs=0.2)


def test_what_may_be_two_storeys_or_three_is_said_to_be_unsure() -> None:
    assert storeys_of(-8.4, std_m=0.5)[3].numbered < 0.9
    assert storeys_of(-8.4, std_m=0.5)[3].numbered > 0.3


def test_a_high_hall_is_one_floor() -> None:
    storeys = storeys_of(0.0, -4.6, -7.6, -10.6)
    assert [one.floor for one in storeys.values() if one.seen] == [0, 1, 2, 3]


def test_a_basement_is_below_the_ground() -> None:
    storeys = storeys_of(0.0, 3.0, -3.1)
    assert storeys[-1].seen
    assert storeys[-1].down_m == pytest.approx(3.0)


def test_what_a_person_says_numbers_the_floors_between() -> None:
    """Without it they would be 1, 2 and 4."""
    heights = (-4.5, -7.6, -13.6)
    assert storeys_of(*heights)[4].seen
    storeys = storeys_of(*heights, said=((-13.5, 3),))
    assert [one.floor for one in storeys.values() if one.seen] == [0, 1, 2, 3]
    assert storeys[3].numbered > 0.9


def test_what_cannot_be_is_not_believed_of_a_person_either() -> None:
    """The first floor cannot be on the ground, nor two floors between three levels."""
    assert storeys_of(-3.0, said=((0.0, 1),))[1].down_m == pytest.approx(-3.0)
    above = storeys_of(-3.0, -6.0, said=((-6.0, 1),))
    assert [one.floor for one in above.values() if one.seen] == [0, 1, 2]


def test_one_who_is_wrong_by_a_metre_makes_no_storey() -> None:
    storeys = storeys_of(0.0, -3.2, -3.2, -3.3, -4.9, -6.4, -6.4, -6.5)
    seen = [one for one in storeys.values() if one.seen]
    assert [one.floor for one in seen] == [0, 1, 2]
    assert seen[1].down_m == pytest.approx(-3.2, abs=0.15)


def test_nobody_is_surer_of_a_level_than_who_knew_it_best() -> None:
    """The same person has the same error again and again."""
    heights = [Height(-3.2, 0.8)] * 100
    assert storeys_of(-3.2, std_m=0.8)[1].std_m == pytest.approx(levels_of(heights)[0].std_m)
    assert levels_of(heights)[0].std_m > 0.8


def test_the_probability_of_a_floor_knows_how_unsure_its_number_is() -> None:
    sure = (Storey(0, 0.0), Storey(1, -3.0), Storey(2, -6.0))
    doubted = (Storey(0, 0.0), Storey(1, -3.0, 0.0, 0.7), Storey(2, -6.0))
    assert sureness(sure, 1, -3.0, 0.3) > 0.99
    assert sureness(doubted, 1, -3.0, 0.3) == pytest.approx(0.7, abs=0.01)
    assert sureness(sure, 7, -3.0, 0.3) == 0.0
    assert math.isclose(sum(sureness(sure, floor, -4.4, 0.8) for floor in range(3)), 1.0)


def test_a_storey_that_is_only_to_be_expected_is_no_height_to_pin_to() -> None:
    storeys = tuple(storeys_of(-3.2).values())
    assert storey_of(storeys, 1) is not None
    assert storey_of(storeys, 2) is None
    assert storey_of(storeys, None) is None
