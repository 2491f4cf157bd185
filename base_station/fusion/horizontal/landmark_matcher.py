"""Landmark matcher: updates the horizontal filter by stairs and walls of the building model, and
adds to the model.
"""

from __future__ import annotations

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.building_model.building import LearntBuilding
from base_station.fusion.building_model.dominant_direction import DominantDirectionFilter
from base_station.fusion.building_model.stairs import (
    SHARED_M2,
    STD_M,
    Climb,
    ClimbDetector,
    LearntStairs,
)
from base_station.fusion.building_model.straight_segments import (
    Drift,
    SegmentDetector,
    StraightSegment,
)
from base_station.fusion.gaussian import conservative_fusion
from base_station.fusion.horizontal.map_aided import MapAidedFilter
from base_station.fusion.horizontal.state import turn_and_std
from base_station.fusion.kernels import DRIFT, OdometryIncrement

Floats = NDArray[np.float64]


class LandmarkMatcher(msgspec.Struct):
    """Detectors and filters of landmarks along one unit's path."""

    climb_detector: ClimbDetector = msgspec.field(default_factory=ClimbDetector)
    segments: SegmentDetector = msgspec.field(default_factory=SegmentDetector)
    axis: DominantDirectionFilter = msgspec.field(default_factory=DominantDirectionFilter)
    climb: Climb | None = None  # just over
    segment: StraightSegment | None = None
    moved_s: float = 0.0  # how long the wearer has moved
    is_corrected: bool = False  # of stairs: the own observation no longer counts as one's own
    shared_m2: float = SHARED_M2  # of the own place's variance: by which everybody errs alike

    def add_increment(self, increment: OdometryIncrement, down_m: float) -> None:
        self.climb = self.climb_detector.update(increment.north_m, increment.east_m, down_m)
        self.segment = self.segments.update(increment.north_m, increment.east_m)
        self.moved_s += increment.moving_s

    def forget(self) -> None:
        """Place and heading are known anew; or another own frame begins."""
        self.axis, self.is_corrected = DominantDirectionFilter(), False
        self.climb = self.segment = None

    def on_fix(self, common_m2: float) -> None:
        """Lower the shared variance: errors of start positions and fixes that all units share."""
        self.shared_m2 = min(self.shared_m2, common_m2)

    def update(
        self, unit_id: str, learnt: LearntBuilding, horizontal: MapAidedFilter, *, inside: bool
    ) -> LearntBuilding:
        """Update the filter by a finished climb or segment; returns the building model with it.
        Only inside: outside fixes are better, and slopes and paths are no stairs and walls.
        """
        climb, segment = self.climb, self.segment
        if climb is None and segment is None:
            return learnt
        self.climb = self.segment = None
        if not inside:
            self.axis = DominantDirectionFilter()  # the next building may stand at another angle
        if not (inside and horizontal.is_plain):
            return learnt
        if climb is not None:
            learnt = self._climbed(unit_id, climb, learnt, horizontal)
        if segment is not None:
            learnt = self._walked(unit_id, segment, learnt, horizontal)
        return learnt

    def _climbed(
        self, unit_id: str, climb: Climb, learnt: LearntBuilding, horizontal: MapAidedFilter
    ) -> LearntBuilding:
        since = climb.since_north_m, climb.since_east_m
        place, covariance = horizontal.place_before(*since)
        seen = LearntStairs.at(climb, place, covariance, self.shared_m2)
        row = learnt.match(seen)
        if row is None:
            return learnt
        if row < 0 or not self.is_corrected:
            learnt = learnt.with_stairs(row, unit_id, seen)
        if row >= 0:
            known, noise = learnt.stairs[row].mean, STD_M**2 * np.eye(2)
            place, covariance = conservative_fusion(place, covariance, *known.place, noise)
            horizontal.set_place_before(*since, place, covariance)
            self.is_corrected = True
        return learnt

    def _walked(
        self,
        unit_id: str,
        segment: StraightSegment,
        learnt: LearntBuilding,
        horizontal: MapAidedFilter,
    ) -> LearntBuilding:
        mean, covariance = horizontal.moments()
        turn_rad, std_rad = turn_and_std(mean, covariance)
        drift = Drift(float(mean[DRIFT]), max(float(covariance[DRIFT, DRIFT]), 0.0))
        segment = msgspec.structs.replace(segment, moved_s=self.moved_s)
        was_known = self.axis.axis is not None
        known = None if self.axis.is_contradicted else learnt.axis
        turned = self.axis.update(segment, turn_rad, std_rad**2, known, drift)
        if self.axis.axis is not None and not was_known:
            learnt = learnt.with_axis(unit_id, self.axis.axis)
        axis = learnt.axis
        if axis is not None and not self.axis.is_contradicted:
            turned = self.axis.fuse_shared(axis, *turned)
        if turned != (turn_rad, std_rad**2):
            horizontal.set_heading(*turned)
        return learnt
