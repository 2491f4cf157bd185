"""Movements of a body: each function continues a ``BodyPlan`` by one movement.

Footholds are (north, east) in metres, angles in radians.  The small differences
between one stride and the next are drawn from the generator.
"""

from __future__ import annotations

from math import copysign, cos, pi, radians, remainder, sin

import numpy as np

from edge.simulation.body_plan import STANDING_PELVIS_M, BodyPlan
from edge.simulation.curve import Curve
from edge.simulation.gait import Gait
from edge.simulation.legs import Point
from edge.simulation.swings import Swing, go_forward, raise_and_lower
from shared.messages.status import Activity

_SETTLE_RAD = radians(1.0)  # how far a shoe tips when it touches down
# What is left of a foot's motion in the middle of its stance, as motion capture and gyroscopes of
# recorded walks have it: a median of 1.7 cm/s along the floor, 0.8 up or down, and 5.6 deg/s; the
# deviation of one axis is about 2 cm/s: of Student's t, as some strides creep far more than most.
_CREEPS_FREEDOM = 3.0
_CREEPS_MOST = 0.1 / 0.0106  # by the gait's: none of 511 recorded stances rose or sank faster
_SETTLES_S = 0.1  # of who stops
_DEFORMS_S = 0.15  # before it is down altogether
_CURVE_PEAK = 140.0 / 64.0  # of a curve's speed by its mean
_SHANK_BY_TOE_OFF = 0.6  # by which the bending knee folds the shank back
_THIGH_BY_TOE_OFF = -0.3  # by which the knee is raised in the swing
_CRAWL_PITCH_RAD = radians(-72)
_CRAWL_TRUNK_RAD = radians(-75)
_CRAWL_PELVIS_M = 0.45
_LIE_PITCH_RAD = radians(75)
_LIE_ROLL_RAD = radians(25)
_LIE_TRUNK_RAD = radians(82)
_LIE_PELVIS_M = 0.06
_LIFT_DOORS_S = 2.0


def stand(plan: BodyPlan, duration_s: float) -> None:
    plan.begin(Activity.STILL)
    settled_s = plan.duration_s + max(_SETTLES_S, min(0.4, duration_s))
    for curve in (plan.pitch, plan.roll, plan.shank_pitch, plan.thigh_pitch):
        if curve.last != 0.0:
            curve.move(max(plan.duration_s, curve.end_s), settled_s, 0.0)
    plan.duration_s += duration_s


def ride(plan: BodyPlan, rise_m: float, speed_mps: float) -> None:
    """Stand while the floor itself goes up or down."""
    stand(plan, _LIFT_DOORS_S)
    plan.duration_s = plan.floor.move(plan.duration_s, -rise_m, speed_mps)
    stand(plan, _LIFT_DOORS_S)


def stride(
    plan: BodyPlan,
    rng: np.random.Generator,
    gait: Gait,
    foothold: Point,
    yaw_rad: float,
    down_m: float | None = None,
) -> None:
    """Stand flat for a while, then move the foot to its next place (and height)."""
    plan.begin(gait.activity)
    jitter = np.clip(rng.normal(1.0, 0.03, size=4), 0.9, 1.1)
    begin_s = plan.duration_s
    end_s = begin_s + gait.stride_s * float(jitter[0])
    off_s = begin_s + gait.flat * (end_s - begin_s)
    swing = Swing(off_s, end_s)
    window = swing.window
    _, lifted_s = window(0.0, min(0.20, gait.forward[0], gait.raised[0]))
    _stand_on_it(plan, rng, gait, begin_s, off_s)
    _deform_ground(plan, rng, gait, begin_s, lifted_s)
    plan.rock.move(*window(0.20, 0.80), 0.0)
    plan.pivot.move(*window(0.40, 0.85), float(gait.lands_on_heel))
    go_forward(plan, gait, swing, foothold)
    if down_m is not None:
        plan.down.move(*window(*gait.upward), down_m)
    raise_and_lower(plan, rng, gait, swing, float(jitter[1]))
    toe_off_rad = gait.toe_off_rad * float(jitter[2])
    tips_s, down_s = window(*gait.tipped)
    leaves_s = max(plan.pitch.end_s, begin_s + gait.leaves * (off_s - begin_s))
    plan.pitch.move(leaves_s, tips_s, toe_off_rad)
    plan.pitch.move(tips_s, down_s, gait.strike_rad * float(jitter[3]))
    plan.pitch.move(down_s, end_s + gait.flattens_s, _tilt_rad(rng, gait))
    plan.roll.move(*window(0.15, 0.50), gait.turns * float(rng.normal(radians(7), radians(2))))
    plan.roll.move(*window(0.50, 0.95), _tilt_rad(rng, gait) or _settle_rad(rng))
    # The toes point outward in mid-swing.
    plan.yaw.move(*window(0.25, 0.55), (plan.yaw.last + yaw_rad) / 2.0 + gait.turns * radians(6))
    plan.yaw.move(*window(0.55, 0.95), yaw_rad)
    # The knee bends in the swing: the shank folds back and swings out under the thigh.
    plan.shank_pitch.move(*window(0.00, 0.45), _SHANK_BY_TOE_OFF * toe_off_rad)
    plan.shank_pitch.move(*window(0.45, 0.90), 0.0)
    plan.thigh_pitch.move(*window(0.05, 0.55), _THIGH_BY_TOE_OFF * toe_off_rad)
    plan.thigh_pitch.move(*window(0.55, 1.00), 0.0)
    _swing_trunk(plan, gait, begin_s, end_s)
    plan.duration_s = end_s
    plan.footfall_s.append(end_s)


def _settle_rad(rng: np.random.Generator) -> float:
    return float(rng.normal(0.0, _SETTLE_RAD))


def _tilt_rad(rng: np.random.Generator, gait: Gait) -> float:
    """Return the slope of a foothold; 0 on a floor."""
    return float(rng.normal(0.0, gait.tilt_rad)) if gait.tilt_rad else 0.0


def _stand_on_it(
    plan: BodyPlan, rng: np.random.Generator, gait: Gait, begin_s: float, off_s: float
) -> None:
    """The shoe settles and is flat for a moment.

    On the ball alone the heel sinks instead, and no moment is still.  On what slopes the shoe
    stands as it has come down, and what it stands on gives way a little.
    """
    flat_s = begin_s + 0.35 * (off_s - begin_s)
    rise_s = begin_s + 0.60 * (off_s - begin_s)
    deformation_rad = 0.2 * _tilt_rad(rng, gait)
    plan.roll.move(begin_s, flat_s, plan.roll.last + deformation_rad if gait.tilt_rad else 0.0)
    # The pivot changes while the foot is flat, where it has no effect.
    plan.pivot.move(flat_s, rise_s, float(gait.leaves_on_heel))
    if gait.sink_rad:
        plan.pitch.move(begin_s + gait.flattens_s, rise_s, gait.sink_rad)
    if gait.slip_m:
        slip_m = abs(float(rng.normal(0.0, gait.slip_m)))
        slips_s = begin_s + gait.leaves * (off_s - begin_s)
        plan.north.move(slips_s, off_s, plan.north.last - slip_m * cos(plan.yaw.last))
        plan.east.move(slips_s, off_s, plan.east.last - slip_m * sin(plan.yaw.last))


def _deform_ground(
    plan: BodyPlan, rng: np.random.Generator, gait: Gait, begin_s: float, lifted_s: float
) -> None:
    """No shoe holds a foot still: it rolls on, unless the heel sinks, and creeps any way.

    It does so before the foot is flat and after, so the stillest moment is in the middle.
    """
    begins_s = begin_s - _DEFORMS_S

    def creep(curve: Curve, per_s: float) -> None:
        start_s = max(curve.end_s, begins_s)
        curve.move(start_s, lifted_s, curve.last + per_s * (lifted_s - start_s) / _CURVE_PEAK)

    most_mps = _CREEPS_MOST * gait.creeps_mps
    creeps_mps = gait.creeps_mps * rng.standard_t(_CREEPS_FREEDOM, 3)
    north_mps, east_mps, down_mps = creeps_mps.clip(-most_mps, most_mps).tolist()
    rolls_radps = copysign(rng.normal(gait.rolls_radps, 0.5 * gait.rolls_radps), gait.toe_off_rad)
    creep(plan.lift, down_mps)
    if not gait.sink_rad:
        creep(plan.rock, rolls_radps)
    if not gait.slip_m:
        creep(plan.north, north_mps)
        creep(plan.east, east_mps)


def _swing_trunk(plan: BodyPlan, gait: Gait, begin_s: float, end_s: float) -> None:
    """The trunk rises over each standing leg and leans towards it."""
    quarter_s = (end_s - begin_s) / 4.0
    for quarter, bounce_m in enumerate((-gait.bounce_m, gait.bounce_m, -gait.bounce_m, 0.0)):
        start_s = begin_s + quarter * quarter_s
        plan.bounce.move(start_s, start_s + quarter_s, bounce_m)
    plan.sway.move(begin_s, begin_s + quarter_s, gait.sway_m)
    plan.sway.move(begin_s + quarter_s, begin_s + 3.0 * quarter_s, -gait.sway_m)
    plan.sway.move(begin_s + 3.0 * quarter_s, end_s, 0.0)


def lie(plan: BodyPlan, duration_s: float, fall: bool) -> None:
    """Go down onto the back, the toes up; nothing moves until getting up."""
    plan.begin(Activity.FALLING if fall else Activity.LYING)
    begin_s = plan.duration_s
    down_s = begin_s + (0.9 if fall else 2.4)
    rest_s = down_s + duration_s
    up_s = rest_s + 2.6
    standing = plan.north.last, plan.east.last
    reach = 0.45 * cos(plan.yaw.last), 0.45 * sin(plan.yaw.last)
    plan.pivot.move(begin_s, begin_s + 0.2, 1.0)
    for start_s, end_s, down in ((begin_s + 0.2, down_s, True), (rest_s, up_s, False)):
        plan.north.move(start_s, end_s, standing[0] + down * reach[0])
        plan.east.move(start_s, end_s, standing[1] + down * reach[1])
        plan.pitch.move(start_s, end_s, down * _LIE_PITCH_RAD)
        plan.roll.move(start_s, end_s, down * _LIE_ROLL_RAD)
        plan.shank_pitch.move(start_s, end_s, down * _LIE_TRUNK_RAD)
        plan.thigh_pitch.move(start_s, end_s, down * _LIE_TRUNK_RAD)
        plan.trunk_pitch.move(start_s, end_s, down * _LIE_TRUNK_RAD)
        plan.pelvis_height.move(start_s, end_s, _LIE_PELVIS_M if down else STANDING_PELVIS_M)
        plan.tremor.move(start_s, end_s, float(not down))
    plan.duration_s = down_s
    plan.begin(Activity.LYING)
    plan.duration_s = up_s


def kneel(plan: BodyPlan) -> None:
    """Go down on hands and knees, the foot on its toes."""
    plan.begin(Activity.CRAWLING)
    begin_s = plan.duration_s
    plan.pivot.move(begin_s, begin_s + 0.2, 0.0)
    _kneel_or_rise(plan, begin_s + 0.2, begin_s + 1.6, down=True)
    plan.duration_s = begin_s + 1.8


def rise(plan: BodyPlan) -> None:
    """Get up from hands and knees."""
    _kneel_or_rise(plan, plan.duration_s, plan.duration_s + 1.4, down=False)
    plan.duration_s += 1.4


def _kneel_or_rise(plan: BodyPlan, start_s: float, end_s: float, *, down: bool) -> None:
    plan.pitch.move(start_s, end_s, down * _CRAWL_PITCH_RAD)
    plan.shank_pitch.move(start_s, end_s, down * radians(-85))
    plan.trunk_pitch.move(start_s, end_s, down * _CRAWL_TRUNK_RAD)
    plan.pelvis_height.move(start_s, end_s, _CRAWL_PELVIS_M if down else STANDING_PELVIS_M)


def pull(plan: BodyPlan, rng: np.random.Generator, foothold: Point, yaw_rad: float) -> None:
    """Crawling: rest on the toes, then drag the foot to its next place."""
    begin_s = plan.duration_s + float(rng.uniform(0.35, 0.6))
    # The foot tilts most early in the pull, so that it never glides without turning.
    mid_s = begin_s + float(rng.uniform(0.15, 0.25))
    end_s = mid_s + float(rng.uniform(0.45, 0.55))
    plan.north.move(begin_s, end_s, foothold[0])
    plan.east.move(begin_s, end_s, foothold[1])
    plan.yaw.move(begin_s, end_s, yaw_rad)
    plan.pitch.move(begin_s, mid_s, _CRAWL_PITCH_RAD + float(rng.normal(0.25, 0.06)))
    plan.pitch.move(mid_s, end_s, _CRAWL_PITCH_RAD)
    plan.roll.move(begin_s, mid_s, float(rng.normal(0.15, 0.05)))
    plan.roll.move(mid_s, end_s, 0.0)
    plan.sway.move(begin_s, mid_s, 0.04)
    plan.sway.move(mid_s, end_s, 0.0)
    plan.duration_s = end_s
    plan.footfall_s.append(end_s)


def unwrapped(heading_rad: float, near_rad: float) -> float:
    """The same heading, by the turns nearest to another."""
    return near_rad + remainder(heading_rad - near_rad, 2.0 * pi)
