"""What a satellite fix has to stand up to before it is taken.

A receiver that hangs is noticed, one that was wrong just now is not believed at once, and how much
worse fixes fit than they claim is learnt as they come.
"""

from __future__ import annotations

import math

import msgspec

from base_station.fusion.fixes.outliers import Outliers, Shape
from base_station.fusion.fixes.sky import common_m2
from base_station.fusion.parameters import Parameters
from base_station.fusion.path.recent_path import OwnPlace
from base_station.fusion.port import PlaceFix
from shared.clock import NS_PER_S

SURPRISE_LEAST, SURPRISE_MOST = 1.0, 8.0
# Chi-square of 2 degrees of freedom from which a fix is worse than it claims: at this rate of
# forgiving, those that are just as they claim leave no surprise on the mean.
SURPRISED = 4.85
FORGIVEN = 0.97  # of a surprise is left after a fix
FRESH_PART = 0.4  # of a receiver's own variance, before it is learnt: new with every fix
FRESH_FIXES = 15.0  # which is worth so many pairs of fixes
FRESH_LEAST = 0.1
FRESH_KEPT = 200.0  # pairs that are remembered
FRESH_MOST = 4.0
IN_A_ROW_NS = 3 * NS_PER_S
EXCESS = 2.0  # what a receiver admits beyond its usual accuracy is but half of it


class FixTrust(msgspec.Struct):
    last_fix_m: tuple[float, float] | None = None
    same_fixes: int = 0
    same_since_m: float = 0.0  # distance walked when the fix last changed
    distrust: int = 0  # grows by one with a fix that does not fit, falls by two with one that does
    outliers: Outliers = msgspec.field(default_factory=Outliers)
    best_own_m2: float = math.inf  # least variance of its own claimed by a fix that was taken
    surprise: float = 1.0  # how much worse fixes fit than they claim, as a variance
    before: tuple[PlaceFix, OwnPlace] | None = None  # the last fix and the own path's place then
    fresh_sum: float = FRESH_FIXES * FRESH_PART
    fresh_pairs: float = FRESH_FIXES

    def is_stuck(self, kind: Parameters, fix: PlaceFix, walked_m: float) -> bool:
        """The very same place again and again while the wearer walks on."""
        place = fix.seen_m or (fix.north_m, fix.east_m)
        if self.last_fix_m != place:
            self.last_fix_m, self.same_fixes, self.same_since_m = place, 1, walked_m
            return False
        self.same_fixes += 1
        return self.same_fixes >= kind.stuck_fixes and walked_m - self.same_since_m > kind.stuck_m

    def fits(self) -> bool:
        """Note a fix within the gate; False while the receiver was wrong just before."""
        if self.distrust > 0:
            self.distrust -= 2
            return False
        self.outliers.clear()
        return True

    def own_m2(self, fix: PlaceFix) -> float:
        """Variance of what the receiver errs by itself where nothing disturbs it."""
        return min(self.best_own_m2, self._claimed_m2(fix))

    def believe(self, fix: PlaceFix) -> None:
        """Note a fix that was taken; what one claims that was turned away tells nothing."""
        self.best_own_m2 = self.own_m2(fix)

    def lose_path(self) -> None:
        """No fix and no place of the own path of before can be held against those to come."""
        self.last_fix_m, self.before = None, None
        self.outliers.clear()

    @property
    def fresh_part(self) -> float:
        """Of the own variance: what is new with every fix, and not slow."""
        return min(max(self.fresh_sum / self.fresh_pairs, FRESH_LEAST), 1.0)

    def compare_pair(self, fix: PlaceFix, then: OwnPlace) -> None:
        """Two fixes in a row differ from the way between them by what is new with each: whatever
        the heading, their squared distance is the way's and four such variances on the mean.
        """
        before, self.before = self.before, (fix, then)
        if before is None or not 0 < fix.t_mono_ns - before[0].t_mono_ns < IN_A_ROW_NS:
            return
        (last, was) = before
        apart_m2 = (fix.north_m - last.north_m) ** 2 + (fix.east_m - last.east_m) ** 2
        way_m2 = (then.north_m - was.north_m) ** 2 + (then.east_m - was.east_m) ** 2
        part = min((apart_m2 - way_m2) / (4.0 * self._claimed_m2(fix)), FRESH_MOST)
        keep = 1.0 - 1.0 / FRESH_KEPT
        self.fresh_sum = keep * self.fresh_sum + part
        self.fresh_pairs = keep * self.fresh_pairs + 1.0

    def common_m2(self, fix: PlaceFix) -> float:
        """Variance of what everybody's fixes err by alike."""
        return common_m2(fix.horizontal_std_m) if fix.common_m2 is None else fix.common_m2

    def doubt_m2(self, fix: PlaceFix, walls_std_m: float) -> float:
        """Variance beyond that."""
        best_m2 = self.own_m2(fix) + self.common_m2(fix)
        excess_m2 = EXCESS**2 * (fix.horizontal_std_m**2 - best_m2)
        return excess_m2 + walls_std_m**2 + best_m2 * max(0.0, self.surprise - 1.0)

    def compare(self, distance2: float) -> None:
        """Learn from how far a fix lies off; slowly forgiven."""
        more = max(FORGIVEN, distance2 / SURPRISED)
        self.surprise = min(SURPRISE_MOST, max(SURPRISE_LEAST, self.surprise * more))

    def misses(self, kind: Parameters, fix: PlaceFix, own_m: tuple[float, float]) -> Shape | None:
        """Note a fix outside the gate; the shape of the walk where such fixes draw it."""
        self.distrust = min(self.distrust + 1, kind.distrust_most)
        shape = self.outliers.add((fix.north_m, fix.east_m), own_m)
        if shape is not None:
            self.outliers.clear()
            self.distrust = 0
        return shape

    def _claimed_m2(self, fix: PlaceFix) -> float:
        """Variance of what the receiver says that it errs by itself."""
        return fix.horizontal_std_m**2 - self.common_m2(fix)
