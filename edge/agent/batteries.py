"""Batteries of a unit: of its computer and of its sensor."""

from __future__ import annotations

from edge.samples import BatterySample
from shared.clock import NS_PER_S

_CURRENT_NS = 60 * NS_PER_S  # an older reading counts only where there is no other


class Batteries:
    """Newest reading of each battery; the emptiest is that of the unit, which needs them all."""

    def __init__(self) -> None:
        self._readings: dict[str, BatterySample] = {}

    def push(self, sample: BatterySample) -> None:
        self._readings[sample.battery] = sample

    def emptiest(self, t_ns: int) -> BatterySample | None:
        readings = self._readings.values()
        current = [one for one in readings if abs(t_ns - one.t_ns) <= _CURRENT_NS]
        if current:
            return min(current, key=lambda one: one.level)
        return max(readings, key=lambda one: one.t_ns, default=None)
