"""Swings of a foot between lift-off and landing: forward, off the floor, and onto it.

Most feet come down softly.  Those of runners are stopped by the floor within a hundredth of a
second, and the shoe rings; feet that are dragged scrape along it.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import atan2, cos, hypot, pi, sin

import numpy as np

from edge.simulation.body_plan import BodyPlan
from edge.simulation.gait import Gait
from edge.simulation.legs import Point

# Of an even swing: it gains speed, keeps it, loses it.
_GAINS, _KEEPS = 0.36, 0.54  # shares of the way's time until the end of each
_STOPS_S = 0.014  # a shoe and the floor under it
_RINGS_S = 0.011  # half a cycle of the ringing shoe
_RINGS_BY = (-0.35, 0.2, -0.1, 0.0)  # of what it gave way, after each half cycle
_SCRAPES_S = 0.03  # half a cycle of a shoe that scrapes

_Rng = np.random.Generator


@dataclass(frozen=True, slots=True)
class Swing:
    """Times from when a foot leaves the ground until it is down again."""

    off_s: float
    end_s: float

    def window(self, start: float, end: float) -> tuple[float, float]:
        """Return times by their shares of the swing."""
        moves_s = self.end_s - self.off_s
        return self.off_s + start * moves_s, self.off_s + end * moves_s


def go_forward(plan: BodyPlan, gait: Gait, swing: Swing, foothold: Point) -> None:
    """Move the foot to its next place; a runner's arrives there at a speed."""
    start_s, end_s = swing.window(*gait.forward)
    if not gait.strike_ahead_mps:
        plan.north.move(start_s, end_s, foothold[0])
        plan.east.move(start_s, end_s, foothold[1])
        return
    gained_s, kept_s = swing.window(_GAINS, _KEEPS)
    north_m, east_m = foothold[0] - plan.north.last, foothold[1] - plan.east.last
    way_m, heading_rad = hypot(north_m, east_m), atan2(east_m, north_m)
    losing_s = 0.5 * (end_s - kept_s)
    arrives_mps = gait.strike_ahead_mps
    fast_s = 0.5 * (gained_s - start_s) + kept_s - gained_s + losing_s
    fast_mps = (way_m - losing_s * arrives_mps) / fast_s
    gained_m = 0.5 * (gained_s - start_s) * fast_mps
    kept_m = gained_m + (kept_s - gained_s) * fast_mps
    for curve, part in ((plan.north, cos(heading_rad)), (plan.east, sin(heading_rad))):
        begin_m = curve.last
        curve.move(start_s, gained_s, begin_m + part * gained_m, part * fast_mps)
        curve.move(gained_s, kept_s, begin_m + part * kept_m, part * fast_mps)
        curve.move(kept_s, end_s, begin_m + part * way_m, part * arrives_mps)
        curve.move(end_s, end_s + _STOPS_S, curve.last + part * 0.5 * arrives_mps * _STOPS_S)


def raise_and_lower(plan: BodyPlan, rng: _Rng, gait: Gait, swing: Swing, by: float) -> None:
    """Lift the foot by its clearance, times ``by``, and put it down; or scrape it along."""
    if gait.scrapes_m:
        _scrape(plan, rng, gait, swing)
        return
    plan.lift.move(*swing.window(*gait.raised), -gait.clearance_m * by)
    start_s, end_s = swing.window(*gait.lowered)
    plan.lift.move(start_s, end_s, 0.0, gait.strike_mps)
    if gait.strike_mps:
        gives_m = 0.5 * gait.strike_mps * _STOPS_S
        plan.lift.move(end_s, end_s + _STOPS_S, gives_m)
        _ring(plan, rng, gait, end_s, gives_m)


def _ring(plan: BodyPlan, rng: _Rng, gait: Gait, struck_s: float, gave_m: float) -> None:
    rings_rad = gait.rings_rad * float(rng.uniform(0.5, 1.5))
    at_rad = plan.rock.last
    plan.rock.move(struck_s, struck_s + _STOPS_S, at_rad + rings_rad)
    for number, by in enumerate(_RINGS_BY):
        start_s = struck_s + _STOPS_S + number * _RINGS_S
        plan.lift.move(start_s, start_s + _RINGS_S, gave_m * (1.0 + by))
        plan.rock.move(start_s, start_s + _RINGS_S, at_rad + by * rings_rad)


def _scrape(plan: BodyPlan, rng: _Rng, gait: Gait, swing: Swing) -> None:
    """The shoe never leaves the floor, but jumps over what is rough."""
    start_s, end_s = swing.window(*gait.forward)
    start_s = max(start_s, plan.lift.end_s)
    count = max(2, round((end_s - start_s) / _SCRAPES_S))
    times_s = np.linspace(start_s, end_s, count + 1).tolist()
    down_m = np.linspace(plan.lift.last, 0.0, count + 1)[1:]
    over_m = gait.clearance_m * np.sin(np.linspace(0.0, pi, count + 1)[1:])
    jumps_m = np.abs(rng.normal(0.0, gait.scrapes_m, count))
    jumps_m[-1] = 0.0
    for (before_s, after_s), lift_m in zip(
        pairwise(times_s), down_m - over_m - jumps_m, strict=True
    ):
        plan.lift.move(before_s, after_s, float(lift_m))
