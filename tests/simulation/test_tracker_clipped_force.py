"""A sprinter whose accelerometer clips in every stride."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.simulation.imu import GRAVITY_MPS2
from edge.simulation.legs import Stand, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import Simulation
from edge.tracker.interface import Reason
from tests.bench.tracker.scoring import CHI2_95_2DOF, horizontal_nees
from tests.bench.tracker.walk_errors import track, true_way_m
from tests.bench.tracker.wearers import KINDS, stray
from tests.rig.inertial_walk import inertial_samples

LEGS = (Stand(4.0), Walk(((60.0, 0.0), (0.0, 0.0)), pace="sprint"), Stand(2.0))


@pytest.mark.parametrize(("full_scale_g", "short"), [(8.0, 0.03), (6.0, 0.08)])
@pytest.mark.parametrize("is_reported", [True, False])
def test_clipped_force_is_recovered_at_the_next_stance(full_scale_g, short, is_reported):
    simulation = Simulation(Scenario("sprint", "sprints", LEGS), seed=1)
    full_scale_mps2 = full_scale_g * GRAVITY_MPS2
    imu = inertial_samples(simulation)
    clipped = np.clip(imu.accel_mps2, -full_scale_mps2, full_scale_mps2)
    described_mps2 = full_scale_mps2 if is_reported else None
    described = replace(simulation.description, accel_full_scale_mps2=described_mps2)
    rows = track(described, replace(imu, accel_mps2=clipped), "eskf")
    truth = simulation.truth(np.asarray(rows.t_ns * 1e-9, np.float64))
    way_m, _ = true_way_m(rows.quaternion_nb, truth)
    walked_m, true_m = (
        np.hypot(*np.diff(path[::20, :2], axis=0).T).sum() for path in (rows.position_n_m, way_m)
    )
    assert walked_m == pytest.approx(true_m, rel=short)
    every = slice(100, None, 100)
    nees = horizontal_nees(rows.position_n_m[every], way_m[every], rows.position_cov_m2[every])
    assert np.mean(nees <= CHI2_95_2DOF) > 0.9
    assert np.mean(rows.reasons & int(Reason.ACCEL_SATURATED) != 0) > 0.3


@pytest.mark.parametrize("seed", [100, 104])
def test_velocity_of_a_poor_sensor_does_not_refuse_the_stances_of_a_sprint(seed):
    """The foot seems to fall, and the push to the next stride looks like its landing."""
    kind = next(one for one in KINDS if one.does.startswith("sprints"))
    errors = stray(kind, seed, calibrated=False)
    assert errors.error_m < 15.0
    assert errors.inside > 0.9
