"""Decimation of samples for publishing: one in each period of the sample clock."""

from __future__ import annotations

import numpy as np

from edge.samples import Nanoseconds
from shared.clock import NS_PER_S


class Decimator:
    """Decimator that picks the first sample in each period, whatever the batching.

    Periods lie on a fixed grid of time, so that nothing drifts, and no sample is lost when the
    clock jumps.
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
        """Return True if the one sample at ``t_ns`` is to be published."""
        return bool(self.picks(np.array([t_ns], dtype=np.int64)))


class OncePerPeriod:
    """Decimator of input that may have the same period, of which it then drops none.  The first
    item lies in the middle of a period, so that half a period of jitter or drift never puts two
    into one.
    """

    def __init__(self, rate_hz: float) -> None:
        self._period_ns = round(NS_PER_S / rate_hz)
        self._from_ns: int | None = None
        self._last: int | None = None

    def takes(self, t_ns: int) -> bool:
        """Return True if the one at ``t_ns`` is to be published."""
        if self._from_ns is None:
            self._from_ns = t_ns - self._period_ns // 2
        period = (t_ns - self._from_ns) // self._period_ns
        taken, self._last = period != self._last, period
        return taken
