"""Receiver model: how far a receiver's fixes are worse than stated, learnt as they come.

A receiver that repeats one position while the wearer walks is stuck; after rejected fixes the next
ones are accepted only after a while; an inflation factor scales the stated variance by the
innovations.
"""

from __future__ import annotations

import math

import msgspec

from base_station.fusion.gnss.common_mode_error import common_m2
from base_station.fusion.gnss.outliers import Outliers, WalkShape
from base_station.fusion.interface import PlaceFix
from base_station.fusion.odometry.recent_path import PathPoint
from base_station.fusion.parameters import Parameters
from shared.clock import NS_PER_S

MIN_INFLATION, MAX_INFLATION = 1.0, 8.0
# Chi-square of 2 degrees of freedom from which a fix is worse than it claims: at this rate of
# forgiving, those that are just as they claim leave no surprise on the mean.
CONSISTENT_CHI2 = 4.85
INFLATION_DECAY = 0.97  # of a surprise is left after a fix
WHITE_PART = 0.4  # of a receiver's own variance, before it is learnt: new with every fix
WHITE_PRIOR_PAIRS = 15.0  # which is worth so many pairs of fixes
MIN_WHITE_PART = 0.1
WHITE_MEMORY_PAIRS = 200.0  # pairs that are remembered
MAX_WHITE_PART = 4.0
IN_A_ROW_NS = 3 * NS_PER_S
EXCESS = 2.0  # a receiver's excess over its usual accuracy is only half of the error


class ReceiverModel(msgspec.Struct):
    last_fix_m: tuple[float, float] | None = None
    same_fixes: int = 0
    same_since_m: float = 0.0  # distance walked when the fix last changed
    rejected_count: int = (
        0  # grows by one with a fix that does not fit, falls by two with one that does
    )
    outliers: Outliers = msgspec.field(default_factory=Outliers)
    best_own_m2: float = math.inf  # least variance of its own claimed by a fix that was taken
    inflation: float = 1.0  # how much worse fixes fit than they claim, as a variance
    previous: tuple[PlaceFix, PathPoint] | None = None  # the last fix and the own path's place then
    white_sum: float = WHITE_PRIOR_PAIRS * WHITE_PART
    white_pairs: float = WHITE_PRIOR_PAIRS

    def is_stuck(self, kind: Parameters, fix: PlaceFix, walked_m: float) -> bool:
        """The very same place again and again while the wearer walks on."""
        place = fix.uncorrected_m or (fix.north_m, fix.east_m)
        if self.last_fix_m != place:
            self.last_fix_m, self.same_fixes, self.same_since_m = place, 1, walked_m
            return False
        self.same_fixes += 1
        return self.same_fixes >= kind.stuck_fixes and walked_m - self.same_since_m > kind.stuck_m

    def on_within_gate(self) -> bool:
        """Note a fix within the gate; False while the receiver was wrong just before."""
        if self.rejected_count > 0:
            self.rejected_count -= 2
            return False
        self.outliers.clear()
        return True

    def own_m2(self, fix: PlaceFix) -> float:
        """Variance of what the receiver errs by itself where nothing disturbs it."""
        return min(self.best_own_m2, self._claimed_m2(fix))

    def on_accepted(self, fix: PlaceFix) -> None:
        """Learn from an accepted fix; accuracies claimed by rejected fixes are not used."""
        self.best_own_m2 = self.own_m2(fix)

    def forget_path(self) -> None:
        """No fix and no place of the own path of before can be held against those to come."""
        self.last_fix_m, self.previous = None, None
        self.outliers.clear()

    @property
    def white_part(self) -> float:
        """Part of the own variance that is new with every fix; the rest is slow."""
        return min(max(self.white_sum / self.white_pairs, MIN_WHITE_PART), 1.0)

    def update_white_part(self, fix: PlaceFix, then: PathPoint) -> None:
        """Two fixes in a row differ from the way between them by what is new with each: whatever
        the heading, their squared distance is the way's and four such variances on the mean.
        """
        previous, self.previous = self.previous, (fix, then)
        if previous is None or not 0 < fix.t_mono_ns - previous[0].t_mono_ns < IN_A_ROW_NS:
            return
        (last, was) = previous
        apart_m2 = (fix.north_m - last.north_m) ** 2 + (fix.east_m - last.east_m) ** 2
        way_m2 = (then.north_m - was.north_m) ** 2 + (then.east_m - was.east_m) ** 2
        part = min((apart_m2 - way_m2) / (4.0 * self._claimed_m2(fix)), MAX_WHITE_PART)
        keep = 1.0 - 1.0 / WHITE_MEMORY_PAIRS
        self.white_sum = keep * self.white_sum + part
        self.white_pairs = keep * self.white_pairs + 1.0

    def common_m2(self, fix: PlaceFix) -> float:
        """Variance of the common-mode error of a fix, each axis."""
        return common_m2(fix.horizontal_std_m) if fix.common_m2 is None else fix.common_m2

    def extra_m2(self, fix: PlaceFix, walls_std_m: float) -> float:
        """Variance beyond that."""
        best_m2 = self.own_m2(fix) + self.common_m2(fix)
        excess_m2 = EXCESS**2 * (fix.horizontal_std_m**2 - best_m2)
        return excess_m2 + walls_std_m**2 + best_m2 * max(0.0, self.inflation - 1.0)

    def update_inflation(self, distance2: float) -> None:
        """Learn from how far a fix lies off; slowly forgiven."""
        more = max(INFLATION_DECAY, distance2 / CONSISTENT_CHI2)
        self.inflation = min(MAX_INFLATION, max(MIN_INFLATION, self.inflation * more))

    def on_rejected(
        self, kind: Parameters, fix: PlaceFix, own_m: tuple[float, float]
    ) -> WalkShape | None:
        """Note a fix outside the gate; the shape of the walk where such fixes draw it."""
        self.rejected_count = min(self.rejected_count + 1, kind.max_rejected_count)
        shape = self.outliers.add((fix.north_m, fix.east_m), own_m)
        if shape is not None:
            self.outliers.clear()
            self.rejected_count = 0
        return shape

    def _claimed_m2(self, fix: PlaceFix) -> float:
        """Stated variance without the common-mode part."""
        return fix.horizontal_std_m**2 - self.common_m2(fix)
