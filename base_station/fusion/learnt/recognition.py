"""Where a unit's own path shows what was learnt of the building: it goes by it and adds to it."""

from __future__ import annotations

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.conditioning import conservative_fusion
from base_station.fusion.kernels import Stretch
from base_station.fusion.learnt.axes import AxisFilter
from base_station.fusion.learnt.building import LearntBuilding
from base_station.fusion.learnt.legs import Drift, Leg, LegWatch
from base_station.fusion.learnt.stairs import SHARED_M2, STD_M, Climb, ClimbWatch, Stairs
from base_station.fusion.plane.state import DRIFT, turn_of
from base_station.fusion.plane.walled_filter import WalledFilter

Floats = NDArray[np.float64]


class Recognition(msgspec.Struct):
    """What one unit's path shows."""

    climbs: ClimbWatch = msgspec.field(default_factory=ClimbWatch)
    legs: LegWatch = msgspec.field(default_factory=LegWatch)
    axis: AxisFilter = msgspec.field(default_factory=AxisFilter)
    climb: Climb | None = None  # just over
    leg: Leg | None = None
    moved_s: float = 0.0  # how long the wearer has moved
    heard: bool = False  # of stairs: the own place is not the own word any more
    shared_m2: float = SHARED_M2  # of the own place's variance: by which everybody errs alike

    def follow(self, stretch: Stretch, down_m: float) -> None:
        self.climb = self.climbs.follow(stretch.north_m, stretch.east_m, down_m)
        self.leg = self.legs.follow(stretch.north_m, stretch.east_m)
        self.moved_s += stretch.moving_s

    def forget(self) -> None:
        """Place and heading are known anew; or another own frame begins."""
        self.axis, self.heard = AxisFilter(), False
        self.climb = self.leg = None

    def hear_fix(self, common_m2: float) -> None:
        """Whatever ties everybody to the frame best, a start or fixes, is what they share."""
        self.shared_m2 = min(self.shared_m2, common_m2)

    def go_by(
        self, unit_id: str, learnt: LearntBuilding, horizontal: WalledFilter, *, inside: bool
    ) -> LearntBuilding:
        """Correct the filter; gives what is learnt then.  Outside fixes tell more, and slopes and
        ways are no stairs and walls.
        """
        climb, leg = self.climb, self.leg
        if climb is None and leg is None:
            return learnt
        self.climb = self.leg = None
        if not inside:
            self.axis = AxisFilter()  # the next building may stand at another angle
        if not (inside and horizontal.is_plain):
            return learnt
        if climb is not None:
            learnt = self._climbed(unit_id, climb, learnt, horizontal)
        if leg is not None:
            learnt = self._walked(unit_id, leg, learnt, horizontal)
        return learnt

    def _climbed(
        self, unit_id: str, climb: Climb, learnt: LearntBuilding, horizontal: WalledFilter
    ) -> LearntBuilding:
        since = climb.since_north_m, climb.since_east_m
        place, covariance = horizontal.place_before(*since)
        seen = Stairs.at(climb, place, covariance, self.shared_m2)
        row = learnt.which(seen)
        if row is None:
            return learnt
        if row < 0 or not self.heard:
            learnt = learnt.with_stairs(row, unit_id, seen)
        if row >= 0:
            known, noise = learnt.stairs[row].mean, STD_M**2 * np.eye(2)
            place, covariance = conservative_fusion(place, covariance, *known.place, noise)
            horizontal.stand_then(*since, place, covariance)
            self.heard = True
        return learnt

    def _walked(
        self, unit_id: str, leg: Leg, learnt: LearntBuilding, horizontal: WalledFilter
    ) -> LearntBuilding:
        mean, covariance = horizontal.moments()
        turn_rad, std_rad = turn_of(mean, covariance)
        drift = Drift(float(mean[DRIFT]), max(float(covariance[DRIFT, DRIFT]), 0.0))
        leg = msgspec.structs.replace(leg, moved_s=self.moved_s)
        was_known = self.axis.axis is not None
        known = None if self.axis.apart else learnt.axis
        turned = self.axis.look(leg, turn_rad, std_rad**2, known, drift)
        if self.axis.axis is not None and not was_known:
            learnt = learnt.with_axis(unit_id, self.axis.axis)
        axis = learnt.axis
        if axis is not None and not self.axis.apart:
            turned = self.axis.hear(axis, *turned)
        if turned != (turn_rad, std_rad**2):
            horizontal.face(*turned)
        return learnt
