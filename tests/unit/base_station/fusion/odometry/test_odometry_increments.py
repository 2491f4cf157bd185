"""Increments of a unit's own path from one position to the next, with their errors."""

from __future__ import annotations

import math

import pytest

from base_station.fusion.kernels import DRIFT_LEARNING_S, OdometryIncrement
from base_station.fusion.odometry.odometry_increments import OdometryIncrements
from base_station.fusion.parameters import Parameters
from shared.messages import Header
from shared.quality import Quality
from tests.rig import message_factory

KIND = Parameters()
STEP_S = 0.2


def go(
    own: OdometryIncrements, north_m: float, east_m: float, **stated: float | Quality
) -> OdometryIncrement:
    """Move there in a fifth of a second."""
    place = {"north_m": north_m, "east_m": east_m, "down_m": 0.0} | stated
    return own.increment(message_factory.position(Header("u1", 1, 1, 0), **place), STEP_S)


def test_first_increment_begins_at_the_frames_origin_without_duration() -> None:
    increment = go(OdometryIncrements(KIND), 3.0, 4.0, down_m=-1.0)
    assert (increment.north_m, increment.east_m, increment.down_m) == (3.0, 4.0, -1.0)
    assert increment.length_m == 5.0
    assert increment.moving_s == 0.0
    assert increment.place_var_m2 == pytest.approx(5.0 * KIND.walk_m_per_sqrt_m**2)
    assert increment.turn_var == pytest.approx(5.0 * KIND.turn_rad_per_sqrt_m**2)


def test_reversal_is_half_a_turn() -> None:
    own = OdometryIncrements(KIND)
    go(own, 0.0, 1.0)
    by_way = 0.2 * KIND.turn_rad_per_sqrt_m**2
    assert go(own, 0.0, 1.2).turn_var == pytest.approx(by_way)
    back = go(own, 0.0, 1.0)
    assert back.turn_var == pytest.approx(by_way + (KIND.turn_part * math.pi) ** 2)
    assert back.moving_s == STEP_S
    assert go(own, 0.0, 1.001).moving_s == 0.0  # slower than any walk


def test_heading_that_becomes_uncertain_at_once_has_not_drifted() -> None:
    own = OdometryIncrements(KIND)
    go(own, 0.0, 0.0, heading_std_rad=0.1)
    usual_rad = 3.0 * KIND.drift_radps * STEP_S
    jumped = go(own, 0.0, 0.0, heading_std_rad=0.3)
    assert jumped.turn_var == pytest.approx(0.3**2 - 0.1**2 - 2.0 * 0.3 * usual_rad)
    assert go(own, 0.0, 0.0, heading_std_rad=0.3 + 0.9 * usual_rad).turn_var < 1e-9


def test_drift_rate_follows_the_stated_heading_deviation() -> None:
    own = OdometryIncrements(KIND)
    go(own, 0.0, 0.0, heading_std_rad=0.1)
    steps = round(DRIFT_LEARNING_S / STEP_S)
    stated_radps = 5e-4
    for step in range(1, steps + 2):
        std_rad = 0.1 + stated_radps * step * STEP_S
        drift_radps = go(own, 0.3 * step, 0.0, heading_std_rad=std_rad).drift_radps
        if step < steps:
            assert drift_radps == KIND.drift_radps
    assert drift_radps == pytest.approx(KIND.drift_inflation * stated_radps)


def test_heading_that_is_held_drifts_no_longer() -> None:
    own = OdometryIncrements(KIND)
    std_rad = 0.0
    for step in range(1500):
        std_rad = min(std_rad + 5e-4 * STEP_S, 0.05)  # rests and a compass hold it there
        drift_radps = go(own, 0.3 * step, 0.0, heading_std_rad=std_rad).drift_radps
        if std_rad < 0.05 and step > 60:
            assert drift_radps == pytest.approx(KIND.drift_inflation * 5e-4)
    assert drift_radps < 2.0 * KIND.drift_least_radps


def test_path_continues_behind_a_jump() -> None:
    own = OdometryIncrements(KIND)
    go(own, 0.0, 0.0)
    own.reset_to(
        message_factory.position(Header("u1", 1, 2, 0), north_m=500.0, east_m=0.0, down_m=0.0)
    )
    assert go(own, 501.0, 0.0).length_m == pytest.approx(1.0)


def test_saved_path_continues_with_the_same_numbers() -> None:
    own = OdometryIncrements(KIND)
    go(own, 1.0, 0.0)
    again = OdometryIncrements(KIND, own.save())
    assert go(again, 1.0, 1.0) == go(own, 1.0, 1.0)
