"""Formulas of Hettiarachchige Don (2016), against values worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from edge.tracker.hip.error_state import propagate, update
from edge.tracker.hip.state import GAUSSIAN, SAWTOOTH, SINUSOIDAL, HipConfig
from edge.tracker.hip.step_length import kim_m, scarlett_m, weinberg_m
from edge.tracker.hip.velocity_models import (
    gaussian_mps,
    model_mps,
    sawtooth_mps,
    sinusoidal_mps,
)


def test_step_lengths():
    assert weinberg_m(16.0, 0.0, 0.5) == pytest.approx(1.0)  # the fourth root of 16 is 2
    assert scarlett_m(10.0, 14.0, 6.0, 1.4) == pytest.approx(0.7)
    assert kim_m(2.744, 0.5) == pytest.approx(0.7)  # 1.4 cubed is 2.744


def test_a_step_without_any_swing_has_a_length_all_the_same():
    assert scarlett_m(9.8, 9.8, 9.8, 1.4) == pytest.approx(0.0)
    assert weinberg_m(9.8, 9.8, 0.5) == 0.0


def test_gaussian_peaks_at_its_fraction_of_the_step():
    config = HipConfig(gaussian_m=0.3)
    assert gaussian_mps(0.2, 0.5, config) == pytest.approx(0.9 + 0.3 / 0.5)
    one_width_later_mps = gaussian_mps(0.2 + 0.15 * 0.5, 0.5, config)
    assert one_width_later_mps == pytest.approx(0.9 + 0.6 * math.exp(-0.5))
    assert gaussian_mps(0.5, 0.5, config) == pytest.approx(0.9, abs=1e-3)


def test_sinusoid_is_half_a_wave():
    config = HipConfig(sinusoidal_mps2=1.29)
    assert sinusoidal_mps(0.0, 0.6, config) == pytest.approx(1.29 * 0.6)
    assert sinusoidal_mps(0.3, 0.6, config) == pytest.approx(1.29 * 0.6 + 0.25)
    assert sinusoidal_mps(0.6, 0.6, config) == pytest.approx(1.29 * 0.6)


def test_sawtooth_rises_for_a_quarter_and_falls_for_the_rest():
    config = HipConfig(sawtooth_mps2=1.67)
    shift_mps = 1.67 * 0.6
    assert sawtooth_mps(0.0, 0.6, config) == pytest.approx(shift_mps - 0.2)
    assert sawtooth_mps(0.15, 0.6, config) == pytest.approx(shift_mps + 0.2)
    assert sawtooth_mps(0.375, 0.6, config) == pytest.approx(shift_mps)


@pytest.mark.parametrize(
    ("model", "of"),
    [(GAUSSIAN, gaussian_mps), (SINUSOIDAL, sinusoidal_mps), (SAWTOOTH, sawtooth_mps)],
)
def test_the_model_that_is_set_is_taken(model, of):
    config = HipConfig(velocity_model=model)
    assert model_mps(0.1, 0.5, config) == of(0.1, 0.5, config)


def test_the_filter_is_kalmans():
    """Against the equations written with matrices."""
    covariance = np.array([[0.04, 0.01], [0.01, 0.09]])
    transition, noise = np.array([[1.0, 0.1], [0.0, 1.0]]), np.diag([0.0, 0.2 * 0.1])
    predicted = transition @ covariance @ transition.T + noise
    propagate(covariance, 0.1, 0.0, 0.2)
    np.testing.assert_allclose(covariance, predicted)
    for measured in (0, 1):
        row = np.eye(2)[[measured]]
        gain = predicted @ row.T / (row @ predicted @ row.T + 0.02)
        error = np.zeros(2)
        update(covariance, measured, 0.3, 0.02, error)
        np.testing.assert_allclose(error, 0.3 * gain[:, 0])
        predicted = predicted - gain @ row @ predicted
        np.testing.assert_allclose(covariance, predicted)
