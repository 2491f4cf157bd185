"""Monitor of the samples of a device: faults of its rate and of its times, for a person."""

from __future__ import annotations

import numpy as np

from edge.samples import Nanoseconds
from shared.clock import NS_PER_S
from shared.coded_text import CodedText, coded

_CHECK_NS = 10 * NS_PER_S
_MANY = 0.01  # of the samples: a device that loses more is worth a look
_RATE_OFF = 0.15
_HOLE = 1.5  # of a period: a sample is missing


class StreamMonitor:
    """Monitor; ``rate_hz``: as it was set."""

    def __init__(self, rate_hz: float) -> None:
        self._rate_hz = rate_hz
        self._last_ns: int | None = None
        self._since_ns: int | None = None
        self._reported: set[str] = set()  # codes of faults that last
        self._reset()

    def _reset(self) -> None:
        self._count = self._lost = self._unplaced = 0

    def count(self, times_ns: Nanoseconds, unplaced: int) -> None:
        """``unplaced``: samples whose time repeated another one's, or cannot be."""
        self._unplaced += unplaced
        if not len(times_ns):
            return
        last_ns = int(times_ns[0]) if self._last_ns is None else self._last_ns
        periods = np.diff(times_ns, prepend=last_ns) * (self._rate_hz / NS_PER_S)
        self._lost += int((np.rint(periods[periods > _HOLE]) - 1).sum())
        self._count += len(times_ns)
        self._last_ns = int(times_ns[-1])
        self._since_ns = last_ns if self._since_ns is None else self._since_ns

    def take_events(self) -> list[str]:
        """Return faults of the last ten seconds, each once while it lasts; mostly none."""
        if self._since_ns is None or self._last_ns is None:
            return []
        elapsed_ns = self._last_ns - self._since_ns
        if elapsed_ns < _CHECK_NS:
            return []
        rate_hz = self._count * NS_PER_S / elapsed_ns
        known = self._count + self._lost
        is_slow = abs(rate_hz / self._rate_hz - 1.0) > _RATE_OFF
        faults = [
            *self._report(
                is_slow,
                coded(
                    "iio-rate",
                    "it gives {rate_hz:.0f} samples a second and is set to {set_hz:g}: its bus or "
                    "this machine is too slow, or ?rate= is not what it can do",
                    rate_hz=round(rate_hz),
                    set_hz=self._rate_hz,
                ),
            ),
            *self._report(
                not is_slow and self._lost > _MANY * known,
                coded(
                    "iio-lost",
                    "{lost} of {known} samples in 10 s were lost: this machine is too busy, or the "
                    "bus too slow",
                    lost=self._lost,
                    known=known,
                ),
            ),
            *self._report(
                self._unplaced > _MANY * known,
                coded(
                    "iio-times",
                    "{unplaced} of {known} samples in 10 s came with a time that had been or "
                    "cannot be, and were left out",
                    unplaced=self._unplaced,
                    known=known,
                ),
            ),
        ]
        self._reset()
        self._since_ns = self._last_ns
        return faults

    def _report(self, holds: bool, text: CodedText) -> list[str]:  # a condition
        kind = text.code.code
        if not holds:
            self._reported.discard(kind)
            return []
        is_new = kind not in self._reported
        self._reported.add(kind)
        return [text] if is_new else []
