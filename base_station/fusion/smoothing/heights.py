"""Heights of a path: the live estimate plus a shift by position constraints.

The shift is a random walk with the height error of paths, larger where the live estimate was
uncertain: a tridiagonal problem. A storey recognised live is no constraint, as it may have been the
wrong one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from base_station.fusion.odometry.points import PathArrays
from base_station.fusion.smoothing.consistency import GATE2, Prediction, consistent_set
from base_station.fusion.smoothing.interface import PositionConstraint, UnitEvidence

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

WANDER_M_PER_SQRT_S = 0.01
CLIMB_M_PER_SQRT_CLIMB_M = 0.12
CLIMB_M_PER_SQRT_M = 0.01
MIN_AGREEING = 2  # sources, against the path
MIN_GROWTH_STD_M = 0.5  # less is stated anew at every storey: no error that comes to it
ANY_FLOOR_M = 100.0  # standard deviation of the place of switching on: up a tower, perhaps


@dataclass(frozen=True)
class Solved:
    """A row a point."""

    t_ns: Ints
    down_m: Floats
    std_m: Floats
    shift: tuple[float, float | None]  # at the last one, and its std; None: no place gives one

    def at(self, t_ns: int) -> tuple[float, float]:
        """Down and its standard deviation then."""
        row = min(int(np.searchsorted(self.t_ns, t_ns)), len(self.t_ns) - 1)
        return float(self.down_m[row]), float(self.std_m[row])


@dataclass(frozen=True)
class Heights:
    """Live heights along a path, and the variance of their error."""

    path: PathArrays
    assumed: bool  # no evidence how high it began
    begin_m2: float  # variance of the shift at the first point
    grown_m2: Floats  # (n - 1,) increments until the next

    @staticmethod
    def of(evidence: UnitEvidence) -> Heights:
        path = evidence.path
        stated_m = _stated_m(path)
        begin_m2 = ANY_FLOOR_M**2 if evidence.height_assumed else float(stated_m[0]) ** 2
        walked_m = np.hypot(*np.diff(path.own_m, axis=0).T)
        grown = np.maximum(np.diff(np.maximum(stated_m, MIN_GROWTH_STD_M) ** 2), 0.0) + 1e-6
        grown += CLIMB_M_PER_SQRT_CLIMB_M**2 * np.abs(np.diff(path.down_m))
        grown += CLIMB_M_PER_SQRT_M**2 * walked_m
        grown += WANDER_M_PER_SQRT_S**2 * np.diff(path.t_ns) * 1e-9
        return Heights(path, evidence.height_assumed, begin_m2, grown)

    def expected(self, places: Sequence[PositionConstraint]) -> Prediction:
        """Prediction of places that give a height, without any of them."""
        rows = self._rows(places)
        variances = self.begin_m2 + np.concatenate(([0.0], np.cumsum(self.grown_m2)))
        return Prediction(
            mean_m=self.path.down_m[rows],
            covariance_m2=variances[np.minimum.outer(rows, rows)],
            seen_m=np.array([place.down_m for place in places]),
            noise_m2=np.array([place.down_std_m for place in places]) ** 2,
        )

    def consistent_set(self, places: Sequence[PositionConstraint]) -> list[int]:
        """Indices of constraints with height that can be true together.

        Those that fit the path within its stated deviation. One wrong floor moves no path; but a
        path may have missed a flight of stairs: accepted if two sources agree on it, not one beacon
        twice, and no fitting constraint lies between them.
        """
        if self.assumed:
            return consistent_set(self.expected(places))
        as_stated = [row for row, one in enumerate(places) if self.off(one)[1] ** 2 <= GATE2]
        if as_stated:
            together = consistent_set(self.expected([places[row] for row in as_stated]))
            as_stated = [as_stated[row] for row in together]
        others = [row for row in range(len(places)) if row not in as_stated]
        if len(others) < MIN_AGREEING:
            return as_stated
        missed = replace(self, begin_m2=ANY_FLOOR_M**2).expected([places[row] for row in others])
        same = [others[row] for row in consistent_set(missed)]
        if len({places[row].source_key for row in same}) < MIN_AGREEING:
            return as_stated
        times = [places[row].t_ns for row in same]
        is_denied = any(min(times) <= places[row].t_ns <= max(times) for row in as_stated)
        return as_stated if is_denied else sorted(as_stated + same)

    def off(self, place: PositionConstraint) -> tuple[float, float]:
        """Distance of a place below the live path (m), and the same in stated standard
        deviations.
        """
        assert place.down_m is not None
        (row,) = self._rows([place])
        below_m = place.down_m - float(self.path.down_m[row])
        stated_m = math.sqrt(self.begin_m2) if self.assumed else float(_stated_m(self.path)[row])
        return below_m, abs(below_m) / math.hypot(stated_m, place.down_std_m)

    def solve(self, places: Sequence[PositionConstraint]) -> Solved:
        """Solve with all constraints that give a height."""
        path, constraints = self.path, with_height(places)
        if not constraints:
            unknown_m = ANY_FLOOR_M if self.assumed else 0.0
            return Solved(path.t_ns, path.down_m, np.hypot(_stated_m(path), unknown_m), (0.0, None))
        begin_m2, grown_m2 = self._inflated_variances(constraints)
        diagonal, right = np.zeros(len(path)), np.zeros(len(path))
        diagonal[0] += 1.0 / begin_m2
        diagonal[:-1] += 1.0 / grown_m2
        diagonal[1:] += 1.0 / grown_m2
        for row, place in zip(self._rows(constraints), constraints, strict=True):
            assert place.down_m is not None
            diagonal[row] += 1.0 / place.down_std_m**2
            right[row] += (place.down_m - path.down_m[row]) / place.down_std_m**2
        banded = np.vstack((np.concatenate(([0.0], -1.0 / grown_m2)), diagonal))
        shift = solveh_banded(banded[-len(path) :], right)  # a single point has nothing beside it
        std = np.sqrt(_variances(diagonal, -1.0 / grown_m2))
        return Solved(path.t_ns, path.down_m + shift, std, (float(shift[-1]), float(std[-1])))

    def _inflated_variances(self, places: Sequence[PositionConstraint]) -> tuple[float, Floats]:
        """Variances of begin and steps, inflated between constraints that do not follow from each
        other, where something was missed.
        """
        begin_m2, grown_m2 = self.begin_m2, self.grown_m2.copy()
        before, off_m, known_m2 = 0, 0.0, begin_m2
        in_time = sorted(places, key=lambda place: place.t_ns)
        for place, row in zip(in_time, self._rows(in_time).tolist(), strict=True):
            below_m, _ = self.off(place)
            var_m2 = place.down_std_m**2
            since_m2 = float(grown_m2[before:row].sum())
            missed_m2 = (below_m - off_m) ** 2
            if missed_m2 > GATE2 * (known_m2 + since_m2 + var_m2):
                if row > before:
                    grown_m2[before:row] *= missed_m2 / since_m2
                else:
                    begin_m2 = max(begin_m2, missed_m2)
            before, off_m, known_m2 = row, below_m, var_m2
        return begin_m2, grown_m2

    def _rows(self, places: Sequence[PositionConstraint]) -> Ints:
        last = len(self.path) - 1
        return np.searchsorted(self.path.t_ns, [place.t_ns for place in places]).clip(0, last)


def with_height(places: Sequence[PositionConstraint]) -> list[PositionConstraint]:
    """Constraints that give a height."""
    return [place for place in places if place.down_m is not None]


def _stated_m(path: PathArrays) -> Floats:
    return np.maximum(path.down_std_m, 0.1)


def _variances(diagonal: Floats, beside: Floats) -> Floats:
    """Diagonal of the inverse of a symmetric tridiagonal matrix."""
    count = len(diagonal)
    ahead, behind = np.empty(count), np.empty(count)
    ahead[0] = diagonal[0]
    for row in range(1, count):
        ahead[row] = diagonal[row] - beside[row - 1] ** 2 / ahead[row - 1]
    behind[-1] = diagonal[-1]
    for row in range(count - 2, -1, -1):
        behind[row] = diagonal[row] - beside[row] ** 2 / behind[row + 1]
    return 1.0 / (ahead + behind - diagonal)
