"""Scale of the steps of a walk, by the fixes of a satellite receiver.

Two fixes and the path between them give two chords of one way, whatever the path's heading; their
ratio is the scale.  The path is that of the tracker, in which no fix has a part.  So the station,
which fuses path and fixes itself, counts the same fixes a second time if they change the path of
this walk: they are for the walks after it.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import numpy as np

from edge.samples import GpsSample
from edge.tracker.interface import Quality, StepScale, TrackBatch
from shared.geo import Anchor
from shared.path_noise import PathNoise

_WAY_M = 80.0  # between two fixes that are compared: errors of fixes are metres
_STRAIGHT = 0.6  # chord by way, at least: bends make the chord depend on the heading
_LEVEL_M = 3.0  # climbed, at most: steps on stairs are others
_MOST_STD_M = 6.0  # of a fix, each axis
_STEP_NOISE = 0.2  # m a root metre, of a path that does not state it
_BEND = 0.01  # of a chord, by the wander of the heading
_LEAST_STD = 0.01  # fixes are alike for minutes, and so is what a street does to them
_SIGMAS = 3.0  # a ride is no walk
_USUAL_STD = 0.08
_WAITING = 30  # fixes without a row


@dataclass(frozen=True, slots=True)
class _Point:
    """A fix, and where the path was then."""

    fix: GpsSample
    position_n_m: tuple[float, float, float]
    distance_m: float


class StepScaleByFixes:
    """Scale of the steps of one walk; pure."""

    def __init__(self) -> None:
        self._waiting: deque[GpsSample] = deque(maxlen=_WAITING)
        self._from: _Point | None = None
        self._weight = self._sum = 0.0

    @property
    def scale(self) -> StepScale | None:
        """By the lengths in the rows; None: nothing was measured."""
        if self._weight == 0.0:
            return None
        std = max(math.sqrt(1.0 / self._weight), _LEAST_STD)
        return StepScale(self._sum / self._weight, std)

    def take_fix(self, fix: GpsSample) -> None:
        """Take a fix; it waits for the row of its time."""
        is_located = math.isfinite(fix.lat_deg) and math.isfinite(fix.lon_deg)
        if is_located and fix.fix_type >= 2 and 0.0 < fix.horizontal_std_m <= _MOST_STD_M:
            self._waiting.append(fix)

    def push(self, rows: TrackBatch, noise: PathNoise | None) -> None:
        """Take the path's next rows."""
        if not len(rows):
            return
        if (rows.quality == Quality.LOST).any():
            self._from = None
        while self._waiting and self._waiting[0].t_ns <= rows.t_ns[-1]:
            fix = self._waiting.popleft()
            if fix.t_ns < rows.t_ns[0]:
                continue
            k = int(np.searchsorted(rows.t_ns, fix.t_ns))
            north_m, east_m, down_m = (float(one) for one in rows.position_n_m[k])
            self._take(_Point(fix, (north_m, east_m, down_m), float(rows.distance_m[k])), noise)

    def _take(self, point: _Point, noise: PathNoise | None) -> None:
        begin = self._from
        if begin is None:
            self._from = point
            return
        way_m = point.distance_m - begin.distance_m
        if way_m < _WAY_M:
            return
        self._from = point
        chord_m = math.dist(point.position_n_m[:2], begin.position_n_m[:2])
        climbed_m = abs(point.position_n_m[2] - begin.position_n_m[2])
        if chord_m < _STRAIGHT * way_m or climbed_m > _LEVEL_M:
            return
        self._compare(begin.fix, point.fix, chord_m, way_m, noise)

    def _compare(
        self,
        begin: GpsSample,
        end: GpsSample,
        chord_m: float,
        way_m: float,
        noise: PathNoise | None,
    ) -> None:
        north_m, east_m = _between(begin, end)
        fixes_m2 = begin.horizontal_std_m**2 + end.horizontal_std_m**2
        # Errors across the chord lengthen it: in the mean by as much as is taken off here.
        true_m = math.sqrt(max(north_m**2 + east_m**2 - fixes_m2, 0.0))
        stated = None if noise is None else noise.place_std_m_per_sqrt_m
        path_m2 = (_STEP_NOISE if stated is None else stated) ** 2 * way_m
        ratio = true_m / chord_m
        variance = (fixes_m2 + path_m2) / chord_m**2 + _BEND**2
        if (ratio - 1.0) ** 2 > _SIGMAS**2 * (variance + _USUAL_STD**2):
            return
        self._weight += 1.0 / variance
        self._sum += ratio / variance


def _between(begin: GpsSample, end: GpsSample) -> tuple[float, float]:
    """Return how far north and east one fix is of the other."""
    origin = Anchor(begin.lat_deg, begin.lon_deg, 0.0, 0.0)
    north_m, east_m, _ = origin.to_incident_m(end.lat_deg, end.lon_deg, 0.0)
    return north_m, east_m
