"""The height of one unit: its own, a shift, and satellite heights that err slowly."""

from __future__ import annotations

import math

import msgspec
import numpy as np
from filterpy.kalman import KalmanFilter

_GATE_STD = 3.0


class SavedHeight(msgspec.Struct, frozen=True):
    x: list[float]
    covariance: list[list[float]]


class HeightFilter:
    """State: down in the incident frame, and the fixes' slow error in units of their std."""

    def __init__(self, wander_part: float) -> None:
        """``wander_part``: of a fix's variance that wanders slowly."""
        self._wander_part = wander_part
        self._filter = KalmanFilter(dim_x=2, dim_z=1)
        self._filter.x = np.zeros((2, 1))
        self._filter.P = np.diag([1.0, 1.0])

    def save(self) -> SavedHeight:
        return SavedHeight(self._filter.x.ravel().tolist(), self._filter.P.tolist())

    def load(self, saved: SavedHeight) -> None:
        self._filter.x = np.array(saved.x).reshape(2, 1)
        self._filter.P = np.array(saved.covariance)

    @property
    def down_m(self) -> float:
        return float(self._filter.x[0, 0])

    @property
    def variance_m2(self) -> float:
        return float(self._filter.P[0, 0])

    def begin(self, down_m: float, std_m: float) -> None:
        self._filter.x[0, 0] = down_m
        self._filter.P[:] = np.diag([std_m**2, 1.0])

    def climb(self, down_m: float, variance_m2: float) -> None:
        """The own height went on by this much."""
        self._filter.x[0, 0] += down_m
        self._filter.P[0, 0] += variance_m2

    def fade(self, keep: float) -> None:
        """Time went by for the fixes' slow error."""
        self._filter.x[1] *= keep
        self._filter.P[1, :] *= keep
        self._filter.P[:, 1] *= keep
        self._filter.P[1, 1] += 1.0 - keep**2

    def correct(self, down_m: float, std_m: float) -> None:
        """Take a fix's height, unless it cannot be true."""
        observe = np.array([[1.0, std_m * math.sqrt(self._wander_part)]])
        noise = np.array([[std_m**2 * (1.0 - self._wander_part)]])
        innovation_m = down_m - float((observe @ self._filter.x)[0, 0])
        spread_m2 = float((observe @ self._filter.P @ observe.T + noise)[0, 0])
        if innovation_m**2 <= _GATE_STD**2 * spread_m2:
            self._filter.update(np.array([[down_m]]), R=noise, H=observe)
