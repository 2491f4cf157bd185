"""Trail of a unit: when it gets a point, the place of a late point, and which points are
dropped.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from base_station.core.state.trail import (
    RECENT_POINTS,
    TRAIL_POINTS,
    TrailStep,
    extend_trail,
    insert_into_trail,
)
from shared.clock import NS_PER_S
from shared.messages import STATION_ID, FusedPosition, Header
from tests.rig import message_factory


def fused(t_s: float, north_m: float = 0.0, east_m: float = 0.0, floor: int = 1) -> FusedPosition:
    header = Header(STATION_ID, 1, 1, 0)
    t_ns = round(t_s * NS_PER_S)
    return message_factory.fused(
        header, "FF-01", t_meas_ns=t_ns, north_m=north_m, east_m=east_m, floor=floor
    )


def step(t_s: float) -> TrailStep:
    return TrailStep(round(t_s * NS_PER_S), 3.0, -4.0, 1)


def at(t_s: float, north_m: float = 3.0, east_m: float = -4.0, floor: int = 1) -> FusedPosition:
    return fused(t_s, north_m, east_m, floor)


@pytest.mark.parametrize(
    ("next_one", "added"),
    [
        (at(99.9, north_m=9.0), False),  # before
        (at(100.9, north_m=9.0), False),  # at most one a second
        (at(101.0, north_m=3.5), True),
        (at(101.0, north_m=3.4, east_m=-4.4), True),
        (at(101.0, north_m=3.3, east_m=-4.3), False),  # not half a metre
        (at(101.0, floor=2), True),
        (at(114.9), False),
        (at(115.0), True),  # standing still
    ],
)
def test_point_is_added_for_a_step_a_floor_or_a_rest(next_one: FusedPosition, added: bool) -> None:
    trail = [step(100.0)]
    assert extend_trail(trail, next_one) is added
    assert len(trail) == 1 + added
    assert not added or trail[-1] == TrailStep(
        next_one.t_meas_ns, next_one.north_m, next_one.east_m, next_one.floor
    )


@pytest.mark.parametrize(
    ("late_s", "place"),
    [(95.0, 0), (99.0, 0), (99.1, None), (100.9, None), (101.0, 1), (109.1, None), (120.0, 2)],
)
def test_late_point_takes_its_place_where_none_is_near(late_s: float, place: int | None) -> None:
    trail = [step(100.0), step(110.0)]
    assert insert_into_trail(trail, fused(late_s)) is (place is not None)
    assert [one.t_ns for one in trail] == sorted(one.t_ns for one in trail)
    assert place is None or trail[place].t_ns == round(late_s * NS_PER_S)


def rooms(seconds: int) -> list[FusedPosition]:
    """A metre a second, a corner every 20 s, and up a floor in the middle."""
    walk, north_m, east_m = [], 0.0, 0.0
    for second in range(seconds):
        walk.append(fused(second, north_m, east_m, floor=int(second >= seconds // 2)))
        turn = second // 20 % 3
        north_m += (1.0, 0.0, -0.7)[turn]
        east_m += 1.0 if turn == 1 else 0.1
    return walk


def off_m(at: FusedPosition, trail: list[TrailStep]) -> float:
    """Distance of a place from the trail."""
    places_m = np.array([(step.north_m, step.east_m) for step in trail])
    here_m = np.array([at.north_m, at.east_m])
    begins_m, ways_m = places_m[:-1], np.diff(places_m, axis=0)
    along = ((here_m - begins_m) * ways_m).sum(axis=1) / np.maximum((ways_m**2).sum(axis=1), 1e-9)
    nearest_m = begins_m + along.clip(0.0, 1.0)[:, None] * ways_m
    return float(np.hypot(*(here_m - nearest_m).T).min())


@pytest.mark.slow
@pytest.mark.parametrize(("hours", "most_m"), [(1, 0.6), (2, 0.6), (4, 20.0)])
def test_whole_way_stays_and_is_bounded(hours: int, most_m: float) -> None:
    trail: list[TrailStep] = []
    walk = rooms(hours * 3600)
    for one in walk:
        extend_trail(trail, one)
        assert len(trail) <= TRAIL_POINTS
    assert trail[0].t_ns == 0
    assert max(off_m(one, trail) for one in walk[::13]) < most_m
    changes = [after for before, after in pairwise(trail) if after.floor != before.floor]
    assert [one.t_ns for one in changes] == [hours * 1800 * NS_PER_S]


def test_gap_of_a_trail_stays_until_it_is_backfilled() -> None:
    trail: list[TrailStep] = []
    for second in [*range(400), *range(460, 2000)]:
        extend_trail(trail, fused(second, north_m=float(second)))
    assert [step.t_ns // NS_PER_S for step in trail if step.after_gap] == [460]
    assert insert_into_trail(trail, fused(430, north_m=430.0))  # out of the journal
    gaps = [step.t_ns // NS_PER_S for step in trail if step.after_gap]
    assert gaps == [430, 460]
    for second in range(400, 460):
        insert_into_trail(trail, fused(second, north_m=float(second)))
    assert not any(step.after_gap for step in trail)
    assert not insert_into_trail(trail, fused(200, north_m=200.0)), "on a line that was thinned"


def test_full_trail_takes_older_points_and_stays_bounded() -> None:
    trail = [step(100.0 + 10.0 * number) for number in range(TRAIL_POINTS)]
    newest = trail[-RECENT_POINTS:]
    assert insert_into_trail(trail, fused(50.0))
    assert trail[0].t_ns == 50 * NS_PER_S
    assert len(trail) <= TRAIL_POINTS
    assert trail[-RECENT_POINTS:] == newest


def test_trail_with_room_takes_points_older_than_all() -> None:
    trail = [step(100.0)]
    assert insert_into_trail(trail, fused(50.0))
    assert [one.t_ns for one in trail] == [50 * NS_PER_S, 100 * NS_PER_S]
