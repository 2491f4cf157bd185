"""Movements of a body that stays where it is: standing about, raising a foot, kneeling, sitting.

No person is still for minutes.  The weight goes from one leg to the other, a foot is put anew,
the foot of crossed legs dangles.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, radians, sin

import numpy as np

from edge.simulation.body_plan import STANDING_PELVIS_M, BodyPlan
from edge.simulation.movements import kneel, rise
from shared.messages.status import Activity

_SHIFT_RAD = radians(1.5)  # how far a shoe tips when the weight goes off it
_FOOT_SHIFT_M = 0.06  # how far a foot is put from where it stood
_FOOT_SHIFT_RAD = radians(8)
_FOOT_LIFT_M = 0.03
_KNEELING_SHIFT_RAD = radians(3)
_SIT_PELVIS_M = 0.40
_SIT_THIGH_RAD = radians(80)
_CROSSED_LIFT_M = 0.35
_CROSSED_FORWARD_M = 0.12
_CROSSED_PITCH_RAD = radians(-25)
_DANGLES_RAD = radians(4)

_NEAR = 0.15  # of its height: from there on a raised foot is put down ever slower
_RAISED_SWAY_M = 0.02
_RAISED_TILT_RAD = radians(-35), radians(8)
_RAISED_KNEE_RAD_PER_M = 1.6

_Rng = np.random.Generator
_Fidget = Callable[[BodyPlan, _Rng, float], float]  # at a time; returns when it ends


def wait(plan: BodyPlan, rng: _Rng, duration_s: float) -> None:
    """Stand about on one spot."""
    plan.begin(Activity.STILL)
    end_s = plan.duration_s + duration_s
    _fidget(plan, rng, end_s, _shift_foot)
    _tip(plan, end_s, 0.4, 0.0, 0.0)
    plan.duration_s = end_s + 0.4


def stay_kneeling(plan: BodyPlan, rng: _Rng, duration_s: float) -> None:
    """Go down on hands and knees, stay there on one's toes, get up again."""
    kneel(plan)
    pitch_rad = plan.pitch.last
    end_s = plan.duration_s + duration_s
    while (start_s := plan.duration_s + float(rng.uniform(2.0, 8.0))) + 2.0 < end_s:
        tip_rad = rng.normal(0.0, _KNEELING_SHIFT_RAD, 2)
        plan.duration_s = _tip(plan, start_s, 0.8, pitch_rad + float(tip_rad[0]), float(tip_rad[1]))
    _tip(plan, end_s, 0.4, pitch_rad, 0.0)
    plan.duration_s = end_s + 0.4
    rise(plan)


def sit(plan: BodyPlan, rng: _Rng, duration_s: float) -> None:
    """Sit down; cross the legs now and then, which takes the foot off the ground; get up."""
    plan.begin(Activity.STILL)
    plan.pelvis_height.move(plan.duration_s, plan.duration_s + 1.5, _SIT_PELVIS_M)
    plan.thigh_pitch.move(plan.duration_s, plan.duration_s + 1.5, _SIT_THIGH_RAD)
    plan.duration_s += 1.5
    end_s = plan.duration_s + duration_s
    _fidget(plan, rng, end_s, _cross_legs)
    _tip(plan, end_s, 0.4, 0.0, 0.0)
    plan.pelvis_height.move(end_s + 0.4, end_s + 1.9, STANDING_PELVIS_M)
    plan.thigh_pitch.move(end_s + 0.4, end_s + 1.9, 0.0)
    plan.duration_s = end_s + 1.9


def raise_foot(plan: BodyPlan, rng: _Rng, height_m: float) -> None:
    """Raise the foot and put it down slowly, ever slower; it turns back on the whole way down."""
    plan.begin(Activity.WALKING)
    start_s = plan.duration_s + float(rng.uniform(0.2, 1.2))
    slows_s = start_s + float(rng.uniform(0.4, 0.7))
    sinks_s = slows_s + float(rng.uniform(0.25, 0.45))
    down_s = sinks_s + float(rng.uniform(0.8, 1.3))
    high_m = height_m * float(rng.uniform(0.6, 1.2))
    near_s = sinks_s + 0.6 * (down_s - sinks_s)
    near_m = _NEAR * high_m
    plan.lift.move(start_s, slows_s, -high_m, -high_m / (slows_s - start_s))
    plan.lift.move(slows_s, sinks_s, -high_m, (high_m - near_m) / (near_s - sinks_s))
    plan.lift.move(sinks_s, near_s, -near_m, near_m / (down_s - near_s))
    plan.lift.move(near_s, down_s, 0.0)
    plan.duration_s = down_s
    top_s = 0.5 * (slows_s + sinks_s)
    sways_m, tilts_rad = rng.normal(0.0, _RAISED_SWAY_M, 2), rng.normal(*_RAISED_TILT_RAD)
    for curve, there in (
        (plan.north, plan.north.last + float(sways_m[0])),
        (plan.east, plan.east.last + float(sways_m[1])),
        (plan.pitch, float(tilts_rad)),
        (plan.thigh_pitch, _RAISED_KNEE_RAD_PER_M * high_m),
    ):
        back = curve.last
        curve.move(start_s, top_s, there)
        curve.move(top_s, down_s, back)
    plan.footfall_s.append(down_s)


def _fidget(plan: BodyPlan, rng: _Rng, end_s: float, more: _Fidget) -> None:
    """Shift the weight every few seconds until a time, and one time in four do ``more``."""
    longest_s = 18.0
    while (start_s := plan.duration_s + float(rng.uniform(2.0, 10.0))) + longest_s < end_s:
        if rng.random() < 0.25:
            plan.duration_s = more(plan, rng, start_s)
        else:
            pitch_rad, roll_rad = rng.normal(0.0, _SHIFT_RAD, 2)
            takes_s = float(rng.uniform(0.5, 1.5))
            plan.duration_s = _tip(plan, start_s, takes_s, -abs(float(pitch_rad)), float(roll_rad))


def _tip(
    plan: BodyPlan, start_s: float, takes_s: float, pitch_rad: float, roll_rad: float
) -> float:
    plan.pitch.move(start_s, start_s + takes_s, pitch_rad)
    plan.roll.move(start_s, start_s + takes_s, roll_rad)
    return start_s + takes_s


def _shift_foot(plan: BodyPlan, rng: _Rng, start_s: float) -> float:
    takes_s = float(rng.uniform(0.4, 0.7))
    middle_s, end_s = start_s + 0.5 * takes_s, start_s + takes_s
    north_m, east_m = rng.normal(0.0, _FOOT_SHIFT_M, 2)
    plan.lift.move(start_s, middle_s, -_FOOT_LIFT_M)
    plan.lift.move(middle_s, end_s, 0.0)
    plan.north.move(start_s, end_s, plan.north.last + float(north_m))
    plan.east.move(start_s, end_s, plan.east.last + float(east_m))
    plan.yaw.move(start_s, end_s, plan.yaw.last + float(rng.normal(0.0, _FOOT_SHIFT_RAD)))
    return _tip(plan, start_s, takes_s, 0.0, 0.0)


def _cross_legs(plan: BodyPlan, rng: _Rng, start_s: float) -> float:
    """Put the foot up, let it dangle, put it back."""
    north_m, east_m = plan.north.last, plan.east.last
    ahead_m = _CROSSED_FORWARD_M * cos(plan.yaw.last), _CROSSED_FORWARD_M * sin(plan.yaw.last)
    _raise(plan, start_s, -_CROSSED_LIFT_M, north_m + ahead_m[0], east_m + ahead_m[1])
    now_s = _tip(plan, start_s, 1.0, _CROSSED_PITCH_RAD, radians(10))
    for _ in range(int(rng.integers(4, 9))):
        off_rad = rng.normal(0.0, _DANGLES_RAD, 2)
        now_s = _tip(
            plan,
            now_s + float(rng.uniform(0.0, 1.0)),
            float(rng.uniform(0.3, 0.9)),
            _CROSSED_PITCH_RAD + float(off_rad[0]),
            radians(10) + float(off_rad[1]),
        )
    _raise(plan, now_s, 0.0, north_m, east_m)
    return _tip(plan, now_s, 1.0, 0.0, 0.0)


def _raise(plan: BodyPlan, start_s: float, lift_m: float, north_m: float, east_m: float) -> None:
    plan.lift.move(start_s, start_s + 1.0, lift_m)
    plan.north.move(start_s, start_s + 1.0, north_m)
    plan.east.move(start_s, start_s + 1.0, east_m)
