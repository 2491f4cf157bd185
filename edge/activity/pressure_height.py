"""Height differences from air pressure: a check on stairs.

A barometer in a pocket or a boot is good to some decimetres over a few seconds and useless
over minutes, and a door that slams is worth metres for a moment.  So only differences over
seconds are used, of medians.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from edge.samples import ImuBatch
from shared.clock import NS_PER_S
from shared.geo import pressure_altitude_m

_CELL_NS = NS_PER_S // 4
_KEPT_NS = 30 * NS_PER_S
_MEDIAN_HALF_WINDOW_NS = 3 * NS_PER_S // 4


class PressureHeight:
    """Median-filtered pressure altitude of one unit; takes samples in order."""

    def __init__(self) -> None:
        self._cells: deque[tuple[int, float]] = deque()  # (middle, mean pressure altitude)
        self._cell: int | None = None
        self._pressures_pa: list[float] = []

    def push(self, imu: ImuBatch) -> None:
        if imu.pressure_pa is None:
            return
        known = imu.pressure_pa > 0.0  # and not NaN
        for t_ns, pressure_pa in zip(
            imu.t_ns[known].tolist(), imu.pressure_pa[known].tolist(), strict=True
        ):
            cell = t_ns // _CELL_NS
            if cell != self._cell:
                self._close()
                if self._cell is not None and cell < self._cell - 1:
                    self._cells.clear()  # a clock that went back
                self._cell = cell
            self._pressures_pa.append(pressure_pa)

    def climbed_m(self, from_ns: int, to_ns: int) -> float | None:
        """Return the height gained, up positive; None without readings around both times."""
        before_m, after_m = self._median_height_m(from_ns), self._median_height_m(to_ns)
        return None if before_m is None or after_m is None else after_m - before_m

    def _median_height_m(self, t_ns: int) -> float | None:
        near = [
            height_m
            for middle_ns, height_m in self._cells
            if abs(middle_ns - t_ns) <= _MEDIAN_HALF_WINDOW_NS
        ]
        return float(np.median(near)) if near else None

    def _close(self) -> None:
        if self._cell is None or not self._pressures_pa:
            return
        middle_ns = self._cell * _CELL_NS + _CELL_NS // 2
        self._cells.append((middle_ns, pressure_altitude_m(float(np.mean(self._pressures_pa)))))
        self._pressures_pa = []
        while self._cells[0][0] < middle_ns - _KEPT_NS:
            self._cells.popleft()
