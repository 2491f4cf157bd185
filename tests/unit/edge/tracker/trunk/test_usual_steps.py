"""Steps of a usual walk, and how far the length of any other is doubted."""

from __future__ import annotations

import pytest

from edge.tracker.trunk.usual_steps import (
    UsualSteps,
    is_usual,
    length_at,
    length_doubt_m,
    length_std,
)

USUAL = UsualSteps()


@pytest.mark.parametrize("frequency_hz", [1.4, 1.8, 2.4])
def test_steps_on_a_level_floor_within_the_range_are_usual(frequency_hz):
    assert is_usual(2, 2.0 / frequency_hz, 0.05, USUAL)


@pytest.mark.parametrize(
    ("frequency_hz", "climbed_m"),
    [(1.1, 0.0), (3.1, 0.0), (1.8, 0.3), (1.8, -0.3)],
    ids=["dragged", "sprint", "up stairs", "down stairs"],
)
def test_any_other_step_is_not(frequency_hz, climbed_m):
    assert not is_usual(2, 2.0 / frequency_hz, climbed_m, USUAL)


def test_length_by_frequency_goes_on_beyond_the_range_and_is_never_negative():
    assert length_at(3.0, USUAL) == pytest.approx(1.1856)
    assert length_at(0.2, USUAL) == 0.0


def test_doubt_is_what_two_ways_of_telling_are_apart():
    """A sprint: 0.57 m by the swing of the trunk, 1.28 m by 3.2 steps a second."""
    assert length_doubt_m(1, 1.0 / 3.2, 0.57, USUAL) == pytest.approx(1.27568 - 0.57)


def test_two_ways_that_agree_where_neither_is_known_to_hold_leave_a_doubt():
    length_m = 2.0 * length_at(3.0, USUAL)
    assert length_doubt_m(2, 2.0 / 3.0, length_m, USUAL) == pytest.approx(0.5 * length_m)


def test_deviation_is_never_less_than_that_of_usual_steps_nor_without_bound():
    assert length_std(1, 1.0, 0.44, 0.9, USUAL) == 0.9
    assert length_std(1, 1.0, 0.0, 0.18, USUAL) < 10.0
