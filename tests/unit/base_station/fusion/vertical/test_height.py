"""Height of one unit: which inputs move it, by how much, and with what uncertainty."""

from __future__ import annotations

import math

import pytest

from base_station.fusion.interface import BarometricHeight
from base_station.fusion.parameters import Parameters
from base_station.fusion.vertical.height import HeightFilter, climb_var_m2
from base_station.site.storeys import Storey
from shared.clock import NS_PER_S

KIND = Parameters()


def at(down_m: float, std_m: float) -> HeightFilter:
    height = HeightFilter(KIND)
    height.reset(down_m, std_m)
    return height


def std_m(height: HeightFilter) -> float:
    return math.sqrt(height.variance_m2)


def update_barometer(
    height: HeightFilter, begin_s: int, airs_m: list[float], *, referenced: bool
) -> None:
    """A reading of the barometer every second."""
    for second, air_m in enumerate(airs_m, begin_s):
        height.update_barometer(BarometricHeight(second * NS_PER_S, air_m, referenced))


def test_slow_errors_of_fix_heights_are_not_averaged_away() -> None:
    height = at(0.0, 50.0)
    for _ in range(1000):
        height.update_gnss(-6.0, 5.0)
    assert height.down_m == pytest.approx(-6.0, abs=0.1)
    assert std_m(height) == pytest.approx(5.0 * math.sqrt(KIND.height_slow_part), rel=0.02)


def test_height_of_fixes_counts_anew_after_some_time() -> None:
    height = at(0.0, 50.0)
    height.update_gnss(-6.0, 5.0)
    at_once, later = HeightFilter(KIND), HeightFilter(KIND)
    for one in (at_once, later):
        one.load(height.save())
    later.decay_slow_errors(0.0)
    for one in (at_once, later):
        one.update_gnss(-6.0, 5.0)
    assert std_m(later) == pytest.approx(5.0 / math.sqrt(2.0), rel=0.02)
    assert std_m(later) < 0.8 * std_m(at_once)


def test_slow_error_of_fixes_fades_to_its_prior() -> None:
    """After many half-lives nothing of it is left."""
    height, long_after = at(0.0, 0.1), at(0.0, 0.1)
    for one in (height, long_after):
        one.update_gnss(8.0, 5.0)
    for _ in range(40):
        height.decay_slow_errors(0.5)
    long_after.decay_slow_errors(0.0)
    for one in (height, long_after):
        one.update_gnss(8.0, 5.0)
    assert height.down_m == pytest.approx(long_after.down_m)
    assert height.variance_m2 == pytest.approx(long_after.variance_m2)


@pytest.mark.parametrize(("off_m", "is_taken"), [(14.0, True), (-14.0, True), (16.0, False)])
def test_impossible_height_of_a_fix_moves_no_member(off_m: float, is_taken: bool) -> None:
    height = at(0.0, 0.5)
    height.update_gnss(off_m, 5.0)
    assert (height.down_m != 0.0) is is_taken


@pytest.mark.parametrize(("referenced", "least_m", "most_m"), [(True, 0.8, 3.0), (False, 0.0, 0.5)])
def test_barometer_detects_a_storey_that_the_own_path_missed(
    referenced: bool, least_m: float, most_m: float
) -> None:
    """Partly: stairs up and down ten times before, of which the own path has errors as well."""
    height = at(0.0, 0.3)
    update_barometer(height, 0, [7.0] * 60, referenced=True)
    for climbed_m in (-3.0, 3.0) * 10:
        height.predict(climbed_m, 5.0)
    for second in range(60, 90):
        height.predict(0.0, 0.5)
        update_barometer(
            height, second, [min(7.0 + 0.2 * (second - 59), 10.0)], referenced=referenced
        )
    assert least_m < height.down_m < most_m


def test_start_set_anew_restarts_the_barometer() -> None:
    height = at(0.0, 0.3)
    update_barometer(height, 0, [7.0] * 60, referenced=True)
    height.reset(-20.0, 0.3)
    update_barometer(height, 3600, [7.0] * 60, referenced=True)
    assert height.down_m == pytest.approx(-20.0, abs=0.01)
    assert std_m(height) == pytest.approx(0.3, rel=0.02)


def test_moved_frame_moves_heights_and_no_barometer() -> None:
    moved, stays = at(0.0, 0.3), at(0.0, 0.3)
    for height, shift_m in ((moved, 12.0), (stays, 0.0)):
        update_barometer(height, 0, [7.0] * 60, referenced=True)
        height.predict(-3.0, 10.0)
        height.shift(shift_m)
        update_barometer(height, 60, [4.5] * 10, referenced=True)
    assert abs(stays.down_m + 3.0) > 0.02, "the barometer is heard"
    assert moved.down_m == pytest.approx(stays.down_m + 12.0)
    assert moved.variance_m2 == pytest.approx(stays.variance_m2)


def test_barometer_moves_no_height_before_the_start_is_set() -> None:
    height = HeightFilter(KIND)
    update_barometer(height, 0, [-500.0] * 5, referenced=True)
    assert height.down_m == pytest.approx(0.0, abs=0.1)
    assert std_m(height) == pytest.approx(1.0, rel=0.01)


def test_saved_height_continues_with_the_same_numbers() -> None:
    height, again = at(0.0, 0.3), HeightFilter(KIND)
    update_barometer(height, 0, [7.0] * 30, referenced=True)
    height.predict(-1.0, 3.0, 0.2)
    again.load(height.save())
    for one in (height, again):
        update_barometer(one, 100, [6.0] * 5, referenced=False)
        one.predict(-0.4, 3.0, 0.2)
    assert (again.down_m, again.variance_m2) == (height.down_m, height.variance_m2)
    assert again.walked_level == height.walked_level


def test_height_far_from_every_storey_of_the_plan_is_on_none() -> None:
    height = at(-6.0, 0.3)
    height.predict(0.0, 10.0)
    height.constrain_to_plan_floors((0.0, -3.2))
    assert height.down_m == -6.0
    height.constrain_to_plan_floors((0.0, -3.2, -6.4))
    assert height.down_m < -6.1


@pytest.mark.parametrize(
    ("down_m", "own_std_m", "is_taken"),
    [(-3.0, 0.6, True), (0.2, 0.6, True), (-1.7, 0.6, False), (-3.0, 2.5, False)],
)
def test_storey_of_the_plan_is_used_by_units_on_no_other(
    down_m: float, own_std_m: float, is_taken: bool
) -> None:
    height = at(down_m, own_std_m)
    height.constrain_to_plan_floors((0.0, -3.2))
    assert (height.down_m != down_m) is is_taken


def test_six_metres_walked_since_the_question_are_level() -> None:
    height = at(0.0, 0.3)
    for begun in range(2):
        levels = []
        for _ in range(7):
            height.predict(0.0, 1.0)
            levels.append(height.walked_level)
        assert levels == [False] * 6 + [True], begun
        height.constrain_to_plan_floors(())


def test_storey_makes_no_height_surer_than_its_own() -> None:
    """However often; and a surer height learns nothing of it."""
    height = at(-2.8, 0.7)
    storeys = [Storey(0, 0.0, std_m=0.4), Storey(1, -3.2, std_m=0.4)]
    best_m = math.hypot(0.4, KIND.level_std_m)
    for _ in range(50):
        height.constrain_to_learnt_floors(storeys)
    assert std_m(height) == pytest.approx(best_m)
    assert -3.2 < height.down_m < -3.0
    sure = at(-3.0, 0.3)
    sure.constrain_to_learnt_floors(storeys)
    assert (sure.down_m, std_m(sure)) == pytest.approx((-3.0, 0.3))


@pytest.mark.parametrize(
    ("down_m", "own_std_m", "is_taken"),
    [
        (-3.0, 0.6, True),
        (-0.2, 0.6, True),
        (0.2, 0.6, True),
        (-1.6, 0.6, False),  # as near to one as to the other
        (-3.0, 2.5, False),  # may be a storey off
        (-6.0, 0.6, False),  # where nobody has walked yet
    ],
)
def test_storey_is_used_only_where_no_other_is_possible(
    down_m: float, own_std_m: float, is_taken: bool
) -> None:
    height = at(down_m, own_std_m)
    height.constrain_to_learnt_floors([Storey(0, 0.0, std_m=0.2), Storey(1, -3.2, std_m=0.2)])
    assert (height.down_m != down_m) is is_taken
    height.constrain_to_learnt_floors([])


def test_uncertainty_of_a_climb_grows_with_its_height_and_direction() -> None:
    by_climb = KIND.climb_m_per_sqrt_climb_m**2
    expected_m2 = 3.0 * by_climb + 10.0 * KIND.climb_m_per_sqrt_m**2
    for climbed_m in (3.0, -3.0):
        assert climb_var_m2(KIND, climbed_m, 10.0) == pytest.approx(expected_m2)
        height = at(0.0, 0.3)
        height.predict(climbed_m, 10.0)
        assert height.variance_m2 == pytest.approx(0.3**2 + expected_m2)
        assert height.down_m == climbed_m
