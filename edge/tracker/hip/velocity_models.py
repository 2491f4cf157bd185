"""Velocity of the hip within a step (Hettiarachchige Don 2016, equations 3.3 to 3.5).

Each has a constant of the person, by a walk of known length; the shapes are those of the thesis.
"""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.hip.state import GAUSSIAN, SINUSOIDAL, HipConfig


@njit()
def gaussian_mps(since_s: float, period_s: float, config: HipConfig) -> float:
    """Return A + K / T exp(-(t - a T)^2 / (2 (b T)^2))."""
    off = (since_s / period_s - config.gaussian_peak) / config.gaussian_width
    bump_mps = config.gaussian_m / period_s * math.exp(-0.5 * off * off)
    return config.gaussian_shift_mps + bump_mps


@njit()
def sinusoidal_mps(since_s: float, period_s: float, config: HipConfig) -> float:
    """Return K T + a sin(2 pi t / (2 T))."""
    wave_mps = config.sinusoidal_mps * math.sin(math.pi * since_s / period_s)
    return config.sinusoidal_mps2 * period_s + wave_mps


@njit()
def sawtooth_mps(since_s: float, period_s: float, config: HipConfig) -> float:
    """Return K T + a saw(t), which rises from -1 to 1 until its peak and falls again until T."""
    share = since_s / period_s - math.floor(since_s / period_s)
    if share < config.sawtooth_peak:
        saw = 2.0 * share / config.sawtooth_peak - 1.0
    else:
        saw = 1.0 - 2.0 * (share - config.sawtooth_peak) / (1.0 - config.sawtooth_peak)
    return config.sawtooth_mps2 * period_s + config.sawtooth_mps * saw


@njit()
def model_mps(since_s: float, period_s: float, config: HipConfig) -> float:
    """Return the velocity at ``since_s`` in a step of ``period_s``, by the model that is set."""
    if config.velocity_model == GAUSSIAN:
        return gaussian_mps(since_s, period_s, config)
    if config.velocity_model == SINUSOIDAL:
        return sinusoidal_mps(since_s, period_s, config)
    return sawtooth_mps(since_s, period_s, config)
