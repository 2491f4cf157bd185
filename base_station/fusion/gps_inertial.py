"""GPS and inertial path in one filter, whatever the initial heading, with and without GPS.

The place on the plane is in ``plane``, the height in ``vertical``, the path's errors in ``path``,
and what a fix has to stand up to in ``fixes``; here they are put together, and what is said of it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import msgspec
import numpy as np

from base_station.fusion.fixes.taking import FixTaker
from base_station.fusion.fuser_memory import Memory
from base_station.fusion.kernels import Placed, Stretch
from base_station.fusion.learnt.building import LearntBuilding
from base_station.fusion.learnt.recognition import Recognition
from base_station.fusion.parameters import Parameters
from base_station.fusion.path.own_path import OwnPath
from base_station.fusion.path.recent_path import PathMemory
from base_station.fusion.plane.compassed_filter import CompassedFilter
from base_station.fusion.plane.walled_filter import WalledFilter
from base_station.fusion.port import (
    AirHeight,
    Bearing,
    Estimate,
    FixVerdict,
    PlaceFix,
    Present,
    Start,
)
from base_station.fusion.position_quality import quality_of
from base_station.fusion.vertical.height import HeightFilter, climb_var_m2
from base_station.site.floor_grid import FloorGrid
from base_station.site.roaming import RADII_95, roamed_m
from base_station.site.storeys import Storey
from shared.clock import NS_PER_S
from shared.messages import Position

INSIDE_NS = 10 * NS_PER_S  # without a fix for as long: inside, where no plan tells


@dataclass(frozen=True, slots=True)
class GpsInertial(Parameters):
    """The kind that makes these fusers."""

    name: str = "gps-inertial"

    def new(self) -> GpsInertialFuser:
        return GpsInertialFuser(self, Memory())

    def restore(self, saved: bytes) -> GpsInertialFuser:
        return GpsInertialFuser(self, msgspec.msgpack.decode(saved, type=Memory))


class GpsInertialFuser:
    """One unit's filter; see the module's text."""

    def __init__(self, kind: GpsInertial, memory: Memory) -> None:
        self._kind = kind
        self._memory = memory
        self._horizontal = WalledFilter(
            CompassedFilter(kind.scale_std, kind.linear_rad, kind.drift_wander_radps)
        )
        self._horizontal.expect_drift(kind.drift_radps)
        self._height = HeightFilter(kind)
        self._own = OwnPath(kind, memory.own)
        self._fixes = FixTaker(kind, memory, self._horizontal, self._height)
        self._ended = kind.restore(memory.ended) if memory.ended else None  # the run before this
        if memory.horizontal is not None and memory.height is not None:
            self._horizontal.load(memory.horizontal)
            self._height.load(memory.height)

    def save(self) -> bytes:
        self._memory.horizontal = self._horizontal.save()
        self._memory.height = self._height.save()
        self._memory.own = self._own.save()
        self._memory.ended = b"" if self._ended is None else self._ended.save()
        return msgspec.msgpack.encode(self._memory)

    def start(self, start: Start) -> None:
        memory = self._memory
        self._horizontal.begin(
            (start.north_m, start.east_m), start.std_m, start.heading_rad, start.heading_std_rad
        )
        self._height.begin(start.down_m, start.std_m)
        memory.assumed = memory.height_assumed = False
        memory.trust.outliers.clear()
        memory.recognition.forget()
        memory.recognition.shared_m2 = start.std_m**2
        if memory.last is not None:
            self._walk(OwnPath(self._kind).stretch(memory.last, 0.0), memory.last.std_down_m)

    def settle(self, present: Present) -> None:
        self._horizontal.settle(np.array(present.mean), np.array(present.covariance))
        if present.down_std_m is not None:
            self._height.begin(self._height.down_m + present.down_shift_m, present.down_std_m)
            self._memory.height_assumed = False
        self._memory.assumed = False
        self._memory.trust.outliers.clear()
        self._memory.recognition.forget()

    def consider(self, grid: FloorGrid | None) -> None:
        self._horizontal.consider(grid)

    def advance(self, position: Position, away_s: float = 0.0) -> str:
        memory, last = self._memory, self._memory.last
        t_ns = position.header.t_mono_ns
        if last is not None and last.header.boot_id != position.header.boot_id:
            self._restart(last.header.t_mono_ns, t_ns, away_s)
            last = None
        duration_s = 0.0
        if last is not None:
            duration_s = (t_ns - last.header.t_mono_ns) / NS_PER_S
            if duration_s < 0.0 and position.header.seq < last.header.seq:
                return "older than the last position"
            if duration_s < 0.0:
                self._go_back_to(t_ns)
            north_m, east_m = position.north_m - last.north_m, position.east_m - last.east_m
            jumped_m = math.hypot(north_m, east_m)
            if jumped_m > self._kind.fastest_mps * max(duration_s, 0.2) + 1.0:
                strayed_m = max(self._kind.unguided_mps * duration_s, self._kind.restart_m)
                self._horizontal.spread(min(strayed_m, jumped_m) ** 2)
                memory.last, memory.path = position, PathMemory()
                memory.path.note(position)
                memory.trust.lose_path()
                self._own.jump(position)
                return "the unit's own path jumped"
        stretch = self._own.stretch(position, max(duration_s, 0.0))
        self._walk(stretch, position.std_down_m)
        self._horizontal.expect_drift(stretch.drift_radps)
        memory.last = position
        memory.path.note(position)
        return ""

    def feel(self, air: AirHeight) -> None:
        self._height.feel(air)

    def face(self, bearing: Bearing) -> None:
        self._horizontal.go_by(bearing, assumed=self._memory.assumed)

    def rest_on(self, storeys: Sequence[Storey]) -> None:
        self._height.rest_near(storeys)

    def recognise(self, learnt: LearntBuilding) -> LearntBuilding:
        memory, last = self._memory, self._memory.last
        if last is None or memory.assumed:  # it is another frame, and tells nothing of this one
            return learnt
        fix_ns = memory.fix_t_mono_ns
        inside = fix_ns is None or last.header.t_mono_ns - fix_ns > INSIDE_NS
        unit_id = last.header.unit_id
        return memory.recognition.go_by(unit_id, learnt, self._horizontal, inside=inside)

    def correct(self, fix: PlaceFix) -> FixVerdict:
        return self._fixes.take(fix)

    def reframe(self, turn_rad: float, north_m: float, east_m: float, down_m: float) -> None:
        self._horizontal.reframe(turn_rad, north_m, east_m)
        self._height.shift(down_m)
        self._memory.trust.lose_path()
        self._memory.recognition.forget()
        if self._ended is not None:
            self._ended.reframe(turn_rad, north_m, east_m, down_m)

    def estimate(self) -> Estimate | None:
        memory = self._memory
        if memory.last is None and memory.fix_t_mono_ns is None:
            return None
        last = memory.last
        t_mono_ns = max(last.header.t_mono_ns if last else 0, memory.fix_t_mono_ns or 0)
        heading_rad = last.heading_rad if last else 0.0
        placed = self._horizontal.placed_before(0.0, 0.0)
        height = self._height.down_m, self._height.variance_m2
        return self._estimate_at(t_mono_ns, heading_rad, placed, height)

    def remember(self, position: Position) -> None:
        last = self._memory.last
        if last is not None and last.header.boot_id == position.header.boot_id:
            self._memory.path.fill(position)

    def recall(self, position: Position) -> Estimate | None:
        """The path from then to now is taken back from the present place, with the heading and
        scale that are believed now; that of the run before this one, from where it had led.
        """
        last, kind = self._memory.last, self._kind
        if last is None or last.header.boot_id != position.header.boot_id:
            return None if self._ended is None else self._ended.recall(position)
        placed = self._horizontal.placed_before(
            last.north_m - position.north_m, last.east_m - position.east_m
        )
        walked_m = abs(last.distance_m - position.distance_m)
        climbed_m = last.down_m - position.down_m
        height_m = self._height.down_m - climbed_m
        height_var_m2 = self._height.variance_m2 + climb_var_m2(kind, climbed_m, walked_m)
        return self._estimate_at(
            position.header.t_mono_ns,
            position.heading_rad,
            placed.widened(kind.walk_m_per_sqrt_m**2 * walked_m),
            (height_m, height_var_m2),
        )

    def _estimate_at(
        self,
        t_mono_ns: int,
        own_heading_rad: float,
        placed: Placed,
        height: tuple[float, float],
    ) -> Estimate:
        """``height`` with its variance."""
        memory, fix_ns = self._memory, self._memory.fix_t_mono_ns
        split = self._horizontal.is_split
        quality, reason = quality_of(
            self._kind, placed, memory.last, assumed=memory.assumed, split=split
        )
        return Estimate(  # by place: every position comes through here
            t_mono_ns,
            placed.north_m,
            placed.east_m,
            height[0],
            placed.std_north_m,
            placed.std_east_m,
            math.sqrt(height[1]),
            placed.correlation_ne,
            (placed.turn_rad + own_heading_rad) % (2.0 * math.pi),
            placed.turn_std_rad,
            quality,
            reason,
            None if fix_ns is None else max(0.0, (t_mono_ns - fix_ns) / NS_PER_S),
            memory.height_assumed,
            memory.assumed,
        )

    def _walk(self, stretch: Stretch, own_std_m: float) -> None:
        kind = self._kind
        path = (stretch.north_m, stretch.east_m, stretch.moving_s, -stretch.down_m)
        noise = kind.walk_m_per_sqrt_m**2, kind.turn_rad_per_sqrt_m**2
        self._height.climb(
            stretch.down_m, stretch.length_m, own_std_m, moves=stretch.moving_s > 0.0
        )
        if self._height.walked_level and self._horizontal.outside_m() < 0.0:
            self._height.rest_on(self._horizontal.storeys_down_m)
        down_m = self._height.down_m
        self._horizontal.stand_at(down_m)
        self._horizontal.walk(path, stretch.place_var_m2, stretch.turn_var, noise)
        self._memory.recognition.follow(stretch, down_m)

    def _go_back_to(self, t_mono_ns: int) -> None:
        """The unit's clock was ahead when it was last heard, and is right again."""
        memory = self._memory
        memory.path = PathMemory()
        memory.wander_t_mono_ns = t_mono_ns
        if memory.fix_t_mono_ns is not None:
            memory.fix_t_mono_ns = min(memory.fix_t_mono_ns, t_mono_ns)

    def _restart(self, last_ns: int, t_ns: int, away_s: float) -> None:
        """The unit began anew: its frame starts where the wearer got to since, heading unknown,
        and no better known than while it was silent.
        Fixes are as old as they were, whatever its clock has done; where nobody knows how long it
        was away, it went on or went back.
        """
        self._ended = self._as_it_ends()
        memory = self._memory
        known = 0.0 < away_s < math.inf
        back_ns = last_ns + round(away_s * NS_PER_S) - t_ns if known else max(0, last_ns - t_ns)
        roamed_std_m = roamed_m(away_s) / RADII_95
        self._horizontal.spread(self._kind.restart_m**2 + roamed_std_m**2)
        self._height.lose_sight(self._kind.climb_part * roamed_std_m, away_s)
        self._horizontal.forget_heading()
        memory.path = PathMemory()
        memory.trust.lose_path()
        if memory.fix_t_mono_ns is not None:
            memory.fix_t_mono_ns -= back_ns
        if memory.wander_t_mono_ns is not None:
            memory.wander_t_mono_ns -= back_ns
        self._own = OwnPath(self._kind)
        memory.recognition = Recognition(shared_m2=memory.recognition.shared_m2)
        self._horizontal.hear_anew()

    def _as_it_ends(self) -> GpsInertialFuser:
        """Where this run has led, for what comes of it later."""
        memory = msgspec.msgpack.decode(self.save(), type=Memory)
        memory.ended, memory.path, memory.recognition = b"", PathMemory(), Recognition()
        return GpsInertialFuser(self._kind, memory)
