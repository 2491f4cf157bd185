"""Smoothed paths have the noise of each run of the path, not that of the last one."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion.interface import Start
from base_station.fusion.odometry.noise_runs import NoiseRun
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.smoothing import SMOOTHERS
from base_station.fusion.smoothing.interface import UnitEvidence
from shared.clock import NS_PER_S
from shared.messages import Header
from shared.path_noise import PathNoise
from tests.rig.message_factory import position

SMOOTHER = SMOOTHERS[0]
HALF, FAR = 40, 80
WIDE, NARROW = PathNoise(0.08, 0.03, 0.004), PathNoise(0.01, 0.03, 0.004)


def std_along_m(*noises: PathNoise) -> np.ndarray:
    """Deviations along a straight way of eighty metres, whose halves have these noises."""
    history = PathHistory()
    history.set_start(Start(0.0, 0.0, 0.0, 0.0, 0.1, 0.02))
    for row in range(FAR + 1):
        header = Header("a", 1, row + 1, row * NS_PER_S)
        history.append(position(header, north_m=float(row)), row * NS_PER_S, jumped=False)
    runs = [NoiseRun(HALF * NS_PER_S, noise) for noise in noises[:-1]]
    evidence = UnitEvidence(
        history.arrays(),
        history.start.position,
        history.start.begin_ns,
        path_noise=noises[-1],
        noise_runs=runs,
    )
    path = SMOOTHER.solve({"a": evidence}).paths["a"]
    return np.interp([HALF, FAR], path.t_ns / NS_PER_S, path.std_north_m)


def test_last_noise_does_not_hold_for_the_way_before() -> None:
    (half_m, far_m), (alone_m, _) = std_along_m(NARROW, WIDE), std_along_m(NARROW, NARROW)
    assert half_m == pytest.approx(alone_m, rel=0.1)
    assert far_m == pytest.approx(math.hypot(HALF * 0.08, HALF * 0.01), rel=0.1)


def test_error_of_a_scale_that_was_wide_stays_in_the_place() -> None:
    half_m, far_m = std_along_m(WIDE, NARROW)
    assert half_m == pytest.approx(HALF * 0.08, rel=0.1)
    assert far_m == pytest.approx(half_m, rel=0.1)


def test_runs_of_one_noise_are_one() -> None:
    assert std_along_m(WIDE, WIDE) == pytest.approx(std_along_m(WIDE))
