"""Durations in words."""

from __future__ import annotations

import pytest

from base_station.core.durations import format_duration


@pytest.mark.parametrize(
    ("span_s", "words"),
    [
        (0.2, "0 seconds"),
        (1.0, "1 second"),
        (119.0, "119 seconds"),
        (120.0, "2 minutes"),
        (7_199.0, "120 minutes"),
        (7_200.0, "2 hours"),
        (172_800.0, "2 days"),
        (1_795_489_170.0, "20,781 days"),
    ],
)
def test_duration_is_given_in_the_largest_unit_of_which_there_are_two(
    span_s: float, words: str
) -> None:
    assert format_duration(span_s) == words
