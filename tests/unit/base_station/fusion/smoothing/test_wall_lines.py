"""Segments along one corridor are drawn together, and segments that only seem so are not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from base_station.fusion.interface import Start
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.smoothing.interface import UnitEvidence
from base_station.fusion.smoothing.path_graph import PathGraph
from base_station.fusion.smoothing.wall_lines import ASIDE_M, HABIT_PART, counts_of, mixture
from shared.clock import NS_PER_S
from shared.messages import Header
from tests.rig.message_factory import position

ASIDE_NORTH_M = 1.0  # error of the second unit's start


def test_legs_gather_at_two_corridors_and_others_lie_anywhere() -> None:
    rng = np.random.default_rng(3)
    of_line = np.repeat([0, 1, 2], [20, 12, 6])
    across_m = np.array([3.0, 6.0, 0.0])[of_line] + rng.normal(0.0, 0.2, len(of_line))
    across_m[of_line == 2] = [-9.0, -6.0, 9.0, 12.0, 15.0, 18.0]
    likely = mixture(across_m, np.full(len(across_m), 0.2**2))
    assert likely.shape[1] == 2
    assert likely[of_line == 0].max(axis=1).min() > 0.8
    assert (likely[of_line == 0].argmax(axis=1) != likely[of_line == 1].argmax(axis=1)[0]).all()
    assert likely[of_line == 2].max() < 0.1
    assert (likely.sum(axis=1) <= 1.0 + 1e-9).all()


@pytest.mark.parametrize("count", [0, 1, 4])
def test_few_legs_show_no_line(count: int) -> None:
    assert mixture(np.zeros(count), np.full(count, 0.1)).shape == (count, 0)


def test_legs_at_great_distances_cost_nothing() -> None:
    across_m = np.concatenate((np.zeros(8), [1e7, -1e7]))
    likely = mixture(across_m, np.full(10, ASIDE_M**2))
    assert (likely[:8].sum(axis=1) > 0.9).all()
    assert likely[8:].max() < 1e-6


def test_segments_of_one_person_weigh_less_than_as_many_of_several() -> None:
    alone = counts_of(["FF-01"] * 12, np.ones(12)).sum()
    together = counts_of([f"FF-{number:02}" for number in range(12)], np.ones(12)).sum()
    assert together == pytest.approx(12.0)
    assert alone == pytest.approx(12.0 / (1.0 + 11.0 * HABIT_PART))
    assert counts_of(["FF-01"], np.array([0.3])).sum() == pytest.approx(0.3)


def searched(start_m: tuple[float, float], std_m: float, seed: int, down_m: float) -> UnitEvidence:
    """There and back along a corridor at north 0, and into rooms of all depths beside it; the start
    is at the origin, whatever was reported of it.
    """
    rng, history, place, t_s = np.random.default_rng(seed), PathHistory(), np.zeros(2), 0
    history.set_start(Start(*start_m, 0.0, 0.0, std_m, 0.03))
    for corner in _corners(rng):
        way_m = float(np.linalg.norm(corner - place))
        for part in np.linspace(0.0, 1.0, max(2, round(way_m)))[1:]:
            t_s += 1
            north_m, east_m = (place + part * (corner - place)).tolist()
            reported = position(
                Header("FF-01", 1, t_s, t_s * NS_PER_S), north_m=north_m, east_m=east_m
            )
            history.append(reported, t_s * NS_PER_S, jumped=False)
        place = corner
    path = history.arrays()
    lies = replace(path, down_m=np.full(len(path), down_m))
    return UnitEvidence(lies, history.start.position, history.start.begin_ns)


def _corners(rng: np.random.Generator) -> list[NDArray[np.float64]]:
    corners, east_m = list[tuple[float, float]](), 0.0
    for number in range(14):
        depth_m = float(rng.uniform(3.0, 9.0)) * (1.0 if number % 2 else -1.0)
        corners += [(depth_m, east_m), (0.0, east_m)]
        east_m = float(rng.uniform(10.0, 20.0)) if east_m == 0.0 else 0.0
        corners.append((0.0, east_m))
    return [np.array(corner) for corner in corners]


def off_north_m(down_m: float, *, afterwards: bool) -> float:
    """Offset of the second unit, whose start was wrong and uncertain."""
    units = {
        "FF-01": searched((0.0, 0.0), 0.1, seed=1, down_m=0.0),
        "FF-02": searched((ASIDE_NORTH_M, 0.0), 1.0, seed=2, down_m=down_m),
    }
    kind = PathGraph()
    path = (kind.smooth if afterwards else kind.solve)(units).paths["FF-02"]
    return float((path.north_m - units["FF-02"].path.own_m[:, 0]).mean())


def test_unit_in_the_corridor_of_others_is_drawn_into_it() -> None:
    assert off_north_m(0.0, afterwards=False) == pytest.approx(ASIDE_NORTH_M, abs=0.1)
    assert abs(off_north_m(0.0, afterwards=True)) < 0.3


def test_storey_has_corridors_of_its_own() -> None:
    assert off_north_m(-3.2, afterwards=True) == pytest.approx(ASIDE_NORTH_M, abs=0.2)
