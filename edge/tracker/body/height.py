"""Height by the barometer, where there is one; without one the floor is taken for level."""

from __future__ import annotations

import math

from numba import njit

from edge.tracker.body.state import BodyState

LOW_PASS_S = 1.0
SCALE_HEIGHT_M = 8434.0  # of the standard atmosphere at 288 K


@njit()
def low_pass_pressure(state: BodyState, pressure_pa: float, dt_s: float) -> None:
    """Take the pressure of a sample, if it has one: a barometer is slower than the rest."""
    state.pressure_age_s += dt_s
    if not pressure_pa > 0.0:
        return
    if state.pressure_pa == 0.0:
        state.pressure_pa = state.first_pressure_pa = pressure_pa
    share = min(state.pressure_age_s / LOW_PASS_S, 1.0)
    state.pressure_pa += share * (pressure_pa - state.pressure_pa)
    state.pressure_age_s = 0.0


@njit()
def take_height(state: BodyState) -> None:
    if state.pressure_pa > 0.0:
        state.down_m = SCALE_HEIGHT_M * math.log(state.pressure_pa / state.first_pressure_pa)
