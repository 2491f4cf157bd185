"""Five floors up and back, by risers of every height that is built."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import ImuBatch
from edge.simulation.legs import Stairs, Stand, Turn, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import Simulation
from edge.tracker.eskf import EskfTracker
from edge.tracker.rows import join_rows

RISERS = 9  # a flight; two flights and a landing a floor


def flights(rise_m, floors):
    """Up the stairwell, along the top floor and back, down again."""
    far = (RISERS * 0.28, 0.0)
    up = (Stairs(far, rise_m, RISERS), Turn(180.0), Stairs((0.0, 0.0), rise_m, RISERS), Turn(0.0))
    down = (
        Stairs(far, -rise_m, RISERS),
        Turn(180.0),
        Stairs((0.0, 0.0), -rise_m, RISERS),
        Turn(0.0),
    )
    top = (Walk(((-8.0, 0.0), (0.0, 0.0))), Turn(0.0))
    return (Stand(5.0), *floors * up, *top, *floors * down, Stand(3.0))


def tracked(legs, seed):
    """Height above the start, tracked (n,), its deviation and the true one."""
    simulation = Simulation(Scenario("stairwell", "stairs", legs), seed)
    imu = [batch.imu for batch in simulation.batches(1.0)]
    t_ns = np.concatenate([part.t_ns for part in imu])
    tracker = EskfTracker(simulation.description)
    rows = join_rows(
        [
            tracker.push(
                ImuBatch(
                    t_ns,
                    np.concatenate([part.accel_mps2 for part in imu]),
                    np.concatenate([part.gyro_radps for part in imu]),
                )
            ),
            tracker.finish(),
        ]
    )
    true_m = simulation.truth(t_ns * 1e-9).position_n_m[:, 2]
    std_m = np.sqrt(rows.position_cov_m2[:, 2, 2])
    return -rows.position_n_m[:, 2], std_m, true_m[0] - true_m


@pytest.mark.parametrize("riser_m", [0.14, 0.17, 0.21])
def test_five_floors_keep_their_height(riser_m):
    height_m, std_m, true_m = tracked(flights(RISERS * riser_m, 5), seed=int(1000 * riser_m))
    top_m = true_m.max()
    assert top_m == pytest.approx(5 * 2 * RISERS * riser_m, abs=0.1)
    error_m = height_m - true_m
    assert np.abs(error_m).max() < max(0.02 * top_m, 0.3)
    assert np.mean(np.abs(error_m) < 2.0 * std_m + 0.02) > 0.95


def test_what_stairs_may_add_up_is_stated():
    _, once, _ = tracked(flights(1.53, 1), seed=2)
    _, thrice, _ = tracked(flights(1.53, 3), seed=2)
    assert thrice[-1] > 1.9 * once[-1]
