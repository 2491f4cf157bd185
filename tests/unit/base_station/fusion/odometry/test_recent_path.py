"""Recent path of a unit: its places of the last minutes, in its own frame."""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import pytest

from base_station.fusion.odometry.recent_path import (
    COARSE_NS,
    KEPT_NS,
    MOST_POINTS,
    PLACE_ROW,
    PathPoint,
    RecentPath,
)
from shared.clock import NS_PER_S
from shared.messages import Header, Position

FIFTH_NS = NS_PER_S // 5

At = Callable[..., Position]


@pytest.fixture
def at(make_position: Callable[[], Position]) -> At:
    """A walk to the north at a metre a second, a little to the west, or elsewhere."""

    def make(t_ns: int, north_m: float | None = None) -> Position:
        way_m = t_ns / NS_PER_S
        return msgspec.structs.replace(
            make_position(),
            header=Header("FF-01", 1, 1, t_ns),
            north_m=way_m if north_m is None else north_m,
            east_m=-0.1 * way_m,
            distance_m=1.4 * way_m,
        )

    return make


@pytest.fixture
def hour(at: At) -> RecentPath:
    memory = RecentPath()
    for t_ns in range(0, 3600 * NS_PER_S, FIFTH_NS):
        memory.append(at(t_ns))
    return memory


def test_half_an_hour_is_known_everywhere(hour: RecentPath) -> None:
    restored = msgspec.msgpack.decode(msgspec.msgpack.encode(hour), type=RecentPath)
    for ago_s in (0.3, 59.7, 61.3, 150.1, 1000.9, 1790.9):
        t_ns = round((3599.8 - ago_s) * NS_PER_S)
        then = restored.at(t_ns)
        assert then == hour.at(t_ns)
        assert not isinstance(then, str)
        assert then.t_ns == t_ns
        assert then.north_m == pytest.approx(t_ns / NS_PER_S)
        assert then.east_m == pytest.approx(-0.1 * t_ns / NS_PER_S)
        assert then.distance_m == pytest.approx(1.4 * t_ns / NS_PER_S)


def test_places_longer_ago_are_unknown(hour: RecentPath) -> None:
    assert hour.at(1600 * NS_PER_S) == "too old"


def test_recent_path_stays_small(hour: RecentPath) -> None:
    assert len(hour.points) < MOST_POINTS
    size = len(hour.loose) + sum(len(chunk.columns) for chunk in hour.packed.chunks)
    assert size < 8 * (KEPT_NS // COARSE_NS)
    old = len(hour.loose) // PLACE_ROW.itemsize + len(hour.packed.rows(PLACE_ROW))
    assert old == pytest.approx(KEPT_NS // COARSE_NS, rel=0.15), "one in two seconds"


def test_places_before_a_long_silence_are_too_old(at: At) -> None:
    memory, again_s = RecentPath(), 7200
    for begin_s in (0, again_s):
        for t_ns in range(begin_s * NS_PER_S, (begin_s + 300) * NS_PER_S, FIFTH_NS):
            memory.append(at(t_ns))
    assert memory.at(100 * NS_PER_S) == "too old"
    assert not isinstance(memory.at((again_s + 100) * NS_PER_S), str)


def test_unknown_place_is_the_begin_of_the_own_frame() -> None:
    assert RecentPath().at(7 * NS_PER_S) == PathPoint(7 * NS_PER_S, 0.0, 0.0, 0.0)


def test_newest_place_counts_for_the_future(hour: RecentPath) -> None:
    then = hour.at(3700 * NS_PER_S)
    assert not isinstance(then, str)
    assert then.t_ns == 3600 * NS_PER_S - FIFTH_NS


def test_first_known_place_holds_for_some_seconds_before_it(at: At) -> None:
    memory = RecentPath()
    memory.append(at(100 * NS_PER_S))
    just_before = memory.at(96 * NS_PER_S)
    assert not isinstance(just_before, str)
    assert just_before.north_m == 100.0
    assert memory.at(94 * NS_PER_S) == "too old"


def test_fast_positions_are_known_to_the_newest_and_not_kept_more_densely(at: At) -> None:
    """A hundred a second."""
    memory = RecentPath()
    for step in range(5000):
        t_ns = step * NS_PER_S // 100
        memory.append(at(t_ns))
        newest = memory.at(t_ns + NS_PER_S)
        assert not isinstance(newest, str)
        assert newest.t_ns == t_ns
    assert len(memory.points) <= 54 * 5


def test_last_minute_is_known_as_it_was_walked(at: At) -> None:
    """There and back every second; of older parts, only the begin and the end."""
    memory = RecentPath()
    for t_ns in range(0, 300 * NS_PER_S, FIFTH_NS):
        memory.append(at(t_ns, north_m=t_ns // NS_PER_S % 2))
    for ago_s in range(1, 59):
        t_ns = 299 * NS_PER_S - ago_s * NS_PER_S + 2 * FIFTH_NS
        then = memory.at(t_ns)
        assert not isinstance(then, str)
        assert then.north_m == t_ns // NS_PER_S % 2


@pytest.mark.parametrize("late_s", [1480, 900])
def test_gap_is_filled_by_late_positions(at: At, late_s: int) -> None:
    memory, late_ns = RecentPath(), late_s * NS_PER_S
    for t_ns in range(0, 1500 * NS_PER_S, FIFTH_NS):
        if abs(t_ns - late_ns) > 10 * NS_PER_S:
            memory.append(at(t_ns))
    assert memory.at(late_ns) == "the path at its time is not known"
    memory.insert_late(at(late_ns, north_m=7.0))
    memory.insert_late(at(late_ns + FIFTH_NS // 2))  # too near to add information
    then = memory.at(late_ns)
    assert not isinstance(then, str)
    assert then.north_m == 7.0
    further = memory.at(late_ns + FIFTH_NS // 2)
    assert not isinstance(further, str)
    assert further.north_m == pytest.approx(7.0 + 0.1 * (late_s + 10.2 - 7.0) / 10.2, abs=0.01)


def test_half_an_hour_that_comes_late_is_known_everywhere_and_stays_as_small(at: At) -> None:
    memory = RecentPath()
    last_s = 1700
    for t_s in (0, last_s):
        memory.append(at(t_s * NS_PER_S))
    for fifth in range(5 * last_s):
        memory.insert_late(at(fifth * FIFTH_NS))
    for t_s in range(last_s):
        place = memory.at(t_s * NS_PER_S)
        assert isinstance(place, PathPoint)
        assert place.north_m == pytest.approx(t_s, abs=0.01)
    dense, coarse = 60 * NS_PER_S // FIFTH_NS, last_s * NS_PER_S // COARSE_NS
    assert len(memory.points) + len(memory.loose) // PLACE_ROW.itemsize < dense + coarse + 3


def test_late_positions_that_are_too_old_are_not_kept(at: At, hour: RecentPath) -> None:
    """Out of a journal of hours; each would have to be sorted in."""
    before = msgspec.msgpack.encode(hour)
    for t_s in range(1, 1799, 100):
        hour.insert_late(at(t_s * NS_PER_S))
    assert msgspec.msgpack.encode(hour) == before


def test_place_beyond_the_range_of_a_row_is_at_its_limit(at: At) -> None:
    memory = RecentPath()
    for t_ns in range(0, 300 * NS_PER_S, FIFTH_NS):
        memory.append(at(t_ns, north_m=1e300))
    then = memory.at(10 * NS_PER_S)
    assert not isinstance(then, str)
    assert 2e6 < then.north_m < 3e6
