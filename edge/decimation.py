"""Which of many samples are published: the first in each period of the sample clock."""

from __future__ import annotations

import numpy as np

from edge.samples import Nanoseconds
from shared.clock import NS_PER_S


class Decimator:
    """Picks one sample a period, whatever the batching.

    Periods lie on a fixed grid of time, so nothing drifts, and a clock that jumps in either
    direction costs nothing.
    """

    def __init__(self, rate_hz: float) -> None:
        self._period_ns = round(NS_PER_S / rate_hz)
        self._last_t_ns: int | None = None

    def set_rate(self, rate_hz: float) -> None:
        self._period_ns = round(NS_PER_S / rate_hz)

    def picks(self, t_ns: Nanoseconds) -> list[int]:
        """Indices of the samples at ``t_ns`` (n,) to publish."""
        if not len(t_ns):
            return []
        cells = t_ns // self._period_ns
        last = self._last_t_ns
        before = cells[0] - 1 if last is None else last // self._period_ns
        self._last_t_ns = int(t_ns[-1])
        picked: list[int] = np.flatnonzero(np.diff(cells, prepend=before) != 0).tolist()
        return picked

    def takes(self, t_ns: int) -> bool:
        """Whether the one sample at ``t_ns`` is to be published."""
        return bool(self.picks(np.array([t_ns], dtype=np.int64)))
