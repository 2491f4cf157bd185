"""Adaptive chunk size: the size of a request to a unit follows the speed of its answers."""

from __future__ import annotations

import pytest

from base_station.unit_sync.adaptive_chunk_size import LEAST_BYTES, MOST_BYTES, AdaptiveChunkSize
from shared.clock import NS_PER_S


@pytest.mark.parametrize("rate_bytes_s", [2_500.0, 12_500.0, 40_000.0])
def test_answers_approach_half_a_second(rate_bytes_s: float) -> None:
    pace = AdaptiveChunkSize()
    for _ in range(20):
        took_ns = round(pace.answer_bytes / rate_bytes_s * NS_PER_S)
        pace.note(pace.answer_bytes, took_ns)
    assert pace.answer_bytes / rate_bytes_s == pytest.approx(0.5, abs=0.1)


def test_good_link_soon_gets_the_largest_requests() -> None:
    pace = AdaptiveChunkSize()
    asked = []
    while pace.answer_bytes < MOST_BYTES:
        asked.append(pace.answer_bytes)
        pace.note(pace.answer_bytes, 1_000_000)
    assert len(asked) < 10
    assert asked[0] == LEAST_BYTES


def test_link_that_slows_down_gets_smaller_requests_and_never_empty_ones() -> None:
    pace = AdaptiveChunkSize()
    for _ in range(10):
        pace.note(pace.answer_bytes, 0)
    assert pace.answer_bytes == MOST_BYTES
    for _ in range(2):  # each of them may cost the link
        pace.note(8192, 10 * NS_PER_S)
    assert pace.answer_bytes < 2 * LEAST_BYTES
    pace.note(100, 10 * NS_PER_S)
    assert pace.answer_bytes == LEAST_BYTES


def test_request_never_exceeds_the_demonstrated_capacity() -> None:
    """A single lost message comes quickly over any link."""
    pace = AdaptiveChunkSize()
    for _ in range(20):
        pace.note(100, 1_000_000)
    assert pace.answer_bytes == LEAST_BYTES


def test_messages_smaller_than_expected_keep_no_link_slow() -> None:
    pace = AdaptiveChunkSize()
    for _ in range(10):
        pace.note(round(0.3 * pace.answer_bytes), 1_000_000)
    assert pace.answer_bytes == MOST_BYTES


def test_size_is_reset_after_no_answer() -> None:
    pace = AdaptiveChunkSize()
    pace.note(pace.answer_bytes, 0)
    pace.note_timeout()
    assert pace.answer_bytes == LEAST_BYTES
