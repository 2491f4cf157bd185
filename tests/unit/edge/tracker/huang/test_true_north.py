"""The thesis's tracker has true north where it knows the place, and magnetic north elsewhere."""

from __future__ import annotations

from math import degrees, radians

import numpy as np
import pytest

from edge.simulation.factory import open_simulation
from edge.simulation.simulation import IDEAL_SENSORS, Simulation
from edge.tracker.huang.tracker import HuangTracker
from edge.tracker.mechanization.strapdown import rotation_matrix
from edge.tracker.track_rows import join_rows
from shared.earth_field import EarthField

SIMULATED_RAD = np.arctan2(1.48, 16.07)  # declination of the simulated field


def field(declination_rad: float) -> EarthField:
    return EarthField(declination_rad, 0.007, 16.1, 48.6, 0.133, 0.141)


@pytest.fixture(scope="module")
def walk():
    scenario = open_simulation("square-60m").scenario
    simulation = Simulation(scenario, 0, IDEAL_SENSORS)
    imus = [batch.imu for batch in simulation.batches(1.0)][:25]
    t_s = np.concatenate([imu.t_ns for imu in imus]) * 1e-9
    return simulation.description, imus, simulation.truth(t_s)


def tracked(walk, learned_at=None, declination_rad=SIMULATED_RAD):
    """Rows, the field being learned before that batch."""
    description, imus, _ = walk
    tracker, parts = HuangTracker(description), []
    for k, imu in enumerate(imus):
        if k == learned_at:
            tracker.set_earth_field(field(declination_rad), int(imu.t_ns[0]))
        parts.append(tracker.push(imu))
    return join_rows([*parts, tracker.finish()])


def heading_errors_deg(rows, walk):
    rotation, errors = np.zeros((3, 3)), []
    for k in np.flatnonzero(rows.stationary)[::20]:
        rotation_matrix(rows.quaternion_nb[k], rotation)
        turn = rotation @ walk[2].rotation_nb[k].T
        errors.append(np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1]))
    return np.degrees(errors)


def test_at_a_known_place_headings_are_true(walk):
    errors_deg = heading_errors_deg(tracked(walk, learned_at=0), walk)
    assert abs(np.median(errors_deg)) < 1.0


def test_elsewhere_they_are_magnetic(walk):
    errors_deg = heading_errors_deg(tracked(walk), walk)
    assert np.median(errors_deg) == pytest.approx(-degrees(SIMULATED_RAD), abs=1.0)


def test_a_place_learned_on_the_way_turns_what_follows_and_nothing_before(walk):
    before, after = tracked(walk), tracked(walk, learned_at=12)
    changed = np.flatnonzero(np.any(before.position_n_m != after.position_n_m, axis=1))[0]
    assert 11.0 < after.t_ns[changed] * 1e-9 < 12.1
    turned_deg = heading_errors_deg(after, walk)[-10:] - heading_errors_deg(before, walk)[-10:]
    assert np.median(turned_deg) == pytest.approx(degrees(SIMULATED_RAD), abs=0.5)
    steps_m = np.linalg.norm(np.diff(after.position_n_m, axis=0), axis=1)
    assert steps_m.max() < 1.1 * np.linalg.norm(np.diff(before.position_n_m, axis=0), axis=1).max()


def test_the_path_is_turned_by_the_declination(walk):
    true = tracked(walk, learned_at=0, declination_rad=radians(90.0)).position_n_m[-1]
    magnetic = tracked(walk).position_n_m[-1]
    assert true[0] == pytest.approx(-magnetic[1], abs=0.05)
    assert true[1] == pytest.approx(magnetic[0], abs=0.05)
