"""What everybody's paths have shown of a building that nobody has a plan of.

Its stairs and the direction of its walls are each known as well as whoever knew them best.  Others
take that over where their own path shows the same, and nobody becomes surer by hearing their own
word again (``told``).
"""

from __future__ import annotations

import msgspec

from base_station.fusion.building_axes import Axis, quarter
from base_station.fusion.same_stairs import Stairs

SURE_M = 6.0  # a climb that is less known than this, each axis, may be on any stairs
ODDS = 10.0  # so much likelier the same stairs than others: believed
BETTER = 0.9  # of the variance held: worth a change


class LearntBuilding(msgspec.Struct, frozen=True):
    """In the incident frame."""

    stairs: tuple[Stairs, ...] = ()
    axis: Axis | None = None

    def which(self, seen: Stairs) -> int | None:
        """The stairs that a climb was on; -1: such as nobody knows yet; None: it cannot be told."""
        if max(seen.covariance_m2[0], seen.covariance_m2[2]) > SURE_M**2:
            return None
        odds = [seen.odds(one) for one in self.stairs]
        if sum(odds) < 1.0 / ODDS:
            return -1
        best = odds.index(max(odds))
        return best if odds[best] > ODDS * (1.0 + sum(odds) - odds[best]) else None

    def with_stairs(self, row: int, seen: Stairs) -> LearntBuilding:
        """``row`` as ``which`` gives it."""
        if row < 0:
            return msgspec.structs.replace(self, stairs=(*self.stairs, seen))
        if seen.variance_m2 > BETTER * self.stairs[row].variance_m2:
            return self
        stairs = (*self.stairs[:row], seen, *self.stairs[row + 1 :])
        return msgspec.structs.replace(self, stairs=stairs)

    def with_axis(self, axis: Axis) -> LearntBuilding:
        if self.axis is not None and axis.variance > BETTER * self.axis.variance:
            return self
        return msgspec.structs.replace(self, axis=axis)

    def reframed(self, turn_rad: float, north_m: float, east_m: float) -> LearntBuilding:
        """The incident frame was moved: turned clockwise, then shifted."""
        axis = self.axis
        if axis is not None:
            axis = Axis(quarter(axis.direction_rad + turn_rad), axis.variance)
        moved = tuple(one.reframed(turn_rad, north_m, east_m) for one in self.stairs)
        return LearntBuilding(moved, axis)
