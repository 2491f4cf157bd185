"""Offset of a unit's clock from its exchanges with the station, with its uncertainty."""

from __future__ import annotations

import math

import pytest

from edge.clocks.offset import ClockEstimate, ClockOffsetFilter, Exchange
from shared.clock import NS_PER_S

OFFSET_S = 1_800_000_000.0
HOUR_S = 3600.0


def exchange(
    at_s: float, there_s: float = 0.005, back_s: float = 0.005, offset_s: float = OFFSET_S
) -> Exchange:
    """Asked at this monotonic time, with this long on the way there and back."""
    asked, answered = at_s, at_s + there_s + back_s
    at_station = asked + there_s + offset_s
    query_ns, station_ns, reply_ns = (round(t * 1e9) for t in (asked, at_station, answered))
    return Exchange(query_ns, station_ns, station_ns, reply_ns)


def estimate(offset: ClockOffsetFilter, at_s: float) -> ClockEstimate:
    found = offset.at(round(at_s * NS_PER_S))
    assert found is not None
    return found


def off_s(offset: ClockOffsetFilter, at_s: float) -> float:
    """By how much the estimate is wrong."""
    return (estimate(offset, at_s).offset_ns - round(OFFSET_S * NS_PER_S)) / NS_PER_S


@pytest.fixture
def settled() -> ClockOffsetFilter:
    offset = ClockOffsetFilter()
    for at_s in range(10):
        assert offset.note(exchange(float(at_s)))
    return offset


def test_offset_is_unknown_before_the_first_exchange() -> None:
    assert ClockOffsetFilter().at(0) is None


def test_the_first_exchange_is_as_sure_as_its_round_trip_allows() -> None:
    offset = ClockOffsetFilter()
    offset.note(exchange(0.0, 0.1, 0.1))
    within_s = 0.1  # half the round trip, evenly; once of the exchange, once of the two ways
    assert estimate(offset, 0.1).std_s == pytest.approx(within_s * math.sqrt(2 / 3), rel=0.01)


@pytest.mark.parametrize("wrong", [(-0.1, 0.0), (0.0, -0.1)])
def test_an_exchange_that_took_less_than_no_time_is_not_used(wrong: tuple[float, float]) -> None:
    offset = ClockOffsetFilter()
    assert not offset.note(exchange(0.0, *wrong))
    assert offset.at(0) is None


def test_exchange_with_a_negative_delay_is_not_used() -> None:
    asked, received, sent, answered = exchange(0.0)
    offset = ClockOffsetFilter()
    assert not offset.note(Exchange(asked, received + 1_000_000, sent, answered))


def test_delayed_exchange_changes_the_offset_little(settled: ClockOffsetFilter) -> None:
    std_s = estimate(settled, 10.0).std_s
    assert settled.note(exchange(10.0, there_s=8.0))
    assert abs(off_s(settled, 20.0)) < 0.01
    assert estimate(settled, 20.0).std_s == pytest.approx(std_s, rel=0.5)


def test_an_answer_that_comes_after_a_later_one_changes_nothing(settled: ClockOffsetFilter) -> None:
    before = estimate(settled, 20.0)
    assert not settled.note(exchange(4.0, there_s=4.0))
    assert estimate(settled, 20.0) == before


def test_impossible_offset_is_accepted_the_third_time_in_a_row(settled: ClockOffsetFilter) -> None:
    wrong_s = OFFSET_S + HOUR_S
    for at_s in (10.0, 11.0):
        assert not settled.note(exchange(at_s, offset_s=wrong_s))
    assert settled.note(exchange(12.0))  # and then one that is possible
    for at_s in (13.0, 14.0):
        assert not settled.note(exchange(at_s, offset_s=wrong_s))
        assert abs(off_s(settled, at_s)) < 0.01
    assert settled.note(exchange(15.0, offset_s=wrong_s))
    assert off_s(settled, 15.0) == pytest.approx(HOUR_S, abs=0.01)
    assert settled.note(exchange(16.0, offset_s=wrong_s))


def test_filter_estimates_the_drift_and_its_uncertainty_grows_with_time() -> None:
    offset, drift = ClockOffsetFilter(), 3e-5
    for number in range(60):
        at_s = 15.0 * number
        assert offset.note(exchange(at_s, offset_s=OFFSET_S + drift * at_s))
    last_s = 15.0 * 59
    assert estimate(offset, last_s).drift == pytest.approx(drift, rel=0.1)
    later_s = last_s + 600.0
    error_s = off_s(offset, later_s) - drift * later_s
    assert abs(error_s) < 3.0 * estimate(offset, later_s).std_s
    assert abs(error_s) < 0.005
    stds_s = [estimate(offset, last_s + wait_s).std_s for wait_s in (0.0, 600.0, 86_400.0)]
    assert stds_s == sorted(stds_s)
    assert stds_s[-1] > 2.0 * stds_s[0]


def test_the_quickest_of_them_says_how_far_the_two_ways_can_differ(
    settled: ClockOffsetFilter,
) -> None:
    for at_s in range(10, 40):
        settled.note(exchange(float(at_s), 0.2, 0.2))
    assert estimate(settled, 40.0).std_s < 0.01


AT_ONCE = (0.0, 0.0)  # there and back


def test_processing_time_of_the_station_is_no_part_of_the_delay() -> None:
    asked, received, sent, answered = exchange(0.0, 0.1, 0.1)
    thought_ns = 3 * NS_PER_S
    slow = Exchange(asked, received, sent + thought_ns, answered + thought_ns)
    assert slow.round_trip_s == pytest.approx(0.2)
    assert slow.offset_ns == round(OFFSET_S * NS_PER_S)


def test_an_answer_at_once_is_as_sure_as_a_timestamp_and_less_by_what_any_quartz_may_be_off() -> (
    None
):
    offset = ClockOffsetFilter()
    assert offset.note(exchange(0.0, *AT_ONCE))
    assert estimate(offset, 0.0).std_s == pytest.approx(math.sqrt(2.0) * 2e-4)
    assert estimate(offset, 1000.0).std_s == pytest.approx(5e-5 * 1000.0, rel=0.01)


def test_a_quartz_that_is_known_well_wanders_all_the_same() -> None:
    """By the integral of a random walk: a third of the cube of the time."""
    offset = ClockOffsetFilter()
    for number in range(2000):
        offset.note(exchange(15.0 * number, *AT_ONCE))
    away_s = 1e6
    expected_s = 1e-8 * math.sqrt(away_s**3 / 3.0)
    assert estimate(offset, 15.0 * 1999 + away_s).std_s == pytest.approx(expected_s, rel=0.1)


@pytest.mark.parametrize(("off_ms", "is_used"), [(4.0, True), (-4.0, True), (9.0, False)])
def test_some_milliseconds_are_a_machine_that_was_busy(off_ms: float, is_used: bool) -> None:
    offset = ClockOffsetFilter()
    for number in range(100):
        offset.note(exchange(float(number), *AT_ONCE))
    late = exchange(100.0, *AT_ONCE, offset_s=OFFSET_S + off_ms * 1e-3)
    assert offset.note(late) is is_used


@pytest.mark.parametrize(("off_s", "is_used"), [(0.45, True), (-0.45, True), (0.9, False)])
def test_half_the_round_trip_is_how_far_an_exchange_can_be_off(
    settled: ClockOffsetFilter, off_s: float, is_used: bool
) -> None:
    assert settled.note(exchange(10.0, 0.5, 0.5, OFFSET_S + off_s)) is is_used


def test_delay_that_changes_its_direction_is_possible() -> None:
    """An error common to all exchanges is unobservable."""
    offset = ClockOffsetFilter()
    for number in range(300):
        assert offset.note(exchange(float(number), there_s=1.0, back_s=0.0))
    assert offset.note(exchange(300.0, there_s=0.0, back_s=1.0))


def test_the_quickest_of_the_last_ones_counts_whenever_it_came() -> None:
    offset = ClockOffsetFilter()
    for number in range(70):
        offset.note(exchange(float(number), 0.2, 0.2))
    assert estimate(offset, 70.0).std_s > 0.1
    offset.note(exchange(70.0))
    for number in range(71, 134):
        offset.note(exchange(float(number), 0.2, 0.2))
    assert estimate(offset, 134.0).std_s < 0.02
    offset.note(exchange(134.0, 0.2, 0.2))
    assert estimate(offset, 135.0).std_s > 0.1, "64 slow ones: the way is another by now"


def test_another_clock_is_laid_by_its_own_exchanges_alone(settled: ClockOffsetFilter) -> None:
    wrong_s = OFFSET_S + HOUR_S
    for number in range(3):
        settled.note(exchange(10.0 + number, 0.2, 0.2, wrong_s))
    assert estimate(settled, 13.0).std_s > 0.1, (
        "how quick the way to the other one was says nothing"
    )
    for number in range(2):
        assert not settled.note(exchange(13.0 + number))
    assert off_s(settled, 15.0) == pytest.approx(HOUR_S, abs=0.01)
