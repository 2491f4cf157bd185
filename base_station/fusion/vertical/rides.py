"""What a lift does to a height.

A unit that feels the ride climbs by its barometer, and says how little it knows until its wearer
walks again; that doubt is ours as well.  One that does not feel it stays where it was while the
pressure changes as fast as lifts go.  That may have been a fan all the same, so nobody is moved by
it: the height is known no better than either would have it, until a storey, a fix or a pin tells.
"""

from __future__ import annotations

from itertools import pairwise, takewhile
from statistics import median

import msgspec

from base_station.fusion.port import AirHeight
from shared.clock import NS_PER_S

CLIMBED_M = 0.5  # by the own path while it rests: the unit felt the ride
STOREY_M = 2.2  # less is no ride
WITHIN_NS = 40 * NS_PER_S  # a ride of ten storeys, slow as they are
BEGIN_NS = NS_PER_S  # of standing, whose median is the height before: doors slam
OVER_NS, OVER_M = 2 * NS_PER_S, 0.6  # so long without more than this: the ride is over
JUMP = 0.6  # of the change at once: a door or a fan


class Rides(msgspec.Struct):
    felt: list[tuple[int, float]] = msgspec.field(default_factory=list)  # heights while it rests

    def feel(self, air: AirHeight, climbed_m: float) -> float:
        """By how much the air says that somebody who stands was lifted, and the own path, which
        climbed by so much meanwhile, does not; 0 where it does not say so.
        """
        felt, now_ns = self.felt, air.t_mono_ns
        if felt and now_ns < felt[-1][0]:  # the unit's clock went back
            felt.clear()
        felt.append((now_ns, air.down_m))
        if now_ns - felt[0][0] < BEGIN_NS + OVER_NS:
            return 0.0
        while now_ns - felt[0][0] > WITHIN_NS:
            del felt[0]
        begin_ns = felt[0][0]
        first = [one[1] for one in takewhile(lambda one: one[0] - begin_ns <= BEGIN_NS, felt)]
        last = [one[1] for one in takewhile(lambda one: now_ns - one[0] <= OVER_NS, reversed(felt))]
        goes_on = max(last) - min(last) > OVER_M or now_ns - begin_ns < BEGIN_NS + OVER_NS
        lifted_m = median(last) - median(first)
        if goes_on or abs(lifted_m) < STOREY_M or abs(climbed_m) > CLIMBED_M:
            return 0.0
        jump_m = max(abs(after[1] - before[1]) for before, after in pairwise(felt))
        self.felt = [felt[-1]]
        return 0.0 if jump_m > JUMP * abs(lifted_m) else lifted_m
