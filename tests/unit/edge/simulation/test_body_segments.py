"""Foot, leg and trunk belong to one body and move as people do."""

from __future__ import annotations

import numpy as np
import pytest

from edge.samples import Floats
from edge.simulation.factory import open_simulation
from edge.simulation.kinematics import Motion
from edge.simulation.legs import Segment
from edge.simulation.lift_motion import ACCEL_MPS2, LiftMotion
from shared.messages.status import Activity
from tests.rig.inertial_walk import InertialWalk, inertial_walk, of_one_person


def worn(segment: str, scenario: str, t_s: Floats) -> Motion:
    return open_simulation(f"{scenario}?worn_on={segment}").truth(t_s)


@pytest.mark.parametrize(
    ("segment", "height_m"),
    [
        ("foot", 0.08),
        ("shank", 0.31),
        ("pocket", 0.73),
        ("hip", 0.95),
        ("waist", 1.01),
        ("chest", 1.35),
    ],
)
def test_standing_height(segment: str, height_m: float) -> None:
    motion = worn(segment, "straight", np.array([1.0]))
    assert -motion.position_n_m[0, 2] == pytest.approx(height_m, abs=0.005)


@pytest.mark.slow
@pytest.mark.parametrize("segment", ["shank", "pocket", "hip", "waist", "chest"])
def test_all_parts_go_where_the_foot_goes(segment: str) -> None:
    t_s = np.arange(0.0, 300.0, 0.5)
    foot = worn("foot", "climbs-stairs", t_s).position_n_m
    other = worn(segment, "climbs-stairs", t_s).position_n_m
    apart_m = np.linalg.norm(foot[:, :2] - other[:, :2], axis=1)
    assert apart_m.max() < 1.2
    assert np.ptp(other[:, 2]) == pytest.approx(3.2, abs=0.4)


def standing_leg_radps(walk: InertialWalk) -> Floats:
    """Return the rate at which the shank passes the vertical, once a stride."""
    side_s = walk.truth.rotation_nb[0].T @ np.array([0.0, 1.0, 0.0])  # it starts facing north
    front_s = walk.truth.rotation_nb[0].T @ np.array([1.0, 0.0, 0.0])
    down = (walk.truth.rotation_nb @ front_s)[:, 2]
    passes = np.flatnonzero((down[:-1] < 0.0) & (down[1:] >= 0.0))
    rates: Floats = -(walk.truth.rate_b_radps @ side_s)[passes]
    return rates


def test_the_standing_leg_turns_by_the_speed_of_the_body_over_its_length() -> None:
    chest, shank = of_one_person("straight", ("chest", "shank"))
    far_m = np.linalg.norm(chest.truth.position_n_m[-1, :2] - chest.truth.position_n_m[0, :2])
    rates_radps = standing_leg_radps(shank)
    assert len(rates_radps) == pytest.approx(len(shank.simulation.plan.footfall_s), abs=2)
    walked_s = len(rates_radps) * 1.06
    assert np.median(rates_radps) * shank.leg_length_m == pytest.approx(far_m / walked_s, rel=0.1)


@pytest.mark.parametrize(
    ("segment", "least_deg", "most_deg"),
    [("shank", (-70, -45), (15, 30)), ("pocket", (-25, -10), (20, 45))],
)
def test_shank_and_thigh_swing_as_legs_do(
    segment: Segment, least_deg: tuple[float, float], most_deg: tuple[float, float]
) -> None:
    walk = inertial_walk("straight", worn_on=segment)
    front_s = walk.truth.rotation_nb[0].T @ np.array([1.0, 0.0, 0.0])
    pitch_deg = -np.degrees(np.arcsin((walk.truth.rotation_nb @ front_s)[:, 2]))
    assert least_deg[0] < pitch_deg.min() < least_deg[1]
    assert most_deg[0] < pitch_deg.max() < most_deg[1]


def test_sensors_of_one_person_share_the_walk_and_nothing_else() -> None:
    first, second = of_one_person("straight", ("waist", "waist"))
    np.testing.assert_array_equal(first.truth.position_n_m, second.truth.position_n_m)
    assert not np.allclose(first.truth.rotation_nb[0], second.truth.rotation_nb[0], atol=0.01)
    standing = slice(0, 400)
    norms_mps2 = [
        np.linalg.norm(walk.imu.accel_mps2[standing].mean(axis=0)) for walk in (first, second)
    ]
    assert abs(norms_mps2[0] - norms_mps2[1]) > 1e-3, "another bias"
    assert first.imu.mag_ut is not None
    assert first.imu.pressure_pa is not None


@pytest.mark.parametrize("segment", ["hip", "waist", "chest"])
def test_the_trunk_glides_while_the_foot_stops_and_goes(segment: str) -> None:
    t_s = np.arange(15.0, 35.0, 0.01)
    speed = np.linalg.norm(worn(segment, "straight", t_s).velocity_n_mps[:, :2], axis=1)
    assert speed.mean() == pytest.approx(1.28, abs=0.1)
    assert speed.std() < 0.15
    down = worn(segment, "straight", t_s).position_n_m[:, 2]
    assert 0.02 < np.ptp(down) < 0.06, "it rises and falls by some centimetres"


def test_the_trunk_bounces_twice_a_stride() -> None:
    simulation = open_simulation("straight?worn_on=chest")
    t_s = np.arange(15.0, 35.0, 0.01)
    rate = simulation.truth(t_s).velocity_n_mps[:, 2]
    rises = int(((rate[:-1] > 0.0) & (rate[1:] <= 0.0)).sum())
    strides = sum(15.0 < footfall_s < 35.0 for footfall_s in simulation.plan.footfall_s)
    assert rises == pytest.approx(2 * strides, abs=3)


@pytest.mark.parametrize("segment", ["foot", "hip", "chest"])
def test_lying_on_the_back_points_the_front_up(segment: str) -> None:
    simulation = open_simulation(f"goes-down?worn_on={segment}")
    plan = simulation.plan
    lying_s = plan.activity_start_s[plan.activities.index(Activity.LYING)]
    # Two seconds later the smoothed trunk, too, has come to rest.
    before, after = (simulation.truth(np.array([t_s])) for t_s in (1.0, lying_s + 3.0))
    front_s = before.rotation_nb[0].T @ np.array([1.0, 0.0, 0.0])  # it starts facing north
    assert (after.rotation_nb[0] @ front_s)[2] < -0.8
    assert -after.position_n_m[0, 2] < 0.45
    assert np.abs(after.velocity_n_mps).max() == 0.0


@pytest.mark.parametrize(("by", "speed_mps"), [(-3.2, 1.6), (32.0, 3.0), (0.4, 1.0)])
def test_a_lift_glides_to_its_floor_with_comfort(by, speed_mps):
    glide = LiftMotion()
    glide.move(1.0, 2.0, 5.0)
    end_s = glide.move(40.0, by, speed_mps)
    t_s = np.arange(35.0, end_s + 2.0, 1e-3)
    jet = glide.jet(t_s)
    assert jet.value[0] == pytest.approx(2.0)
    assert jet.value[-1] == pytest.approx(2.0 + by)
    assert np.abs(jet.rate).max() <= speed_mps + 1e-9
    assert np.abs(jet.accel).max() <= ACCEL_MPS2 + 1e-9
    assert jet.rate[t_s > end_s] == pytest.approx(0.0)
    np.testing.assert_allclose(np.gradient(jet.value, t_s), jet.rate, atol=1e-5)
    np.testing.assert_allclose(np.gradient(jet.rate, t_s), jet.accel, atol=1e-5)
