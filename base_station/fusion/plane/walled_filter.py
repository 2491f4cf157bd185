"""North and east of one unit where a plan may say what stands in the way.

Away from the building ``HorizontalFilter`` is all there is.  Near it and in it a ``WallParticles``
goes beside it and leads; when it comes away from the building again the filter goes on from what
the cloud came to.  A cloud that the walls contradict move after move is given up: then the filter,
which never heard of walls, is what is left, as wide as it is.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.conditioning import jeffrey_update
from base_station.fusion.kernels import Placed, placed_before
from base_station.fusion.plane.compassed_filter import CompassedFilter, SavedCompassed
from base_station.fusion.plane.heading_bank import Sighting
from base_station.fusion.plane.state import DRIFT, place_then, turn_of
from base_station.fusion.plane.wall_particles import SavedParticles, WallParticles
from base_station.fusion.port import Bearing
from base_station.site.floor_grid import FloorGrid

Floats = NDArray[np.float64]

NEAR_M = 8.0  # of the outline: a cloud may begin
AWAY_M = 14.0  # and ends
BEGIN_STD_M = 6.0  # known as well as this, or a cloud would be too thin
BEGIN_TURN_RAD = 0.35
REPENT_M = 25.0  # walked after a cloud was given up until another begins


class SavedWalled(msgspec.Struct, frozen=True):
    plain: SavedCompassed
    cloud: SavedParticles | None
    clouds: int
    to_walk_m: float
    floor: int | None


class WalledFilter:
    """The same questions as ``HorizontalFilter`` answers, walls considered."""

    def __init__(self, plain: CompassedFilter) -> None:
        self._plain = plain
        self._cloud: WallParticles | None = None
        self._clouds = 0  # begun so far: the seed of the next
        self._to_walk_m = 0.0
        self._floor: int | None = None
        self._grid: FloorGrid | None = None

    def save(self) -> SavedWalled:
        cloud = None if self._cloud is None else self._cloud.save()
        return SavedWalled(self._plain.save(), cloud, self._clouds, self._to_walk_m, self._floor)

    def load(self, saved: SavedWalled) -> None:
        self._plain.load(saved.plain)
        self._cloud = None if saved.cloud is None else WallParticles.restore(saved.cloud)
        self._clouds, self._to_walk_m = saved.clouds, saved.to_walk_m
        self._floor = saved.floor

    @property
    def storeys_down_m(self) -> tuple[float, ...]:
        """Of the building, where a plan is known."""
        return () if self._grid is None else self._grid.plan.storeys_down_m

    def consider(self, grid: FloorGrid | None) -> None:
        """Of another plan than before, the cloud goes on as far as it fits that: one that a wrong
        plan held in the wrong rooms is asked for elsewhere.
        """
        if grid is None:
            self._cloud = None
        elif self._grid is not None and self._cloud is not None:
            self._cloud.consider(grid)
        self._grid = grid

    def stand_at(self, down_m: float) -> None:
        """The height says on which storey the wearer is, and whose walls stand in the way."""
        if self._grid is not None:
            self._floor = self._grid.plan.floor_at(down_m, self._floor)

    def outside_m(self, north_m: float = 0.0, east_m: float = 0.0) -> float:
        """Distance to the building before this much of own path was walked, negative inside; far
        where no plan is known.
        """
        if self._grid is None:
            return math.inf
        mean, _ = self.moments()
        c, s = float(mean[2]), float(mean[3])
        at_north_m = float(mean[0]) - c * north_m + s * east_m
        at_east_m = float(mean[1]) - s * north_m - c * east_m
        return -self._grid.plan.depth_m(at_north_m, at_east_m)

    @property
    def drift_std_radps(self) -> float:
        """Of what is known of the own heading's drift rate."""
        _, covariance = self.moments()
        return math.sqrt(max(float(covariance[DRIFT, DRIFT]), 0.0))

    def moments(self) -> tuple[Floats, Floats]:
        """Mean (9,) and covariance (9, 9) of the state of ``HorizontalFilter``."""
        return self._plain.moments() if self._cloud is None else self._cloud.moments()

    def placed_before(self, north_m: float, east_m: float) -> Placed:
        """As ``place_before``, in numbers, and how the own frame is turned."""
        if self._cloud is None:
            return self._plain.placed_before(north_m, east_m)
        return Placed._make(placed_before(*self._cloud.moments(), north_m, east_m))

    def place_before(self, north_m: float, east_m: float) -> tuple[Floats, Floats]:
        """Place and covariance before this much of own path was walked, as it looks now."""
        mean, covariance = self.moments()
        back = place_then(north_m, east_m)
        return back @ mean, back @ covariance @ back.T

    @property
    def is_plain(self) -> bool:
        """No walls are heeded, and one heading is left."""
        return self._cloud is None and self._plain.is_linear

    @property
    def is_split(self) -> bool:
        """Walls leave more than one place open."""
        return self._cloud is not None and self._cloud.is_split

    def stand_then(self, north_m: float, east_m: float, place: Floats, covariance: Floats) -> None:
        """Where the wearer was before this much of own path was walked has come to be known as
        this; only where the filter is plain.
        """
        observe = place_then(north_m, east_m)
        self._plain.adopt(*jeffrey_update(*self._plain.moments(), observe, place, covariance))

    def face(self, turn_rad: float, variance: float) -> None:
        """The own frame's turn has come to be known as this; only where the filter is plain."""
        self._plain.face(turn_rad, variance)

    def go_by(self, bearing: Bearing, *, assumed: bool) -> None:
        """Hear a compass; among walls they know better."""
        if self._cloud is None:
            self._plain.go_by(bearing, assumed=assumed)

    def hear_anew(self) -> None:
        """The unit has begun anew, and with it its compass."""
        self._plain.hear_anew()

    def turn(self) -> tuple[float, float]:
        """Heading correction and its standard deviation, pi where it is not known."""
        return turn_of(*self.moments())

    def begin(
        self, place_m: tuple[float, float], std_m: float, heading_rad: float, heading_std_rad: float
    ) -> None:
        self._cloud = None
        self._plain.begin(place_m, std_m, heading_rad, heading_std_rad)

    def settle(self, mean: Floats, covariance: Floats) -> None:
        """What walls have told is kept, unless it is of another place."""
        if self._cloud is not None and not self._cloud.agree(mean, covariance):
            self._cloud = None
        self._plain.settle(mean, covariance)

    def forget_heading(self) -> None:
        self._cloud = None
        self._plain.forget_heading()

    def forget_place(self) -> None:
        self._cloud = None
        self._plain.forget_place()

    def expect_drift(self, std_radps: float) -> None:
        share = self._plain.expect_drift(std_radps)
        if self._cloud is not None and share < 1.0:
            self._cloud.ease_drift(share)

    def walk(
        self,
        path: tuple[float, float, float, float],
        place_var_m2: float,
        turn_var: float,
        noise: tuple[float, float],
    ) -> None:
        """``path``: own north and east, seconds moving, metres climbed; then the variances of
        this stretch, and those of place and turn by metre.
        """
        north_m, east_m, moving_s, _ = path
        self._plain.walk(north_m, east_m, moving_s, place_var_m2, turn_var)
        if self._grid is None:
            return
        if self._cloud is not None:
            self._cloud.walk(path, noise, self._grid, self._floor)
            if self._cloud.is_doubtful and self._plain.is_linear:
                self._cloud.look_elsewhere(self._plain.moments(), self._grid)
        self._to_walk_m -= math.hypot(north_m, east_m)
        if self._to_walk_m <= 0.0:
            self._to_walk_m = 1.0
            self._reconsider()

    def _reconsider(self) -> None:
        """Begin or end the cloud."""
        assert self._grid is not None
        outside_m = self.outside_m()
        if self._cloud is None:
            if outside_m < NEAR_M and self._is_known():
                self._clouds += 1
                self._cloud = WallParticles(*self._plain.moments(), self._clouds)
        elif self._cloud.is_contradicted:
            self._cloud = None
            self._to_walk_m = REPENT_M
        elif outside_m > AWAY_M:
            self._plain.adopt(*self._cloud.moments())
            self._cloud = None

    def _is_known(self) -> bool:
        if not self._plain.is_linear:
            return False
        mean, covariance = self._plain.moments()
        std_m = math.sqrt(max(covariance[0, 0], covariance[1, 1]))
        return std_m < BEGIN_STD_M and turn_of(mean, covariance)[1] < BEGIN_TURN_RAD

    def spread(self, variance_m2: float) -> None:
        self._plain.spread(variance_m2)
        if self._cloud is not None:
            self._cloud.spread(variance_m2)

    def fade(self, keeps: Floats) -> None:
        self._plain.fade(keeps)
        if self._cloud is not None:
            self._cloud.fade(keeps)

    def distance2(self, sighting: Sighting) -> float:
        """To what is believed; or, if nearer, to what would be without a compass."""
        distance2 = self._plain.distance2(sighting)
        if self._cloud is None:
            return distance2
        walled2 = self._cloud.distance2(sighting)
        return min(walled2, distance2) if self._plain.is_contested else walled2

    def update(self, sighting: Sighting) -> None:
        was_refuted = self._plain.is_refuted
        self._plain.update(sighting)
        if self._plain.is_refuted and not was_refuted:
            self._cloud = None  # its heading was the compass's
        if self._cloud is not None:
            self._cloud.update(sighting)

    def reframe(self, turn_rad: float, north_m: float, east_m: float) -> None:
        """The cloud, if any, is taken up by the filter first: its walls stay where they are."""
        if self._cloud is not None:
            self._plain.adopt(*self._cloud.moments())
            self._cloud = None
        self._plain.reframe(turn_rad, north_m, east_m)
