"""Turns that clipping hides alike in every swing add up one to one."""

from __future__ import annotations

import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.output.hidden_turn import add_hidden_turn, propagate_hidden_turn
from edge.tracker.foot.state import new_filter_state

CONFIG = EskfConfig()
SWING_RAD2 = 0.01  # variance of the heading by one swing


def walked(swings, duration_s=1.0):
    """North at 1 m/s for ``duration_s`` a stride; the rate clips in the first ``swings`` of ten."""
    state = new_filter_state()[0]
    state["velocity_n_mps"] = [1.0, 0.0, 0.0]
    for stride in range(10):
        state["swing_hidden_rad2"] = SWING_RAD2 if stride < swings else 0.0
        add_hidden_turn(state, config_record(CONFIG)[0])
        propagate_hidden_turn(state, duration_s)
    return state


@pytest.mark.slow
@pytest.mark.parametrize("swings", [1, 4, 10])
def test_turns_of_swings_add_up(swings):
    each_rad = CONFIG.clipping.hidden_turn_share * SWING_RAD2**0.5
    assert walked(swings)["hidden_turn_rad"] == pytest.approx(swings * each_rad)


@pytest.mark.slow
def test_a_turn_moves_what_is_walked_after_it_to_the_side():
    state = walked(1)
    each_rad = CONFIG.clipping.hidden_turn_share * SWING_RAD2**0.5
    assert state["hidden_way_n_m"] == pytest.approx([0.0, 10.0 * each_rad])


@pytest.mark.slow
def test_nothing_is_hidden_where_nothing_clips():
    state = walked(0)
    assert state["hidden_turn_rad"] == 0.0
    assert state["hidden_way_n_m"] == pytest.approx([0.0, 0.0])
