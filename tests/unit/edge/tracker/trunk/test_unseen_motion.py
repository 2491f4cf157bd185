"""Variance of a place while its wearer moves and no step is found."""

from __future__ import annotations

import math

import pytest

from edge.tracker.trunk.unseen_motion import UnseenMotion, unseen_m2

UNSEEN = UnseenMotion()
DT_S = 0.02


def std_after(lasts_s: float) -> float:
    ticks = range(1, round(lasts_s / DT_S) + 1)
    return math.sqrt(sum(unseen_m2(DT_S * tick, DT_S, UNSEEN) for tick in ticks))


def test_a_step_has_its_time_first():
    assert std_after(1.6) == 0.0


def test_a_slow_way_of_half_a_minute_is_held():
    """Feet felt ahead at 0.2 m/s; two deviations of the axis along the way."""
    assert 2.0 * std_after(30.0) > 0.2 * 30.0


def test_in_the_long_run_it_is_a_random_walk():
    assert std_after(400.0) / std_after(100.0) == pytest.approx(2.0, rel=0.05)
