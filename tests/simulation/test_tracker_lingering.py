"""A wearer who stands, kneels or sits for a while stays at the place, and gets up there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.simulation.legs import Kneel, Sit, Stand, Wait
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import Simulation
from edge.tracker.foot.error_state import GYRO_BIAS
from edge.tracker.foot.eskf import EskfTracker
from tests.bench.tracker.wearers import KINDS, Wearer, WearerKindErrors, stray, wearers_table
from tests.rig.inertial_walk import inertial_samples


@pytest.mark.parametrize("seed", [103, 104])
def test_small_slow_steps_on_one_spot_are_integrated(seed):
    """Taken for sway, steps of some centimetres were lost, and the place was stated as known."""
    one = stray(Wearer("waits", (Stand(4.0), Wait(150.0))), seed, calibrated=True)
    assert one.error_m < 0.03
    assert one.inside > 0.95
    assert abs(one.height_m) < 0.03


@pytest.mark.parametrize("leg", [Kneel(20.0), Sit(60.0)], ids=["kneels", "sits"])
def test_wearer_who_gets_up_again_is_on_the_same_floor(leg):
    for calibrated in (True, False):
        one = stray(Wearer("lingers", (Stand(4.0), leg, Stand(3.0))), 101, calibrated)
        assert one.error_m < 0.15
        assert abs(one.height_m) < max(0.1, 2.0 * one.height_std_m)
        assert one.silent == 0.0


def test_bias_estimate_of_a_rest_is_independent_of_the_sample_rate():
    """Samples without information were selected one by one, so that fast rates learned half."""
    known = []
    for rate_hz in (100.0, 200.0, 800.0):
        simulation = Simulation(Scenario("rests", "rests", (Stand(30.0),), rate_hz=rate_hz), 1)
        tracker = EskfTracker(replace(simulation.description, mag_present=False))
        tracker.push(inertial_samples(simulation))
        known.append(np.sqrt(np.diag(tracker._state["covariance"][0])[GYRO_BIAS : GYRO_BIAS + 3]))
    assert known[0] == pytest.approx(known[1], rel=0.2)
    assert known[2] == pytest.approx(known[1], rel=0.2)


def test_table_names_the_activity_and_the_sensors():
    assert len({kind.does for kind in KINDS}) == len(KINDS)
    one = WearerKindErrors("waits", False, 0.012, 0.5, 2.0, 3.0, 0.1, 0.2, 0.95, 0.0)
    assert [next(iter(column.cells)) for column in wearers_table([one]).columns] == [
        "waits", "data sheet", "1.2", "0.50", "2.0 / 3.0", "0.10 / 0.20", "95", "0",
    ]  # fmt: skip


def test_part_of_a_walk_is_recorded_from_its_start():
    whole = stray(Wearer("stands", (Stand(8.0),)), 1, calibrated=True)
    part = stray(Wearer("stands", (Stand(8.0),), cut_s=4.0), 1, calibrated=True)
    assert part.error_m < 0.02
    assert not np.isclose(whole.heading_rad, part.heading_rad, atol=0.0)
