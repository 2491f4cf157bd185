"""Errors of a track against a simulated walk, in the frame of the walk's first heading."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from edge.samples import Floats, ImuBatch, SensorDescription
from edge.simulation.kinematics import Motion
from edge.tracker.interface import TrackBatch
from edge.tracker.registry import make_tracker
from edge.tracker.track_rows import join_rows

_EVERY_S = 1.0
_KNOWN_M = 0.02  # a height is shown to no less, whatever the tracker states


@dataclass(frozen=True, slots=True)
class WalkErrors:
    """Root mean squares over a walk, once a second; ``stated`` by their stated deviation."""

    heading_deg: float
    heading_stated: float  # 1 is honest, more is too sure
    horizontal_m: float
    height_m: float
    height_stated: float


def track(description: SensorDescription, imu: ImuBatch, tracker: str) -> TrackBatch:
    made = make_tracker(tracker, description)
    return join_rows([made.push(imu), made.finish()])


def walk_errors(rows: TrackBatch, truth: Motion) -> WalkErrors:
    """Compare ``rows`` with the truth at the same times, the first row being held."""
    step = max(1, round(_EVERY_S * 1e9 / float(np.median(np.diff(rows.t_ns)))))
    every = slice(0, None, step)
    way_m, drift_rad = true_way_m(rows.quaternion_nb[every], _at(truth, every))
    error_m = rows.position_n_m[every] - way_m
    height_std_m = np.sqrt(rows.position_cov_m2[every, 2, 2] + _KNOWN_M**2)
    late = slice(len(drift_rad) // 4, None)  # what is stated of the first steps is almost zero
    return WalkErrors(
        heading_deg=float(np.degrees(rms(drift_rad))),
        heading_stated=rms((drift_rad / np.maximum(rows.heading_std_rad[every], 1e-6))[late]),
        horizontal_m=rms(np.hypot(error_m[:, 0], error_m[:, 1])),
        height_m=rms(error_m[:, 2]),
        height_stated=rms((error_m[:, 2] / height_std_m)[late]),
    )


def true_way_m(quaternion_nb: Floats, truth: Motion) -> tuple[Floats, Floats]:
    """Return the way since the start (n, 3) in the tracker's frame, and its heading's error (n,).

    The tracker's frame has its heading right at the first row.
    """
    turn = np.einsum("nij,nkj->nik", rotations_of(quaternion_nb), truth.rotation_nb)
    yaw_rad = np.unwrap(np.arctan2(turn[:, 1, 0] - turn[:, 0, 1], turn[:, 0, 0] + turn[:, 1, 1]))
    c, s = np.cos(yaw_rad[0]), np.sin(yaw_rad[0])
    frame = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return (truth.position_n_m - truth.position_n_m[0]) @ frame.T, yaw_rad - yaw_rad[0]


def _at(truth: Motion, rows: slice) -> Motion:
    return Motion(*(getattr(truth, field.name)[rows] for field in fields(Motion)))


def rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def rotations_of(quaternion_nb: Floats) -> Floats:
    """Return the matrices (n, 3, 3) of quaternions (n, 4)."""
    w, x, y, z = quaternion_nb.T
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.moveaxis(np.array(rows), 2, 0)
