"""Magnetometer in the frames of an inertial sensor, as of an MPU-9250 or a BNO055.

It measures more rarely than the gyroscope beside it, and its value stands in each frame until the
next: one that has not changed is no new measurement.
"""

from __future__ import annotations

import numpy as np

from edge.sources.iio.block import Block
from edge.sources.iio.conversion import MAG
from edge.sources.iio.slow_sensors import MAG_PERIOD_S, STUCK_NS, Reading
from shared.clock import NS_PER_S
from shared.coded_text import coded

_PERIOD_NS = round(0.9 * MAG_PERIOD_S * NS_PER_S)  # as of one that is read apart


class CapturedMagnetometer:
    """``take`` its new measurements out of each block."""

    def __init__(self) -> None:
        self._last: Reading | None = None  # the first one with the values that it shows now
        self._given_ns = 0
        self._is_stuck = False
        self._events: list[str] = []

    def take(self, block: Block) -> list[Reading]:
        """Return new measurements in uT, as many a second as are of use."""
        taken: list[Reading] = []
        for place in self._changes(block):
            reading = Reading(int(block.t_ns[place]), tuple(block.values[MAG][place].tolist()))
            self._last, self._is_stuck = reading, False
            if reading.t_ns - self._given_ns >= _PERIOD_NS:
                self._given_ns = reading.t_ns
                taken.append(reading)
        self._note_stuck(block)
        return taken

    def take_events(self) -> list[str]:
        """Return what is wrong with it since the last call, for a person."""
        events, self._events = self._events, []
        return events

    def _changes(self, block: Block) -> list[int]:
        """Return the rows whose values are others than those before them."""
        if not len(block):
            return []
        values = block.values[MAG]
        before = values[:1] + np.nan if self._last is None else np.array([self._last.values])
        is_new = (np.diff(values, axis=0, prepend=before) != 0.0).any(axis=1)
        changed: list[int] = np.flatnonzero(is_new).tolist()
        return changed

    def _note_stuck(self, block: Block) -> None:
        if self._last is None or not len(block) or self._is_stuck:
            return
        if int(block.t_ns[-1]) - self._last.t_ns > STUCK_NS:
            self._is_stuck = True
            self._events.append(
                coded(
                    "iio-mag-stuck",
                    "its magnetometer has repeated one value for {stuck_s:.0f} s: it hangs",
                    stuck_s=STUCK_NS / NS_PER_S,
                )
            )
