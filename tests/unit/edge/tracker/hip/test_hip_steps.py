"""Steps of the hip's state machine, and the constraints of a building."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.hip.state import NO_MODEL, HipConfig
from edge.tracker.hip.tracker import HipTracker
from edge.tracker.track_rows import join_rows
from tests.rig.trunk_walk import DESCRIPTION, bobbing, joined

CORNERS = HipConfig(velocity_model=NO_MODEL, right_angles=True)
CORRIDORS = CORNERS._replace(straight_walks=True)


def tracked(imu, config=None):
    tracker = HipTracker(DESCRIPTION, config)
    return join_rows([tracker.push(imu), tracker.finish()])


def heading_rad(rows, from_s, to_s):
    """Heading of the path between two times."""
    t_s = rows.t_ns * 1e-9
    first, last = (rows.position_n_m[np.searchsorted(t_s, at)] for at in (from_s, to_s))
    return np.arctan2(*(last - first)[[1, 0]])


@pytest.mark.parametrize("frequency_hz", [1.4, 1.9, 2.4])
def test_every_step_is_found(frequency_hz):
    rows = tracked(bobbing(24, frequency_hz))
    assert rows.steps[-1] == 12


@pytest.mark.parametrize("amplitude_mps2", [0.3, 0.6])
def test_motion_below_any_threshold_is_no_step(amplitude_mps2):
    assert tracked(bobbing(24, 1.9, amplitude_mps2)).steps[-1] == 0


def test_half_a_step_is_none():
    """A jolt upward alone: the machine waits for the other peak, and gives up."""
    imu = bobbing(1, 1.9)
    imu.accel_mps2[226:260] = imu.accel_mps2[0]  # the second half of the wave
    assert tracked(imu).distance_m[-1] == 0.0


def drifting(turn_radps):
    """Straight on for 20 s with a gyroscope that says otherwise."""
    return bobbing(38, 1.9, turn_radps=turn_radps)


def test_constraints_are_off_unless_person_sets_them():
    assert not HipConfig().straight_walks
    assert not HipConfig().right_angles
    turned_rad = heading_rad(tracked(drifting(0.02)), 20.0, 22.0)
    assert abs(turned_rad - heading_rad(tracked(drifting(0.0)), 20.0, 22.0)) > 0.3


def test_a_straight_walk_is_kept_straight():
    kept = tracked(drifting(0.02), CORRIDORS)
    assert abs(heading_rad(kept, 20.0, 22.0) - heading_rad(kept, 6.0, 8.0)) < 0.05


def test_a_turn_becomes_a_right_angle():
    """90 degrees by a gyroscope that shows 80 of them."""
    corner = joined(
        bobbing(20, 1.9),
        bobbing(4, 1.9, turn_radps=np.radians(80.0) * 1.9 / 4.0, stands_s=0.0),
        bobbing(20, 1.9, stands_s=0.0),
    )
    end_s = corner.t_ns[-1] * 1e-9
    for config, turned_deg in ((HipConfig(velocity_model=NO_MODEL), 80.0), (CORNERS, 90.0)):
        rows = tracked(corner, config)
        turned_rad = heading_rad(rows, end_s - 4.0, end_s - 1.0) - heading_rad(rows, 4.0, 8.0)
        assert np.degrees(turned_rad) == pytest.approx(turned_deg, abs=2.0)
