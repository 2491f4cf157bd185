"""Deltas come as often as consoles can follow them, and leave the stepping thread its time."""

from __future__ import annotations

import pytest

from base_station.engine.delta_pace import USUAL_NS, DeltaPace
from shared.clock import NS_PER_MS, NS_PER_S


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
    assert DeltaPace().interval_ns(0, spent_ms * NS_PER_MS, 0) == expected_ms * NS_PER_MS


def test_a_process_without_time_left_sends_them_at_the_usual_pace() -> None:
    """Many consoles cost the thread that sends, which shares the interpreter with the one that
    steps.
    """
    pace = DeltaPace()
    process_ns = 0
    intervals = []
    for second, core_share in enumerate((0.5, 0.5, 0.95, 0.95, 0.6, 0.6)):
        process_ns += round(core_share * NS_PER_S)
        intervals.append(pace.interval_ns(second * NS_PER_S, 5 * NS_PER_MS, process_ns))
    often_ns = 50 * NS_PER_MS
    assert intervals == [often_ns, often_ns, USUAL_NS, USUAL_NS, often_ns, often_ns]
