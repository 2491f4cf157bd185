"""What a satellite fix has to stand up to before it is taken.

A receiver that hangs is noticed, one that was wrong just now is not believed at once, and how much
worse fixes fit than they claim is learnt as they come.
"""

from __future__ import annotations

import math

import msgspec

from base_station.fusion.fixes.outliers import Outliers, Shape
from base_station.fusion.fixes.sky import COMMON_PART
from base_station.fusion.parameters import Parameters
from base_station.fusion.port import PlaceFix

SURPRISE_LEAST, SURPRISE_MOST = 1.06, 8.0
SURPRISED = 3.0  # chi-square of 2 degrees of freedom from which a fix is worse than it claims
FORGIVEN = 0.97  # of a surprise is left after a fix
EXCESS = 2.0  # what a receiver admits beyond its usual accuracy is but half of it


class FixTrust(msgspec.Struct):
    last_fix_m: tuple[float, float] | None = None
    same_fixes: int = 0
    same_since_m: float = 0.0  # distance walked when the fix last changed
    distrust: int = 0  # grows by one with a fix that does not fit, falls by two with one that does
    outliers: Outliers = msgspec.field(default_factory=Outliers)
    best_std_m: float = math.inf  # the best that the receiver ever claimed
    surprise: float = 1.0  # how much worse fixes fit than they claim, as a variance

    def is_stuck(self, kind: Parameters, fix: PlaceFix, walked_m: float) -> bool:
        """The very same place again and again while the wearer walks on."""
        place = (fix.north_m, fix.east_m)
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

    def best_m(self, fix: PlaceFix) -> float:
        """The receiver's accuracy where nothing disturbs it."""
        self.best_std_m = min(self.best_std_m, fix.horizontal_std_m)
        return self.best_std_m

    def common_m2(self, fix: PlaceFix) -> float:
        """Variance of what everybody's fixes err by alike."""
        return COMMON_PART * self.best_m(fix) ** 2 if fix.common_m2 is None else fix.common_m2

    def doubt_m2(self, fix: PlaceFix, walls_std_m: float) -> float:
        """Variance beyond that."""
        best_m2 = self.best_std_m**2
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
