"""Deltas come as often as consoles can follow them, and leave the stepping thread its time."""

from __future__ import annotations

import pytest

from base_station.engine.delta_pace import DeltaPace
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
    pace = DeltaPace(0)
    pace.note_sent(0, spent_ms * NS_PER_MS)
    assert pace.due_ns == expected_ms * NS_PER_MS
    assert pace.urgent_due_ns == expected_ms * NS_PER_MS // 2


def test_deltas_that_are_sent_late_do_not_become_fewer() -> None:
    pace = DeltaPace(0)
    now_ns = 0
    for _ in range(20):
        now_ns = pace.due_ns + 19 * NS_PER_MS
        pace.note_sent(now_ns, NS_PER_MS)
    assert now_ns == 19 * 50 * NS_PER_MS + 19 * NS_PER_MS


def test_after_a_pause_they_do_not_come_in_a_burst() -> None:
    pace = DeltaPace(0)
    pace.note_sent(5 * NS_PER_S, NS_PER_MS)
    assert pace.due_ns == 5 * NS_PER_S + 50 * NS_PER_MS
    pace.send_at_once()
    pace.note_sent(5 * NS_PER_S, NS_PER_MS)
    assert pace.due_ns == 5 * NS_PER_S + 50 * NS_PER_MS
