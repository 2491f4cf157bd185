"""Body segments that can wear a unit: foot, shank, thigh (in a pocket), hip, waist and chest.

Axes of each are forward, right, down when the person stands upright.  The foot is
rigid and rolls about its ball when the heel rises and about its heel when it
lands; hip, waist and chest ride on one rigid trunk whose pelvis follows the feet.
The leg is a pendulum between foot and pelvis: shank and thigh, hinged at ankle and
hip, lean as it does, and apart by what the knee bends.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from edge.samples import Floats
from edge.simulation.body_plan import LEG_LENGTH_M, BodyPlan
from edge.simulation.jet import Jet, arctangent, constant, oscillation, sine_and_cosine
from edge.simulation.kinematics import Attitude, Motion, Place, motion
from edge.simulation.planner import HALF_TRACK_M

# From the ball and from the heel to the unit on the instep, foot axes.
_BALL_TO_INSTEP_X_M = -0.10
_HEEL_TO_INSTEP_X_M = 0.13
_SOLE_TO_INSTEP_Z_M = -0.08
_INSTEP_TO_ANKLE_M = (-0.07, 0.0, -0.01)
_ANKLE_TO_SHANK_M = (0.04, 0.0, -0.22)
_PELVIS_TO_HIP_JOINT_M = (0.0, 0.09, 0.04)
_HIP_JOINT_TO_POCKET_M = (0.07, 0.03, 0.18)
_PELVIS_TO_WAIST_M = (-0.13, 0.0, -0.06)  # of the belt, at the back
_PELVIS_TO_HIP_M = (-0.02, 0.17, 0.0)
_PELVIS_TO_CHEST_M = (0.10, 0.0, -0.40)

_FOLLOW_S = 2.2  # two strides of mean, in which the foot's go and stop cancels out
_TWIST_RAD_PER_M = 3.0  # the pelvis turns as the trunk sways, a quarter of a stride earlier
_TWIST_LEAD_S = 0.26
_LEAN_RAD_PER_M = 1.5


class Tremor:
    """Tremor of a standing body: tenths of a millimetre, hundredths of a degree."""

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
        sums = [constant(t_s, 0.0)] * 6
        for amplitude, frequency_hz, phase_rad, axis in self._harmonics:
            sums[axis] = sums[axis] + oscillation(t_s, amplitude, frequency_hz, phase_rad)
        return [total * scale for total in sums]


_SegmentMotion = Callable[[BodyPlan, Tremor, Floats], tuple[Place, Attitude]]


def _foot(plan: BodyPlan, tremor: Tremor, t_s: Floats) -> tuple[Place, Attitude]:
    shake = tremor.jets(t_s, plan.tremor.jet(t_s))
    roll, yaw = plan.roll.jet(t_s) + shake[3], plan.yaw.jet(t_s) + shake[5]
    pitch = plan.pitch.jet(t_s) + shake[4]
    sole = Attitude(roll, pitch, yaw)
    attitude = Attitude(roll, pitch + plan.rock.jet(t_s), yaw)
    flat = Place(
        plan.north.jet(t_s) + shake[0],
        plan.east.jet(t_s) + shake[1],
        plan.down.jet(t_s) + plan.floor.jet(t_s) + plan.lift.jet(t_s) + shake[2],
    )
    # The lever from the point that stays on the ground, and where it would be if flat.
    to_heel_m = _HEEL_TO_INSTEP_X_M - _BALL_TO_INSTEP_X_M
    x = plan.pivot.jet(t_s).scaled(to_heel_m).shifted(_BALL_TO_INSTEP_X_M)
    zero, z = constant(t_s, 0.0), constant(t_s, _SOLE_TO_INSTEP_Z_M)
    below = sole.turned(x, zero, zero)
    return flat + below + attitude.turned(zero, zero, z) - attitude.yawed(x, zero, z), attitude


def _shank(plan: BodyPlan, tremor: Tremor, t_s: Floats) -> tuple[Place, Attitude]:
    instep, foot = _foot(plan, tremor, t_s)
    shank = Attitude(
        roll=plan.roll.jet(t_s).scaled(0.5),
        pitch=_leg_pitch(plan, t_s) + plan.shank_pitch.jet(t_s),
        yaw=plan.yaw.jet(t_s),
    )
    ankle = instep + foot.turned(*_levers(t_s, _INSTEP_TO_ANKLE_M))
    return ankle + shank.turned(*_levers(t_s, _ANKLE_TO_SHANK_M)), shank


def _leg_pitch(plan: BodyPlan, t_s: Floats) -> Jet:
    """Lean of the leg from the pelvis to its foot, forward positive.

    While the foot stands it turns by the body's speed over its length.
    """
    yaw = plan.yaw.smoothed(t_s, _FOLLOW_S)
    north = plan.north.jet(t_s) - plan.north.smoothed(t_s, _FOLLOW_S)
    east = plan.east.jet(t_s) - plan.east.smoothed(t_s, _FOLLOW_S)
    sin_yaw, cos_yaw = sine_and_cosine(yaw)
    ahead = north * cos_yaw + east * sin_yaw
    return arctangent(ahead.scaled(1.0 / LEG_LENGTH_M))


def _pocket(plan: BodyPlan, tremor: Tremor, t_s: Floats) -> tuple[Place, Attitude]:
    pelvis, trunk = _pelvis(plan, t_s, twist=1.0)
    shake = tremor.jets(t_s, plan.tremor.jet(t_s))
    thigh = Attitude(
        roll=plan.roll.jet(t_s).scaled(0.3),
        pitch=_leg_pitch(plan, t_s) + plan.thigh_pitch.jet(t_s),
        yaw=plan.yaw.smoothed(t_s, _FOLLOW_S),
    )
    joint = pelvis + trunk.turned(*_levers(t_s, _PELVIS_TO_HIP_JOINT_M)) + Place(*shake[:3])
    return joint + thigh.turned(*_levers(t_s, _HIP_JOINT_TO_POCKET_M)), thigh


def _pelvis(plan: BodyPlan, t_s: Floats, twist: float) -> tuple[Place, Attitude]:
    sway = plan.sway.jet(t_s)
    early = plan.sway.jet(np.maximum(t_s + _TWIST_LEAD_S, 0.0))
    yaw = plan.yaw.smoothed(t_s, _FOLLOW_S)
    attitude = Attitude(
        roll=sway.scaled(_LEAN_RAD_PER_M),
        pitch=plan.trunk_pitch.jet(t_s),
        yaw=yaw + early.scaled(twist * _TWIST_RAD_PER_M),
    )
    feet = Place(
        plan.north.smoothed(t_s, _FOLLOW_S),
        plan.east.smoothed(t_s, _FOLLOW_S),
        plan.down.smoothed(t_s, _FOLLOW_S)
        + plan.floor.jet(t_s)
        - plan.pelvis_height.jet(t_s)
        + plan.bounce.jet(t_s),
    )
    zero = constant(t_s, 0.0)
    middle = Attitude(zero, zero, yaw).yawed(zero, sway.shifted(-HALF_TRACK_M), zero)
    return feet + middle, attitude


def _on_trunk(lever_m: tuple[float, float, float], twist: float) -> _SegmentMotion:
    """Return the motion of what is fixed to the trunk; the shoulders turn against the pelvis."""

    def place(plan: BodyPlan, tremor: Tremor, t_s: Floats) -> tuple[Place, Attitude]:
        pelvis, attitude = _pelvis(plan, t_s, twist)
        shake = tremor.jets(t_s, plan.tremor.jet(t_s))
        return pelvis + attitude.turned(*_levers(t_s, lever_m)) + Place(*shake[:3]), attitude

    return place


def _levers(t_s: Floats, lever_m: tuple[float, float, float]) -> tuple[Jet, Jet, Jet]:
    x_m, y_m, z_m = lever_m
    return constant(t_s, x_m), constant(t_s, y_m), constant(t_s, z_m)


_SEGMENTS: dict[str, _SegmentMotion] = {
    "foot": _foot,
    "shank": _shank,
    "pocket": _pocket,
    "hip": _on_trunk(_PELVIS_TO_HIP_M, twist=1.0),
    "waist": _on_trunk(_PELVIS_TO_WAIST_M, twist=1.0),
    "chest": _on_trunk(_PELVIS_TO_CHEST_M, twist=-0.6),
}


def segment_motion(segment: str, plan: BodyPlan, tremor: Tremor, t_s: Floats) -> Motion:
    """Return the motion of the unit worn on ``segment`` at times ``t_s`` (n,), none of them
    negative.
    """
    return motion(t_s, *_SEGMENTS[segment](plan, tremor, t_s))
