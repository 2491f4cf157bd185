"""Height by pressure: P = P0 (1 - H / 44330)^5.255."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.tracker.track_rows import join_rows
from edge.tracker.trunk.pressure_height import pressure_height_m
from edge.tracker.waist.tracker import WaistTracker
from tests.rig.trunk_walk import DESCRIPTION, bobbing


@pytest.mark.parametrize("height_m", [-100.0, 0.0, 4.0, 500.0])
def test_the_formula_is_inverted(height_m):
    pressure_pa = 101_325.0 * (1.0 - height_m / 44_330.0) ** 5.255
    assert pressure_height_m(pressure_pa) == pytest.approx(height_m, abs=1e-6)


def climbing(height_m, bad=()):
    """A walk of 40 steps that climbs evenly, with what a barometer beside shows."""
    imu = bobbing(40, 1.8, stands_s=4.0)
    share = np.clip((imu.t_ns * 1e-9 - 4.0) / (40 / 1.8), 0.0, 1.0)
    pressure_pa = 98_000.0 * (1.0 - share * height_m / 44_330.0) ** 5.255
    for row, value in bad:
        pressure_pa[row] = value
    tracker = WaistTracker(DESCRIPTION)
    return join_rows([tracker.push(replace(imu, pressure_pa=pressure_pa)), tracker.finish()])


def test_a_storey_is_climbed():
    down_m = climbing(4.0).position_n_m[:, 2]
    assert down_m[0] == 0.0
    assert down_m[-1] == pytest.approx(-4.0, abs=0.15)


def test_readings_that_are_none_are_left_out():
    bad = [(600, np.nan), (700, 0.0), (800, 2e5)]
    assert climbing(4.0, bad).position_n_m[-1, 2] == pytest.approx(-4.0, abs=0.15)


def test_without_a_barometer_the_way_is_level_and_its_height_little_known():
    imu = bobbing(40, 1.8)
    tracker = WaistTracker(DESCRIPTION)
    rows = join_rows([tracker.push(imu), tracker.finish()])
    assert np.all(rows.position_n_m[:, 2] == 0.0)
    std_m = np.sqrt(rows.position_cov_m2[-1, 2, 2])
    assert std_m == pytest.approx(0.1 * rows.distance_m[-1])
    assert np.sqrt(climbing(4.0).position_cov_m2[-1, 2, 2]) < 0.5
