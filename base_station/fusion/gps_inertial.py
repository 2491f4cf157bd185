"""GPS and inertial path in one filter, whatever the initial heading, with and without GPS.

Plane and height are ``horizontal`` and ``height``; here is what a fix has to stand up to before
they take it, and what is said of the result.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.heading_bank import Sighting
from base_station.fusion.height import HeightFilter, SavedHeight
from base_station.fusion.horizontal import HorizontalFilter, SavedHorizontal
from base_station.fusion.outliers import Outliers
from base_station.fusion.path_memory import PathMemory
from base_station.fusion.port import Estimate, FixVerdict, PlaceFix, Present, Start
from shared.clock import NS_PER_S
from shared.geo import wrap_pi
from shared.messages import Position
from shared.quality import Quality

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class GpsInertial:
    """Parameters, and the kind that makes fusers of them."""

    name: str = "gps-inertial"
    walk_m_per_sqrt_m: float = 0.06  # the own path's error by distance, each axis
    turn_rad_per_sqrt_m: float = 0.004  # its heading's wander by distance
    turn_part: float = 0.004  # and by turning
    scale_std: float = 0.03
    climb_part: float = 0.03  # height error by height climbed
    climb_m_per_sqrt_m: float = 0.02  # and by distance
    wander_part: float = 0.7  # of a fix's variance that wanders slowly
    wander_s: float = 30.0  # with this correlation time
    gate: float = 13.8  # chi-square of 2 degrees of freedom, 99.9 %
    linear_rad: float = 0.2  # heading standard deviation from which one hypothesis will do
    aligned_rad: float = 0.35  # and from which the heading is called known
    height_std_floor_m: float = 5.0
    fastest_mps: float = 12.0
    unguided_mps: float = 1.5  # how fast a wearer gets away while nothing is heard of the path
    restart_m: float = 5.0  # and how far while the unit starts again
    stuck_fixes: int = 5
    stuck_m: float = 8.0
    distrust_most: int = 20

    def new(self) -> GpsInertialFuser:
        return GpsInertialFuser(self, _Memory())

    def restore(self, saved: bytes) -> GpsInertialFuser:
        return GpsInertialFuser(self, msgspec.msgpack.decode(saved, type=_Memory))


class _Memory(msgspec.Struct):
    """Everything beside the filters, and what these were when written out."""

    horizontal: SavedHorizontal | None = None
    height: SavedHeight | None = None
    assumed: bool = True  # nothing but the own frame is known: shown about the unit's start
    last: Position | None = None
    last_step_rad: float | None = None  # direction of the last increment, own frame
    path: PathMemory = msgspec.field(default_factory=PathMemory)
    fix_t_mono_ns: int | None = None  # the newest accepted fix
    wander_t_mono_ns: int | None = None
    last_fix_m: tuple[float, float] | None = None
    same_fixes: int = 0
    same_since_m: float = 0.0  # distance walked when the fix last changed
    distrust: int = 0  # grows by one with a fix that does not fit, falls by two with one that does
    outliers: Outliers = msgspec.field(default_factory=Outliers)
    surprise: float = 1.0  # how much worse fixes fit than they claim


class GpsInertialFuser:
    """One unit's filter; see the module's text."""

    def __init__(self, kind: GpsInertial, memory: _Memory) -> None:
        self._kind = kind
        self._memory = memory
        self._horizontal = HorizontalFilter(kind.scale_std, kind.linear_rad)
        self._height = HeightFilter(kind.wander_part)
        if memory.horizontal is not None and memory.height is not None:
            self._horizontal.load(memory.horizontal)
            self._height.load(memory.height)

    def save(self) -> bytes:
        self._memory.horizontal = self._horizontal.save()
        self._memory.height = self._height.save()
        return msgspec.msgpack.encode(self._memory)

    def start(self, start: Start) -> None:
        memory = self._memory
        self._horizontal.begin(
            (start.north_m, start.east_m), start.std_m, start.heading_rad, start.heading_std_rad
        )
        self._height.begin(start.down_m, start.std_m)
        memory.assumed = False
        memory.outliers.clear()
        if memory.last is not None:
            self._walk(memory.last.north_m, memory.last.east_m, memory.last.down_m, 0.0)

    def settle(self, present: Present) -> None:
        self._horizontal.settle(np.array(present.mean), np.array(present.covariance))
        if present.down_std_m is not None:
            self._height.begin(self._height.down_m + present.down_shift_m, present.down_std_m)
        self._memory.assumed = False
        self._memory.outliers.clear()

    def advance(self, position: Position) -> str:
        memory, last = self._memory, self._memory.last
        t_ns = position.header.t_mono_ns
        if last is None:
            self._walk(position.north_m, position.east_m, position.down_m, 0.0)
        elif last.header.boot_id != position.header.boot_id:
            self._restart(position)
        else:
            duration_s = (t_ns - last.header.t_mono_ns) / NS_PER_S
            if duration_s < 0.0:
                return "older than the last position"
            north_m, east_m = position.north_m - last.north_m, position.east_m - last.east_m
            if math.hypot(north_m, east_m) > self._kind.fastest_mps * max(duration_s, 0.2) + 1.0:
                self._horizontal.spread((self._kind.unguided_mps * duration_s) ** 2)
                memory.last, memory.path = position, PathMemory()
                return "the unit's own path jumped"
            extra_m2 = max(0.0, _variance(position) - _variance(last))
            doubtful = position.quality is not Quality.GOOD
            self._walk(
                north_m, east_m, position.down_m - last.down_m, extra_m2 if doubtful else 0.0
            )
        memory.last = position
        memory.path.note(t_ns, position.north_m, position.east_m)
        return ""

    def correct(self, fix: PlaceFix) -> FixVerdict:
        memory = self._memory
        if self._is_stuck(fix):
            return FixVerdict(False, "the receiver is stuck")
        then = memory.path.at(fix.t_mono_ns)
        if isinstance(then, str):
            return FixVerdict(False, then)
        if memory.assumed:  # the first thing known of the incident frame
            memory.assumed = False
            self._horizontal.forget_place()
            self._horizontal.forget_heading()
        self._let_wander(fix.t_mono_ns)
        sighting = self._sighting(fix, then)
        distance2 = self._horizontal.distance2(sighting)
        if distance2 > self._kind.gate:
            return self._turned_away(fix, then)
        if memory.distrust > 0:
            memory.distrust -= 2
            return FixVerdict(False, "fits, but the receiver was wrong just before")
        memory.outliers.clear()
        surprise = memory.surprise * (1.0 + 0.05 * (distance2 / 2.0 - 1.0))
        memory.surprise = min(4.0, max(1.0, surprise))
        self._horizontal.update(sighting)
        if fix.vertical_std_m is not None:
            std_m = max(fix.vertical_std_m, self._kind.height_std_floor_m)
            self._height.correct(fix.down_m, std_m)
        memory.fix_t_mono_ns = max(fix.t_mono_ns, memory.fix_t_mono_ns or 0)
        return FixVerdict(True)

    def reframe(self, turn_rad: float, north_m: float, east_m: float, down_m: float) -> None:
        self._horizontal.reframe(turn_rad, north_m, east_m)
        self._height.climb(down_m, 0.0)
        self._memory.outliers.clear()

    def estimate(self) -> Estimate | None:
        memory = self._memory
        if memory.last is None and memory.fix_t_mono_ns is None:
            return None
        last = memory.last
        t_mono_ns = max(last.header.t_mono_ns if last else 0, memory.fix_t_mono_ns or 0)
        place = self._horizontal.place_m, self._horizontal.place_var_m2
        height = self._height.down_m, self._height.variance_m2
        return self._estimate_at(t_mono_ns, last.heading_rad if last else 0.0, place, height)

    def recall(self, position: Position) -> Estimate | None:
        """The path from then to now is taken back from the present place, with the heading and
        scale that are believed now.
        """
        last, kind = self._memory.last, self._kind
        if last is None or last.header.boot_id != position.header.boot_id:
            return None
        place_m, place_var_m2 = self._horizontal.place_before(
            last.north_m - position.north_m, last.east_m - position.east_m
        )
        walked_m = abs(last.distance_m - position.distance_m)
        climbed_m = last.down_m - position.down_m
        place_var_m2 = place_var_m2 + np.eye(2) * kind.walk_m_per_sqrt_m**2 * walked_m
        height_m = self._height.down_m - climbed_m
        height_var_m2 = self._height.variance_m2 + self._climb_var_m2(climbed_m, walked_m)
        return self._estimate_at(
            position.header.t_mono_ns,
            position.heading_rad,
            (place_m, place_var_m2),
            (height_m, height_var_m2),
        )

    def _estimate_at(
        self,
        t_mono_ns: int,
        own_heading_rad: float,
        place: tuple[Floats, Floats],
        height: tuple[float, float],
    ) -> Estimate:
        """``place`` and ``height`` each with its variance."""
        memory = self._memory
        place_m, variances = place
        std_north_m, std_east_m = math.sqrt(variances[0, 0]), math.sqrt(variances[1, 1])
        product = std_north_m * std_east_m
        turn_rad, turn_std_rad = self._horizontal.turn()
        since_s = None
        if memory.fix_t_mono_ns is not None:
            since_s = max(0.0, (t_mono_ns - memory.fix_t_mono_ns) / NS_PER_S)
        quality, reason = self._quality(math.hypot(std_north_m, std_east_m), turn_std_rad)
        return Estimate(
            t_mono_ns=t_mono_ns,
            north_m=float(place_m[0]),
            east_m=float(place_m[1]),
            down_m=height[0],
            std_north_m=std_north_m,
            std_east_m=std_east_m,
            std_down_m=math.sqrt(height[1]),
            correlation_ne=float(variances[0, 1]) / product if product > 0.0 else 0.0,
            heading_rad=(turn_rad + own_heading_rad) % (2.0 * math.pi),
            heading_std_rad=turn_std_rad,
            quality=quality,
            quality_reason=reason,
            since_gps_s=since_s,
        )

    def _walk(self, north_m: float, east_m: float, down_m: float, extra_m2: float) -> None:
        """Errors grow with the way and its turns, not with time."""
        kind = self._kind
        length_m = math.hypot(north_m, east_m)
        turn_var = kind.turn_rad_per_sqrt_m**2 * length_m
        turn_var += (kind.turn_part * self._turned(north_m, east_m, length_m)) ** 2
        place_var_m2 = kind.walk_m_per_sqrt_m**2 * length_m + extra_m2
        self._horizontal.walk(north_m, east_m, place_var_m2, turn_var)
        self._height.climb(down_m, self._climb_var_m2(down_m, length_m))

    def _climb_var_m2(self, climbed_m: float, walked_m: float) -> float:
        kind = self._kind
        return kind.climb_part**2 * abs(climbed_m) + kind.climb_m_per_sqrt_m**2 * walked_m

    def _turned(self, north_m: float, east_m: float, length_m: float) -> float:
        if length_m < 0.1:
            return 0.0
        step_rad = math.atan2(east_m, north_m)
        last_rad = self._memory.last_step_rad
        self._memory.last_step_rad = step_rad
        return 0.0 if last_rad is None else abs(wrap_pi(step_rad - last_rad))

    def _restart(self, position: Position) -> None:
        """The unit began anew: its frame starts where the wearer got to since, heading unknown."""
        self._horizontal.spread(self._kind.restart_m**2)
        self._horizontal.forget_heading()
        self._memory.path = PathMemory()
        self._walk(position.north_m, position.east_m, position.down_m, 0.0)

    def _sighting(self, fix: PlaceFix, then: tuple[float, float]) -> Sighting:
        memory, last, part = self._memory, self._memory.last, self._kind.wander_part
        own_m = (0.0, 0.0) if last is None else (last.north_m, last.east_m)
        white_m2 = memory.surprise * fix.horizontal_std_m**2 * (1.0 - part)
        return Sighting(
            north_m=fix.north_m,
            east_m=fix.east_m,
            since_north_m=own_m[0] - then[0],
            since_east_m=own_m[1] - then[1],
            slow_m=fix.horizontal_std_m * math.sqrt(part),
            white_m2=white_m2 + self._unguided_m2(fix.t_mono_ns),
        )

    def _unguided_m2(self, t_mono_ns: int) -> float:
        """How far a wearer may have got since the last word of the own path."""
        last = self._memory.last
        heard_ns = last.header.t_mono_ns if last else self._memory.fix_t_mono_ns
        if heard_ns is None or t_mono_ns - heard_ns < NS_PER_S:
            return 0.0
        return (self._kind.unguided_mps * (t_mono_ns - heard_ns) / NS_PER_S) ** 2

    def _let_wander(self, t_mono_ns: int) -> None:
        """Predict the fixes' slow error up to the time of this one."""
        before_ns = self._memory.wander_t_mono_ns
        self._memory.wander_t_mono_ns = max(t_mono_ns, before_ns or t_mono_ns)
        if before_ns is None or t_mono_ns <= before_ns:
            return
        keep = math.exp(-(t_mono_ns - before_ns) / NS_PER_S / self._kind.wander_s)
        self._horizontal.fade(keep)
        self._height.fade(keep)

    def _is_stuck(self, fix: PlaceFix) -> bool:
        """The very same place again and again while the wearer walks on."""
        memory, kind = self._memory, self._kind
        walked_m = memory.last.distance_m if memory.last else 0.0
        place = (fix.north_m, fix.east_m)
        if memory.last_fix_m != place:
            memory.last_fix_m, memory.same_fixes, memory.same_since_m = place, 1, walked_m
            return False
        memory.same_fixes += 1
        walked_since_m = walked_m - memory.same_since_m
        return memory.same_fixes >= kind.stuck_fixes and walked_since_m > kind.stuck_m

    def _turned_away(self, fix: PlaceFix, then: tuple[float, float]) -> FixVerdict:
        """Outside the gate; but fixes that draw the shape of the walk are right after all."""
        memory = self._memory
        memory.distrust = min(memory.distrust + 1, self._kind.distrust_most)
        shape = memory.outliers.add((fix.north_m, fix.east_m), then)
        if shape is None:
            return FixVerdict(False, "does not fit the path walked")
        memory.outliers.clear()
        memory.distrust = 0
        held_rad, held_std_rad = self._horizontal.turn()
        shape_std_rad = 2.0 * fix.horizontal_std_m / shape.spread_m
        apart_rad = abs(wrap_pi(shape.turn_rad - held_rad))
        self._horizontal.forget_place()
        if apart_rad > 3.0 * math.hypot(held_std_rad, shape_std_rad):
            self._horizontal.forget_heading()
        return FixVerdict(False, "contradicts the path, and agrees with others: going there")

    def _quality(self, std_m: float, turn_std_rad: float) -> tuple[Quality, str]:
        memory = self._memory
        tracker = memory.last.quality if memory.last is not None else Quality.GOOD
        within = f"within {2.0 * std_m:.0f} m"
        causes = (
            (tracker is Quality.LOST, Quality.LOST, "the unit's tracker is lost"),
            (memory.assumed, Quality.DEGRADED, "start not known: shown about the unit's own start"),
            (std_m > 30.0, Quality.LOST, within),
            (turn_std_rad > self._kind.aligned_rad, Quality.DEGRADED, "heading not known yet"),
            (std_m > 5.0, Quality.DEGRADED, within),
            (tracker is Quality.DEGRADED, Quality.DEGRADED, "the unit's tracker is unsure"),
        )
        return next(((quality, why) for holds, quality, why in causes if holds), (Quality.GOOD, ""))


def _variance(position: Position) -> float:
    return max(position.std_north_m, position.std_east_m) ** 2
