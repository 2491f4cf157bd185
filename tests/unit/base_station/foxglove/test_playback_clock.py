"""The clock of a replay, as a client plays, pauses and seeks it."""

from __future__ import annotations

import math

import pytest

from base_station.foxglove.playback_clock import SPEED_MAX, PlaybackClock

START_NS, END_NS = 1_000, 2_000


def clock() -> PlaybackClock:
    return PlaybackClock(START_NS, END_NS, now_ns=0)


def test_clock_begins_paused_at_the_start() -> None:
    paused = clock()
    assert paused.advance(500) == START_NS
    assert not paused.is_playing


def test_clock_plays_at_its_speed_and_pauses() -> None:
    one = clock()
    one.play()
    assert one.advance(100) == START_NS + 100
    one.set_speed(2.0)
    assert one.advance(200) == START_NS + 300
    one.pause()
    assert one.advance(900) == START_NS + 300


def test_clock_stops_at_the_end_and_plays_again_from_the_start() -> None:
    one = clock()
    one.play()
    assert one.advance(5_000) == END_NS
    assert one.is_at_end
    assert not one.is_playing
    one.play()
    assert one.advance(5_010) == START_NS + 10


@pytest.mark.parametrize(("asked_ns", "at_ns"), [(1_500, 1_500), (0, START_NS), (9_999, END_NS)])
def test_seek_stays_within_the_window(asked_ns: int, at_ns: int) -> None:
    one = clock()
    one.seek(asked_ns)
    assert one.at_ns == at_ns


def test_clock_waits_where_publication_has_not_arrived() -> None:
    one = clock()
    one.play()
    one.advance(600)
    one.hold(START_NS + 200)
    assert one.advance(700) == START_NS + 300


@pytest.mark.parametrize("speed", [0.0, -1.0, math.nan, math.inf])
def test_impossible_speed_changes_nothing(speed: float) -> None:
    one = clock()
    one.set_speed(speed)
    assert one.speed == 1.0


def test_speed_is_bounded() -> None:
    one = clock()
    one.set_speed(1e6)
    assert one.speed == SPEED_MAX
