"""Feet that are raised slowly, put down with care, or dragged: found, or reported as doubtful."""

from __future__ import annotations

import pytest

from edge.simulation.hard_motions import HARD_MOTIONS
from edge.simulation.legs import RaiseFoot, Stand, Walk
from edge.simulation.scenario import Scenario
from tests.bench.tracker.hard_motions import walk_end

SEEDS = (31, 32, 33)  # none of them was looked at when the rules were chosen
MOTIONS = {motion.name: motion for motion in HARD_MOTIONS}
LOW = Scenario("raised-low", "raises the foot a little", (Stand(4.0), RaiseFoot(12, 0.2), Stand(3)))
LIMPS_AND_DRAGS = Scenario(
    "limps-and-drags",
    "limps, and drags the foot when it hurts",
    (
        Stand(4.0),
        Walk(((8.0, 0.0),), "limp"),
        Walk(((16.0, 0.0),), "drag"),
        Walk(((24.0, 0.0),), "laden"),
        Stand(3.0),
    ),
)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("motion", ["raised-feet", "careful-steps", "dragged-foot"])
def test_hard_motion_has_no_unreported_error(motion, seed):
    assert walk_end(MOTIONS[motion], seed, "eskf").score.silently_wrong == 0.0


@pytest.mark.parametrize("seed", SEEDS)
def test_slowly_raised_feet_return_to_their_floor(seed):
    end = walk_end(MOTIONS["raised-feet"], seed, "eskf")
    assert abs(end.vertical_m) < 0.3  # up to 17 where smooth motion was taken for a rest
    assert end.horizontal_m < 0.5


@pytest.mark.parametrize("seed", SEEDS)
def test_slightly_raised_feet_accumulate_no_height(seed):
    end = walk_end(LOW, seed, "eskf")
    assert abs(end.vertical_m) < 0.4
    assert end.score.silently_wrong == 0.0


@pytest.mark.parametrize("seed", SEEDS)
def test_dragged_foot_keeps_its_position(seed):
    """40 m: 8 m short where each glide that is still for an instant is a stance."""
    end = walk_end(MOTIONS["dragged-foot"], seed, "eskf")
    assert end.horizontal_m < 4.0
    assert end.horizontal_m < 2.5 * end.horizontal_stated_m


@pytest.mark.parametrize("seed", SEEDS)
def test_limp_that_becomes_a_drag_keeps_its_position(seed):
    end = walk_end(LIMPS_AND_DRAGS, seed, "eskf")
    assert end.horizontal_m < 1.5
    assert end.score.silently_wrong == 0.0
