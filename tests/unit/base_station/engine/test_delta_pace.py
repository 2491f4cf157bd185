"""Deltas come as often as consoles can follow them, and leave the stepping thread its time."""

from __future__ import annotations

import pytest

from base_station.engine.delta_pace import interval_ns
from shared.clock import NS_PER_MS


@pytest.mark.parametrize(
    ("spent_ms", "expected_ms"),
    [
        (0, 50),
        (4, 50),
        (8, 80),  # a tenth of the time
        (10, 100),
        (20, 100),  # ten a second, until they take a quarter
        (40, 160),
    ],
)
def test_the_interval_follows_what_a_delta_costs(spent_ms: int, expected_ms: int) -> None:
    assert interval_ns(spent_ms * NS_PER_MS) == expected_ms * NS_PER_MS
