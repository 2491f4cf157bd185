"""Walking velocity update on the routes of Chiu (2011): sides, headings and the end of a circle."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.interface import BodyDimensions
from edge.tracker.torso_shank.tracker import TorsoShankTracker
from tests.bench.tracker.documented_routes import ROUTES
from tests.bench.tracker.scoring import CHI2_95_2DOF, horizontal_nees
from tests.rig.sensors_of_person import track_person, walk_with_sensors, worn

SEEDS = range(3)
CORNERS_M = ((15.0, 0.0), (15.0, 28.0), (0.0, 28.0), (0.0, 0.0))
LEG = BodyDimensions(leg_length_m=0.87)  # of the simulated person

pytestmark = pytest.mark.slow


def walked(route, place, seed):
    walks = walk_with_sensors(ROUTES[route], (place, "shank"), seed)
    samples = {name: walk.sensed() for name, walk in walks.items()}
    return track_person(TorsoShankTracker(worn(walks), LEG), samples), walks[place].truth


def sides(rows, truth):
    """Length errors as shares, and headings against the first side's, of the four sides."""
    true_m, tracked_m = truth.position_n_m[:, :2], rows.position_n_m[:, :2]
    corners = [0]
    for corner in CORNERS_M:
        away_m = np.hypot(*(true_m[corners[-1] :] - corner).T)
        corners.append(corners[-1] + int(np.argmin(away_m)))
    true_m, tracked_m = np.diff(true_m[corners], axis=0), np.diff(tracked_m[corners], axis=0)
    turned_rad = np.arctan2(*tracked_m.T[::-1]) - np.arctan2(*true_m.T[::-1])
    lengths = np.hypot(*tracked_m.T) / np.hypot(*true_m.T) - 1.0
    return np.abs(lengths), np.abs(np.degrees(np.unwrap(turned_rad - turned_rad[0])[1:]))


@pytest.mark.parametrize("place", ["waist", "chest"])
def test_sides_and_headings_of_the_court_are_as_good_as_documented(place):
    measured = [sides(*walked("court-86m", place, seed)) for seed in SEEDS]
    assert np.mean([lengths for lengths, _ in measured]) < 0.034
    assert np.mean([headings_deg for _, headings_deg in measured]) < 3.9


def test_closure_of_the_roundabout_is_within_the_stated_uncertainty():
    off_m = []
    for seed in SEEDS:
        rows, _ = walked("roundabout-50m", "waist", seed)
        first_m, last_m = rows.position_n_m[:1], rows.position_n_m[-1:]
        off_m.append(np.hypot(*(last_m - first_m)[0, :2]))
        assert horizontal_nees(last_m, first_m, rows.position_cov_m2[-1:])[0] < CHI2_95_2DOF
    assert np.mean(off_m) < 1.03  # the thesis's three walks: 1.2, 0.9 and 1.0 m
