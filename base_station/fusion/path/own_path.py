"""How a unit's own path grows, and its errors with it: by way, turns and climbs, not by time
standing still.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from base_station.fusion import kernels
from base_station.fusion.kernels import HOW, OWN, Record, Stretch
from base_station.fusion.parameters import Parameters
from shared.messages import Position
from shared.quality import Quality


class OwnPath:
    """Gives it stretch by stretch, from the frame's origin on."""

    def __init__(self, kind: Parameters, saved: bytes = b"") -> None:
        self._how = _how(kind)
        self._own = np.frombuffer(saved, OWN).copy() if saved else np.zeros(1, OWN)
        if not saved:
            self._own["step_rad"] = self._own["moved_heading_std_rad"] = np.nan

    def save(self) -> bytes:
        return self._own.tobytes()

    def stretch(self, position: Position, duration_s: float) -> Stretch:
        """To there from where it was that long before."""
        return Stretch._make(
            kernels.stretch(
                self._own,
                self._how,
                (position.north_m, position.east_m, position.down_m),
                (position.std_north_m, position.std_east_m, position.heading_std_rad),
                duration_s,
                position.path_quality is Quality.GOOD,
            )
        )

    def jump(self, position: Position) -> None:
        """It goes on from there, and nobody knows how it got there."""
        own = self._own
        own["north_m"], own["east_m"] = position.north_m, position.east_m
        own["down_m"] = position.down_m
        own["std_m"] = max(position.std_north_m, position.std_east_m)
        own["heading_std_rad"] = position.heading_std_rad


@lru_cache
def _how(kind: Parameters) -> Record:
    return np.array([tuple(getattr(kind, name) for name in HOW.names or ())], HOW)
