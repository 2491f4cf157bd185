"""A satellite receiver: good outside, misled beside walls, silent inside."""

from __future__ import annotations

from math import atan2, exp, hypot, nan, pi

import numpy as np

from edge.samples import GpsSample
from edge.simulation.building import Building
from shared.geo import Anchor

_CORRELATION_S = 40.0  # of the slowly wandering part of the error
_WANDER_STD_M = 1.2
_NOISE_STD_M = 0.4
_REFLECTED_STD_M = 3.5  # of the wandering part when walls are near
_NEAR_WALL_M = 6.0
_LOST_INSIDE_M = 1.5  # through a doorway a fix survives this far
_REACQUIRE_S = 4.0


class Gps:
    """Receiver: one fix a call; keeps its slowly wandering error and when it last saw the sky."""

    def __init__(self, anchor: Anchor, building: Building | None, rng: np.random.Generator) -> None:
        self._anchor = anchor
        self._building = building
        self._rng = rng
        self._wander = rng.normal(0.0, 1.0, 3)  # in standard deviations
        self._last_s = -1.0
        self._blind_s = -_REACQUIRE_S  # when the sky was last hidden

    def fix(
        self,
        t_s: float,
        position_n_m: tuple[float, float, float],
        velocity_n_mps: tuple[float, float],
    ) -> GpsSample:
        """``velocity_n_mps`` is the wearer's, not the swinging foot's."""
        keep = exp(-(t_s - self._last_s) / _CORRELATION_S)
        self._last_s = t_s
        fresh = self._rng.normal(0.0, 1.0, 8)
        self._wander = keep * self._wander + (1.0 - keep**2) ** 0.5 * fresh[:3]
        depth_m = self._depth_inside_m(position_n_m)
        if depth_m > _LOST_INSIDE_M:
            self._blind_s = t_s
        if t_s - self._blind_s < _REACQUIRE_S:
            return GpsSample(round(t_s * 1e9), nan, nan, nan, nan, nan, 0, 0, nan, nan)
        wander_std_m = _WANDER_STD_M
        if depth_m > -_NEAR_WALL_M:
            wander_std_m = _REFLECTED_STD_M
        error_m = self._wander * wander_std_m + fresh[3:6] * _NOISE_STD_M
        lat_deg, lon_deg, height_m = self._anchor.to_geodetic(
            position_n_m[0] + float(error_m[0]),
            position_n_m[1] + float(error_m[1]),
            position_n_m[2] + 2.0 * float(error_m[2]),
        )
        north_mps = velocity_n_mps[0] + 0.1 * float(fresh[6])
        east_mps = velocity_n_mps[1] + 0.1 * float(fresh[7])
        std_m = hypot(wander_std_m, _NOISE_STD_M)
        return GpsSample(
            t_ns=round(t_s * 1e9),
            lat_deg=lat_deg,
            lon_deg=lon_deg,
            height_m=height_m,
            horizontal_std_m=std_m,
            vertical_std_m=2.0 * std_m,
            fix_type=3,
            satellites=9 if wander_std_m > _WANDER_STD_M else 15,
            speed_mps=hypot(north_mps, east_mps),
            course_rad=atan2(east_mps, north_mps) % (2.0 * pi),
        )

    def _depth_inside_m(self, position_n_m: tuple[float, float, float]) -> float:
        if self._building is None:
            return -1e3
        north_m, east_m = np.array([position_n_m[0]]), np.array([position_n_m[1]])
        return float(self._building.depth_inside_m(north_m, east_m)[0])
