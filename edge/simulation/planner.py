"""Turns legs into the curves of one walking right foot, stride by stride."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from math import atan2, ceil, cos, hypot, pi, radians, remainder, sin

import numpy as np

from edge.simulation.curve import Curve
from edge.simulation.gait import PACES, STAIRS_DOWN, STAIRS_UP, TURN, Gait
from edge.simulation.legs import Leg, Lie, Point, Stairs, Stand, Turn, Walk
from shared.messages.status import Activity

SENSOR_HEIGHT_M = 0.08  # of the instep above the sole
_HALF_TRACK_M = 0.09  # from the body's middle to the foot
_SETTLE_RAD = radians(1.0)  # how far a shoe tips when it touches down
_ROLL_OVER_RAD = radians(3)  # how far it has rolled when the heel leaves the ground
_SHARP_TURN_RAD = radians(100)  # from here on a person stops and turns
_CRAWL_PITCH_RAD = radians(-72)
_LIE_PITCH_RAD = radians(75)
_LIE_ROLL_RAD = radians(25)


@dataclass(slots=True, eq=False)
class FootPlan:
    """Where the foot is at every time, as curves; NED metres in the site frame.

    ``pivot`` is 0 when the foot rolls about its ball and 1 when about its heel;
    ``tremor`` scales the small motion that a living foot never quite stops.
    """

    north: Curve
    east: Curve
    down: Curve
    lift: Curve
    yaw: Curve
    pitch: Curve
    roll: Curve
    pivot: Curve
    tremor: Curve
    duration_s: float = 0.0
    activity_start_s: list[float] = field(default_factory=list)
    activities: list[Activity] = field(default_factory=list)
    footfall_s: list[float] = field(default_factory=list)  # when each stride has ended

    def activity(self, t_s: float) -> Activity:
        return self.activities[max(0, bisect_right(self.activity_start_s, t_s) - 1)]


class Planner:
    """Walks through legs, keeping the time, the place and the heading."""

    def __init__(
        self, rng: np.random.Generator, start: Point, down_m: float, heading_rad: float
    ) -> None:
        self._rng = rng
        self._middle = start
        self._heading_rad = heading_rad
        north_m, east_m = self._foothold(start, heading_rad)
        self.plan = FootPlan(
            north=Curve(north_m),
            east=Curve(east_m),
            down=Curve(down_m - SENSOR_HEIGHT_M),
            lift=Curve(0.0),
            yaw=Curve(heading_rad),
            pitch=Curve(0.0),
            roll=Curve(0.0),
            pivot=Curve(0.0),
            tremor=Curve(1.0),
        )

    @property
    def t_s(self) -> float:
        return self.plan.duration_s

    def do(self, leg: Leg) -> None:
        if isinstance(leg, Walk):
            self._walk(leg.to, PACES[leg.pace])
        elif isinstance(leg, Stairs):
            self._climb(leg)
        elif isinstance(leg, Stand):
            self._stand(leg.duration_s)
        elif isinstance(leg, Turn):
            self._face(radians(leg.heading_deg))
        elif isinstance(leg, Lie):
            self._lie(leg)
        else:
            self._crawl(leg.to)

    def _stand(self, duration_s: float) -> None:
        plan = self.plan
        self._begin(Activity.STILL)
        for curve in (plan.pitch, plan.roll):
            if curve.last != 0.0:
                curve.move(self.t_s, self.t_s + min(0.3, duration_s), 0.0)
        plan.duration_s += duration_s

    def _face(self, heading_rad: float, at_least_rad: float = radians(5)) -> None:
        """Turn on the spot in as many strides as a person needs."""
        turn_rad = remainder(heading_rad - self._heading_rad, 2.0 * pi)
        if abs(turn_rad) < at_least_rad:
            return
        strides = ceil(abs(turn_rad) / radians(65))
        for _ in range(strides):
            self._stride(TURN, self._middle, self._heading_rad + turn_rad / strides)

    def _walk(self, to: tuple[Point, ...], gait: Gait) -> None:
        for corner_points in _split_at_sharp_turns(self._middle, to):
            line = _Line(corner_points)
            self._face(line.direction_rad(0.0, 0.1), at_least_rad=radians(50))
            strides = max(1, round(line.length_m / gait.stride_m))
            reach_m = 0.35 * gait.stride_m
            for k in range(1, strides + 1):
                along_m = line.length_m * k / strides
                if k < strides:
                    along_m += self._rng.normal(0.0, 0.03) * gait.stride_m
                self._stride(gait, line.point(along_m), line.direction_rad(along_m, reach_m))

    def _climb(self, stairs: Stairs) -> None:
        line = _Line((self._middle, stairs.to))
        heading_rad = line.direction_rad(0.0, 0.1)
        self._face(heading_rad)
        gait = STAIRS_UP if stairs.rise_m > 0.0 else STAIRS_DOWN
        floor_down_m = self.plan.down.last
        for tread in [*range(2, stairs.risers, 2), stairs.risers]:
            # A foot stands in the middle of a tread; the last riser leads to the landing.
            on_tread = min((tread - 0.5) / (stairs.risers - 0.5), 1.0)
            down_m = floor_down_m - stairs.rise_m * tread / stairs.risers
            self._stride(gait, line.point(line.length_m * on_tread), heading_rad, down_m)

    def _stride(
        self, gait: Gait, middle: Point, heading_rad: float, down_m: float | None = None
    ) -> None:
        """Stand flat for a while, then move the foot to its next place."""
        plan = self.plan
        jitter = np.clip(self._rng.normal(1.0, 0.03, size=4), 0.9, 1.1)
        begin_s = plan.duration_s
        stride_s = gait.stride_s * float(jitter[0])
        off_s = begin_s + gait.flat * stride_s
        moving_s = begin_s + stride_s - off_s

        def window(start: float, end: float) -> tuple[float, float]:
            return off_s + start * moving_s, off_s + end * moving_s

        self._begin(gait.activity)
        yaw_rad = plan.yaw.last + remainder(heading_rad - plan.yaw.last, 2.0 * pi)
        yaw_rad += float(self._rng.normal(0.0, radians(2)))
        north_m, east_m = self._foothold(middle, yaw_rad)
        self._stance(begin_s, off_s)
        plan.pivot.move(*window(0.40, 0.85), 1.0)
        plan.north.move(*window(*gait.forward), north_m)
        plan.east.move(*window(*gait.forward), east_m)
        if down_m is not None:
            plan.down.move(*window(*gait.upward), down_m)
        plan.lift.move(*window(0.30, 0.60), -gait.clearance_m * float(jitter[1]))
        plan.lift.move(*window(0.60, 0.90), 0.0)
        plan.pitch.move(*window(0.00, 0.42), gait.toe_off_rad * float(jitter[2]))
        plan.pitch.move(*window(0.42, 0.84), gait.strike_rad * float(jitter[3]))
        plan.pitch.move(*window(0.84, 1.00), float(abs(self._rng.normal(0.0, _SETTLE_RAD))))
        plan.roll.move(*window(0.15, 0.50), float(self._rng.normal(radians(7), radians(2))))
        plan.roll.move(*window(0.50, 0.95), float(self._rng.normal(0.0, _SETTLE_RAD)))
        # The toes point outward in mid-swing.
        plan.yaw.move(*window(0.25, 0.55), (plan.yaw.last + yaw_rad) / 2.0 + radians(6))
        plan.yaw.move(*window(0.55, 0.95), yaw_rad)
        plan.duration_s = begin_s + stride_s
        plan.footfall_s.append(plan.duration_s)
        self._middle, self._heading_rad = middle, heading_rad

    def _stance(self, begin_s: float, off_s: float) -> None:
        """The shoe settles, is flat for a moment, and begins to roll over the ball."""
        plan = self.plan
        flat_s = begin_s + 0.35 * (off_s - begin_s)
        rise_s = begin_s + 0.60 * (off_s - begin_s)
        plan.pitch.move(begin_s, flat_s, 0.0)
        plan.roll.move(begin_s, flat_s, 0.0)
        # The pivot changes while the foot is flat, where it has no effect.
        plan.pivot.move(flat_s, rise_s, 0.0)
        plan.pitch.move(rise_s, off_s, -float(abs(self._rng.normal(_ROLL_OVER_RAD, _SETTLE_RAD))))

    def _lie(self, leg: Lie) -> None:
        """Go down onto the back, the toes up; nothing moves until getting up."""
        plan = self.plan
        self._begin(Activity.FALLING if leg.fall else Activity.LYING)
        begin_s = plan.duration_s
        down_s = begin_s + (0.9 if leg.fall else 2.4)
        rest_s = down_s + leg.duration_s
        up_s = rest_s + 2.6
        standing = plan.north.last, plan.east.last
        reach = 0.45 * cos(plan.yaw.last), 0.45 * sin(plan.yaw.last)
        plan.pivot.move(begin_s, begin_s + 0.2, 1.0)
        for start_s, end_s, down in ((begin_s + 0.2, down_s, True), (rest_s, up_s, False)):
            plan.north.move(start_s, end_s, standing[0] + down * reach[0])
            plan.east.move(start_s, end_s, standing[1] + down * reach[1])
            plan.pitch.move(start_s, end_s, down * _LIE_PITCH_RAD)
            plan.roll.move(start_s, end_s, down * _LIE_ROLL_RAD)
            plan.tremor.move(start_s, end_s, float(not down))
        plan.duration_s = down_s
        self._begin(Activity.LYING)
        plan.duration_s = up_s

    def _crawl(self, to: tuple[Point, ...]) -> None:
        """Drag the foot, resting on its toes between two pulls."""
        plan = self.plan
        for corner_points in _split_at_sharp_turns(self._middle, to):
            line = _Line(corner_points)
            self._face(line.direction_rad(0.0, 0.1), at_least_rad=radians(50))
            self._begin(Activity.CRAWLING)
            begin_s = plan.duration_s
            plan.pivot.move(begin_s, begin_s + 0.2, 0.0)
            plan.pitch.move(begin_s + 0.2, begin_s + 1.6, _CRAWL_PITCH_RAD)
            plan.duration_s = begin_s + 1.8
            pulls = max(1, round(line.length_m / 0.45))
            for k in range(1, pulls + 1):
                along_m = line.length_m * k / pulls
                self._pull(line.point(along_m), line.direction_rad(along_m, 0.2))
            plan.pitch.move(plan.duration_s, plan.duration_s + 1.4, 0.0)
            plan.duration_s += 1.4

    def _pull(self, middle: Point, heading_rad: float) -> None:
        plan = self.plan
        begin_s = plan.duration_s + float(self._rng.uniform(0.35, 0.6))
        # The foot tilts most early in the pull, so that it never glides without turning.
        mid_s = begin_s + float(self._rng.uniform(0.15, 0.25))
        end_s = mid_s + float(self._rng.uniform(0.45, 0.55))
        yaw_rad = plan.yaw.last + remainder(heading_rad - plan.yaw.last, 2.0 * pi)
        north_m, east_m = self._foothold(middle, yaw_rad)
        plan.north.move(begin_s, end_s, north_m)
        plan.east.move(begin_s, end_s, east_m)
        plan.yaw.move(begin_s, end_s, yaw_rad)
        plan.pitch.move(begin_s, mid_s, _CRAWL_PITCH_RAD + float(self._rng.normal(0.25, 0.06)))
        plan.pitch.move(mid_s, end_s, _CRAWL_PITCH_RAD)
        plan.roll.move(begin_s, mid_s, float(self._rng.normal(0.15, 0.05)))
        plan.roll.move(mid_s, end_s, 0.0)
        plan.duration_s = end_s
        plan.footfall_s.append(end_s)
        self._middle, self._heading_rad = middle, heading_rad

    def _begin(self, activity: Activity) -> None:
        plan = self.plan
        if not plan.activities or plan.activities[-1] is not activity:
            plan.activities.append(activity)
            plan.activity_start_s.append(plan.duration_s)

    @staticmethod
    def _foothold(middle: Point, yaw_rad: float) -> Point:
        """The right foot stands beside the body's middle."""
        return (
            middle[0] - _HALF_TRACK_M * sin(yaw_rad),
            middle[1] + _HALF_TRACK_M * cos(yaw_rad),
        )


class _Line:
    """A polyline by the distance along it."""

    def __init__(self, points: tuple[Point, ...]) -> None:
        self._points = np.array(points)
        steps_m = np.hypot(*np.diff(self._points, axis=0).T)
        self._along_m = np.concatenate(([0.0], np.cumsum(steps_m)))

    @property
    def length_m(self) -> float:
        return float(self._along_m[-1])

    def point(self, along_m: float) -> Point:
        return (
            float(np.interp(along_m, self._along_m, self._points[:, 0])),
            float(np.interp(along_m, self._along_m, self._points[:, 1])),
        )

    def direction_rad(self, along_m: float, reach_m: float) -> float:
        """Heading of the chord around a place, so that corners are rounded."""
        behind = self.point(max(0.0, along_m - reach_m))
        ahead = self.point(min(self.length_m, along_m + reach_m))
        return atan2(ahead[1] - behind[1], ahead[0] - behind[0])


def _split_at_sharp_turns(start: Point, to: tuple[Point, ...]) -> list[tuple[Point, ...]]:
    """Polylines without sharp turns, each starting where the one before ended."""
    lines: list[tuple[Point, ...]] = []
    line: tuple[Point, ...] = (start,)
    heading_rad: float | None = None
    for point in to:
        north_m, east_m = point[0] - line[-1][0], point[1] - line[-1][1]
        if hypot(north_m, east_m) < 0.01:
            continue
        next_rad = atan2(east_m, north_m)
        if heading_rad is not None and (
            abs(remainder(next_rad - heading_rad, 2.0 * pi)) > _SHARP_TURN_RAD
        ):
            lines.append(line)
            line = (line[-1],)
        line = (*line, point)
        heading_rad = next_rad
    return [*lines, line] if len(line) > 1 else lines
