"""A brief stance that the next one contradicts is undone with all its effects."""

from __future__ import annotations

import numpy as np
import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from edge.tracker.foot.error_state import ATTITUDE, POSITION, SIZE, VELOCITY
from edge.tracker.foot.filter.error_model import transition_matrix
from edge.tracker.foot.state import new_filter_state, new_progress
from edge.tracker.foot.zupt.stance_revision import (
    note_correction,
    propagate_correction,
    weigh_stance,
)

CONFIG = config_record(EskfConfig())[0]
STD_MPS = 0.1  # of the velocity after a swing
SWING_S = 0.5
STEPS = 100


def begin(state, progress, off_mps, t_s, level_mps=1.0):
    state["stance_off_n_mps"][:] = off_mps
    state["stance_after_s"] = SWING_S
    state["swing_level_speed_mps"] = level_mps
    weigh_stance(progress, state, t_s, CONFIG)


def two_stances(first_mps, second_mps, lasts_s=0.02, level_mps=1.0):
    """Let a stance take ``first_mps`` away to the north and the next one ``second_mps``."""
    state, progress = new_filter_state()[0], new_progress()[0]
    state["faulty_stride"] = True  # the filter's own variance
    state["rotation_nb"][:] = np.eye(3)
    state["force_n_mps2"][:] = (0.0, 0.0, -9.8)
    for i in range(3):
        state["covariance"][VELOCITY + i, VELOCITY + i] = STD_MPS**2
    begin(state, progress, (first_mps, 0.0, 0.0), 10.0, level_mps)
    state["error"][VELOCITY] = first_mps
    note_correction(state, 10.0, CONFIG)
    state["velocity_n_mps"][0] = first_mps
    state["error"][:] = 0.0
    note_correction(state, 10.0 + lasts_s, CONFIG)
    for _ in range(STEPS):
        propagate_correction(state, SWING_S / STEPS)
    state["position_n_m"][0] = first_mps * SWING_S
    begin(state, progress, (second_mps, 0.0, 0.0), 10.5)
    return state, progress


def is_taken_back(state, progress):
    return bool(progress["misfit_s"] == 10.5)


@pytest.mark.parametrize(
    ("first", "second", "taken_back"),
    [
        (-0.9, 0.9, True),  # what the first has taken away is missing at the second
        (-0.3, 0.3, True),
        (0.1, -0.1, False),  # noise
        (0.9, 0.9, False),  # errors that are alike in every swing
        (0.9, 0.0, False),  # a filter that was wrong and is right now
        (0.0, 0.9, False),
        (-0.9, 0.4, False),  # neither explains it
    ],
)
def test_residual_at_the_next_stance_decides(first, second, taken_back):
    assert is_taken_back(*two_stances(first, second)) == taken_back


def test_way_and_velocity_are_given_back_and_a_share_is_doubted():
    state, _ = two_stances(-0.9, 0.9)
    assert state["velocity_n_mps"][0] == pytest.approx(0.0, abs=1e-9)
    assert state["position_n_m"][0] == pytest.approx(0.0, abs=1e-9)
    assert state["stance_off_n_mps"][0] == pytest.approx(0.0, abs=1e-9)
    assert state["misfit_n_m"][0] == pytest.approx(0.1 * 0.9 * SWING_S)
    assert state["misfit_n_m"][1] == 0.0


def test_a_stance_that_remains_is_doubted_by_its_probability():
    certain, uncertain = (two_stances(-v, v)[0]["misfit_n_m"][0] for v in (0.05, 0.215))
    assert certain < 0.2 * 0.05 * SWING_S
    assert 0.25 * 0.215 * SWING_S < uncertain < 0.5 * 0.215 * SWING_S


@pytest.mark.parametrize("kwargs", [{"lasts_s": 0.4}, {"level_mps": 3.0}])
def test_a_stance_that_lasts_or_ends_a_stride_is_no_question(kwargs):
    state, progress = two_stances(-0.9, 0.9, **kwargs)
    assert not is_taken_back(state, progress)
    assert state["misfit_n_m"][0] == 0.0


def test_repeated_correction_needs_less_evidence():
    state, progress = two_stances(-0.9, 0.9)
    for i in range(3):  # as after any other swing
        state["covariance"][VELOCITY + i, VELOCITY + i] = STD_MPS**2
    begin(state, progress, (-0.215, 0.0, 0.0), 11.0)
    assert progress["misfit_s"] == 10.5
    state["error"][VELOCITY] = -0.215
    note_correction(state, 11.0, CONFIG)
    begin(state, progress, (0.215, 0.0, 0.0), 11.5)
    assert progress["misfit_s"] == 11.5
    assert not is_taken_back(*two_stances(-0.215, 0.18))


def test_a_correction_is_carried_on_as_the_filter_carries_an_error():
    state = new_filter_state()[0]
    rng = np.random.default_rng(3)
    state["rotation_nb"][:] = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    state["force_n_mps2"][:] = rng.standard_normal(3)
    state["rival"]["alive"] = True
    state["rival"]["error"][:] = error = rng.standard_normal(SIZE)
    propagate_correction(state, 0.005)
    expected = transition_matrix(state["rotation_nb"], state["force_n_mps2"], 0.005) @ error
    carried = state["rival"]["error"]
    assert carried[VELOCITY:] == pytest.approx(expected[VELOCITY:], abs=1e-12)
    assert carried[POSITION:VELOCITY] == pytest.approx(expected[POSITION:VELOCITY], abs=1e-12)
    assert np.abs(carried[ATTITUDE:] - error[ATTITUDE:]).max() > 1e-4
