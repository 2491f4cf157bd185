"""Least-squares problem of all paths, and its iterations.

Each unit's own path is a chain of knots; all evidence is attached to them. The first solution is
linear for any headings; where it shows a heading, turn and drift are solved again about it, with
less weight for misfits (Gauss-Newton with a Cauchy kernel; Grisetti et al. 2010, A tutorial on
graph-based SLAM).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.lazy_mapping import LastValueMapping
from base_station.fusion.smoothing.chain import STATES, Chain, PathEstimate, WalkNoise, place_of
from base_station.fusion.smoothing.common_errors import CommonErrors
from base_station.fusion.smoothing.consistency import Prediction
from base_station.fusion.smoothing.equations import Equations, NormalEquations
from base_station.fusion.smoothing.interface import PositionConstraint, UnitEvidence
from base_station.fusion.smoothing.landmarks import Landmark, Visit, Visited
from base_station.fusion.smoothing.live_estimates import add_shown
from base_station.fusion.smoothing.path_equations import (
    add_path,
    add_places,
    add_position_constraints,
)
from base_station.fusion.smoothing.receiver_errors import add_receiver
from base_station.fusion.smoothing.segment_constraints import Axes, PathSegments, add_segments
from base_station.fusion.smoothing.wall_constraints import WallMessages
from base_station.fusion.smoothing.wall_lines import Line, add_line, find_lines

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MAX_ITERATIONS = 10  # Gauss-Newton steps at most
CONVERGED_M = 0.02  # no knot moved further: done
UNINFORMATIVE_STD_M = 1e4  # standard deviation of a visit without information
ALIGNED_RAD = 0.5  # standard deviation below which the evidence gives a heading


class Graph:
    """Graph of chains and constraints; constraints beside path, start and fixes may be changed
    before ``relax``.
    """

    def __init__(self, units: Mapping[str, UnitEvidence], chains: dict[str, Chain]) -> None:
        self.chains = chains
        self.places: dict[str, list[PositionConstraint]] = {unit_id: [] for unit_id in units}
        self.shown: dict[str, Ints] = {}  # rows where the live estimate is heeded
        self.wall_messages: dict[str, WallMessages] = {}  # of walls
        self.landmarks: list[Landmark] = []
        self._lines: list[Line] = []
        self.estimates = {one: PathEstimate.none(len(chain)) for one, chain in chains.items()}
        self._columns: dict[str, slice] = {}
        first = 0
        for unit_id, chain in chains.items():
            self._columns[unit_id] = slice(first, first + STATES * len(chain))
            first = self._columns[unit_id].stop
        self.common = CommonErrors(first, units)
        self._bases = {unit_id: columns.start for unit_id, columns in self._columns.items()}
        self.visited = Visited(self._bases, self.estimates)
        self._segments = {unit_id: PathSegments.of(chain) for unit_id, chain in chains.items()}
        self._axes: Axes | None = None
        self._normal: NormalEquations

    def visit(self, unit_id: str, t_ns: int) -> Visit:
        knot, since = self.chains[unit_id].at(np.array([t_ns], dtype=np.int64))
        return Visit(unit_id, int(knot[0]), since[0])

    def add_landmarks(self, landmarks: Sequence[Landmark]) -> None:
        """Add landmarks that paths lead through, at unknown places."""
        self.landmarks += landmarks
        for one in landmarks:
            self.common.add_landmarks(self.visited.places_m(one).mean(axis=0))

    def reject_landmarks(self, numbers: Sequence[int]) -> None:
        """Remove the weight of these landmarks."""
        for number in numbers:
            self.landmarks[number] = replace(self.landmarks[number], std_m=UNINFORMATIVE_STD_M)

    def find_lines(self) -> bool:
        """Lines that people walk along again and again, as it looks now, in place of those found
        before; false: there are and were none.
        """
        if self._axes is None or not self._axes.are_shown:
            return False
        before, spreads = self._lines, self.own_spreads()
        self._lines = find_lines(self._segments, self.estimates, spreads, self._axes)
        self.common.set_lines(len(self._lines))
        return bool(before or self._lines)

    def relax(self, noise: WalkNoise) -> None:
        """Solve from the beginning, and then about that."""
        for unit_id, chain in self.chains.items():
            self.estimates[unit_id] = PathEstimate.none(len(chain))
        self.common.forget()
        self._axes = None
        self.step(noise)
        self._align()
        self.iterate(noise)

    def iterate(self, noise: WalkNoise) -> None:
        """Solve about the last solution until no knot moves."""
        for _ in range(MAX_ITERATIONS):
            if self._axes is None:
                self._axes = Axes(self._segments, self.estimates)
            self._axes.update(self.estimates)
            if self.step(noise) < CONVERGED_M:
                break

    def step(self, noise: WalkNoise) -> float:
        """Solve once about the last solution; returns the largest movement of a knot (m)."""
        if hasattr(self, "_normal"):
            del self._normal  # it is the largest array: never two of them
        self._normal = self._equations(noise)
        of_chains, shared = self._normal.solve()
        moved_m = 0.0
        if self._axes is not None:
            self._axes.rad += shared[self.common.axes - self.common.first]
        self.common.take(shared)
        for unit_id, x in of_chains.items():
            estimate, now = self.estimates[unit_id], x.reshape(-1, STATES)
            moved_m = max(moved_m, float(np.abs(now[:, :2] - estimate.x[:, :2]).max()))
            estimate.x = now
        return moved_m

    def _equations(self, noise: WalkNoise) -> NormalEquations:
        shared = Equations(self.common.end)
        self.common.add_priors(shared)
        of_chains = ((unit_id, self._of_chain(unit_id, noise)) for unit_id in self.chains)
        return NormalEquations(self._columns, STATES, of_chains, self._links(), shared)

    def _of_chain(self, unit_id: str, noise: WalkNoise) -> Equations:
        equations, common = Equations(self.common.end), self.common
        chain, estimate = self.chains[unit_id], self.estimates[unit_id]
        base = self._columns[unit_id].start
        add_path(equations, base, chain, estimate, common, noise)
        add_receiver(equations, base, chain, estimate, common)
        add_position_constraints(equations, base, chain, self.places[unit_id])
        if self._axes is not None:
            columns = common.axes[0] + self._axes.building[unit_id]
            axes = self._axes.of(unit_id), columns
            add_segments(equations, base, self._segments[unit_id], estimate, axes)
        if unit_id in self.shown:
            add_shown(equations, base, chain, estimate, self.shown[unit_id])
        if unit_id in self.wall_messages:
            self.wall_messages[unit_id].add(equations, base, common.plan)
        return equations

    def _links(self) -> Equations:
        """Equations of landmarks and lines, which join several chains."""
        equations, common = Equations(self.common.end), self.common
        column = common.landmarks
        for landmark, place_m in zip(self.landmarks, common.landmarks_m, strict=True):
            self.visited.add(equations, landmark, column, place_m)
            column += 2
        if self._axes is not None:
            axes = self._axes.rad, common.axes
            for column, line in enumerate(self._lines, start=common.lines):
                add_line(equations, line, column, axes, self._bases, self.estimates)
        return equations

    def _align(self) -> None:
        """Find the parts of paths whose heading the evidence shows."""
        for unit_id, chain in self.chains.items():
            segments = chain.segments()
            middles = [(segment.start + segment.stop) // 2 for segment in segments]
            rows, base = Equations(self.common.end), self._columns[unit_id].start
            for middle in middles:
                column = np.array([base + STATES * middle])
                rows.add(1.0, 0.0, (column + 2, 1.0))
                rows.add(1.0, 0.0, (column + 3, 1.0))
            spread, estimate = (
                self._normal.spread_of(unit_id, rows.matrix()),
                self.estimates[unit_id],
            )
            for number, (segment, middle) in enumerate(zip(segments, middles, strict=True)):
                turn = estimate.x[middle, 2:4]
                across = np.array([-turn[1], turn[0]]) / max(float(turn @ turn), 1e-9)
                pair = slice(2 * number, 2 * number + 2)
                is_observed = float(across @ spread[pair, pair] @ across) < ALIGNED_RAD**2
                estimate.aligned[segment] = is_observed and 0.5 < float(np.hypot(*turn)) < 2.0

    # ---- results of the solution

    def expected(self, unit_id: str, places: Sequence[PositionConstraint]) -> Prediction:
        """Prediction of places that the solution does not use."""
        chain = self.chains[unit_id]
        knot, since = chain.at(np.array([place.t_ns for place in places], dtype=np.int64))
        rows = Equations(self.common.end)
        for one in range(len(places)):
            column = np.array([self._columns[unit_id].start + STATES * knot[one]])
            add_places(rows, column, since[one : one + 1], np.zeros((1, 2)), np.ones(1))
        return Prediction(
            mean_m=place_of(self.estimates[unit_id].x[knot], since).ravel(),
            covariance_m2=self._normal.spread_of(unit_id, rows.matrix()),
            seen_m=np.array([(place.north_m, place.east_m) for place in places]).ravel(),
            noise_m2=np.array([place.std_m for place in places]) ** 2,
        )

    def residuals_m(self, unit_id: str, places: Sequence[PositionConstraint]) -> Floats:
        """Between the trail and places."""
        knot, since = self.chains[unit_id].at(np.array([p.t_ns for p in places], dtype=np.int64))
        seen = np.array([(place.north_m, place.east_m) for place in places])
        apart = place_of(self.estimates[unit_id].x[knot], since) - seen
        distances: Floats = np.hypot(apart[:, 0], apart[:, 1])
        return distances

    def spreads(self, *, on_plan: bool = False) -> Mapping[str, Floats]:
        """Covariances of all knots (k, 7, 7) by unit; ``on_plan``: of where they lie on the plan,
        which may lie aside itself.
        """
        plus = self.common.plan - self.common.first if on_plan else None
        normal = self._normal
        return LastValueMapping(
            self.chains,
            lambda one: normal.covariances(one) + normal.shared_covariances(one, plus),
        )

    def own_spreads(self) -> Mapping[str, Floats]:
        """Covariances of all knots without the shared errors."""
        return LastValueMapping(self.chains, self._normal.covariances)
