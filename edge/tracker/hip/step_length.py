"""Step lengths by the acceleration of a step (Hettiarachchige Don 2016, equations 2.1 to 2.3)."""

from __future__ import annotations

from numba import njit

from edge.tracker.hip.state import KIM, WEINBERG, HipConfig, HipState


@njit()
def weinberg_m(highest_mps2: float, lowest_mps2: float, constant: float) -> float:
    """Return K (A_max - A_min)^(1/4)."""
    return float(constant * (highest_mps2 - lowest_mps2) ** 0.25)


@njit()
def scarlett_m(
    mean_mps2: float, highest_mps2: float, lowest_mps2: float, constant_m: float
) -> float:
    """Return K (A_avg - A_min) / (A_max - A_min)."""
    return float(constant_m * (mean_mps2 - lowest_mps2) / max(highest_mps2 - lowest_mps2, 1e-6))


@njit()
def kim_m(mean_swing_mps2: float, constant: float) -> float:
    """Return K times the cube root of the mean acceleration."""
    return float(constant * mean_swing_mps2 ** (1.0 / 3.0))


@njit()
def step_length_m(state: HipState, config: HipConfig) -> float:
    """Return the length of the step that has just ended, by the formula that is set."""
    samples = max(state.samples, 1)
    if config.step_length == WEINBERG:
        return weinberg_m(state.highest_mps2, state.lowest_mps2, config.weinberg)
    if config.step_length == KIM:
        return kim_m(state.swing_sum_mps2 / samples, config.kim)
    return scarlett_m(
        state.sum_mps2 / samples, state.highest_mps2, state.lowest_mps2, config.scarlett_m
    )
