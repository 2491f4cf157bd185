"""Parts of the smoother: common stairs, errors of receivers, and the solution of the problem."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base_station.fusion.interface import PlaceFix, Start
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.smoothing import SMOOTHERS
from base_station.fusion.smoothing.equations import Equations, NormalEquations
from base_station.fusion.smoothing.interface import SmoothedPath, UnitEvidence
from shared.clock import NS_PER_S
from shared.messages import Header
from tests.rig.message_factory import position

SMOOTHER = SMOOTHERS[0]
OFF_M = 1.5


def a_climber(unit_id: str, east_of_start_m: float, start_off_m: float) -> UnitEvidence:
    """North 10 m from a wrong start, two flights that turn back, and back again; the stairs are 10
    m north of the origin.
    """
    ahead = [(0.5, 0.0, 0.0)] * 20
    east = [(0.0, -0.5 * np.sign(east_of_start_m), 0.0)] * round(2 * abs(east_of_start_m))
    up = [(0.4, 0.0, -0.16)] * 10 + [(0.0, 0.5, 0.0)] * 3 + [(-0.4, 0.0, -0.16)] * 10
    down = [(-north, -side, -fall) for north, side, fall in reversed(up)]
    around = [(0.0, 0.5, 0.0)] * 12 + [(0.0, -0.5, 0.0)] * 12
    history, own_m, down_m = PathHistory(), np.zeros(2), 0.0
    history.set_start(Start(start_off_m, east_of_start_m, 0.0, 0.0, 0.3 + abs(start_off_m), 0.02))
    for row, (north_m, east_m, falls_m) in enumerate([*ahead, *east, *up, *around, *down, *around]):
        own_m, down_m = own_m + np.array([north_m, east_m]), down_m + falls_m
        header = Header(unit_id, 1, row + 1, row * NS_PER_S)
        stated = position(header, north_m=float(own_m[0]), east_m=float(own_m[1]))
        history.append(stated, row * NS_PER_S, jumped=False)
        history.own.points[-1].shown_down_m = down_m
    return UnitEvidence(history.arrays(), history.start.position, history.start.begin_ns)


def test_climbs_of_the_same_stairs_are_at_the_same_place() -> None:
    """One start was wrong, and uncertain."""
    right, wrong = a_climber("a", 4.0, 0.0), a_climber("b", -4.0, OFF_M)
    units = {"a": right, "b": wrong}
    alone, together = SMOOTHER.solve(units).paths["b"], SMOOTHER.smooth(units).paths["b"]
    assert alone.north_m[0] - 0.5 == pytest.approx(OFF_M, abs=0.1)
    assert abs(together.north_m[0] - 0.5) < 0.4 * OFF_M
    assert together.std_north_m[0] < 0.7 * alone.std_north_m[0]


def test_stairs_too_far_apart_are_two() -> None:
    units = {"a": a_climber("a", 4.0, 0.0), "b": a_climber("b", -4.0, 0.0)}
    start = units["b"].start
    assert start is not None
    units["b"] = replace(units["b"], start=Start(0.0, 16.0, 0.0, 0.0, 0.3, 0.02))
    alone, together = SMOOTHER.solve(units), SMOOTHER.smooth(units)
    assert np.allclose(alone.paths["b"].east_m, together.paths["b"].east_m, atol=0.05)


def standing(fixes: int, wild: bool = False) -> SmoothedPath:
    """Fixes of a wearer at rest, a second apart, all 1 m north; or one far off."""
    history = PathHistory()
    for row in range(120):
        t_ns = row * NS_PER_S
        stated = position(Header("a", 1, row + 1, t_ns), north_m=0.1 * row if row < 80 else 8.0)
        history.append(stated, t_ns, jumped=False)
    for row in range(0, 2 * fixes, 2):
        north_m = 0.1 * row + (60.0 if wild and row == 10 else 1.0)
        history.fix(PlaceFix(row * NS_PER_S, north_m, 0.0, 0.0, 1.3, None), row * NS_PER_S)
    start = Start(0.0, 0.0, 0.0, 0.0, 3.0, 0.02)
    return SMOOTHER.solve({"a": UnitEvidence(history.arrays(), start)}).paths["a"]


def test_many_fixes_of_half_a_minute_are_little_more_than_one() -> None:
    """Their errors last, and the common error of receivers is never averaged away."""
    one, half_a_minute, longer = (standing(count).std_north_m[5] for count in (1, 15, 40))
    assert half_a_minute > 0.8 * one
    assert 0.85 < longer < half_a_minute  # of the 0.87 m that all share


def test_one_distant_fix_is_an_outlier() -> None:
    plain, wild = standing(40), standing(40, wild=True)
    assert wild.north_m == pytest.approx(plain.north_m, abs=0.1)
    assert wild.std_north_m == pytest.approx(plain.std_north_m, rel=0.05)


def test_block_arrow_solver_equals_a_general_one() -> None:
    """Two chains of three knots with two unknowns each, and two that both share."""
    rng, shared, links = np.random.default_rng(5), Equations(14), Equations(14)
    of_chains = {"a": Equations(14), "b": Equations(14)}
    columns = {"a": slice(0, 6), "b": slice(6, 12)}
    for base, equations in zip((0, 6), of_chains.values(), strict=True):
        here = base + np.arange(4)
        both = np.full(4, 12)
        equations.add(0.5, rng.normal(size=4), (here + 2, 1.0), (here, -0.9), (both, 0.3))
        equations.add(2.0, rng.normal(size=6), (base + np.arange(6), 1.0), (np.full(6, 13), -1.0))
    links.add(0.7, 0.1, (np.array([8, 1]), 1.0), (np.array([13, 13]), -1.0))
    shared.add(1.0, 0.2, (np.array([12, 13]), 1.0))
    normal = NormalEquations(columns, 2, of_chains.items(), links, shared)
    every = [*of_chains.values(), links, shared]
    matrix = np.concatenate([one.matrix().toarray() for one in every])
    right = np.concatenate([one.right for one in every])
    covariance = np.linalg.inv(matrix.T @ matrix)
    wanted = covariance @ matrix.T @ right
    chains, reported = normal.solve()
    assert np.concatenate([*chains.values(), reported]) == pytest.approx(wanted)
    assert normal.shared_covariance == pytest.approx(covariance[12:, 12:])
    for name, equations in of_chains.items():
        rows = equations.matrix()
        expected = rows.toarray() @ covariance @ rows.toarray().T
        assert normal.spread_of(name, rows) == pytest.approx(expected)
        spreads = normal.covariances(name) + normal.shared_covariances(name)
        aside = normal.covariances(name) + normal.shared_covariances(name, plus=0)
        for knot, first in enumerate(range(columns[name].start, columns[name].stop, 2)):
            of_knot = slice(first, first + 2)
            assert spreads[knot] == pytest.approx(covariance[of_knot, of_knot])
            plus = np.zeros((2, 14))
            plus[:, of_knot] = plus[:, 12:] = np.eye(2)
            assert aside[knot] == pytest.approx(plus @ covariance @ plus.T)
