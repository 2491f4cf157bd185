"""GNSS update of a fuser: gate, receiver model, observation, and the response to rejected fixes."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from base_station.fusion.fuser_memory import FuserMemory
from base_station.fusion.gnss.common_mode_error import COMMON_S
from base_station.fusion.gnss.fix_faults import FIX_FAULTS
from base_station.fusion.horizontal.heading_hypotheses import GnssObservation
from base_station.fusion.horizontal.map_aided import MapAidedFilter
from base_station.fusion.interface import FixVerdict, PlaceFix
from base_station.fusion.odometry.path_since_fix import path_since_fix, unguided_m2, walls_std_m
from base_station.fusion.odometry.recent_path import PathPoint
from base_station.fusion.parameters import Parameters
from base_station.fusion.vertical.height import HeightFilter
from shared.clock import NS_PER_S
from shared.geo import wrap_pi

LATE_NS = 5 * NS_PER_S  # a fix is later than the newest by more than receivers are


class GnssUpdater:
    """Works on the filters of one fuser."""

    def __init__(
        self,
        kind: Parameters,
        memory: FuserMemory,
        horizontal: MapAidedFilter,
        height: HeightFilter,
    ) -> None:
        self._kind = kind
        self._memory = memory
        self._horizontal = horizontal
        self._height = height

    def update(self, fix: PlaceFix) -> FixVerdict:
        """Update the filters with a fix, or reject it with a reason."""
        memory = self._memory
        then = memory.path.at(fix.t_mono_ns)
        if isinstance(then, str):
            return FixVerdict(False, then)
        if memory.fix_t_mono_ns is not None and fix.t_mono_ns < memory.fix_t_mono_ns - LATE_NS:
            return self._update_late(fix, then)
        walked_m = memory.last.distance_m if memory.last else 0.0
        if memory.receiver.is_stuck(self._kind, fix, walked_m):
            return FixVerdict(False, FIX_FAULTS["stuck"], faulty=True)
        if memory.assumed:  # the first evidence of the incident frame
            memory.assumed = False
            self._horizontal.reset_place()
            self._horizontal.reset_heading()
        self._predict_slow_errors(fix.t_mono_ns)
        distance2 = self._horizontal.distance2(self._observation(fix, then, lasts=1.0))
        if distance2 > self._kind.gate:
            return self._on_rejected(fix, then)
        if not memory.receiver.on_within_gate():
            return FixVerdict(False, "fits, but the receiver was wrong just before")
        if self._unguided_m2(fix.t_mono_ns) == 0.0:
            memory.receiver.update_inflation(distance2)
            memory.receiver.update_white_part(fix, then)
        self._horizontal.update(self._observation(fix, then, self._kind.correlated_fixes))
        memory.receiver.on_accepted(fix)
        if fix.vertical_std_m is not None:
            std_m = max(fix.vertical_std_m, self._kind.height_std_floor_m)
            self._height.update_gnss(fix.down_m, std_m)
        if fix.horizontal_std_m < self._kind.open_sky_m:  # a unit with such fixes is outside
            memory.height_assumed = False
        memory.fix_t_mono_ns = max(fix.t_mono_ns, memory.fix_t_mono_ns or 0)
        memory.landmarks.on_fix(memory.receiver.common_m2(fix))
        return FixVerdict(True)

    def _update_late(self, fix: PlaceFix, then: PathPoint) -> FixVerdict:
        """A fix of a time before the newest one: the state then, less the path walked since."""
        observation = self._observation(fix, then, self._kind.correlated_fixes)
        slow_m2 = observation.slow_m**2
        own_m2 = slow_m2 + observation.white_m2
        once = msgspec.structs.replace(observation, slow_m=0.0, white_m2=own_m2)
        if self._horizontal.distance2(once) > self._kind.gate:
            return FixVerdict(False, "does not fit the path walked")
        lasting_m2 = 2.0 * self._kind.slow_s * slow_m2 + own_m2
        self._horizontal.update(msgspec.structs.replace(once, white_m2=lasting_m2))
        self._memory.receiver.on_accepted(fix)
        return FixVerdict(True)

    def _observation(self, fix: PlaceFix, then: PathPoint, lasts: float) -> GnssObservation:
        """``lasts``: so many fixes in a row have about the same doubtful error."""
        last, kind, receiver = self._memory.last, self._kind, self._memory.receiver
        since = path_since_fix(then, last)
        outside_m = self._horizontal.distance_outside_m(since.north_m, since.east_m)
        own_m2, common_m2, part = (
            receiver.own_m2(fix),
            receiver.common_m2(fix),
            1.0 - receiver.white_part,
        )
        extra_m2 = lasts * receiver.extra_m2(fix, walls_std_m(kind, outside_m))
        extra_m2 += self._unguided_m2(fix.t_mono_ns)
        extra_m2 += since.error_m2(kind, self._horizontal.drift_std_radps)
        return GnssObservation(
            north_m=fix.north_m,
            east_m=fix.east_m,
            since_north_m=since.north_m,
            since_east_m=since.east_m,
            slow_m=math.sqrt(own_m2 * part),
            common_m=math.sqrt(common_m2),
            white_m2=own_m2 * (1.0 - part) + extra_m2,
        )

    def _unguided_m2(self, t_mono_ns: int) -> float:
        """Variance of the movement since the last position of the own path."""
        last = self._memory.last
        last_ns = last.header.t_mono_ns if last else self._memory.fix_t_mono_ns
        return unguided_m2(self._kind, t_mono_ns, last_ns)

    def _predict_slow_errors(self, t_mono_ns: int) -> None:
        """Predict the fixes' slow errors up to the time of this one."""
        before_ns = self._memory.wander_t_mono_ns
        self._memory.wander_t_mono_ns = max(t_mono_ns, before_ns or t_mono_ns)
        if before_ns is None or t_mono_ns <= before_ns:
            return
        since_s = (t_mono_ns - before_ns) / NS_PER_S
        lasts_s = np.array([self._kind.slow_s] * 2 + [COMMON_S] * 2)
        self._horizontal.decay_slow_errors(np.exp(-since_s / lasts_s))
        self._height.decay_slow_errors(math.exp(-since_s / self._kind.height_slow_s))

    def _on_rejected(self, fix: PlaceFix, then: PathPoint) -> FixVerdict:
        """Outside the gate; but fixes that draw the shape of the walk are right after all."""
        shape = self._memory.receiver.on_rejected(self._kind, fix, (then.north_m, then.east_m))
        if shape is None:
            return FixVerdict(False, "does not fit the path walked")
        held_rad, held_std_rad = self._horizontal.turn()
        shape_std_rad = 2.0 * fix.horizontal_std_m / shape.spread_m
        apart_rad = abs(wrap_pi(shape.turn_rad - held_rad))
        self._horizontal.reset_place()
        self._memory.landmarks.forget()
        if apart_rad > 3.0 * math.hypot(held_std_rad, shape_std_rad):
            self._horizontal.reset_heading()
        return FixVerdict(False, "contradicts the path, and agrees with others: going there")
