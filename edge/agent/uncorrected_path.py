"""Published path of the tracker, without retrospective corrections.

A tracker corrects the foot's position by later evidence about the past walk
(``correction_tracking``): by centimetres at every stance, more with the distance from the start; by
metres where a rest shows the error of the gyroscope's bias.  For the position as seen from the
start that is the best estimate.  A consumer that follows the walk step by step, as a base station
does with satellite fixes, walls and pins, would take a correction for a step.  So the published
path goes on from where it was.  Its distance from the best estimate is part of the reported
covariance.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from edge.samples import Floats
from edge.tracker.interface import TrackBatch


class UncorrectedPath:
    """Path without corrections; takes rows as they come, and is the same but for rounding
    however they are cut.
    """

    def __init__(self) -> None:
        self._last: Floats | None = None  # (1, 4) of the row before: position and correction
        self._last_m = np.zeros(2)  # end of the uncorrected path

    def take(self, track: TrackBatch) -> TrackBatch:
        """Return ``track``, whose rows are all finite, in a frame that follows no correction."""
        if not len(track):
            return track
        rotation_rad = -track.past_turn_rad
        rows = np.column_stack((track.position_n_m[:, :2], track.past_shift_n_m))
        before = rows[:1] if self._last is None else self._last
        steps = np.diff(rows, axis=0, prepend=before)
        rotations = _rotations(rotation_rad)
        path_m = self._last_m + np.cumsum(_rotated(rotations, steps[:, :2] - steps[:, 2:]), axis=0)
        if self._last is None:
            path_m += rows[0, :2]
        self._last, self._last_m = rows[-1:], path_m[-1]
        position_m, velocity_mps = track.position_n_m.copy(), track.velocity_n_mps.copy()
        correction_m = path_m - position_m[:, :2]
        position_m[:, :2] = path_m
        velocity_mps[:, :2] = _rotated(rotations, velocity_mps[:, :2])
        covariance_m2 = track.position_cov_m2.copy()
        covariance_m2[:, :2, :2] += correction_m[:, :, None] * correction_m[:, None, :]
        return replace(
            track,
            position_n_m=position_m,
            velocity_n_mps=velocity_mps,
            position_cov_m2=covariance_m2,
            magnetic_north_rad=track.magnetic_north_rad + rotation_rad,
        )


def _rotations(angles_rad: Floats) -> Floats:
    """Return rotation matrices (n, 2, 2), clockwise seen from above."""
    cosine, sine = np.cos(angles_rad), np.sin(angles_rad)
    return np.stack((np.stack((cosine, -sine), axis=1), np.stack((sine, cosine), axis=1)), axis=1)


def _rotated(rotations: Floats, vectors: Floats) -> Floats:
    """Return ``vectors`` (n, 2), each rotated by its own matrix."""
    return np.asarray((rotations @ vectors[:, :, None])[:, :, 0], dtype=np.float64)
