"""Odometry increments of a unit's own path, with their noise: it grows with way, turns and climbs,
not with time at rest.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from base_station.fusion import kernels
from base_station.fusion.kernels import ODOMETRY, PARAMS, OdometryIncrement, Record
from base_station.fusion.parameters import Parameters
from shared.messages import Position
from shared.quality import GOOD


class OdometryIncrements:
    """Increments from position to position, from the frame's origin on."""

    def __init__(self, kind: Parameters, saved: bytes = b"") -> None:
        self._params_of = _params_of(kind)
        self._odometry = np.frombuffer(saved, ODOMETRY).copy() if saved else np.zeros(1, ODOMETRY)
        if not saved:
            self._odometry["step_rad"] = self._odometry["moved_heading_std_rad"] = np.nan

    def save(self) -> bytes:
        return self._odometry.tobytes()

    def increment(self, position: Position, duration_s: float) -> OdometryIncrement:
        """Increment to a position; ``duration_s``: time since the last one."""
        return OdometryIncrement(
            *kernels.integrate_increment(
                self._odometry,
                self._params_of,
                (position.north_m, position.east_m, position.down_m),
                (position.std_north_m, position.std_east_m, position.heading_std_rad),
                duration_s,
                position.path_quality is GOOD,
            )
        )

    def reset_to(self, position: Position) -> None:
        """Continue from a position without an increment to it."""
        own = self._odometry
        own["north_m"], own["east_m"] = position.north_m, position.east_m
        own["down_m"] = position.down_m
        own["std_m"] = max(position.std_north_m, position.std_east_m)
        own["heading_std_rad"] = position.heading_std_rad


@lru_cache
def _params_of(kind: Parameters) -> Record:
    return np.array([tuple(getattr(kind, name) for name in PARAMS.names or ())], PARAMS)
