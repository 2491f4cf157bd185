"""Lift detector: rides in a lift, as a change of pressure at rest.

A unit that detects the ride climbs by its barometer, with a larger stated deviation until its
wearer walks again; that deviation is used. Another one stays at its height while the pressure
changes as fast as in a lift. As a fan may do that too, the height is not moved: its variance grows
to hold both, until a storey, a fix or a pin decides.
"""

from __future__ import annotations

from itertools import pairwise, takewhile
from statistics import median

import msgspec

from base_station.fusion.interface import BarometricHeight
from shared.clock import NS_PER_S

CLIMBED_M = 0.5  # by the own path while it rests: the unit felt the ride
STOREY_M = 2.2  # less is no ride
WITHIN_NS = 40 * NS_PER_S  # a ride of ten storeys, slow as they are
BEGIN_NS = NS_PER_S  # of standing, whose median is the height before: doors slam
OVER_NS, OVER_M = 2 * NS_PER_S, 0.6  # so long without more than this: the ride is over
JUMP = 0.6  # of the change at once: a door or a fan


class LiftDetector(msgspec.Struct):
    """Detector of lift rides by the barometric heights of a wearer at rest."""

    heights: list[tuple[int, float]] = msgspec.field(default_factory=list)  # heights while it rests

    def update_barometer(self, air: BarometricHeight, climbed_m: float) -> float:
        """Rise by a lift (m, down) that the pressure shows and the own path, which climbed by
        ``climbed_m``, does not; 0 without one.
        """
        heights, now_ns = self.heights, air.t_mono_ns
        if heights and now_ns < heights[-1][0]:  # the unit's clock went back
            heights.clear()
        heights.append((now_ns, air.down_m))
        if now_ns - heights[0][0] < BEGIN_NS + OVER_NS:
            return 0.0
        while now_ns - heights[0][0] > WITHIN_NS:
            del heights[0]
        begin_ns = heights[0][0]
        first = [one[1] for one in takewhile(lambda one: one[0] - begin_ns <= BEGIN_NS, heights)]
        last = [
            one[1] for one in takewhile(lambda one: now_ns - one[0] <= OVER_NS, reversed(heights))
        ]
        goes_on = max(last) - min(last) > OVER_M or now_ns - begin_ns < BEGIN_NS + OVER_NS
        lifted_m = median(last) - median(first)
        if goes_on or abs(lifted_m) < STOREY_M or abs(climbed_m) > CLIMBED_M:
            return 0.0
        jump_m = max(abs(after[1] - before[1]) for before, after in pairwise(heights))
        self.heights = [heights[-1]]
        return 0.0 if jump_m > JUMP * abs(lifted_m) else lifted_m
