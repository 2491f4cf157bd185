"""Path graph: all paths as one least-squares solution, and the order in which constraints enter.

The stages: build (the graph with paths, fixes, encounters and the consistent set of position
constraints), solve (live estimates, walls and closed loops enter last, as they may have held a
person in the wrong room) and marginals (paths with their deviations, and verdicts).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.smoothing.chain import WALKED, Chain, WalkNoise
from base_station.fusion.smoothing.encounters import Encounters
from base_station.fusion.smoothing.graph import Graph
from base_station.fusion.smoothing.heights import Heights
from base_station.fusion.smoothing.interface import (
    EncounterConstraint,
    PositionConstraint,
    SmoothedPath,
    Solution,
    UnitEvidence,
    Verdict,
)
from base_station.fusion.smoothing.live_estimates import choose_shown, shown_floor_m
from base_station.fusion.smoothing.place_choice import (
    choose_places,
    reject_outliers,
    used_verdicts,
)
from base_station.fusion.smoothing.stairs import find_stairs
from base_station.fusion.smoothing.trail import trail_of
from base_station.fusion.smoothing.wall_constraints import WallMessages, WallSegments

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SWEEPS = 6  # over the wall constraints
LINE_SWEEPS = 2  # over which lines legs are of
COARSEST = 20.0  # times as far apart as they are wanted
CONTRADICTED = 0.3  # of log weight lost a piece, on the mean: the plan or the path is wrong


@dataclass(frozen=True)
class PathGraph:
    """Parameters, and the smoother itself."""

    name: str = "path-graph"
    noise: WalkNoise = field(default_factory=WalkNoise)
    knot_m: float = 3.0
    knot_s: float = 15.0
    most_knots: int = 100_000  # of all units: beyond that they are further apart

    def solve(
        self, units: Mapping[str, UnitEvidence], encounters: Sequence[EncounterConstraint] = ()
    ) -> Solution:
        return marginals(self._solved(units, encounters))

    def smooth(
        self, units: Mapping[str, UnitEvidence], encounters: Sequence[EncounterConstraint] = ()
    ) -> Solution:
        problem = self._solved(units, encounters)
        close_loops(problem)
        return marginals(problem)

    def _solved(
        self, units: Mapping[str, UnitEvidence], encounters: Sequence[EncounterConstraint]
    ) -> PathProblem:
        chains, meetings = self._chains(units), Encounters(units, encounters)
        problem = build(units, chains, meetings, self.noise)
        while meetings.split_by_floor(problem.graph):
            del problem  # its solution is the largest array: never two of them
            problem = build(units, chains, meetings, self.noise)
        add_live_estimates(problem)
        add_wall_constraints(problem)
        return problem

    def _chains(self, units: Mapping[str, UnitEvidence]) -> dict[str, Chain]:
        """With knots as far apart as there may be so many of."""
        coarser, chains = 1.0, dict[str, Chain]()
        while not chains or (
            sum(map(len, chains.values())) > self.most_knots and coarser < COARSEST
        ):
            chains = {
                unit_id: Chain.of(one, self.noise, coarser * self.knot_m, coarser * self.knot_s)
                for unit_id, one in units.items()
            }
            coarser *= 1.5
        return chains


@dataclass(frozen=True)
class PathProblem:
    """One problem on its way, and the verdicts on constraints so far."""

    units: Mapping[str, UnitEvidence]
    encounters: Encounters
    noise: WalkNoise
    graph: Graph
    verdicts: dict[str, Verdict]


# ---- build


def build(
    units: Mapping[str, UnitEvidence],
    chains: dict[str, Chain],
    encounters: Encounters,
    noise: WalkNoise,
) -> PathProblem:
    """Solve by paths, fixes, encounters and the consistent set of constraints."""
    verdicts: dict[str, Verdict] = {}
    graph = Graph(units, chains)
    encounters.add_to(graph)
    graph.relax(noise)
    if any(one.places for one in units.values()):
        for unit_id, evidence in units.items():
            if evidence.places:
                graph.places[unit_id], rejected = choose_places(graph, unit_id, evidence)
                verdicts |= rejected
        graph.relax(noise)
        for unit_id in graph.places:
            verdicts |= reject_outliers(graph, unit_id, noise)
    return PathProblem(units, encounters, noise, graph, verdicts)


# ---- solve


def add_live_estimates(problem: PathProblem) -> None:
    """Add live estimates where only they used the building model or walls."""
    graph, spreads = problem.graph, problem.graph.spreads()
    for unit_id, chain in graph.chains.items():
        estimate, places = graph.estimates[unit_id], graph.places[unit_id]
        rows = choose_shown(chain, estimate, spreads[unit_id], places)
        if len(rows):
            graph.shown[unit_id] = rows
    del spreads  # they hold the last solution
    if graph.shown:
        graph.relax(problem.noise)


def add_wall_constraints(problem: PathProblem) -> None:
    """Replace live estimates by the plan's walls where the path is known well enough for those.
    Where walls are crossed again and again the plan is of another building, and neither is used.
    """
    graph, shown = problem.graph, dict(problem.graph.shown)
    for unit_id, unit in problem.units.items():
        if unit.grid is not None:
            wall_messages = WallMessages(WallSegments.of(graph.chains[unit_id], unit.grid))
            if len(wall_messages.segments):
                graph.wall_messages[unit_id] = wall_messages
    for sweep in range(SWEEPS if graph.wall_messages else 0):
        spreads = graph.spreads(on_plan=True)
        for unit_id, wall_messages in list(graph.wall_messages.items()):
            wall_messages.update(graph.estimates[unit_id], graph.common.plan_m, spreads[unit_id])
            if sweep > 0 and wall_messages.log_loss > CONTRADICTED:
                del graph.wall_messages[unit_id]
                graph.shown.pop(unit_id, None)
            elif unit_id in shown:
                chain = graph.chains[unit_id]
                graph.shown[unit_id] = _without_message(chain, shown[unit_id], wall_messages)
        del spreads
        graph.step(problem.noise)


def _without_message(chain: Chain, rows: Ints, wall_messages: WallMessages) -> Ints:
    """Rows of the path on segments that have no message of walls."""
    knots, _ = chain.at(chain.path.t_ns[rows])
    with_message = wall_messages.segments.knot[wall_messages.is_known]
    return rows[~np.isin(knots, with_message)]


def close_loops(problem: PathProblem) -> None:
    """Close loops where paths lead over the same stairs or along the same line again; lines
    only where no plan's walls are used, which are better.
    """
    graph = problem.graph
    stairs = find_stairs(graph.chains, graph.estimates, graph.own_spreads())
    if stairs:
        graph.add_landmarks(stairs)
        graph.iterate(problem.noise)
    for _ in range(0 if graph.wall_messages else LINE_SWEEPS):
        if graph.find_lines():
            graph.iterate(problem.noise)


# ---- marginals


def marginals(problem: PathProblem) -> Solution:
    """Paths with their deviations, and a verdict on each constraint."""
    graph, encounters = problem.graph, problem.encounters
    refused = encounters.reject(graph, problem.noise)
    verdicts = dict(problem.verdicts)
    for unit_id in graph.places:
        verdicts |= used_verdicts(graph, unit_id)
    verdicts |= encounters.verdicts(graph, refused)
    spreads = graph.spreads()
    on_plan = graph.spreads(on_plan=True) if graph.wall_messages else spreads
    heights = encounters.height_constraints(graph, verdicts)
    paths = {
        one: _smoothed_path(problem, one, spreads[one], on_plan[one], heights[one])
        for one in problem.units
    }
    return Solution(paths, {**verdicts, **encounters.floor_conflicts})


def _smoothed_path(
    problem: PathProblem,
    unit_id: str,
    spreads: Floats,
    on_plan: Floats,
    encounter_heights: Sequence[PositionConstraint],
) -> SmoothedPath:
    """Solved path of one unit; with walls it continues from a place on the plan, as a fuser
    uses the walls as drawn.
    """
    graph = problem.graph
    chain, estimate = graph.chains[unit_id], graph.estimates[unit_id]
    least_m = shown_floor_m(chain.path, graph.shown.get(unit_id))
    now, known = estimate.x[-1, :WALKED].copy(), spreads[-1, :WALKED, :WALKED]
    if unit_id in graph.wall_messages:
        now[:2] += graph.common.plan_m
        known = on_plan[-1, :WALKED, :WALKED]
    constraints = [*graph.places[unit_id], *encounter_heights]
    heights = Heights.of(problem.units[unit_id]).solve(constraints)
    return trail_of(chain, estimate, spreads, least_m, heights, (now, known))
