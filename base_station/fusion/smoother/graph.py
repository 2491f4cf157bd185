"""The one least-squares problem of all trails, and how far it is solved.

Each unit's own path is a chain of knots; whatever is known of it hangs on that.  The first
solution is linear whatever the headings are; where it tells a heading, turn and drift are solved
again about it, with less weight for what does not fit (Gauss-Newton with a Cauchy kernel; Grisetti
et al. 2010, A tutorial on graph-based SLAM).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.smoother.agreement import Expected
from base_station.fusion.smoother.chain import STATES, Belief, Chain, WalkNoise, place_of
from base_station.fusion.smoother.common_errors import CommonErrors
from base_station.fusion.smoother.equations import Equations, NormalEquations
from base_station.fusion.smoother.landmarks import Landmark, Visit, Visited
from base_station.fusion.smoother.legs import Axes, Legs, add_legs
from base_station.fusion.smoother.live_estimates import add_shown
from base_station.fusion.smoother.marginals import chain_covariances, shared_spreads
from base_station.fusion.smoother.path_equations import add_path, add_places, add_seen
from base_station.fusion.smoother.port import PlaceSeen, UnitEvidence
from base_station.fusion.smoother.receiver_errors import add_receiver
from base_station.fusion.smoother.wall_lines import Line, add_line, find_lines
from base_station.fusion.smoother.walls import Words

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TURNS = 10  # Gauss-Newton steps at most
SETTLED_M = 0.02  # no knot moved further: done
NO_PULL_M = 1e4  # standard deviation of a visit that tells nothing
ALIGNED_RAD = 0.5  # standard deviation from which a heading is told by the evidence


class Graph:
    """What hangs on the chains beside path, start and fixes may be changed; then ``relax``."""

    def __init__(self, units: Mapping[str, UnitEvidence], chains: dict[str, Chain]) -> None:
        self.chains = chains
        self.places: dict[str, list[PlaceSeen]] = {unit_id: [] for unit_id in units}
        self.shown: dict[str, Ints] = {}  # rows where the live estimate is heeded
        self.words: dict[str, Words] = {}  # of walls
        self.landmarks: list[Landmark] = []
        self._lines: list[Line] = []
        self.beliefs = {one: Belief.none(len(chain)) for one, chain in chains.items()}
        self._columns: dict[str, slice] = {}
        first = 0
        for unit_id, chain in chains.items():
            self._columns[unit_id] = slice(first, first + STATES * len(chain))
            first = self._columns[unit_id].stop
        self.common = CommonErrors(first, units)
        self._bases = {unit_id: columns.start for unit_id, columns in self._columns.items()}
        self.visited = Visited(self._bases, self.beliefs)
        self._legs = {unit_id: Legs.of(chain) for unit_id, chain in chains.items()}
        self._axes: Axes | None = None
        self._normal: NormalEquations

    def visit(self, unit_id: str, t_ns: int) -> Visit:
        knot, since = self.chains[unit_id].at(np.array([t_ns], dtype=np.int64))
        return Visit(unit_id, int(knot[0]), since[0])

    def lead_through(self, landmarks: Sequence[Landmark]) -> None:
        """Paths led through these places too, wherever those are."""
        self.landmarks += landmarks
        for one in landmarks:
            self.common.add_landmarks(self.visited.places_m(one).mean(axis=0))

    def let_go(self, numbers: Sequence[int]) -> None:
        """Paths no longer lead through these landmarks."""
        for number in numbers:
            self.landmarks[number] = replace(self.landmarks[number], std_m=NO_PULL_M)

    def find_lines(self) -> bool:
        """Lines that people walk along again and again, as it looks now, in place of those found
        before; false: there are and were none.
        """
        if self._axes is None or not self._axes.are_shown:
            return False
        before, spreads = self._lines, self.own_spreads()
        self._lines = find_lines(self._legs, self.beliefs, spreads, self._axes)
        self.common.set_lines(len(self._lines))
        return bool(before or self._lines)

    def relax(self, noise: WalkNoise) -> None:
        """Solve from the beginning, and then about that."""
        for unit_id, chain in self.chains.items():
            self.beliefs[unit_id] = Belief.none(len(chain))
        self.common.forget()
        self._axes = None
        self.step(noise)
        self._align()
        self.settle(noise)

    def settle(self, noise: WalkNoise) -> None:
        """Solve about what is believed, again and again, until nothing moves."""
        for _ in range(TURNS):
            if self._axes is None:
                self._axes = Axes(self._legs, self.beliefs)
            self._axes.look(self.beliefs)
            if self.step(noise) < SETTLED_M:
                break

    def step(self, noise: WalkNoise) -> float:
        """Solve once about what is believed; gives how far the furthest knot moved."""
        self._normal = self._equations(noise)
        x, moved_m = self._normal.solve(), 0.0
        if self._axes is not None:
            self._axes.rad += x[self.common.axes]
        self.common.take(x)
        for unit_id, columns in self._columns.items():
            belief, now = self.beliefs[unit_id], x[columns].reshape(-1, STATES)
            moved_m = max(moved_m, float(np.abs(now[:, :2] - belief.x[:, :2]).max()))
            belief.x = now
        return moved_m

    def _equations(self, noise: WalkNoise) -> NormalEquations:
        equations, common = Equations(self.common.end), self.common
        common.add_priors(equations)
        for unit_id, chain in self.chains.items():
            base, belief = self._columns[unit_id].start, self.beliefs[unit_id]
            add_path(equations, base, chain, belief, common, noise)
            add_receiver(equations, base, chain, belief, common)
            add_seen(equations, base, chain, self.places[unit_id])
            if self._axes is not None:
                columns = common.axes[0] + self._axes.building[unit_id]
                axes = self._axes.of(unit_id), columns
                add_legs(equations, base, self._legs[unit_id], belief, axes)
            if unit_id in self.shown:
                add_shown(equations, base, chain, belief, self.shown[unit_id])
            if unit_id in self.words:
                self.words[unit_id].add(equations, base, common.plan)
        column = common.landmarks
        for landmark, place_m in zip(self.landmarks, common.landmarks_m, strict=True):
            self.visited.add(equations, landmark, column, place_m)
            column += 2
        if self._axes is not None:
            axes = self._axes.rad, common.axes
            for column, line in enumerate(self._lines, start=common.lines):
                add_line(equations, line, column, axes, self._bases, self.beliefs)
        return equations.normal(self._columns, STATES)

    def _align(self) -> None:
        """See of which stretches the evidence tells the heading."""
        middles = [
            (unit_id, segment, (segment.start + segment.stop) // 2)
            for unit_id, chain in self.chains.items()
            for segment in chain.segments()
        ]
        rows = Equations(self.common.end)
        for unit_id, _, middle in middles:
            column = np.array([self._columns[unit_id].start + STATES * middle])
            rows.add(1.0, 0.0, (column + 2, 1.0))
            rows.add(1.0, 0.0, (column + 3, 1.0))
        spread = self._normal.spread_of(rows.matrix())
        for number, (unit_id, segment, middle) in enumerate(middles):
            belief = self.beliefs[unit_id]
            turn = belief.x[middle, 2:4]
            across = np.array([-turn[1], turn[0]]) / max(float(turn @ turn), 1e-9)
            pair = slice(2 * number, 2 * number + 2)
            told = float(across @ spread[pair, pair] @ across) < ALIGNED_RAD**2
            belief.aligned[segment] = told and 0.5 < float(np.hypot(*turn)) < 2.0

    # ---- what the solution says

    def expected(self, unit_id: str, places: Sequence[PlaceSeen]) -> Expected:
        """What the solution as it is expects of places that it does not know."""
        chain = self.chains[unit_id]
        knot, since = chain.at(np.array([place.t_ns for place in places], dtype=np.int64))
        rows = Equations(self.common.end)
        for one in range(len(places)):
            column = np.array([self._columns[unit_id].start + STATES * knot[one]])
            add_places(rows, column, since[one : one + 1], np.zeros((1, 2)), np.ones(1))
        return Expected(
            mean_m=place_of(self.beliefs[unit_id].x[knot], since).ravel(),
            covariance_m2=self._normal.spread_of(rows.matrix()),
            seen_m=np.array([(place.north_m, place.east_m) for place in places]).ravel(),
            noise_m2=np.array([place.std_m for place in places]) ** 2,
        )

    def residuals_m(self, unit_id: str, places: Sequence[PlaceSeen]) -> Floats:
        """Between the trail and places."""
        knot, since = self.chains[unit_id].at(np.array([p.t_ns for p in places], dtype=np.int64))
        seen = np.array([(place.north_m, place.east_m) for place in places])
        apart = place_of(self.beliefs[unit_id].x[knot], since) - seen
        distances: Floats = np.hypot(apart[:, 0], apart[:, 1])
        return distances

    def spreads(self, *, on_plan: bool = False) -> dict[str, Floats]:
        """Covariances of all knots (k, 7, 7) by unit; ``on_plan``: of where they lie on the plan,
        which may lie aside itself.
        """
        plus = self.common.plan - int(self.common.axes[0]) if on_plan else None
        normal = self._normal
        shared = shared_spreads(normal.leans, normal.shared_covariance, STATES, plus)
        own = self.own_spreads()
        return {one: own[one] + shared[one] for one in own}

    def own_spreads(self) -> dict[str, Floats]:
        """The same without what all units err by together."""
        blocks = self._normal.blocks
        return {one: chain_covariances(block, STATES) for one, block in blocks.items()}
