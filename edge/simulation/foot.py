"""The moving foot: position, velocity, acceleration, attitude and angular rate, all exact.

Foot axes are forward, right, down (FRD).  The foot is rigid and rolls about its
ball when the heel rises and about its heel when it lands.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from edge.samples import Floats
from edge.simulation.jet import Jet, cosine, oscillation, sine
from edge.simulation.planner import FootPlan

# From the ball and from the heel to the sensor on the instep, foot axes.
_FROM_BALL_M = (-0.10, 0.0, -0.08)
_FROM_HEEL_M = (0.13, 0.0, -0.08)


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """A rigid body at ``n`` instants; navigation axes NED, body axes its own."""

    t_s: Floats  # (n,)
    position_n_m: Floats  # (n, 3)
    velocity_n_mps: Floats  # (n, 3)
    accel_n_mps2: Floats  # (n, 3)
    rotation_nb: Floats  # (n, 3, 3)
    rate_b_radps: Floats  # (n, 3)


class Tremor:
    """The small motion of a standing foot: tenths of a millimetre, hundredths of a degree."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._harmonics = [
            (
                float(rng.normal(0.0, 1e-4 if axis < 3 else 3e-4)),
                float(rng.uniform(0.7, 3.5)),
                float(rng.uniform(0.0, 2.0 * np.pi)),
                axis,
            )
            for axis in range(6)
            for _ in range(2)
        ]

    def jets(self, t_s: Floats, scale: Jet) -> list[Jet]:
        """North, east, down in metres and roll, pitch, yaw in radians."""
        zero = np.zeros_like(t_s)
        sums = [Jet(zero, zero, zero)] * 6
        for amplitude, frequency_hz, phase_rad, axis in self._harmonics:
            sums[axis] = sums[axis] + oscillation(t_s, amplitude, frequency_hz, phase_rad)
        return [total * scale for total in sums]


def foot_motion(plan: FootPlan, tremor: Tremor, t_s: Floats) -> Motion:
    """Evaluate the sensor's place on the foot at times ``t_s`` (n,)."""
    shake = tremor.jets(t_s, plan.tremor.jet(t_s))
    roll = plan.roll.jet(t_s) + shake[3]
    pitch = plan.pitch.jet(t_s) + shake[4]
    yaw = plan.yaw.jet(t_s) + shake[5]
    sin_roll, cos_roll = sine(roll), cosine(roll)
    sin_pitch, cos_pitch = sine(pitch), cosine(pitch)
    sin_yaw, cos_yaw = sine(yaw), cosine(yaw)

    # Columns of roll and pitch alone, applied to the lever (x, 0, z) less the lever itself.
    pivot = plan.pivot.jet(t_s)
    x = pivot.scaled(_FROM_HEEL_M[0] - _FROM_BALL_M[0]).shifted(_FROM_BALL_M[0])
    z_m = _FROM_BALL_M[2]
    forward = cos_pitch * x + (sin_pitch * cos_roll).scaled(z_m) - x
    right = (-sin_roll).scaled(z_m)
    downward = (cos_pitch * cos_roll).scaled(z_m).shifted(-z_m) - sin_pitch * x

    north = plan.north.jet(t_s) + cos_yaw * forward - sin_yaw * right + shake[0]
    east = plan.east.jet(t_s) + sin_yaw * forward + cos_yaw * right + shake[1]
    down = plan.down.jet(t_s) + plan.lift.jet(t_s) + downward + shake[2]
    axes = (north, east, down)
    return Motion(
        t_s=t_s,
        position_n_m=np.column_stack([axis.value for axis in axes]),
        velocity_n_mps=np.column_stack([axis.rate for axis in axes]),
        accel_n_mps2=np.column_stack([axis.accel for axis in axes]),
        rotation_nb=_rotation(sin_roll, cos_roll, sin_pitch, cos_pitch, sin_yaw, cos_yaw),
        rate_b_radps=_body_rate(roll, pitch, yaw, sin_roll, cos_roll, sin_pitch, cos_pitch),
    )


def _rotation(
    sin_roll: Jet, cos_roll: Jet, sin_pitch: Jet, cos_pitch: Jet, sin_yaw: Jet, cos_yaw: Jet
) -> Floats:
    """Rz(yaw) Ry(pitch) Rx(roll): body to navigation."""
    sr, cr = sin_roll.value, cos_roll.value
    sp, cp = sin_pitch.value, cos_pitch.value
    sy, cy = sin_yaw.value, cos_yaw.value
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


def _body_rate(
    roll: Jet,
    pitch: Jet,
    yaw: Jet,
    sin_roll: Jet,
    cos_roll: Jet,
    sin_pitch: Jet,
    cos_pitch: Jet,
) -> Floats:
    """Angular rate in body axes from the rates of the angles (Titterton and Weston, 3.6)."""
    sr, cr = sin_roll.value, cos_roll.value
    sp, cp = sin_pitch.value, cos_pitch.value
    return np.column_stack(
        (
            roll.rate - yaw.rate * sp,
            pitch.rate * cr + yaw.rate * sr * cp,
            -pitch.rate * sr + yaw.rate * cr * cp,
        )
    )
