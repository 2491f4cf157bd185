"""Rigid bodies in motion, with every derivative exact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from edge.samples import Floats
from edge.simulation.jet import Jet, sine_and_cosine


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """A rigid body at ``n`` instants; navigation axes NED, body axes its own."""

    t_s: Floats  # (n,)
    position_n_m: Floats  # (n, 3)
    velocity_n_mps: Floats  # (n, 3)
    accel_n_mps2: Floats  # (n, 3)
    rotation_nb: Floats  # (n, 3, 3)
    rate_b_radps: Floats  # (n, 3)


@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """A moving point: north, east, down."""

    north: Jet
    east: Jet
    down: Jet

    def __add__(self, other: Place) -> Place:
        return Place(self.north + other.north, self.east + other.east, self.down + other.down)

    def __sub__(self, other: Place) -> Place:
        return Place(self.north - other.north, self.east - other.east, self.down - other.down)


class Attitude:
    """Rz(yaw) Ry(pitch) Rx(roll), which takes body axes to navigation axes."""

    def __init__(self, roll: Jet, pitch: Jet, yaw: Jet) -> None:
        self._angles = roll, pitch, yaw
        self._sin_roll, self._cos_roll = sine_and_cosine(roll)
        self._sin_pitch, self._cos_pitch = sine_and_cosine(pitch)
        self._sin_yaw, self._cos_yaw = sine_and_cosine(yaw)

    def yawed(self, x: Jet, y: Jet, z: Jet) -> Place:
        """Turn a vector by the yaw alone."""
        return Place(
            self._cos_yaw * x - self._sin_yaw * y, self._sin_yaw * x + self._cos_yaw * y, z
        )

    def turned(self, x: Jet, y: Jet, z: Jet) -> Place:
        """Turn a vector from body axes to navigation axes."""
        right = self._cos_roll * y - self._sin_roll * z
        down = self._sin_roll * y + self._cos_roll * z
        forward = self._cos_pitch * x + self._sin_pitch * down
        return self.yawed(forward, right, self._cos_pitch * down - self._sin_pitch * x)

    def rotation(self) -> Floats:
        """The matrices (n, 3, 3)."""
        sr, cr = self._sin_roll.value, self._cos_roll.value
        sp, cp = self._sin_pitch.value, self._cos_pitch.value
        sy, cy = self._sin_yaw.value, self._cos_yaw.value
        rotation = np.empty((len(sr), 3, 3))
        rotation[:, 0, 0] = cy * cp
        rotation[:, 0, 1] = cy * sp * sr - sy * cr
        rotation[:, 0, 2] = cy * sp * cr + sy * sr
        rotation[:, 1, 0] = sy * cp
        rotation[:, 1, 1] = sy * sp * sr + cy * cr
        rotation[:, 1, 2] = sy * sp * cr - cy * sr
        rotation[:, 2, 0] = -sp
        rotation[:, 2, 1] = cp * sr
        rotation[:, 2, 2] = cp * cr
        return rotation

    def body_rate(self) -> Floats:
        """Angular rate (n, 3) in body axes (Titterton and Weston 2004, 3.6)."""
        roll, pitch, yaw = self._angles
        sr, cr = self._sin_roll.value, self._cos_roll.value
        sp, cp = self._sin_pitch.value, self._cos_pitch.value
        return np.column_stack(
            (
                roll.rate - yaw.rate * sp,
                pitch.rate * cr + yaw.rate * sr * cp,
                -pitch.rate * sr + yaw.rate * cr * cp,
            )
        )


def motion(t_s: Floats, place: Place, attitude: Attitude) -> Motion:
    axes = (place.north, place.east, place.down)
    return Motion(
        t_s=t_s,
        position_n_m=np.column_stack([axis.value for axis in axes]),
        velocity_n_mps=np.column_stack([axis.rate for axis in axes]),
        accel_n_mps2=np.column_stack([axis.accel for axis in axes]),
        rotation_nb=attitude.rotation(),
        rate_b_radps=attitude.body_rate(),
    )
