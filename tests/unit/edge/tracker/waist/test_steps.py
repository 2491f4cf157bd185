"""Steps and their lengths as Li et al. (2014) have them."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.track_rows import join_rows
from edge.tracker.waist.state import WaistConfig
from edge.tracker.waist.steps import step_length_m
from edge.tracker.waist.tracker import WaistTracker
from tests.rig.trunk_walk import DESCRIPTION, bobbing

CONFIG = WaistConfig()


def tracked(imu):
    tracker = WaistTracker(DESCRIPTION)
    return join_rows([tracker.push(imu), tracker.finish()])


@pytest.mark.parametrize(
    ("frequency_hz", "length_m"),
    [(1.35, 0.44244), (1.5, 0.51), (1.8, 0.64512), (2.0, 0.7352), (2.45, 0.93788)],
)
def test_length_is_that_of_the_paper(frequency_hz, length_m):
    assert step_length_m(1.0 / frequency_hz, CONFIG) == pytest.approx(length_m)


def test_beyond_the_range_the_length_is_that_of_its_end():
    assert step_length_m(1.0, CONFIG) == pytest.approx(0.44244)
    assert step_length_m(0.35, CONFIG) == pytest.approx(0.93788)


def stated_std(rows):
    """Deviation of the last place by the way to it."""
    return np.sqrt(rows.position_cov_m2[-1, 0, 0]) / rows.distance_m[-1]


@pytest.mark.parametrize("frequency_hz", [1.0, 2.8, 3.2])
def test_a_way_beyond_the_range_is_stated_as_worse(frequency_hz):
    """The fastest is one of which every second peak comes too early for a step."""
    usual = stated_std(tracked(bobbing(60, 1.8)))
    assert stated_std(tracked(bobbing(60, frequency_hz))) > 2.0 * usual


@pytest.mark.parametrize("frequency_hz", [1.4, 1.8, 2.4])
@pytest.mark.parametrize("steps", [12, 30])
def test_every_step_is_found_and_as_long_as_its_period_says(frequency_hz, steps):
    rows = tracked(bobbing(steps, frequency_hz))
    assert rows.steps[-1] == steps // 2
    expected_m = steps * (0.4504 * frequency_hz - 0.1656)
    assert rows.distance_m[-1] == pytest.approx(expected_m, rel=0.02)
    assert np.hypot(*rows.position_n_m[-1, :2]) == pytest.approx(expected_m, rel=0.02)


def test_too_weak_or_too_fast_motion_is_no_step():
    assert tracked(bobbing(20, 1.8, amplitude_mps2=0.3)).distance_m[-1] == 0.0
    fast = tracked(bobbing(40, 4.0, amplitude_mps2=8.0))  # a rattle: every second peak at most
    assert fast.steps[-1] <= 10


def test_a_wearer_who_stands_stays_where_the_last_step_ended():
    rows = tracked(bobbing(10, 1.8))
    last_s = 2.0 + 10 / 1.8 + 0.5
    standing = rows.t_ns > last_s * 1e9
    assert np.ptp(rows.position_n_m[standing, :2], axis=0) == pytest.approx([0.0, 0.0])
    assert np.all(rows.velocity_n_mps[standing] == 0.0)


def test_the_path_turns_as_the_wearer_does():
    """A round of 24 steps ends where it began; each step has its mean heading."""
    frequency_hz, steps = 1.8, 24
    rows = tracked(bobbing(steps, frequency_hz, turn_radps=2.0 * np.pi * frequency_hz / steps))
    around_m = steps * (0.4504 * frequency_hz - 0.1656)
    assert np.hypot(*rows.position_n_m[-1, :2]) < 0.1 * around_m
    assert np.ptp(rows.position_n_m[:, 0]) == pytest.approx(around_m / np.pi, rel=0.1)
