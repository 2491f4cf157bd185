"""The thesis's walks as the bench scores them."""

from __future__ import annotations

from tests.bench.tracker.simulated_walks import score_simulated, simulated_walks


def test_every_walk_is_simulated_with_every_seed():
    walks = simulated_walks("eskf")
    assert len(set(walks)) == len(walks) == 24


def test_the_square_is_scored_against_its_truth():
    score = score_simulated("square-60m?seed=1", "eskf")
    assert 55.0 < score.distance_m < 65.0
    assert score.ate_m is not None
    assert score.ate_m < 0.02 * score.distance_m
    assert score.vertical_rms_m is not None
