"""All trails at once, as the least-squares solution of a graph of knots.

Each unit's own path is a chain (``chain``); fixes, places, headings and meetings hang on it.  The
first solution is linear whatever the headings are; where it tells a heading, turn and drift are
solved again about it, with less weight for fixes that do not fit (Gauss-Newton with a Cauchy
kernel; Grisetti et al. 2010, A tutorial on graph-based SLAM).  Places that contradict each other
or the rest are found before they can pull (``agreement``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.port import Present
from base_station.fusion.smoother.agreement import GATE2, Expected, agreeing, most_against
from base_station.fusion.smoother.chain import (
    STATES,
    Belief,
    Chain,
    WalkNoise,
    add_fixes,
    add_path,
    add_places,
    add_seen,
    place_of,
)
from base_station.fusion.smoother.equations import Equations, NormalEquations
from base_station.fusion.smoother.heights import solve_heights
from base_station.fusion.smoother.legs import Legs, add_legs, axis_of
from base_station.fusion.smoother.links import Link, Places, add_link, told_by_links
from base_station.fusion.smoother.live_estimates import add_shown, choose_shown, shown_floor_m
from base_station.fusion.smoother.marginals import chain_covariances, shared_spreads
from base_station.fusion.smoother.port import (
    PlaceSeen,
    SmoothedPath,
    Solution,
    Tie,
    UnitEvidence,
    Verdict,
)
from base_station.fusion.smoother.revisits import find_crossings
from base_station.fusion.smoother.shared import Shared

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


TIE_TAIL = 3.0  # standard deviations from which a meeting counts less


@dataclass(frozen=True)
class PathGraph:
    """Parameters, and the smoother itself."""

    name: str = "path-graph"
    noise: WalkNoise = field(default_factory=WalkNoise)
    knot_m: float = 3.0
    knot_s: float = 15.0
    turns: int = 10  # Gauss-Newton steps at most
    settled_m: float = 0.02  # no knot moved further: done
    aligned_rad: float = 0.5  # standard deviation from which a heading is told by the evidence

    def solve(self, units: Mapping[str, UnitEvidence], ties: Sequence[Tie] = ()) -> Solution:
        return _Graph(self, units, ties).solution()

    def smooth(self, units: Mapping[str, UnitEvidence], ties: Sequence[Tie] = ()) -> Solution:
        graph = _Graph(self, units, ties)
        graph.close_loops()
        return graph.solution()


class _Graph:
    """One problem and how far it is solved."""

    def __init__(
        self, kind: PathGraph, units: Mapping[str, UnitEvidence], ties: Sequence[Tie]
    ) -> None:
        self._kind = kind
        self._units = units
        self._ties = [t for t in ties if t.unit_id in units and t.other_id in units]
        self._chains = {
            unit_id: Chain.of(one, kind.noise, kind.knot_m, kind.knot_s)
            for unit_id, one in units.items()
        }
        self._bases: dict[str, int] = {}
        count = 0
        for unit_id, chain in self._chains.items():
            self._bases[unit_id] = count
            count += STATES * len(chain)
        self._shared = Shared(count, units)
        self._unknowns = self._shared.end
        self._beliefs = {one: Belief.none(len(chain)) for one, chain in self._chains.items()}
        self._legs = {unit_id: Legs.of(chain) for unit_id, chain in self._chains.items()}
        self._axis_rad: float | None = None
        self._shown: dict[str, Ints] = {}
        self._links = [
            Link((tie.unit_id, tie.t_ns), (tie.other_id, tie.t_ns), tie.std_m, TIE_TAIL)
            for tie in self._ties
        ]
        self._verdicts: dict[str, Verdict] = {}
        self._used: dict[str, list[PlaceSeen]] = {one: [] for one in units}
        self._normal = self._relax()
        if any(one.places for one in units.values()):
            self._choose_places()
            self._normal = self._relax()
            self._drop_misfits()
        self._heed_live_estimates()

    # ---- solving

    def _relax(self) -> NormalEquations:
        """Solve again and again about the last solution, until nothing moves."""
        self._beliefs = {one: Belief.none(len(chain)) for one, chain in self._chains.items()}
        self._axis_rad = None
        normal = self._equations()
        self._take(normal.solve())
        self._align(normal)
        for _ in range(self._kind.turns):
            if self._axis_rad is None:
                self._axis_rad = axis_of(self._legs, self._beliefs)
            normal = self._equations()
            if self._take(normal.solve()) < self._kind.settled_m:
                break
        return normal

    def _equations(self, with_links: bool = True) -> NormalEquations:
        equations = Equations(self._unknowns)
        self._shared.add_priors(equations)
        for unit_id in self._units:
            base, chain, belief = (
                self._bases[unit_id],
                self._chains[unit_id],
                self._beliefs[unit_id],
            )
            add_path(equations, base, chain, belief, self._shared, self._kind.noise)
            add_fixes(equations, base, chain, belief, self._shared, self._kind.noise)
            add_seen(equations, base, chain, self._used[unit_id])
            if self._axis_rad is not None:
                axis = self._axis_rad, self._shared.axis
                add_legs(equations, base, self._legs[unit_id], belief, axis)
            if unit_id in self._shown:
                shown = self._shown[unit_id]
                add_shown(equations, base, chain, belief, shown)
        for link in self._links if with_links else ():
            add_link(equations, link, self._places)
        return equations.normal()

    @property
    def _places(self) -> Places:
        return Places(self._chains, self._bases, self._beliefs)

    def _take(self, x: Floats) -> float:
        """Believe a solution; gives how far the furthest knot moved."""
        moved_m = 0.0
        if self._axis_rad is not None:
            self._axis_rad += float(x[self._shared.axis])
        self._shared.take(x)
        for unit_id, base in self._bases.items():
            belief = self._beliefs[unit_id]
            now = x[base : base + STATES * len(self._chains[unit_id])].reshape(-1, STATES)
            moved_m = max(moved_m, float(np.abs(now[:, :2] - belief.x[:, :2]).max()))
            belief.x = now
        return moved_m

    def _align(self, normal: NormalEquations) -> None:
        """See of which stretches the evidence tells the heading."""
        middles = [
            (unit_id, segment, (segment.start + segment.stop) // 2)
            for unit_id, chain in self._chains.items()
            for segment in chain.segments()
        ]
        rows = Equations(self._unknowns)
        for unit_id, _, middle in middles:
            column = np.array([self._bases[unit_id] + STATES * middle])
            rows.add(1.0, 0.0, (column + 2, 1.0))
            rows.add(1.0, 0.0, (column + 3, 1.0))
        spread = normal.spread_of(rows.matrix())
        for number, (unit_id, segment, middle) in enumerate(middles):
            belief = self._beliefs[unit_id]
            turn = belief.x[middle, 2:4]
            across = np.array([-turn[1], turn[0]]) / max(float(turn @ turn), 1e-9)
            pair = slice(2 * number, 2 * number + 2)
            told = float(across @ spread[pair, pair] @ across) < self._kind.aligned_rad**2
            belief.aligned[segment] = told and 0.5 < float(np.hypot(*turn)) < 2.0

    # ---- places that agree

    def _choose_places(self) -> None:
        for unit_id, evidence in self._units.items():
            if not evidence.places:
                continue
            expected = self._expected(unit_id, evidence.places)
            used = agreeing(expected)
            self._used[unit_id] = [evidence.places[one] for one in used]
            for one, place in enumerate(evidence.places):
                if one not in used:
                    self._verdicts[place.name] = _refused(expected, evidence.places, used, one)

    def _expected(self, unit_id: str, places: Sequence[PlaceSeen]) -> Expected:
        """What the solution as it is, without them, expects of places."""
        chain = self._chains[unit_id]
        knot, since = chain.at(np.array([place.t_ns for place in places], dtype=np.int64))
        rows = Equations(self._unknowns)
        for one in range(len(places)):
            column = np.array([self._bases[unit_id] + STATES * knot[one]])
            add_places(rows, column, since[one : one + 1], np.zeros((1, 2)), np.ones(1))
        return Expected(
            mean_m=place_of(self._beliefs[unit_id].x[knot], since).ravel(),
            covariance_m2=self._normal.spread_of(rows.matrix()),
            seen_m=np.array([(place.north_m, place.east_m) for place in places]).ravel(),
            noise_m2=np.array([place.std_m for place in places]) ** 2,
        )

    def _drop_misfits(self) -> None:
        """Scale and drift come in with the later steps only: what then does not fit goes too."""
        for unit_id, used in self._used.items():
            while used:
                apart_m = self._residuals_m(unit_id, used)
                worst = int(np.argmax(apart_m / [place.std_m for place in used]))
                if (apart_m[worst] / used[worst].std_m) ** 2 <= GATE2:
                    break
                place = used.pop(worst)
                sigmas = float(apart_m[worst]) / place.std_m
                self._verdicts[place.name] = Verdict(False, float(apart_m[worst]), sigmas)
                self._normal = self._relax()

    def _heed_live_estimates(self) -> None:
        """Walls are known to the live estimates only; after places, which may contradict them."""
        spreads = self._spreads()
        for unit_id, chain in self._chains.items():
            belief = self._beliefs[unit_id]
            rows = choose_shown(chain, belief, spreads[unit_id], self._used[unit_id])
            if len(rows):
                self._shown[unit_id] = rows
        if self._shown:
            self._normal = self._relax()

    def _residuals_m(self, unit_id: str, places: Sequence[PlaceSeen]) -> Floats:
        knot, since = self._chains[unit_id].at(np.array([p.t_ns for p in places], dtype=np.int64))
        seen = np.array([(place.north_m, place.east_m) for place in places])
        apart = place_of(self._beliefs[unit_id].x[knot], since) - seen
        distances: Floats = np.hypot(apart[:, 0], apart[:, 1])
        return distances

    # ---- what trails tell of each other

    def close_loops(self) -> None:
        """Where trails lead through the same narrow place again, they are drawn together."""
        crossings = find_crossings(self._chains, self._beliefs, self._spreads())
        if crossings:
            self._links += crossings
            self._normal = self._relax()

    # ---- what comes of it

    def solution(self) -> Solution:
        spreads = self._spreads()
        for unit_id, used in self._used.items():
            if used:
                self._judge_used(unit_id, used)
        for tie, link in zip(self._ties, self._links, strict=False):
            apart_m = self._places.apart_m(link)
            sigmas = apart_m / tie.std_m
            self._verdicts[tie.name] = Verdict(sigmas**2 <= GATE2, apart_m, sigmas)
        paths = {unit_id: self._smoothed(unit_id, spreads[unit_id]) for unit_id in self._units}
        return Solution(paths, self._verdicts)

    def _spreads(self) -> dict[str, Floats]:
        """Covariances of all knots (k, 5, 5) by unit."""
        information = self._equations(with_links=False).information
        chains = {
            unit_id: slice(base, base + STATES * len(self._chains[unit_id]))
            for unit_id, base in self._bases.items()
        }
        blocks = {unit_id: information[own, own].tocsc() for unit_id, own in chains.items()}
        together = shared_spreads(information, chains, self._shared.axis, STATES)
        spreads = {one: chain_covariances(block, STATES) for one, block in blocks.items()}
        if self._links:
            told = told_by_links(self._links, self._places, spreads)
            spreads = {
                one: chain_covariances(block, STATES, told[one]) for one, block in blocks.items()
            }
        return {one: spreads[one] + together[one] for one in spreads}

    def _judge_used(self, unit_id: str, used: Sequence[PlaceSeen]) -> None:
        for place, apart_m in zip(used, self._residuals_m(unit_id, used), strict=True):
            self._verdicts[place.name] = Verdict(True, float(apart_m), float(apart_m) / place.std_m)

    def _smoothed(self, unit_id: str, spreads: Floats) -> SmoothedPath:
        chain, belief = self._chains[unit_id], self._beliefs[unit_id]
        path = chain.path
        place, turn = _between_knots(chain, belief.x)
        covariance = spreads[:, :2, :2]
        knot = np.searchsorted(chain.knots, np.arange(len(path)), side="left")
        std_north = np.sqrt(covariance[:, 0, 0])
        std_east = np.sqrt(covariance[:, 1, 1])
        correlation = (covariance[:, 0, 1] / (std_north * std_east))[knot]
        floor_m = shown_floor_m(path, self._shown.get(unit_id))
        down, down_std, shift = solve_heights(path, self._used[unit_id])
        return SmoothedPath(
            t_ns=path.t_ns,
            north_m=place[:, 0],
            east_m=place[:, 1],
            down_m=down,
            std_north_m=np.maximum(std_north[knot], floor_m),
            std_east_m=np.maximum(std_east[knot], floor_m),
            correlation_ne=correlation * (std_north[knot] >= floor_m) * (std_east[knot] >= floor_m),
            std_down_m=down_std,
            turn_rad=np.arctan2(turn[:, 1], turn[:, 0]),
            present=Present(belief.x[-1].tolist(), spreads[-1].tolist(), *shift),
        )


def _between_knots(chain: Chain, x: Floats) -> tuple[Floats, Floats]:
    """Places (n, 2) and turns (n, 2) of all points: carried on from the knot before and back from
    the one behind, the nearer one counting more.
    """
    rows = np.arange(len(chain.path))
    after = np.searchsorted(chain.knots, rows, side="left")
    before = np.where(chain.knots[after] == rows, after, after - 1)
    own = chain.path.own_m
    walked = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(own, axis=0).T))))
    span = walked[chain.knots[after]] - walked[chain.knots[before]]
    part = ((walked - walked[chain.knots[before]]) / np.maximum(span, 1e-9))[:, None]
    part = np.clip(part, 0.0, 1.0)
    forth = place_of(x[before], own - chain.own_m[before])
    back = place_of(x[after], own - chain.own_m[after])
    turn = (1.0 - part) * x[before, 2:4] + part * x[after, 2:4]
    return (1.0 - part) * forth + part * back, turn


def _refused(
    expected: Expected, places: Sequence[PlaceSeen], used: Sequence[int], one: int
) -> Verdict:
    innovation, _ = expected.given(used, one)
    against = most_against(expected, used, one)
    return Verdict(
        used=False,
        residual_m=float(np.linalg.norm(innovation)),
        sigmas=float(np.sqrt(expected.distance2(used, one))),
        against="" if against is None else places[against].name,
    )
