"""Prediction and estimates along a unit's own path, the same for every fuser of one present state.

The present estimate is that state.  The estimate at an earlier position is the present place less
the path since, with the present turn of the own frame; of the run before this one, it comes from
that run's last state.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Protocol

from base_station.fusion.interface import Estimate
from base_station.fusion.kernels import HorizontalEstimate
from base_station.fusion.odometry.odometry_increments import OdometryIncrements
from base_station.fusion.odometry.recent_path import RecentPath
from base_station.fusion.odometry.run_changes import jump_m, strayed_m
from base_station.fusion.parameters import Parameters
from base_station.fusion.position_quality import quality_of
from base_station.fusion.vertical.height import HeightFilter, climb_var_m2
from shared.clock import NS_PER_S
from shared.messages import Position
from shared.path_noise import PathNoise


class PathMemory(Protocol):
    """The part of a fuser's memory that estimates are made of."""

    last: Position | None
    path: RecentPath
    fix_t_mono_ns: int | None  # the newest fix in use
    assumed: bool  # nothing ties the own frame to the incident frame
    height_assumed: bool


class PathEstimates(ABC):
    """A fuser's prediction by positions, and its estimates, now and at earlier positions."""

    _kind: Parameters
    _memory: PathMemory
    _height: HeightFilter
    _odometry: OdometryIncrements
    _previous_run: PathEstimates | None

    @abstractmethod
    def _place_before(self, north_m: float, east_m: float) -> HorizontalEstimate:
        """Place and turn before the own path went on by that much, in its own frame."""

    @property
    @abstractmethod
    def _is_split(self) -> bool:
        """There are several places where the wearer may be."""

    @abstractmethod
    def _advance(self, position: Position, duration_s: float) -> None:
        """Propagate the present estimate by the increment of the own path to ``position``."""

    @abstractmethod
    def _on_path_jump(self, strayed_var_m2: float, position: Position, /) -> None:
        """Keep the place, with this variance more; the own path goes on at ``position``."""

    @abstractmethod
    def _set_path_noise(self, noise: PathNoise | None) -> None:
        """Use the noise that the unit's tracker states from now on."""

    @abstractmethod
    def _on_clock_set_back(self, t_mono_ns: int) -> None:
        """Drop times of a unit's clock that had been ahead and was set back."""

    @abstractmethod
    def _restart(self, last_ns: int, t_ns: int, outage_s: float) -> None:
        """Begin a new run of the unit's program: its frame starts within the distance that the
        wearer can have walked in ``outage_s``, with unknown heading.
        """

    def predict(self, position: Position, outage_s: float = 0.0) -> str:
        memory, last = self._memory, self._memory.last
        t_ns, duration_s = position.header.t_mono_ns, 0.0
        if last is not None and last.header.boot_id != position.header.boot_id:
            self._restart(last.header.t_mono_ns, t_ns, outage_s)
            last = None
        if last is not None:
            duration_s = (t_ns - last.header.t_mono_ns) / NS_PER_S
            if duration_s < 0.0 and position.header.seq < last.header.seq:
                return "older than the last position"
            if duration_s < 0.0:
                self._on_clock_set_back(t_ns)
        self._set_path_noise(position.path_noise)
        jumped_m = 0.0 if last is None else jump_m(self._kind, last, position, duration_s)
        if jumped_m:
            self._on_path_jump(strayed_m(self._kind, jumped_m, duration_s) ** 2, position)
            memory.path = RecentPath()
            self._odometry.reset_to(position)
        else:
            self._advance(position, max(duration_s, 0.0))
        memory.last = position
        memory.path.append(position)
        return "the unit's own path jumped" if jumped_m else ""

    def insert_late_position(self, position: Position) -> None:
        memory = self._memory
        last = memory.last
        if last is not None and last.header.boot_id == position.header.boot_id:
            memory.path.insert_late(position)

    def estimate(self) -> Estimate | None:
        memory = self._memory
        last, fix_ns = memory.last, memory.fix_t_mono_ns
        if last is None and fix_ns is None:
            return None
        return self._to_estimate(
            max(last.header.t_mono_ns if last else 0, fix_ns or 0),
            last.heading_rad if last else 0.0,
            self._place_before(0.0, 0.0),
            (self._height.down_m, self._height.variance_m2),
        )

    def estimate_at(self, position: Position) -> Estimate | None:
        last, kind = self._memory.last, self._kind
        if last is None or last.header.boot_id != position.header.boot_id:
            return None if self._previous_run is None else self._previous_run.estimate_at(position)
        placed = self._place_before(last.north_m - position.north_m, last.east_m - position.east_m)
        walked_m = abs(last.distance_m - position.distance_m)
        climbed_m = last.down_m - position.down_m
        height_var_m2 = self._height.variance_m2 + climb_var_m2(kind, climbed_m, walked_m)
        return self._to_estimate(
            position.header.t_mono_ns,
            position.heading_rad,
            placed.inflated(kind.walk_m_per_sqrt_m**2 * walked_m),
            (self._height.down_m - climbed_m, height_var_m2),
        )

    def _to_estimate(
        self,
        t_mono_ns: int,
        own_heading_rad: float,
        placed: HorizontalEstimate,
        height: tuple[float, float],
    ) -> Estimate:
        """``height`` with its variance."""
        memory = self._memory
        fix_ns = memory.fix_t_mono_ns
        quality, reason = quality_of(
            self._kind, placed, memory.last, assumed=memory.assumed, split=self._is_split
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
