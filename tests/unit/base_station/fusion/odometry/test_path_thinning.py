"""Thinning of a unit's own path: the points that are kept, and its breaks."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from base_station.fusion.interface import PlaceFix, Start
from base_station.fusion.odometry.packed_rows import CHUNK, MOST_CHUNKS
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.odometry.points import BREAK, DOUBTFUL, RESTART
from base_station.fusion.odometry.straight_segment import OFF_M
from shared.clock import NS_PER_S
from shared.quality import Quality
from tests.rig.published_path import at, walked

SECONDS = (MOST_CHUNKS + 16) * CHUNK


def test_one_point_a_metre_and_the_newest_place() -> None:
    arrays = walked(100).arrays()
    assert 90 <= len(arrays) <= 110
    assert arrays.own_m[-1, 0] == pytest.approx(99.8)
    assert arrays.t_ns[-1] == round(99.8 * NS_PER_S)
    assert arrays.moving_s.sum() == pytest.approx(99.8)
    assert (np.diff(arrays.t_ns) > 0).all()


@pytest.mark.parametrize(
    ("mps", "east_mps"), [(0.0, 1.0), (0.8, 0.8), (0.8, -0.8), (-1.0, 0.0)], ids=str
)
def test_moving_time_counts_in_every_direction(mps: float, east_mps: float) -> None:
    assert walked(60, mps, east_mps).arrays().moving_s.sum() == pytest.approx(59.8)


def test_rest_far_from_the_beginning_is_not_moving() -> None:
    history = PathHistory()
    for second in range(60):
        position = at(float(second), 30.0, east_m=40.0)
        history.append(position, position.header.t_mono_ns, jumped=False)
    assert history.arrays().moving_s.sum() == 0.0


def test_wearer_at_rest_leaves_a_point_now_and_then() -> None:
    arrays = walked(120, mps=0.0).arrays()
    assert 10 <= len(arrays) <= 15
    assert arrays.moving_s.sum() == 0.0


def test_straight_line_between_two_points_is_near_the_path() -> None:
    """Corners, rests and other paces: a line that is straight in time is near the true place."""
    rng, history = np.random.default_rng(5), PathHistory()
    place, velocity, times, places = np.zeros(2), np.zeros(2), [], []
    for step in range(3000):
        if rng.random() < 0.05:
            velocity = rng.normal(0.0, 0.8, 2) * (rng.random() < 0.7)
        place = place + 0.2 * velocity
        position = at(0.2 * step, float(place[0]), east_m=float(place[1]))
        history.append(position, position.header.t_mono_ns, jumped=False)
        times.append(position.header.t_mono_ns)
        places.append(place)
    arrays = history.arrays()
    off = [
        np.interp(times, arrays.t_ns, arrays.own_m[:, axis]) - np.array(places)[:, axis]
        for axis in (0, 1)
    ]
    assert np.percentile(np.abs(off), 95.0) < OFF_M
    assert len(arrays) < 0.2 * len(times)


def test_foot_that_moves_intermittently_is_a_walk() -> None:
    """Strides of 1.3 m: six tenths of each the foot stands."""
    history = PathHistory()
    for tenth in range(3000):
        strides, part = divmod(tenth / 5, 1.1)
        north_m = 1.3 * (strides + np.clip((part - 0.6) / 0.45, 0.0, 1.0))
        history.append(at(tenth / 5, float(north_m)), round(tenth / 5 * NS_PER_S), jumped=False)
    assert len(history.arrays()) < 1.05 * 600.0 / 1.1 * 1.3


def test_breaks_and_doubts_keep_their_places() -> None:
    history = PathHistory()
    for t_s, north_m, boot_id, jumped in (
        (0.0, 0.0, 1, False),
        (1.0, 0.2, 1, False),
        (2.0, 50.0, 1, True),
        (3.0, 0.0, 2, False),
    ):
        history.append(at(t_s, north_m, boot_id), round(t_s * NS_PER_S), jumped)
    history.append(at(4.0, 0.1, 2, quality=Quality.DEGRADED), 4 * NS_PER_S, jumped=False)
    arrays = history.arrays()
    flags = arrays.flags.tolist()
    assert arrays.moving_s.sum() == 2.0, "how long a jump took nobody knows"
    assert flags.count(BREAK) == 1
    assert flags.count(RESTART) == 1
    assert flags[-1] == DOUBTFUL


def test_times_that_go_back_stay_apart_and_in_order() -> None:
    history = PathHistory()
    assert (history.begin_ns, history.end_ns, history.shown_m) == (None, None, None)
    for t_s in (100, 20, 21, 22, 101):
        history.append(at(float(t_s), 2.0 * t_s), t_s * NS_PER_S, jumped=False)
    times_ns = history.arrays().t_ns
    assert (np.diff(times_ns) > 0).all()
    assert (times_ns[0], times_ns[-1]) == (100 * NS_PER_S, 101 * NS_PER_S)


def test_long_path_is_thinned_in_its_old_part() -> None:
    history = PathHistory()
    for second in range(SECONDS):
        history.append(at(float(second), 1.1 * second), second * NS_PER_S, jumped=False)
    arrays = history.arrays()
    assert arrays.t_ns[0] == 0
    assert arrays.t_ns[-1] == (SECONDS - 1) * NS_PER_S
    assert arrays.moving_s.sum() == pytest.approx(SECONDS - 1)
    apart_s = np.diff(arrays.t_ns) / NS_PER_S
    assert apart_s[: 8 * CHUNK].mean() == pytest.approx(2.0, rel=0.02)
    assert (apart_s[-MOST_CHUNKS * CHUNK :] == 1.0).all()


def test_heading_of_many_turns_breaks_nothing() -> None:
    history = PathHistory()
    for second in range(3 * CHUNK):
        position = at(second, float(second), heading_rad=math.tau * 60_000.0)
        history.append(position, second * NS_PER_S, jumped=False)
    assert history.own.packed


def test_saved_path_is_restored_the_same() -> None:
    history = walked(600)
    history.fix(PlaceFix(0, 1.5, -2.5, 0.0, 3.0, None), 7 * NS_PER_S)
    history.set_start(Start(1.0, 2.0, 0.0, 0.1, 0.5, 0.2))
    again = msgspec.msgpack.decode(msgspec.msgpack.encode(history), type=PathHistory)
    assert again == history
    assert history.own.packed
    one, two = again.arrays(), history.arrays()
    assert np.array_equal(one.own_m, two.own_m)
    assert np.array_equal(one.fix_m, two.fix_m)
