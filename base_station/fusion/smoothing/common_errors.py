"""Errors that all units share, as unknowns of the problem.

A start position is given once for all units that begin there; satellites, clocks and atmosphere act
on all receivers of a site. Taken for independent errors, six units that agree would look like
proof.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.gnss.common_mode_error import COMMON_S, common_m2
from base_station.fusion.interface import Start
from base_station.fusion.smoothing.equations import Equations
from base_station.fusion.smoothing.interface import UnitEvidence
from base_station.fusion.smoothing.segment_constraints import AXES
from shared.clock import NS_PER_S

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Term = tuple[Ints, Floats | float]

AXIS_STD_RAD = 0.3  # of the variance that is added in one step
START_PART = 0.65  # of a start's variance: that error is common to all who begin there
PLAN_STD_M = 0.25  # by which plans lie aside, each axis
COMMON_KNOT_S = 600.0  # from one knot of the common error to the next


class CommonErrors:
    """Columns behind those of the chains: what has to be added to the buildings' axes, and pairs
    of north and east: how far off each place is where units begin, the receivers' common error at
    knots of time, how far off the plan lies, and landmarks.  At the end, how far across each line
    lies that people walk along.
    """

    def __init__(self, first: int, units: Mapping[str, UnitEvidence]) -> None:
        self.first, self.axes = first, first + np.arange(AXES)
        self._starts: dict[tuple[float, float, float], int] = {}
        for unit in units.values():
            if unit.start is not None:
                self._starts.setdefault(
                    _start_key(unit.start), first + AXES + 2 * len(self._starts)
                )
        fixes = [unit.path.fix_t_ns for unit in units.values() if len(unit.path.fix_t_ns)]
        self._common = first + AXES + 2 * len(self._starts)
        self._common_t_ns, self.common_std_m = np.zeros(0, dtype=np.int64), 0.0
        if fixes:
            begin, end = min(t_ns[0] for t_ns in fixes), max(t_ns[-1] for t_ns in fixes)
            step_ns = int(COMMON_KNOT_S * NS_PER_S)
            self._common_t_ns = np.arange(begin, end + step_ns, step_ns, dtype=np.int64)
            best_m = min(u.path.fix_std_m.min() for u in units.values() if len(u.path.fix_t_ns))
            self.common_std_m = float(np.sqrt(common_m2(best_m)))
        self.plan = self._common + 2 * len(self._common_t_ns)
        self.landmarks = self.lines = self.end = self.plan + 2
        self._x = np.zeros(self.end - first)  # the last estimate

    def add_priors(self, equations: Equations) -> None:
        equations.add(AXIS_STD_RAD, 0.0, (self.axes, 1.0))
        for (_, _, std_m), column in self._starts.items():
            equations.add(np.sqrt(START_PART) * std_m, 0.0, (np.array([column, column + 1]), 1.0))
        equations.add(PLAN_STD_M, 0.0, (np.array([self.plan, self.plan + 1]), 1.0))
        knots = len(self._common_t_ns)
        if not knots:
            return
        first, keep = np.array([self._common, self._common + 1]), np.exp(-COMMON_KNOT_S / COMMON_S)
        equations.add(self.common_std_m, 0.0, (first, 1.0))
        here = self._common + np.arange(2 * (knots - 1))
        fresh_m = self.common_std_m * np.sqrt(1.0 - keep**2)
        equations.add(fresh_m, 0.0, (here + 2, 1.0), (here, -keep))

    def start(self, start: Start) -> tuple[Ints, float]:
        """Columns (1,) of the north error of a start position, and the variance of the part that is
        each unit's own.
        """
        column = self._starts[_start_key(start)]
        return np.array([column]), (1.0 - START_PART) * _start_key(start)[2] ** 2

    def common_mode(self, t_ns: Ints) -> tuple[Term, Term]:
        """The common error north at these times, as two knots' with their parts; that east is a
        column further.
        """
        last = max(len(self._common_t_ns) - 2, 0)
        knot = np.clip(np.searchsorted(self._common_t_ns, t_ns, side="right") - 1, 0, last)
        part = (t_ns - self._common_t_ns[knot]) / (COMMON_KNOT_S * NS_PER_S)
        columns = self._common + 2 * knot
        behind = np.minimum(columns + 2, self.plan - 2)
        return (columns, 1.0 - part), (behind, part)

    def add_landmarks(self, places_m: Floats) -> None:
        """Add landmarks (n, 2) at their estimated places; before any lines."""
        self._x = np.concatenate((self._x, places_m.ravel()))
        self.lines = self.end = self.end + places_m.size

    def set_lines(self, count: int) -> None:
        """In place of those there were."""
        self.end = self.lines + count

    def forget(self) -> None:
        """Reset the estimates to zero."""
        self._x = np.zeros(self.lines - self.first)

    def take(self, x: Floats) -> None:
        """Set the estimates from a solution of the shared unknowns."""
        self._x = x[: self.lines - self.first]

    @property
    def plan_m(self) -> Floats:
        """Estimated offset of the plan, north and east (2,)."""
        return self._x[self.plan - self.first :][:2]

    @property
    def landmarks_m(self) -> Floats:
        """Estimated places of landmarks (n, 2)."""
        return self._x[self.landmarks - self.first :].reshape(-1, 2)

    def common_mode_m(self, t_ns: Ints) -> Floats:
        """Estimated common-mode error (n, 2)."""
        off_m = np.zeros((len(t_ns), 2))
        for columns, parts in self.common_mode(t_ns):
            rows = columns - self.first
            off_m += np.asarray(parts)[:, None] * self._x[rows[:, None] + [0, 1]]
        return off_m


def _start_key(start: Start) -> tuple[float, float, float]:
    return start.north_m, start.east_m, max(start.std_m, 0.01)
