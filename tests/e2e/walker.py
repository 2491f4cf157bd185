"""A unit whose wearer walks along corners."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from shared.bus_zenoh import UnitEndpoint
from shared.messages import Position
from tests.e2e.wearable import STEP_S, Wearable
from tests.rig import message_factory

Corner = tuple[float, float, float]  # north, east, down, m
SPEED_MPS = 2.5


class Walker(Wearable):
    """Stays at the last corner until there are more."""

    def __init__(self, unit_id: str, station: str | UnitEndpoint, *corners: Corner) -> None:
        super().__init__(unit_id, station)
        self._corners = list(corners)
        self._at_m = 0.0

    def walk(self, *corners: Corner) -> None:
        """Go on to these."""
        with self._lock:
            self._corners += corners

    def _position(self, _: float) -> Position:
        corners = np.array(self._corners)
        legs_m = [float(np.linalg.norm(end - begin)) for begin, end in pairwise(corners)]
        passed_m = np.concatenate([[0.0], np.cumsum(legs_m)])
        self._at_m = min(self._at_m + SPEED_MPS * STEP_S, float(passed_m[-1]))
        place = [np.interp(self._at_m, passed_m, axis) for axis in corners.T]
        north_m, east_m, down_m = (np.array(place) - corners[0]).tolist()
        return message_factory.position(
            self._header_factory.header(),
            north_m=north_m,
            east_m=east_m,
            down_m=down_m,
            distance_m=self._at_m,
        )
