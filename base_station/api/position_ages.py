"""Histogram of the ages of live positions as they are published to consoles."""

from __future__ import annotations

from bisect import bisect_left
from itertools import accumulate

from base_station.views.wire import Delta

BOUNDS_S = (0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0)
_MS_PER_S = 1000.0


class PositionAges:
    """Ages from the time of a position until the delta that contains it, by the station's clock.
    The engine's thread observes; any thread may read.
    """

    def __init__(self) -> None:
        self._counts = [0] * (len(BOUNDS_S) + 1)
        self._newest_ms: dict[str, int] = {}  # position of a unit that was counted last
        self.sum_s = 0.0

    def observe(self, delta: Delta) -> None:
        """Count the positions of linked units that are newer than the published ones."""
        for unit in delta.units:
            position = unit.position
            if position is None or unit.link != "live":
                continue
            if position.t_ms > self._newest_ms.get(unit.unit_id, 0):
                self._newest_ms[unit.unit_id] = position.t_ms
                age_s = max(0.0, (delta.now_ms - position.t_ms) / _MS_PER_S)
                self._counts[bisect_left(BOUNDS_S, age_s)] += 1
                self.sum_s += age_s

    def cumulative(self) -> tuple[int, ...]:
        """Number of positions with an age up to each of ``BOUNDS_S``, and of all."""
        return tuple(accumulate(self._counts))
