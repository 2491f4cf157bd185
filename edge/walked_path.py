"""The tracker's path as it was walked, step by step.

A tracker puts right where the foot is by what it learns of the walk behind (``edge.tracker.past``):
centimetres at every stance, the more the farther the start is; metres, while the foot stands, where
a rest shows at last what the gyroscope's bias did.  For the place as seen from the start that is
the best there is.  Whoever follows the walk step by step, as a base station does with satellite
fixes, walls and pins, would take it for steps.  So the path that is published goes on from where it
was.  How far that is from the best by now is part of what is stated.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from edge.samples import Floats
from edge.tracker.port import TrackBatch


class WalkedPath:
    """Takes rows as they come; however they are cut, the path is the same but for rounding."""

    def __init__(self) -> None:
        self._last: Floats | None = None  # (1, 4) of the row before: place, and what was put right
        self._last_m = np.zeros(2)  # where the path walked has come to

    def take(self, track: TrackBatch) -> TrackBatch:
        """``track``, whose rows are all numbers, in a frame that follows no correction."""
        if not len(track):
            return track
        turned_rad = -track.past_turn_rad
        rows = np.column_stack((track.position_n_m[:, :2], track.past_shift_n_m))
        before = rows[:1] if self._last is None else self._last
        steps = np.diff(rows, axis=0, prepend=before)
        turns = _turns(turned_rad)
        walked_m = self._last_m + np.cumsum(_turned(turns, steps[:, :2] - steps[:, 2:]), axis=0)
        if self._last is None:
            walked_m += rows[0, :2]
        self._last, self._last_m = rows[-1:], walked_m[-1]
        place_m, velocity_mps = track.position_n_m.copy(), track.velocity_n_mps.copy()
        off_m = walked_m - place_m[:, :2]
        place_m[:, :2] = walked_m
        velocity_mps[:, :2] = _turned(turns, velocity_mps[:, :2])
        covariance_m2 = track.position_cov_m2.copy()
        covariance_m2[:, :2, :2] += off_m[:, :, None] * off_m[:, None, :]
        return replace(
            track,
            position_n_m=place_m,
            velocity_n_mps=velocity_mps,
            position_cov_m2=covariance_m2,
            magnetic_north_rad=track.magnetic_north_rad + turned_rad,
        )


def _turns(angles_rad: Floats) -> Floats:
    """(n, 2, 2), clockwise seen from above."""
    cosine, sine = np.cos(angles_rad), np.sin(angles_rad)
    return np.stack((np.stack((cosine, -sine), axis=1), np.stack((sine, cosine), axis=1)), axis=1)


def _turned(turns: Floats, vectors: Floats) -> Floats:
    """Each of ``vectors`` (n, 2) by its own turn."""
    return np.asarray((turns @ vectors[:, :, None])[:, :, 0], dtype=np.float64)
