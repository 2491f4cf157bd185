"""The way behind a unit: when it gets a point, where a late one goes, and what falls off."""

from __future__ import annotations

import pytest

from base_station.bench.rig import said
from base_station.units.trail import TRAIL_POINTS, TrailStep, extend_trail, fill_trail
from shared.clock import NS_PER_S
from shared.messages import STATION_ID, FusedPosition, Header


def fused(t_s: float, north_m: float = 0.0, east_m: float = 0.0, floor: int = 1) -> FusedPosition:
    header = Header(STATION_ID, 1, 1, 0)
    t_ns = round(t_s * NS_PER_S)
    return said.fused(header, "FF-01", t_meas_ns=t_ns, north_m=north_m, east_m=east_m, floor=floor)


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
def test_a_point_is_added_for_a_step_a_floor_or_a_rest(
    next_one: FusedPosition, added: bool
) -> None:
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
def test_a_late_point_takes_its_place_where_none_is_near(late_s: float, place: int | None) -> None:
    trail = [step(100.0), step(110.0)]
    assert fill_trail(trail, fused(late_s)) is (place is not None)
    assert [one.t_ns for one in trail] == sorted(one.t_ns for one in trail)
    assert place is None or trail[place].t_ns == round(late_s * NS_PER_S)


def test_a_full_trail_takes_nothing_older_and_loses_its_oldest() -> None:
    trail = [step(100.0 + 10.0 * number) for number in range(TRAIL_POINTS)]
    whole = list(trail)
    assert not fill_trail(trail, fused(50.0))
    assert trail == whole
    assert fill_trail(trail, fused(105.0))
    assert len(trail) == TRAIL_POINTS
    assert trail[0].t_ns == round(105.0 * NS_PER_S)


def test_one_that_is_not_full_takes_what_is_older_than_all() -> None:
    trail = [step(100.0)]
    assert fill_trail(trail, fused(50.0))
    assert [one.t_ns for one in trail] == [50 * NS_PER_S, 100 * NS_PER_S]
