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
    pace = DeltaPace(0, 0)
    pace.note_sent(0, spent_ms * NS_PER_MS, 0)
    assert pace.due_ns == expected_ms * NS_PER_MS
    assert pace.urgent_due_ns == expected_ms * NS_PER_MS // 2


def test_a_process_without_time_left_sends_them_at_the_usual_pace() -> None:
    """Many consoles cost the thread that sends, which shares the interpreter with the one that
    steps.
    """
    pace = DeltaPace(0, 0)
    process_ns = 0
    intervals = []
    for second, core_share in enumerate((0.5, 0.95, 0.95, 0.6), start=1):
        process_ns += round(core_share * NS_PER_S)
        pace.note_sent(second * NS_PER_S, 5 * NS_PER_MS, process_ns)
        intervals.append(pace.due_ns - second * NS_PER_S)
    often_ns = 50 * NS_PER_MS
    assert intervals == [often_ns, USUAL_NS, USUAL_NS, often_ns]


def test_deltas_that_are_sent_late_do_not_become_fewer() -> None:
    pace = DeltaPace(0, 0)
    now_ns = 0
    for _ in range(20):
        now_ns = pace.due_ns + 19 * NS_PER_MS
        pace.note_sent(now_ns, NS_PER_MS, 0)
    assert now_ns == 19 * 50 * NS_PER_MS + 19 * NS_PER_MS


def test_after_a_pause_they_do_not_come_in_a_burst() -> None:
    pace = DeltaPace(0, 0)
    pace.note_sent(5 * NS_PER_S, NS_PER_MS, 0)
    assert pace.due_ns == 5 * NS_PER_S + 50 * NS_PER_MS
    pace.send_at_once()
    pace.note_sent(5 * NS_PER_S, NS_PER_MS, 0)
    assert pace.due_ns == 5 * NS_PER_S + 50 * NS_PER_MS
