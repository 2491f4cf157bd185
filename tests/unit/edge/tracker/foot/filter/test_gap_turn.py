"""The doubt of a turn that a gap has hidden stays, though the filter forgets it."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.filter.gap_turn import (
    YAW,
    add_gap_turn,
    forgotten_turn_variance,
    learn_gap_turn,
    propagate_gap_turn,
)
from edge.tracker.foot.state import new_filter_state

GAP_RAD2 = 0.04


def walked(known_rad2):
    """North at 1 m/s for ten seconds after a gap; the filter states ``known_rad2`` meanwhile."""
    state = new_filter_state()[0]
    state["velocity_n_mps"] = [1.0, 0.0, 0.0]
    add_gap_turn(state, GAP_RAD2)
    state["covariance"][YAW, YAW] = known_rad2
    for _ in range(10):
        propagate_gap_turn(state, 1.0)
    return state


@pytest.mark.slow
def test_what_the_filter_forgets_moves_what_is_walked_after_it_to_the_side():
    state = walked(known_rad2=0.01)
    assert forgotten_turn_variance(state) == pytest.approx(0.03)
    assert state["gap_way_n_m"] == pytest.approx([0.0, 10.0 * np.sqrt(0.03)])


@pytest.mark.slow
def test_nothing_is_added_to_what_the_filter_still_knows():
    state = walked(known_rad2=0.05)
    assert forgotten_turn_variance(state) == 0.0
    assert state["gap_way_n_m"] == pytest.approx([0.0, 0.0])


@pytest.mark.slow
def test_a_turn_that_was_seen_is_not_doubted_any_more():
    state = walked(known_rad2=0.05)
    state["covariance"][YAW, YAW] = 0.01
    learn_gap_turn(state)
    assert forgotten_turn_variance(state) == 0.0
    state["covariance"][YAW, YAW] = 0.004
    assert forgotten_turn_variance(state) == pytest.approx(0.006)


@pytest.mark.slow
def test_gaps_add_up():
    state = walked(known_rad2=0.0)
    add_gap_turn(state, GAP_RAD2)
    assert forgotten_turn_variance(state) == pytest.approx(2.0 * GAP_RAD2)
