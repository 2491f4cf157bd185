"""Stated errors of dead reckoning by steps."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.interface import Quality, Reason
from edge.tracker.preprocessing.sample_ring import RING
from edge.tracker.trunk.dead_reckoning import begin_walk, state_errors, take_step
from edge.tracker.trunk.state import TRUNK, TrunkConfig

CONFIG = TrunkConfig()
NORTH, SOUTH, EAST = np.array([1.0, 0.0]), np.array([-1.0, 0.0]), np.array([0.0, 1.0])


def walked(*ways):
    """The row after ways of (direction, steps), each step of 0.7 m."""
    trunk, row = np.zeros(1, TRUNK)[0], np.zeros(1, RING)[0]
    trunk["has_compass"] = True
    begin_walk(trunk, CONFIG)
    for direction, steps in ways:
        for _ in range(steps):
            take_step(trunk, 0.7, 0.18, direction, 60.0, CONFIG)
    state_errors(trunk, row, CONFIG)
    return trunk, row


def test_a_wrong_length_stretches_the_way_and_a_wrong_heading_turns_it():
    trunk, row = walked((NORTH, 100))
    assert trunk["position_n_m"] == pytest.approx([70.0, 0.0, 0.0])
    along_m, across_m = np.sqrt(np.diag(row["position_cov_m2"])[:2])
    assert along_m == pytest.approx(0.18 * 70.0, rel=0.02)
    assert across_m == pytest.approx(CONFIG.compass_std_rad * 70.0, rel=0.02)


def test_out_and_back_cancel_both():
    _, out = walked((NORTH, 50))
    _, back = walked((NORTH, 50), (SOUTH, 50))
    assert np.trace(back["position_cov_m2"][:2, :2]) < 0.25 * np.trace(
        out["position_cov_m2"][:2, :2]
    )


def test_turns_are_less_certain_than_straight_ways():
    _, straight = walked((NORTH, 40))
    trunk, turning = walked(*[(NORTH, 1), (EAST, 1)] * 20)
    assert trunk["random_m2"] > 4.0 * (0.1 * 0.7) ** 2 * 40
    assert straight["quality"] == Quality.DEGRADED  # 5 m stated along the way
    assert turning["reasons"] & Reason.UNCERTAIN


def test_quality_follows_what_is_stated():
    _, near = walked((NORTH, 5))
    _, far = walked((NORTH, 200))
    assert near["quality"] == Quality.GOOD
    assert far["quality"] == Quality.LOST
    assert far["reasons"] == Reason.UNCERTAIN
