from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from base_station.report.contents import Interval
from base_station.report.trail import TOLERANCE_M, measure, simplified
from base_station.site.plan import read_plan
from base_station.storage.db.records import TrackSample
from shared.clock import NS_PER_S
from tests.rig.reported_incident import plan


def point(second: float, east_m: float, north_m: float = 0.0, floor: int | None = 0) -> TrackSample:
    t_ns = round(second * NS_PER_S)
    return TrackSample(t_ns, north_m, east_m, 0.0, 1.0, 1.0, 1.0, 0.0, floor, "good")


def seconds(begin: float, end: float) -> Interval:
    return Interval(round(begin * NS_PER_S), round(end * NS_PER_S))


def test_simplified_line_misses_no_point_by_more_than_the_tolerance():
    turns = np.cumsum(np.random.default_rng(3).normal(0.0, 0.2, 500))
    line = np.cumsum(np.column_stack([np.cos(turns), np.sin(turns)]), axis=0)
    kept = np.flatnonzero(simplified(line))
    assert len(kept) < 0.5 * len(line)
    for first, last in pairwise(kept):
        along = line[last] - line[first]
        for one in line[first : last + 1]:
            part = np.clip((one - line[first]) @ along / (along @ along), 0.0, 1.0)
            assert np.linalg.norm(one - line[first] - part * along) <= TOLERANCE_M + 1e-9


def test_line_there_and_back_keeps_its_far_end():
    line = np.array([(0.0, 0.0), (5.0, 0.0), (10.0, 0.0), (5.0, 0.0), (0.0, 0.0)])
    assert simplified(line).tolist() == [True, False, True, False, True]


def test_rest_adds_no_distance_and_an_unknown_way_has_none():
    still = [point(second, 0.1 * (second % 2)) for second in range(100)]
    assert measure(still, None, ()).distance_m == 0.0
    walked = [point(second, 1.0 * second) for second in range(11)]
    later = [point(100.0 + second, 500.0 + second) for second in range(11)]
    assert measure([*walked, *later], None, ()).distance_m == pytest.approx(20.0)


def test_radio_gap_is_a_line_of_its_own_that_joins_its_neighbours():
    points = [point(second, 1.0 * second) for second in range(31)]
    (trail,) = measure(points, None, (seconds(9.5, 20.5),)).trails
    assert trail.floor == 0
    assert [line[0][0] for line in trail.in_contact] == [0.0, 21.0]
    assert [(line[0][0], line[-1][0]) for line in trail.radio_gap] == [(10.0, 21.0)]


def test_unknown_way_is_left_open():
    points = [point(0.0, 0.0), point(1.0, 1.0), point(60.0, 50.0), point(61.0, 51.0)]
    (trail,) = measure(points, None, ()).trails
    assert [(line[0][0], line[-1][0]) for line in trail.in_contact] == [(0.0, 1.0), (50.0, 51.0)]


def test_time_inside_and_on_each_floor():
    outside = [point(second, -10.0, 5.0) for second in range(30)]
    inside = [point(30.0 + second, 10.0, 5.0, 1) for second in range(31)]
    figures = measure([*outside, *inside], read_plan(plan()), ())
    assert figures.inside_s == pytest.approx(30.0, abs=5.0)
    assert [floor for floor, _ in figures.floors] == [0, 1]
    assert [seconds for _, seconds in figures.floors] == pytest.approx([30.0, 30.0])
    assert measure(inside, None, ()).inside_s is None


def test_empty_trail_has_no_measures():
    figures = measure([], read_plan(plan()), ())
    assert (figures.distance_m, figures.inside_s, figures.trails) == (0.0, 0.0, ())
