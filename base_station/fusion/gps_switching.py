"""Fuser by the rule of Li et al. 2014: GPS while there is any, else dead reckoning from the last.

The place is that of the newest fix; until the next one the own path goes on from there.  The
heading of the own frame is what GPS shows of the course, or the compass, or the start, whichever is
surest.  Height is as in the other fuser, from barometer, own path and fixes, without storeys.

No fix is held against the path or the fixes before, so that an outlier, or a wrong fix indoors,
moves the wearer there, and the stated error is what the receiver states; a fix without an accuracy
has the one that the screening gives it.  No plan and no learnt building is used.  It is a baseline:
what more the default fuser gives is the difference between the two.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import msgspec

from base_station.fusion.building_model.building import LearntBuilding
from base_station.fusion.dead_reckoning import DeadReckoning
from base_station.fusion.interface import (
    BarometricHeight,
    CompassHeading,
    FixVerdict,
    PlaceFix,
    Posterior,
    Start,
)
from base_station.fusion.kernels import HorizontalEstimate
from base_station.fusion.odometry.odometry_increments import OdometryIncrements
from base_station.fusion.odometry.recent_path import PathPoint, RecentPath
from base_station.fusion.odometry.run_changes import set_back_ns
from base_station.fusion.parameters import Parameters
from base_station.fusion.path_estimates import PathEstimates
from base_station.fusion.stated_noise import with_path_noise
from base_station.fusion.vertical.height import HeightFilter, SavedHeight
from base_station.site.floor_grid import FloorGrid
from base_station.site.max_travel import RADII_95, max_travel_m
from base_station.site.storeys import Storey
from shared.messages import Position
from shared.path_noise import PathNoise


@dataclass(frozen=True, slots=True)
class GpsSwitching(Parameters):
    """The kind that makes these fusers."""

    name: str = "gps-switching"
    course_m: float = 20.0  # of own path between two fixes that show a course
    course_most_m: float = 50.0  # then the course is measured from the next fix

    def new(self) -> GpsSwitchingFuser:
        return GpsSwitchingFuser(self, _Memory(DeadReckoning(self.scale_std)))

    def restore(self, saved: bytes) -> GpsSwitchingFuser:
        return GpsSwitchingFuser(self, msgspec.msgpack.decode(saved, type=_Memory))


class _CourseFix(msgspec.Struct, frozen=True):
    """Fix from which a course is measured, with the own path's place then."""

    fix: PlaceFix
    own: PathPoint


class _Memory(msgspec.Struct):
    """State of a fuser, and its serialised form."""

    reckoning: DeadReckoning
    height: SavedHeight | None = None
    odometry: bytes = b""
    previous_run: bytes = b""  # of the run before this one, as it ended
    assumed: bool = True  # nothing ties the own frame to the incident frame
    height_assumed: bool = True
    last: Position | None = None
    path_noise: PathNoise | None = None  # as the unit's tracker states it
    path: RecentPath = msgspec.field(default_factory=RecentPath)
    fix_t_mono_ns: int | None = None  # the newest fix
    course_from: _CourseFix | None = None


class GpsSwitchingFuser(PathEstimates):
    """One unit's place by the newest fix and the own path since; see the module's text."""

    _kind: GpsSwitching
    _memory: _Memory
    _previous_run: GpsSwitchingFuser | None

    def __init__(self, kind: GpsSwitching, memory: _Memory) -> None:
        self._usual_kind = kind  # for a unit that states no noise of its path
        self._kind = with_path_noise(kind, memory.path_noise)
        self._memory = memory
        self._height = HeightFilter(kind)
        if memory.height is not None:
            self._height.load(memory.height)
        self._odometry = OdometryIncrements(self._kind, memory.odometry)
        self._previous_run = kind.restore(memory.previous_run) if memory.previous_run else None

    def save(self) -> bytes:
        memory = self._memory
        memory.height, memory.odometry = self._height.save(), self._odometry.save()
        memory.previous_run = b"" if self._previous_run is None else self._previous_run.save()
        return msgspec.msgpack.encode(memory)

    def start(self, start: Start) -> None:
        memory, reckoning = self._memory, self._memory.reckoning
        reckoning.set_turn(start.heading_rad, start.heading_std_rad)
        place_var_m2 = (start.std_m**2, start.std_m**2, 0.0)
        reckoning.set_place((start.north_m, start.east_m), place_var_m2, (0.0, 0.0))
        self._height.reset(start.down_m, start.std_m)
        memory.assumed = memory.height_assumed = False
        memory.course_from = None
        if memory.last is not None:
            self._predict(OdometryIncrements(self._kind), memory.last, 0.0)

    def set_posterior(self, posterior: Posterior) -> None:
        north_m, east_m, cosine, sine, _ = posterior.mean
        (var_n, cov_ne, *_), (_, var_e, *_), (_, _, var_c, cov_cs, _), (_, _, _, var_s, _), _ = (
            posterior.covariance
        )
        size = math.hypot(cosine, sine)
        across = sine**2 * var_c - 2.0 * sine * cosine * cov_cs + cosine**2 * var_s
        reckoning = self._memory.reckoning
        reckoning.set_turn(math.atan2(sine, cosine), math.sqrt(max(across, 0.0)) / size**2)
        reckoning.set_place((north_m, east_m), (var_n, var_e, cov_ne), self._own_m())
        self._memory.assumed = False
        if posterior.down_std_m is not None:
            self._height.reset(self._height.down_m + posterior.down_shift_m, posterior.down_std_m)

    def set_map(self, grid: FloorGrid | None) -> None:
        """Walls are not part of the rule."""

    def update_barometer(self, air: BarometricHeight) -> None:
        self._height.update_barometer(air)

    def update_heading(self, heading: CompassHeading) -> None:
        self._set_turn(heading.turn_rad, heading.std_rad)

    def constrain_to_floors(self, storeys: Sequence[Storey]) -> None:
        """Storeys are not part of the rule."""

    def match_building(self, learnt: LearntBuilding) -> LearntBuilding:
        """Nothing of a building is learnt or used."""
        return learnt

    def update_gnss(self, fix: PlaceFix) -> FixVerdict:
        memory, kind = self._memory, self._kind
        then = memory.path.at(fix.t_mono_ns)
        if isinstance(then, str):
            return FixVerdict(False, then)
        if memory.fix_t_mono_ns is not None and fix.t_mono_ns < memory.fix_t_mono_ns:
            return FixVerdict(False, "older than the fix in use")
        self._update_course(fix, then)
        var_m2 = fix.horizontal_std_m**2
        memory.reckoning.set_place(
            (fix.north_m, fix.east_m), (var_m2, var_m2, 0.0), (then.north_m, then.east_m)
        )
        if fix.vertical_std_m is not None:
            self._height.update_gnss(fix.down_m, max(fix.vertical_std_m, kind.height_std_floor_m))
        if fix.horizontal_std_m < kind.open_sky_m:
            memory.height_assumed = False
        memory.assumed, memory.fix_t_mono_ns = False, fix.t_mono_ns
        return FixVerdict(True)

    def reframe(self, turn_rad: float, north_m: float, east_m: float, down_m: float) -> None:
        self._memory.reckoning.reframe(turn_rad, north_m, east_m)
        self._memory.course_from = None
        self._height.shift(down_m)
        if self._previous_run is not None:
            self._previous_run.reframe(turn_rad, north_m, east_m, down_m)

    @property
    def _is_split(self) -> bool:
        return False

    def _place_before(self, north_m: float, east_m: float) -> HorizontalEstimate:
        end_m, back_m = self._own_m(), (north_m, east_m)
        own_m = end_m[0] - north_m, end_m[1] - east_m
        return self._memory.reckoning.estimate_at(own_m, back_m)

    def _own_m(self) -> tuple[float, float]:
        last = self._memory.last
        return (0.0, 0.0) if last is None else (last.north_m, last.east_m)

    def _on_path_jump(self, strayed_var_m2: float, position: Position, /) -> None:
        self._hold_place(strayed_var_m2, position)

    def _advance(self, position: Position, duration_s: float) -> None:
        self._predict(self._odometry, position, duration_s)

    def _predict(self, odometry: OdometryIncrements, position: Position, duration_s: float) -> None:
        increment = odometry.increment(position, duration_s)
        self._memory.reckoning.predict(increment)
        moves = increment.moving_s > 0.0
        self._height.predict(increment.down_m, increment.length_m, position.std_down_m, moves=moves)

    def _set_turn(self, turn_rad: float, std_rad: float) -> None:
        """Use a heading of the own north that is no less sure than the present one."""
        if std_rad <= self._memory.reckoning.turn_std_rad:
            self._memory.reckoning.set_turn(turn_rad, std_rad)

    def _update_course(self, fix: PlaceFix, then: PathPoint) -> None:
        """Measure the turn of the own frame by the course between two fixes."""
        memory, kind = self._memory, self._kind
        before = memory.course_from
        if before is None:
            memory.course_from = _CourseFix(fix, then)
            return
        own = complex(then.north_m - before.own.north_m, then.east_m - before.own.east_m)
        seen = complex(fix.north_m - before.fix.north_m, fix.east_m - before.fix.east_m)
        apart_m = abs(own)
        if apart_m >= kind.course_m and seen:
            std_m = math.hypot(fix.horizontal_std_m, before.fix.horizontal_std_m)
            turn = seen / own
            self._set_turn(math.atan2(turn.imag, turn.real), std_m / apart_m)
        if apart_m >= kind.course_most_m:
            memory.course_from = _CourseFix(fix, then)

    def _hold_place(self, var_m2: float, at: Position | None) -> None:
        """The wearer is still about where the estimate is, though the own path broke off; it goes
        on at ``at``, or at the origin of another own frame.
        """
        placed = self._memory.reckoning.estimate_at(self._own_m()).inflated(var_m2)
        between_m2 = placed.correlation_ne * placed.std_north_m * placed.std_east_m
        self._memory.reckoning.set_place(
            (placed.north_m, placed.east_m),
            (placed.std_north_m**2, placed.std_east_m**2, between_m2),
            (0.0, 0.0) if at is None else (at.north_m, at.east_m),
        )
        self._memory.course_from = None

    def _set_path_noise(self, noise: PathNoise | None) -> None:
        memory = self._memory
        if noise == memory.path_noise:
            return
        memory.path_noise, self._kind = noise, with_path_noise(self._usual_kind, noise)
        memory.reckoning.scale_std = self._kind.scale_std
        self._odometry = OdometryIncrements(self._kind, self._odometry.save())

    def _on_clock_set_back(self, t_mono_ns: int) -> None:
        memory = self._memory
        memory.path, memory.course_from = RecentPath(), None
        if memory.fix_t_mono_ns is not None:
            memory.fix_t_mono_ns = min(memory.fix_t_mono_ns, t_mono_ns)

    def _restart(self, last_ns: int, t_ns: int, outage_s: float) -> None:
        self._previous_run = self._ended_run()
        memory, kind = self._memory, self._kind
        travel_std_m = max_travel_m(outage_s) / RADII_95
        self._hold_place(kind.restart_m**2 + travel_std_m**2, None)
        memory.reckoning.set_turn(0.0, math.pi)
        self._height.on_outage(kind.climb_part * travel_std_m, outage_s)
        memory.path = RecentPath()
        if memory.fix_t_mono_ns is not None:
            memory.fix_t_mono_ns -= set_back_ns(last_ns, t_ns, outage_s)
        self._odometry = OdometryIncrements(kind)

    def _ended_run(self) -> GpsSwitchingFuser:
        """Copy of this fuser for positions of the ended run that come late."""
        memory = msgspec.msgpack.decode(self.save(), type=_Memory)
        memory.previous_run, memory.path = b"", RecentPath()
        return GpsSwitchingFuser(self._usual_kind, memory)
