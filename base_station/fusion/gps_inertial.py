"""Fuser of GNSS and inertial odometry, for any initial heading, with and without fixes.

It joins the horizontal filter (``horizontal``), the height filter (``vertical``), the errors of the
path (``odometry``) and the GNSS update (``gnss_update``), and gives the estimate with its quality.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import msgspec
import numpy as np

from base_station.fusion.building_model.building import LearntBuilding
from base_station.fusion.fuser_memory import FuserMemory
from base_station.fusion.gnss_update import GnssUpdater
from base_station.fusion.horizontal.compass_aided import CompassAidedFilter
from base_station.fusion.horizontal.landmark_matcher import LandmarkMatcher
from base_station.fusion.horizontal.map_aided import MapAidedFilter
from base_station.fusion.interface import (
    BarometricHeight,
    CompassHeading,
    FixVerdict,
    PlaceFix,
    Posterior,
    Start,
)
from base_station.fusion.kernels import HorizontalEstimate, OdometryIncrement
from base_station.fusion.odometry.odometry_increments import OdometryIncrements
from base_station.fusion.odometry.recent_path import RecentPath
from base_station.fusion.odometry.run_changes import set_back_ns
from base_station.fusion.parameters import Parameters
from base_station.fusion.path_estimates import PathEstimates
from base_station.fusion.stated_noise import with_path_noise
from base_station.fusion.vertical.height import HeightFilter
from base_station.site.floor_grid import FloorGrid
from base_station.site.max_travel import RADII_95, max_travel_m
from base_station.site.storeys import Storey
from shared.clock import NS_PER_S
from shared.messages import Position
from shared.path_noise import PathNoise

INSIDE_NS = 10 * NS_PER_S  # without a fix for as long: inside, where there is no plan


@dataclass(frozen=True, slots=True)
class GpsInertial(Parameters):
    """The kind that makes these fusers."""

    name: str = "gps-inertial"

    def new(self) -> GpsInertialFuser:
        return GpsInertialFuser(self, FuserMemory())

    def restore(self, saved: bytes) -> GpsInertialFuser:
        return GpsInertialFuser(self, msgspec.msgpack.decode(saved, type=FuserMemory))


class GpsInertialFuser(PathEstimates):
    """One unit's filter; see the module's text."""

    _kind: GpsInertial
    _memory: FuserMemory
    _previous_run: GpsInertialFuser | None

    def __init__(self, kind: GpsInertial, memory: FuserMemory) -> None:
        self._usual_kind = kind  # for a unit that states no noise of its path
        self._kind = with_path_noise(kind, memory.path_noise)
        self._memory = memory
        self._horizontal = MapAidedFilter(
            CompassAidedFilter(self._kind.scale_std, kind.linear_rad, kind.drift_wander_radps)
        )
        self._horizontal.set_drift_std(kind.drift_radps)
        self._height = HeightFilter(kind)
        self._odometry = OdometryIncrements(self._kind, memory.odometry)
        self._fixes = GnssUpdater(self._kind, memory, self._horizontal, self._height)
        self._previous_run = (
            kind.restore(memory.previous_run) if memory.previous_run else None
        )  # the run before this
        if memory.horizontal is not None and memory.height is not None:
            self._horizontal.load(memory.horizontal)
            self._height.load(memory.height)

    def save(self) -> bytes:
        self._memory.horizontal = self._horizontal.save()
        self._memory.height = self._height.save()
        self._memory.odometry = self._odometry.save()
        self._memory.previous_run = b"" if self._previous_run is None else self._previous_run.save()
        return msgspec.msgpack.encode(self._memory)

    def start(self, start: Start) -> None:
        memory = self._memory
        self._horizontal.set_start(
            (start.north_m, start.east_m), start.std_m, start.heading_rad, start.heading_std_rad
        )
        self._height.reset(start.down_m, start.std_m)
        memory.assumed = memory.height_assumed = False
        memory.receiver.outliers.clear()
        memory.landmarks.forget()
        memory.landmarks.shared_m2 = start.std_m**2
        if memory.last is not None:
            self._predict(
                OdometryIncrements(self._kind).increment(memory.last, 0.0), memory.last.std_down_m
            )

    def set_posterior(self, posterior: Posterior) -> None:
        self._horizontal.set_posterior(np.array(posterior.mean), np.array(posterior.covariance))
        if posterior.down_std_m is not None:
            self._height.reset(self._height.down_m + posterior.down_shift_m, posterior.down_std_m)
            self._memory.height_assumed = False
        self._memory.assumed = False
        self._memory.receiver.outliers.clear()
        self._memory.landmarks.forget()

    def set_map(self, grid: FloorGrid | None) -> None:
        self._horizontal.set_map(grid)

    def update_barometer(self, air: BarometricHeight) -> None:
        self._height.update_barometer(air)

    def update_heading(self, heading: CompassHeading) -> None:
        self._horizontal.update_compass(heading, assumed=self._memory.assumed)

    def constrain_to_floors(self, storeys: Sequence[Storey]) -> None:
        self._height.constrain_to_learnt_floors(storeys)

    def match_building(self, learnt: LearntBuilding) -> LearntBuilding:
        memory, last = self._memory, self._memory.last
        if last is None or memory.assumed:  # it is another frame, without a relation to this one
            return learnt
        fix_ns = memory.fix_t_mono_ns
        inside = fix_ns is None or last.header.t_mono_ns - fix_ns > INSIDE_NS
        unit_id = last.header.unit_id
        return memory.landmarks.update(unit_id, learnt, self._horizontal, inside=inside)

    def update_gnss(self, fix: PlaceFix) -> FixVerdict:
        return self._fixes.update(fix)

    def reframe(self, turn_rad: float, north_m: float, east_m: float, down_m: float) -> None:
        self._horizontal.reframe(turn_rad, north_m, east_m)
        self._height.shift(down_m)
        self._memory.receiver.forget_path()
        self._memory.landmarks.forget()
        if self._previous_run is not None:
            self._previous_run.reframe(turn_rad, north_m, east_m, down_m)

    @property
    def _is_split(self) -> bool:
        return self._horizontal.is_split

    def _place_before(self, north_m: float, east_m: float) -> HorizontalEstimate:
        return self._horizontal.estimate_before(north_m, east_m)

    def _on_path_jump(self, strayed_var_m2: float, _position: Position, /) -> None:
        self._horizontal.inflate_place(strayed_var_m2)
        self._memory.receiver.forget_path()

    def _advance(self, position: Position, duration_s: float) -> None:
        increment = self._odometry.increment(position, duration_s)
        self._predict(increment, position.std_down_m)
        self._horizontal.set_drift_std(increment.drift_radps)

    def _predict(self, increment: OdometryIncrement, own_std_m: float) -> None:
        kind = self._kind
        path = (increment.north_m, increment.east_m, increment.moving_s, -increment.down_m)
        noise = kind.walk_m_per_sqrt_m**2, kind.turn_rad_per_sqrt_m**2
        self._height.predict(
            increment.down_m, increment.length_m, own_std_m, moves=increment.moving_s > 0.0
        )
        if self._height.walked_level and self._horizontal.distance_outside_m() < 0.0:
            self._height.constrain_to_plan_floors(self._horizontal.storeys_down_m)
        down_m = self._height.down_m
        self._horizontal.select_floor(down_m)
        self._horizontal.predict(path, increment.place_var_m2, increment.turn_var, noise)
        self._memory.landmarks.add_increment(increment, down_m)

    def _set_path_noise(self, noise: PathNoise | None) -> None:
        memory = self._memory
        if noise == memory.path_noise:
            return
        kind = with_path_noise(self._usual_kind, noise)
        memory.path_noise, self._kind = noise, kind
        self._horizontal.set_scale_std(kind.scale_std)
        self._odometry = OdometryIncrements(kind, self._odometry.save())
        self._fixes = GnssUpdater(kind, memory, self._horizontal, self._height)

    def _on_clock_set_back(self, t_mono_ns: int) -> None:
        memory = self._memory
        memory.path = RecentPath()
        memory.wander_t_mono_ns = t_mono_ns
        if memory.fix_t_mono_ns is not None:
            memory.fix_t_mono_ns = min(memory.fix_t_mono_ns, t_mono_ns)

    def _restart(self, last_ns: int, t_ns: int, outage_s: float) -> None:
        # Ages of fixes are kept whatever the unit's clock did.
        self._previous_run = self._ended_run()
        memory, back_ns = self._memory, set_back_ns(last_ns, t_ns, outage_s)
        travel_std_m = max_travel_m(outage_s) / RADII_95
        self._horizontal.inflate_place(self._kind.restart_m**2 + travel_std_m**2)
        self._height.on_outage(self._kind.climb_part * travel_std_m, outage_s)
        self._horizontal.reset_heading()
        memory.path = RecentPath()
        memory.receiver.forget_path()
        if memory.fix_t_mono_ns is not None:
            memory.fix_t_mono_ns -= back_ns
        if memory.wander_t_mono_ns is not None:
            memory.wander_t_mono_ns -= back_ns
        self._odometry = OdometryIncrements(self._kind)
        memory.landmarks = LandmarkMatcher(shared_m2=memory.landmarks.shared_m2)
        self._horizontal.reset_compass()

    def _ended_run(self) -> GpsInertialFuser:
        """Copy of this fuser for positions of the ended run that come late."""
        memory = msgspec.msgpack.decode(self.save(), type=FuserMemory)
        memory.previous_run, memory.path, memory.landmarks = b"", RecentPath(), LandmarkMatcher()
        return GpsInertialFuser(self._usual_kind, memory)
