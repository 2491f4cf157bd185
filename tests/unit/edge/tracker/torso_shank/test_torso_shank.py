"""Walking velocity update: speed at the instants, leg lengths, and a failed shank sensor."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from edge.samples import ImuBatch
from edge.simulation.legs import Stand, Wait, Walk
from edge.simulation.scenario import Scenario
from edge.tracker.interface import BodyDimensions, Quality, Reason
from edge.tracker.torso_shank.state import TorsoShankConfig, leg_length_m
from edge.tracker.torso_shank.tracker import TorsoShankTracker
from tests.rig.sensors_of_person import track_person, walk_with_sensors, worn

LEG = BodyDimensions(leg_length_m=0.87)  # of the simulated person
CORNER = Scenario(
    "corner", "two sides", (Stand(4.0), Walk(((14.0, 0.0), (14.0, 12.0))), Stand(3.0))
)


@cache
def corner():
    return walk_with_sensors(CORNER, ("chest", "shank"))


def tracked(walks, dimensions=LEG, **samples):
    sensed = {place: walk.sensed() for place, walk in walks.items()} | samples
    return track_person(TorsoShankTracker(worn(walks), dimensions), sensed)


def test_two_sides_and_the_corner_between_them_come_out():
    rows = tracked(corner())
    assert rows.distance_m[-1] == pytest.approx(26.0, rel=0.07)  # starts and stops lose some
    place_m = rows.position_n_m[-1, :2] - rows.position_n_m[0, :2]
    assert np.hypot(*place_m) == pytest.approx(np.hypot(14.0, 12.0), rel=0.07)


def test_speed_is_that_of_the_torso():
    rows, truth = tracked(corner()), corner()["chest"].truth
    walking = (rows.t_ns > 8e9) & (rows.t_ns < 22e9)
    speed_mps = np.hypot(*rows.velocity_n_mps[walking, :2].T)
    true_mps = np.hypot(*truth.velocity_n_mps[walking, :2].T)
    assert np.mean(np.abs(speed_mps - true_mps)) < 0.12


def test_a_path_does_not_jump():
    rows = tracked(corner())
    steps_m = np.hypot(*np.diff(rows.position_n_m[:, :2], axis=0).T)
    assert steps_m.max() < 4.0 / 200.0


def test_way_is_as_long_as_the_leg():
    longer = tracked(corner(), BodyDimensions(leg_length_m=1.1 * 0.87))
    ratio = longer.distance_m[-1] / tracked(corner()).distance_m[-1]
    assert ratio == pytest.approx(1.1, abs=0.02)


def test_leg_length_is_estimated_from_the_height_with_more_uncertainty():
    config = TorsoShankConfig()
    measured_m, measured_std = leg_length_m(BodyDimensions(1.8, 0.9), config)
    of_height_m, of_height_std = leg_length_m(BodyDimensions(height_m=1.8), config)
    usual_m, usual_std = leg_length_m(BodyDimensions(), config)
    assert measured_m == 0.9
    assert of_height_m == pytest.approx(0.954)
    assert usual_m < of_height_m
    assert measured_std < of_height_std < usual_std


def test_leg_length_that_no_person_has_is_not_used():
    config = TorsoShankConfig()
    usual = leg_length_m(BodyDimensions(), config)
    assert leg_length_m(BodyDimensions(leg_length_m=95.0), config) == usual
    of_height = leg_length_m(BodyDimensions(height_m=1.8), config)
    assert leg_length_m(BodyDimensions(height_m=1.8, leg_length_m=0.65), config) == of_height


def test_a_stated_region_is_wider_without_a_leg_length():
    known, unknown = tracked(corner()), tracked(corner(), BodyDimensions())
    assert np.trace(unknown.position_cov_m2[-1, :2, :2]) > 2.0 * np.trace(
        known.position_cov_m2[-1, :2, :2]
    )


def test_a_shank_that_is_lost_leaves_the_steps_of_the_torso():
    walks = corner()
    imu = walks["shank"].sensed()
    standing = np.arange(len(imu)) % 400  # its first two seconds, over and over
    lost = ImuBatch(imu.t_ns, imu.accel_mps2[standing], imu.gyro_radps[standing])
    moved = tracked(walks, shank=lost)
    assert moved.distance_m[-1] == pytest.approx(26.0, rel=0.25)
    walking = (moved.t_ns > 12e9) & (moved.t_ns < 22e9)
    assert np.all(moved.quality[walking] != Quality.GOOD)
    assert np.all(moved.reasons[walking] & Reason.NO_STANCE)


def test_standing_about_is_no_way():
    scenario = Scenario("waits", "stands about", (Stand(3.0), Wait(25.0), Stand(2.0)))
    rows = tracked(walk_with_sensors(scenario, ("chest", "shank")))
    assert rows.distance_m[-1] < 2.0
