"""Smoothers: any paths, fixes and pins yield finite places and uncertainties."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion.interface import Start
from base_station.fusion.odometry.points import BREAK, DOUBTFUL, RESTART, PathArrays
from base_station.fusion.smoothing import SMOOTHERS
from base_station.fusion.smoothing.interface import (
    EncounterConstraint,
    PositionConstraint,
    Smoother,
    UnitEvidence,
)
from base_station.site.floor_grid import FloorGrid
from base_station.site.plan import Plan, Stairs, Wall
from base_station.site.storeys import Storey

CASES = 25
ROOM = ((0.0, 0.0), (0.0, 6.0), (6.0, 6.0), (6.0, 0.0), (0.0, 0.0))
PLAN = Plan(
    b"",
    (Storey(0, 0.0), Storey(1, -3.0)),
    (ROOM,),
    (Wall(0, ROOM), Wall(1, ROOM)),
    (Stairs(0, ROOM),),
)


def any_path(rng: np.random.Generator) -> PathArrays:
    points, fixes = int(rng.integers(1, 150)), int(rng.integers(0, 20))
    flags = np.where(rng.random(points) < rng.choice([0.0, 0.05, 0.5]), RESTART, 0)
    flags |= np.where(rng.random(points) < rng.choice([0.0, 0.05]), BREAK, 0)
    flags |= np.where(rng.random(points) < 0.1, DOUBTFUL, 0)
    t_ns = np.cumsum(rng.integers(1, 20_000_000_000, size=points))
    steps = rng.normal(size=(points, 2)) * rng.choice([0.0, 1e-3, 0.5, 3.0])
    return PathArrays(
        t_ns=t_ns,
        own_m=np.cumsum(steps, axis=0) + rng.normal() * rng.choice([0.0, 1e3]),
        std_m=np.abs(rng.normal(size=points)),
        heading_rad=rng.uniform(-4.0, 4.0, points),
        moving_s=rng.uniform(0.0, 20.0, points),
        shown_m=100.0 * rng.normal(size=(points, 2)),
        shown_std_m=rng.choice([0.0, 0.1, 5.0], points),
        down_m=np.cumsum(rng.normal(size=points) * rng.choice([0.0, 0.1, 2.0])),
        down_std_m=rng.choice([0.0, 1.0, 100.0], points),
        floor=np.zeros(points, dtype=np.int64),
        flags=flags,
        fix_t_ns=np.sort(rng.choice(t_ns, fixes)),
        fix_m=rng.normal(size=(fixes, 2)) * rng.choice([1.0, 1e4]),
        fix_std_m=np.full(fixes, rng.choice([2.0, 100.0])),
    )


def any_evidence(rng: np.random.Generator, unit_id: str) -> UnitEvidence:
    path = any_path(rng)
    far = rng.choice([1.0, 100.0, 1e5])
    places = tuple(
        PositionConstraint(
            name=f"{unit_id}{number}",
            t_ns=int(rng.integers(path.t_ns[0] - 5, path.t_ns[-1] + 5)),
            north_m=float(rng.normal() * far),
            east_m=float(rng.normal() * far),
            std_m=float(rng.choice([0.05, 1.0, 1000.0])),
            down_m=3.0 if rng.random() < 0.5 else None,
            heading_rad=1.0 if rng.random() < 0.5 else None,
            heading_std_rad=float(rng.choice([1e-3, 3.0])),
        )
        for number in range(int(rng.integers(0, 6)))
    )
    start = Start(0.0, 0.0, 0.0, 1.0, float(rng.choice([0.0, 1e3])), float(rng.choice([0.0, 4.0])))
    grid = FloorGrid.of(PLAN) if rng.random() < 0.5 else None
    stated = start if rng.random() < 0.5 else None
    return UnitEvidence(path, stated, int(path.t_ns[0]), places, grid)


@pytest.mark.slow
@pytest.mark.parametrize("smoother", SMOOTHERS, ids=lambda smoother: smoother.name)
def test_every_place_and_uncertainty_is_finite(smoother: Smoother) -> None:
    for seed in range(CASES):
        rng = np.random.default_rng(seed)
        units = {name: any_evidence(rng, name) for name in "abc"[: int(rng.integers(1, 4))]}
        names = list(units)
        encounters = [
            EncounterConstraint("met", names[0], names[-1], int(units[names[0]].path.t_ns[-1]), 1.0)
        ]
        solution = smoother.smooth(units, encounters if len(names) > 1 else ())
        for path in solution.paths.values():
            places = (path.north_m, path.east_m, path.down_m, path.turn_rad, path.correlation_ne)
            assert all(np.isfinite(column).all() for column in places), seed
            stds = (path.std_north_m, path.std_east_m, path.std_down_m)
            assert all((np.isfinite(std) & (std > 0.0)).all() for std in stds), seed
            assert all(math.isfinite(value) for value in path.posterior.mean), seed
            assert np.isfinite(path.posterior.covariance).all(), seed
        reported = {place.name for unit in units.values() for place in unit.places}
        assert reported <= solution.verdicts.keys(), seed
