"""Horizontal filter with map matching: north and east of one unit near a building with a plan.

Away from the building ``HorizontalFilter`` estimates alone.  Near it and in it a
``MapParticleFilter`` (the cloud) runs beside it and gives the estimate; away from the building
again the filter goes on from the moments of the cloud.  A cloud that walls contradict step after
step, or that they obstruct where the filter cannot be, is dropped: the filter, which uses no walls,
remains with its own covariance.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.gaussian import jeffrey_update
from base_station.fusion.horizontal.compass_aided import CompassAidedFilter, SavedCompassAided
from base_station.fusion.horizontal.heading_hypotheses import GnssObservation
from base_station.fusion.horizontal.map_particle_filter import MapParticleFilter, SavedMapParticles
from base_station.fusion.horizontal.plan_doubt import mixture, part_without_plan
from base_station.fusion.horizontal.state import place_jacobian, turn_and_std
from base_station.fusion.interface import CompassHeading
from base_station.fusion.kernels import DRIFT, HorizontalEstimate, estimate_before
from base_station.site.floor_grid import FloorGrid

Floats = NDArray[np.float64]

NEAR_M = 8.0  # of the outline: a cloud may begin
AWAY_M = 14.0  # and ends
BEGIN_STD_M = 6.0  # known as well as this, or a cloud would be too thin
BEGIN_TURN_RAD = 0.35
ASTRAY2 = 13.8  # squared distance from the filter, chi-square of two degrees of freedom: 0.1 %
RETRY_M = 25.0  # walked after a cloud was given up until another begins


class SavedMapAided(msgspec.Struct, frozen=True):
    plain: SavedCompassAided
    cloud: SavedMapParticles | None
    clouds: int
    to_walk_m: float
    floor: int | None


class MapAidedFilter:
    """Horizontal filter with the interface of ``HorizontalFilter`` and the walls of a plan."""

    def __init__(self, plain: CompassAidedFilter) -> None:
        self._plain = plain
        self._cloud: MapParticleFilter | None = None
        self._clouds = 0  # begun so far: the seed of the next
        self._to_walk_m = 0.0
        self._floor: int | None = None
        self._grid: FloorGrid | None = None

    def save(self) -> SavedMapAided:
        cloud = None if self._cloud is None else self._cloud.save()
        return SavedMapAided(self._plain.save(), cloud, self._clouds, self._to_walk_m, self._floor)

    def load(self, saved: SavedMapAided) -> None:
        self._plain.load(saved.plain)
        self._cloud = None if saved.cloud is None else MapParticleFilter.restore(saved.cloud)
        self._clouds, self._to_walk_m = saved.clouds, saved.to_walk_m
        self._floor = saved.floor

    @property
    def storeys_down_m(self) -> tuple[float, ...]:
        """Heights of the plan's storeys (down); empty without a plan."""
        return () if self._grid is None else self._grid.plan.storeys_down_m

    def set_map(self, grid: FloorGrid | None) -> None:
        """Set the plan's grid. With another plan the cloud goes on as far as it fits; one that a
        wrong plan held in wrong rooms is relocalised.
        """
        if grid is None:
            self._cloud = None
        elif self._grid is not None and self._cloud is not None:
            self._cloud.set_map(grid)
        self._grid = grid

    def select_floor(self, down_m: float) -> None:
        """Select the floor, and with it the walls, by height."""
        if self._grid is not None:
            self._floor = self._grid.plan.floor_at(down_m, self._floor)

    def distance_outside_m(self, north_m: float = 0.0, east_m: float = 0.0) -> float:
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
        """Standard deviation of the drift rate."""
        _, covariance = self.moments()
        return math.sqrt(max(float(covariance[DRIFT, DRIFT]), 0.0))

    def moments(self) -> tuple[Floats, Floats]:
        """Mean (9,) and covariance (9, 9) of the state of ``HorizontalFilter``."""
        if self._cloud is None:
            return self._plain.moments()
        part = part_without_plan(self._cloud.wall_log_loss) if self._plain.is_linear else 0.0
        walled = self._cloud.moments()
        return mixture(part, self._plain.moments(), walled) if part else walled

    def estimate_before(self, north_m: float, east_m: float) -> HorizontalEstimate:
        """Estimate before this much of own path was walked."""
        if self._cloud is None:
            return self._plain.estimate_before(north_m, east_m)
        return HorizontalEstimate(*estimate_before(*self.moments(), north_m, east_m))

    def place_before(self, north_m: float, east_m: float) -> tuple[Floats, Floats]:
        """Place and covariance before this much of own path was walked, as it looks now."""
        mean, covariance = self.moments()
        back = place_jacobian(north_m, east_m)
        return back @ mean, back @ covariance @ back.T

    @property
    def is_plain(self) -> bool:
        """True where no walls are used and one heading is left."""
        return self._cloud is None and self._plain.is_linear

    @property
    def is_split(self) -> bool:
        """Walls leave more than one place open."""
        return self._cloud is not None and self._cloud.is_split

    def set_place_before(
        self, north_m: float, east_m: float, place: Floats, covariance: Floats
    ) -> None:
        """Condition the state on the place before this much of own path was walked; only where the
        filter is plain.
        """
        observe = place_jacobian(north_m, east_m)
        self._plain.set_state(*jeffrey_update(*self._plain.moments(), observe, place, covariance))

    def set_heading(self, turn_rad: float, variance: float) -> None:
        """Condition the state on the turn of the own frame; only where the filter is plain."""
        self._plain.set_heading(turn_rad, variance)

    def update_compass(self, heading: CompassHeading, *, assumed: bool) -> None:
        """Update with a compass heading; not while walls give a better one."""
        if self._cloud is None:
            self._plain.update_compass(heading, assumed=assumed)

    def reset_compass(self) -> None:
        """The unit has begun anew, and with it its compass."""
        self._plain.reset_compass()

    def turn(self) -> tuple[float, float]:
        """Heading correction and its standard deviation, pi where it is not known."""
        return turn_and_std(*self.moments())

    def set_start(
        self, place_m: tuple[float, float], std_m: float, heading_rad: float, heading_std_rad: float
    ) -> None:
        self._cloud = None
        self._plain.set_start(place_m, std_m, heading_rad, heading_std_rad)

    def set_posterior(self, mean: Floats, covariance: Floats) -> None:
        """Replace the state; the cloud is reweighted to it, and dropped where it lies elsewhere."""
        if self._cloud is not None and not self._cloud.reweight_to(mean, covariance):
            self._cloud = None
        self._plain.set_posterior(mean, covariance)

    def reset_heading(self) -> None:
        self._cloud = None
        self._plain.reset_heading()

    def reset_place(self) -> None:
        self._cloud = None
        self._plain.reset_place()

    def set_scale_std(self, std: float) -> None:
        """Set the prior deviation of the scale; a cloud, drawn by the one before, ends."""
        self._cloud = None
        self._plain.set_scale_std(std)

    def set_drift_std(self, std_radps: float) -> None:
        share = self._plain.set_drift_std(std_radps)
        if self._cloud is not None and share < 1.0:
            self._cloud.scale_drift(share)

    def predict(
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
        self._plain.predict(north_m, east_m, moving_s, place_var_m2, turn_var)
        if self._grid is None:
            return
        if self._cloud is not None:
            self._cloud.predict(path, noise, self._grid, self._floor)
            if self._cloud.is_doubtful and self._plain.is_linear:
                self._cloud.try_relocalise(self._plain.moments(), self._grid)
        self._to_walk_m -= math.hypot(north_m, east_m)
        if self._to_walk_m <= 0.0:
            self._to_walk_m = 1.0
            self._start_or_stop_cloud()

    def _start_or_stop_cloud(self) -> None:
        """Begin or end the cloud."""
        assert self._grid is not None
        distance_outside_m = self.distance_outside_m()
        if self._cloud is None:
            if distance_outside_m < NEAR_M and self._is_known():
                self._clouds += 1
                self._cloud = MapParticleFilter(*self._plain.moments(), self._clouds)
        elif self._cloud.is_contradicted or self._is_astray(self._cloud):
            self._cloud = None
            self._to_walk_m = RETRY_M
        elif distance_outside_m > AWAY_M:
            self._plain.set_state(*self.moments())
            self._cloud = None

    def _is_astray(self, cloud: MapParticleFilter) -> bool:
        """True where walls obstruct, in a place that the path cannot have reached."""
        if not (cloud.is_obstructed and self._plain.is_linear):
            return False
        mean, covariance = self._plain.moments()
        apart = cloud.moments()[0][:2] - mean[:2]
        return float(apart @ np.linalg.solve(covariance[:2, :2], apart)) > ASTRAY2

    def _is_known(self) -> bool:
        if not self._plain.is_linear:
            return False
        mean, covariance = self._plain.moments()
        std_m = math.sqrt(max(covariance[0, 0], covariance[1, 1]))
        return std_m < BEGIN_STD_M and turn_and_std(mean, covariance)[1] < BEGIN_TURN_RAD

    def inflate_place(self, variance_m2: float) -> None:
        self._plain.inflate_place(variance_m2)
        if self._cloud is not None:
            self._cloud.inflate_place(variance_m2)

    def decay_slow_errors(self, keeps: Floats) -> None:
        self._plain.decay_slow_errors(keeps)
        if self._cloud is not None:
            self._cloud.decay_slow_errors(keeps)

    def distance2(self, observation: GnssObservation) -> float:
        """Squared distance to the estimate, or to the one without a compass where that is less."""
        distance2 = self._plain.distance2(observation)
        if self._cloud is None:
            return distance2
        walled2 = self._cloud.distance2(observation)
        return min(walled2, distance2) if self._plain.is_contested else walled2

    def update(self, observation: GnssObservation) -> None:
        was_refuted = self._plain.is_compass_rejected
        self._plain.update(observation)
        if self._plain.is_compass_rejected and not was_refuted:
            self._cloud = None  # its heading was the compass's
        if self._cloud is not None:
            self._cloud.update(observation)

    def reframe(self, turn_rad: float, north_m: float, east_m: float) -> None:
        """The cloud, if any, is taken up by the filter first: its walls stay where they are."""
        if self._cloud is not None:
            self._plain.set_state(*self.moments())
            self._cloud = None
        self._plain.reframe(turn_rad, north_m, east_m)
