"""Five floors up and back, by risers of every height; winding stairs, running, two at once."""

from __future__ import annotations

import numpy as np
import pytest

from edge.simulation.legs import Spiral, StairsLeg, Stand, Turn, Walk
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import CONSUMER_SENSORS, UNCALIBRATED_SENSORS
from tests.bench.tracker.walk_errors import track
from tests.rig.inertial_walk import inertial_walk

RISERS = 9  # a flight; two flights and a landing a floor


def flights(rise_m, floors, at_once=1, pace="walk"):
    """Up the stairwell, along the top floor and back, down again."""
    far, near = (RISERS * 0.28, 0.0), (0.0, 0.0)
    up, down = (
        (
            StairsLeg(far, rise, RISERS, at_once, pace),
            Turn(180.0),
            StairsLeg(near, rise, RISERS, at_once, pace),
            Turn(0.0),
        )
        for rise in (rise_m, -rise_m)
    )
    top = (Walk(((-8.0, 0.0), (0.0, 0.0))), Turn(0.0))
    return (Stand(5.0), *floors * up, *top, *floors * down, Stand(3.0))


def winding(rise_m, floors, turns):
    """Winding stairs with so many turns a floor, up and down."""
    up = Spiral((0.0, 0.9), 360.0 * turns, rise_m, 2 * RISERS)
    down = Spiral((0.0, 0.9), -360.0 * turns, -rise_m, 2 * RISERS)
    return (Stand(5.0), *floors * (up,), Stand(2.0), *floors * (down,), Stand(3.0))


def tracked(legs, seed, sensors=CONSUMER_SENSORS):
    """Height above the start, tracked (n,), its deviation and the true one."""
    found = inertial_walk(Scenario("stairwell", "stairs", legs), seed, sensors=sensors)
    rows = track(found.description, found.sensed(), "eskf")
    true_m = found.truth.position_n_m[:, 2]
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


def test_covariance_grows_with_the_systematic_error_of_stairs():
    once_m2, twice_m2, thrice_m2 = (
        tracked(flights(1.53, count), seed=2)[1][-1] ** 2 for count in (1, 2, 3)
    )
    # By chance every floor adds the same variance; a habit of the strides adds ever more.
    assert thrice_m2 - twice_m2 > 1.4 * (twice_m2 - once_m2)


@pytest.mark.parametrize(
    "legs",
    [
        winding(3.2, 5, 1.5),
        flights(1.6, 5, at_once=2),
        flights(1.6, 5, pace="run"),
        flights(1.6, 5, at_once=2, pace="run"),
    ],
    ids=["winding", "two at once", "running", "running, two at once"],
)
def test_individual_climbing_styles_keep_their_height(legs):
    height_m, _, true_m = tracked(legs, seed=7)
    assert np.abs(height_m - true_m).max() < 0.06 * true_m.max()
    for seed in range(3):  # and by sensors of a data sheet it is said how far it may be off
        height_m, std_m, true_m = tracked(legs, seed, UNCALIBRATED_SENSORS)
        assert np.mean(np.abs(height_m - true_m) < 2.0 * std_m + 0.02) > 0.9


def test_height_of_a_gentle_ramp_is_within_its_uncertainty():
    legs = (Stand(4.0), Walk(((24.0, 0.0),), rise_m=0.48), Walk(((30.0, 0.0),)), Stand(2.0))
    height_m, std_m, true_m = tracked(legs, seed=3)
    assert abs(height_m[-1] - true_m[-1]) > 0.3  # nothing tells it from a habit of the strides
    assert abs(height_m[-1] - true_m[-1]) < 3.0 * std_m[-1]
    _, flat_m, _ = tracked((legs[0], Walk(((30.0, 0.0),)), legs[-1]), seed=3)
    assert flat_m[-1] < 0.5 * std_m[-1]


@pytest.mark.parametrize("seed", [4, 5, 6, 7])
def test_height_error_of_a_level_sprint_is_within_its_uncertainty(seed):
    """Clipped strides of three metres seem to rise by decimetres, some of them past any gate."""
    there_and_back = Walk(((80.0, 0.0), (0.0, 0.0)), pace="sprint")
    height_m, std_m, _ = tracked((Stand(4.0), there_and_back, Stand(2.0)), seed)
    assert abs(height_m[-1]) < 2.0 * std_m[-1] + 0.02
