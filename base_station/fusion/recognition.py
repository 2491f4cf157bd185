"""Where a unit's own path shows what was learnt of the building: it goes by it and adds to it."""

from __future__ import annotations

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.building_axes import AxisFilter, Leg, LegWatch
from base_station.fusion.learnt_building import LearntBuilding
from base_station.fusion.own_path import Stretch
from base_station.fusion.same_stairs import STD_M, Climb, ClimbWatch, Stairs
from base_station.fusion.told import taken_over
from base_station.fusion.walled import WalledFilter

Floats = NDArray[np.float64]


class Recognition(msgspec.Struct):
    """What one unit's path shows."""

    climbs: ClimbWatch = msgspec.field(default_factory=ClimbWatch)
    legs: LegWatch = msgspec.field(default_factory=LegWatch)
    axis: AxisFilter = msgspec.field(default_factory=AxisFilter)
    climb: Climb | None = None  # just over
    leg: Leg | None = None

    def follow(self, stretch: Stretch, down_m: float) -> None:
        self.climb = self.climbs.follow(stretch.north_m, stretch.east_m, down_m)
        self.leg = self.legs.follow(stretch.north_m, stretch.east_m)

    def forget(self) -> None:
        """The place or the heading is believed no more; or another own frame begins."""
        self.axis = AxisFilter()
        self.climb = self.leg = None

    def go_by(
        self, learnt: LearntBuilding, horizontal: WalledFilter, *, inside: bool
    ) -> LearntBuilding:
        """Correct the filter; gives what is learnt then."""
        climb, leg = self.climb, self.leg
        self.climb = self.leg = None
        if not horizontal.is_plain:
            return learnt
        if climb is not None:
            learnt = self._climbed(climb, learnt, horizontal)
        if leg is not None and inside:
            learnt = self._walked(leg, learnt, horizontal)
        return learnt

    def _climbed(
        self, climb: Climb, learnt: LearntBuilding, horizontal: WalledFilter
    ) -> LearntBuilding:
        since = climb.since_north_m, climb.since_east_m
        place, covariance = horizontal.place_before(*since)
        row = learnt.which(Stairs.at(climb, place, covariance))
        if row is None:
            return learnt
        if row >= 0:
            noise = STD_M**2 * np.eye(2)
            place, covariance = taken_over(place, covariance, *learnt.stairs[row].place, noise)
            horizontal.stand_then(*since, place, covariance)
        return learnt.with_stairs(row, Stairs.at(climb, place, covariance))

    def _walked(self, leg: Leg, learnt: LearntBuilding, horizontal: WalledFilter) -> LearntBuilding:
        turn_rad, std_rad = horizontal.turn()
        turned = self.axis.look(leg, turn_rad, std_rad**2)
        if learnt.axis is not None:
            turned = self.axis.hear(learnt.axis, *turned)
        if turned != (turn_rad, std_rad**2):
            horizontal.face(*turned)
        return learnt if self.axis.axis is None else learnt.with_axis(self.axis.axis)
