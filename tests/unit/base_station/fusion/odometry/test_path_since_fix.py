"""The path walked between a fix and the present, and its uncertainty."""

from __future__ import annotations

import math

import pytest

from base_station.fusion.odometry.path_since_fix import (
    PathSinceFix,
    path_since_fix,
    unguided_m2,
    walls_std_m,
)
from base_station.fusion.odometry.recent_path import PathPoint
from base_station.fusion.parameters import Parameters
from shared.clock import NS_PER_S
from tests.rig.published_path import at

KIND = Parameters()


def test_path_since_fix_leads_to_the_last_position() -> None:
    last = at(100.0, 30.0, east_m=-5.0, distance_m=60.0)
    since = path_since_fix(PathPoint(40 * NS_PER_S, 10.0, 2.0, 25.0), last)
    assert since == PathSinceFix(20.0, -7.0, 35.0, 60.0)
    assert path_since_fix(PathPoint(40 * NS_PER_S, 10.0, 2.0, 25.0), None) == PathSinceFix(
        0.0, 0.0, 0.0, 0.0
    )


def test_fix_newer_than_the_last_position_has_no_age() -> None:
    assert (
        path_since_fix(PathPoint(101 * NS_PER_S, 30.0, 0.0, 0.0), at(100.0, 30.0)).lasted_s == 0.0
    )


def test_uncertainty_of_a_path_grows_with_length_and_of_its_turn_with_distance_and_time() -> None:
    drift_radps, walked_m2 = 1e-3, KIND.walk_m_per_sqrt_m**2 * 50.0
    back_again = PathSinceFix(0.0, 0.0, 50.0, 60.0)
    assert back_again.error_m2(KIND, drift_radps) == pytest.approx(walked_m2)
    straight_on = PathSinceFix(30.0, -40.0, 50.0, 60.0)
    turn_var = KIND.turn_rad_per_sqrt_m**2 * 50.0 + (drift_radps * 60.0) ** 2
    expected_m2 = walked_m2 + turn_var * 50.0**2
    assert straight_on.error_m2(KIND, drift_radps) == pytest.approx(expected_m2)


@pytest.mark.parametrize(
    ("outside_m", "std_m"),
    [
        (-1.1, KIND.inside_std_m),
        (-1.0, KIND.wall_std_m),
        (0.0, KIND.wall_std_m),
        (2.0 * KIND.wall_reach_m, KIND.wall_std_m * math.exp(-2.0)),
        (math.inf, 0.0),
    ],
)
def test_building_makes_fixes_worse_beside_it_and_most_in_it(
    outside_m: float, std_m: float
) -> None:
    assert walls_std_m(KIND, outside_m) == pytest.approx(std_m)


@pytest.mark.parametrize(
    ("received_s", "unguided_m"), [(None, 0.0), (99.5, 0.0), (90.0, 15.0), (120.0, 0.0)]
)
def test_variance_without_positions_grows_at_walking_speed(
    received_s: float | None, unguided_m: float
) -> None:
    last_ns = None if received_s is None else round(received_s * NS_PER_S)
    assert KIND.unguided_mps == 1.5
    assert unguided_m2(KIND, 100 * NS_PER_S, last_ns) == pytest.approx(unguided_m**2)
