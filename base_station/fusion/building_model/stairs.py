"""Stairs as landmarks: a climb is at the place of an earlier climb on the same stairs.

Wearers change storeys only on stairs, and a building has few. The place of a climb is the middle of
its way; a climb that matches an earlier one measures the error of the path since then.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from shared.geo import rotate

Floats = NDArray[np.float64]

LOOK_M = 1.0  # way or rise after which the slope is looked at
SLOPE = 0.15  # rise over way from which it is a climb
LANDING_M = 2.5  # walked on the level: the climb is over
STOREY_M = 2.0  # a climb of at least this
TURNS_M = 0.5  # net way over way: less turns back on itself, and lies above the next one
SAME_LEVEL_M = 1.2
STD_M = 0.4  # each axis, of a climb's middle by the stairs': a flight is some 1.2 m wide
SHARED_M2 = 1.0  # error common to all units, each axis, where it is not stated
OTHERS_PER_M2 = 0.15 / 600.0  # other stairs than those known, before anything is known of them


class Climb(msgspec.Struct, frozen=True):
    """One that is over."""

    since_north_m: float  # own path walked since its middle
    since_east_m: float
    low_m: float  # level of its lower end, down
    high_m: float
    turns: bool  # back on itself: the next storey's stairs lie above


class LearntStairs(msgspec.Struct, frozen=True):
    """A climb as it was known best, in the incident frame."""

    north_m: float
    east_m: float
    covariance_m2: tuple[float, float, float]  # north, north-east, east
    low_m: float
    high_m: float
    turns: bool
    shared_m2: float = SHARED_M2  # of the covariance, each axis: by which everybody errs alike

    @staticmethod
    def at(climb: Climb, place: Floats, covariance: Floats, shared_m2: float) -> LearntStairs:
        """A climb whose middle is estimated there: (2,) and (2, 2)."""
        (north_m, east_m), ((north, cross), (_, east)) = place.tolist(), covariance.tolist()
        spread_m2 = north, cross, east
        levels_m = climb.low_m, climb.high_m
        return LearntStairs(north_m, east_m, spread_m2, *levels_m, climb.turns, shared_m2)

    @property
    def variance_m2(self) -> float:
        return self.covariance_m2[0] + self.covariance_m2[2]

    @property
    def place(self) -> tuple[Floats, Floats]:
        north, cross, east = self.covariance_m2
        return np.array([self.north_m, self.east_m]), np.array([[north, cross], [cross, east]])

    def reframed(self, turn_rad: float, north_m: float, east_m: float) -> LearntStairs:
        """The incident frame was moved: turned clockwise, then shifted."""
        moved_m = rotate(self.north_m, self.east_m, turn_rad)
        cosine, sine = math.cos(turn_rad), math.sin(turn_rad)
        turn = np.array([[cosine, -sine], [sine, cosine]])
        ((north, cross), (_, east)) = (turn @ self.place[1] @ turn.T).tolist()
        return msgspec.structs.replace(
            self,
            north_m=moved_m[0] + north_m,
            east_m=moved_m[1] + east_m,
            covariance_m2=(north, cross, east),
        )

    def odds(self, other: LearntStairs) -> float:
        """That both are the same and not two, by where they are."""
        apart_m = abs(self.low_m - other.low_m), abs(self.high_m - other.high_m)
        if not (self.turns and other.turns) and max(apart_m) > SAME_LEVEL_M:
            return 0.0
        (one, spread), (another, also) = self.place, other.place
        whole, apart = spread + also + STD_M**2 * np.eye(2), one - another
        distance2 = float(apart @ np.linalg.solve(whole, apart))
        density = math.exp(-0.5 * distance2) / (math.tau * math.sqrt(np.linalg.det(whole)))
        return density / OTHERS_PER_M2


class ClimbDetector(msgspec.Struct):
    """Detector of finished climbs in the own path. Places are (north, east, level) in a frame that
    begins with the detector.
    """

    here_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    looked_m: tuple[float, float, float] = (0.0, 0.0, 0.0)  # where the slope was last looked at
    way_m: float = 0.0  # since then
    begin_m: tuple[float, float, float] | None = None  # of the climb in progress
    end_m: tuple[float, float, float] = (0.0, 0.0, 0.0)  # its furthest so far
    level_way_m: float = 0.0  # walked on the level since
    sums_m: tuple[float, float, float] = (0.0, 0.0, 0.0)  # of place by way, and way

    def update(self, north_m: float, east_m: float, level_m: float) -> Climb | None:
        """Add an increment of the own path that ends at this level (down, estimated); returns a
        finished climb.
        """
        self.here_m = self.here_m[0] + north_m, self.here_m[1] + east_m, level_m
        self.way_m += math.hypot(north_m, east_m)
        fallen_m = level_m - self.looked_m[2]
        if self.way_m < LOOK_M and abs(fallen_m) < LOOK_M:
            return None
        before_m, way_m = self.looked_m, self.way_m
        self.looked_m, self.way_m = self.here_m, 0.0
        if abs(fallen_m) > SLOPE * way_m:
            return self._climb(before_m, way_m)
        self.level_way_m += way_m
        return self._finish_climb() if self.level_way_m > LANDING_M else None

    def _climb(self, before_m: tuple[float, float, float], way_m: float) -> Climb | None:
        climb = None
        if self.begin_m is not None:
            rises = (self.here_m[2] - before_m[2]) * (self.end_m[2] - self.begin_m[2])
            climb = self._finish_climb() if rises < 0.0 else None
        if self.begin_m is None:
            self.begin_m, self.sums_m = before_m, (0.0, 0.0, 0.0)
        self.end_m, self.level_way_m = self.here_m, 0.0
        north, east, way = self.sums_m
        north += way_m * 0.5 * (before_m[0] + self.here_m[0])
        east += way_m * 0.5 * (before_m[1] + self.here_m[1])
        self.sums_m = north, east, way + way_m
        return climb

    def _finish_climb(self) -> Climb | None:
        begin_m, self.begin_m = self.begin_m, None
        north, east, way_m = self.sums_m
        if begin_m is None or abs(self.end_m[2] - begin_m[2]) < STOREY_M or way_m <= 0.0:
            return None
        net_m = math.dist(begin_m[:2], self.end_m[:2])
        return Climb(
            since_north_m=self.here_m[0] - north / way_m,
            since_east_m=self.here_m[1] - east / way_m,
            low_m=max(begin_m[2], self.end_m[2]),
            high_m=min(begin_m[2], self.end_m[2]),
            turns=net_m < TURNS_M * way_m,
        )
