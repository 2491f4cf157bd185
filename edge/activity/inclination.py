"""Inclination of one body segment: the direction up in the axes of its sensor, twice a second.

The gyroscope carries the direction on and the accelerometer corrects it, the less the further
its force is from that of gravity: in motion it measures the acceleration as well.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from edge.activity.body_motion import WINDOW_NS, BodyMotion, by_window
from edge.samples import Floats, ImuBatch
from shared.clock import NS_PER_S

_TIME_CONSTANT_S = 0.5
_GRAVITY_MPS2 = 9.80665
_FORCE_STD_MPS2 = 1.5  # by which the mean force of a window may differ from gravity
_ENOUGH_SAMPLES = 5
_GAP_WINDOWS = 4  # without samples: it begins anew


@dataclass(frozen=True, slots=True, eq=False)
class InclinationWindow:
    """Half a second of one segment."""

    end_ns: int
    up_b: Floats  # (3,) unit vector away from the ground, sensor axes
    moving: bool
    samples: Floats  # (n, 7): time in s, specific force in m/s^2, angular rate in rad/s


class InclinationFilter:
    """Filter of one sensor; samples come in order, however they are batched."""

    def __init__(self) -> None:
        self._motion = BodyMotion()
        self._moving = False
        self._cell: int | None = None
        self._parts: list[Floats] = []
        self._up_b: Floats | None = None

    def push(self, imu: ImuBatch) -> list[InclinationWindow]:
        """Take samples; return the windows that they complete."""
        windows: list[InclinationWindow] = []
        for part in by_window(imu):
            for window in self._motion.push(part):
                self._moving = window.moving
            cell = int(part.t_ns[0]) // WINDOW_NS
            if cell != self._cell:
                windows += self._close_window()
                if self._cell is not None and not 0 < cell - self._cell <= _GAP_WINDOWS:
                    self._up_b = None
                self._cell = cell
            t_s = part.t_ns / NS_PER_S
            self._parts.append(np.column_stack((t_s, part.accel_mps2, part.gyro_radps)))
        return windows

    def _close_window(self) -> list[InclinationWindow]:
        if self._cell is None:
            return []
        samples = np.vstack(self._parts)
        self._parts = []
        samples = samples[np.isfinite(samples).all(axis=1)]
        if len(samples) < _ENOUGH_SAMPLES:
            return []
        force_mps2 = samples[:, 1:4].mean(axis=0)
        size_mps2 = float(np.linalg.norm(force_mps2))
        if size_mps2 <= 0.0:
            return []
        window_s = WINDOW_NS / NS_PER_S
        measured_b = force_mps2 / size_mps2
        if self._up_b is None:
            up_b = measured_b
        else:
            carried_b = rotated(self._up_b, -window_s * samples[:, 4:7].mean(axis=0))
            doubt = ((size_mps2 - _GRAVITY_MPS2) / _FORCE_STD_MPS2) ** 2
            gain = window_s / (window_s + _TIME_CONSTANT_S) / (1.0 + doubt)
            up_b = carried_b + gain * (measured_b - carried_b)
        self._up_b = up_b / np.linalg.norm(up_b)
        return [InclinationWindow((self._cell + 1) * WINDOW_NS, self._up_b, self._moving, samples)]


def rotated(vector: Floats, rotation_rad: Floats) -> Floats:
    """Return a vector (3,) turned by a rotation vector (3,) in rad, by Rodrigues' formula."""
    angle_rad = float(np.linalg.norm(rotation_rad))
    if angle_rad < 1e-9:
        return vector
    axis = rotation_rad / angle_rad
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    along = float(axis @ vector) * (1.0 - cosine)
    return np.asarray(vector * cosine + np.cross(axis, vector) * sine + axis * along)
