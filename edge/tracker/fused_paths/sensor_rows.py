"""Rows of one sensor's tracker, until those of the other have come as far.

A sensor that is silent for longer than a foot's tracker bridges has gone.  Rows that its tracker
holds back then come when it is back; they are left out, as the fused path has gone on without
them.  Whether that is so shows in the times of the samples, not in how they come.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from edge.samples import ImuBatch
from edge.tracker.interface import TrackBatch, Tracker
from edge.tracker.track_rows import join_rows

NEVER_NS = -(2**62)  # before all times


class SensorRows:
    """Queue of the rows of one tracker; ``silence_s`` is how long no sample is none yet."""

    def __init__(self, tracker: Tracker, silence_s: float) -> None:
        self.tracker = tracker
        self.newest_ns = NEVER_NS  # of its samples
        self.known_ns = NEVER_NS  # all rows up to then are in the queue, or were
        self._silence_ns = round(silence_s * 1e9)
        self._left_out_ns = NEVER_NS
        self._queue: list[TrackBatch] = []

    def push(self, batch: ImuBatch) -> None:
        """Take samples, part by part between silences."""
        if not len(batch):
            return
        latest_ns = np.maximum.accumulate(np.maximum(batch.t_ns, self.newest_ns))
        before_ns = np.concatenate(([self.newest_ns], latest_ns[:-1]))
        after_silence = np.flatnonzero(latest_ns - before_ns > self._silence_ns)
        bounds = [0, *(int(k) for k in after_silence if k > 0), len(batch)]
        for first, stop in pairwise(bounds):
            if first in after_silence and self.newest_ns > NEVER_NS:
                self._left_out_ns = self.newest_ns
            if first in after_silence:
                self.known_ns = max(self.known_ns, int(latest_ns[first]) - 1)
            self.newest_ns = int(latest_ns[stop - 1])
            self._append(self.tracker.push(batch.part(slice(first, stop))))

    def finish(self) -> None:
        """Take the rows still held back."""
        self._append(self.tracker.finish())

    def take(self, until_ns: int) -> TrackBatch:
        """Return the rows up to a time, and keep the others."""
        rows = join_rows(self._queue)
        stop = int(np.searchsorted(rows.t_ns, until_ns, side="right"))
        order = np.arange(len(rows))
        self._queue = [rows.part(order[stop:])] if stop < len(rows) else []
        return rows.part(order[:stop])

    def _append(self, rows: TrackBatch) -> None:
        rows = rows.part(np.flatnonzero(rows.t_ns > self._left_out_ns))
        if len(rows):
            self._queue.append(rows)
            self.known_ns = max(self.known_ns, int(rows.t_ns[-1]))
