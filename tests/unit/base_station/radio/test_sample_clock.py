"""Times of samples, from pieces that come late, at once or from a clock that drifts."""

from __future__ import annotations

from random import Random

import pytest

from base_station.radio.sample_clock import SampleClock
from shared.clock import NS_PER_MS, NS_PER_S

PIECE_S = 0.02


@pytest.mark.parametrize("rate_ppm", [-200.0, 0.0, 200.0])
def test_drifting_device_is_followed(rate_ppm: float) -> None:
    """An hour: uncorrected, it would be 0.7 s."""
    clock, random = SampleClock(2.0), Random(1)
    true_ns = 0
    for number in range(1, round(3_600.0 / PIECE_S)):
        end_s = number * PIECE_S
        true_ns = round(end_s * (1.0 + rate_ppm * 1e-6) * NS_PER_S)
        clock.note(end_s, true_ns + round(random.expovariate(200.0) * NS_PER_S))
        if number > 100:
            assert abs(clock.time_ns(end_s) - true_ns) < 5 * NS_PER_MS


def test_stream_that_stops_and_catches_up_stays_in_place() -> None:
    clock = SampleClock(10.0)
    clock.note(30.0, 31 * NS_PER_S)
    for number in range(1, 10):  # after fifteen seconds everything at once
        clock.note(30.0 + number, 46 * NS_PER_S)
        assert clock.time_ns(30.0 + number) == (31 + number) * NS_PER_S


def test_burst_of_a_server_at_the_beginning_is_of_before() -> None:
    clock = SampleClock(10.0)
    for end_s in range(1, 6):
        clock.note(end_s, 100 * NS_PER_S)
    clock.note(6.0, 101 * NS_PER_S)
    assert clock.time_ns(1.0) == 96 * NS_PER_S


def test_lost_samples_are_a_gap_when_the_window_is_over() -> None:
    clock = SampleClock(2.0)
    for number in range(100):
        lost_ns = 3 * NS_PER_S if number >= 50 else 0
        clock.note(number * 0.1, round(number * 0.1 * NS_PER_S) + lost_ns)
    assert clock.time_ns(9.9) == round(12.9 * NS_PER_S)
