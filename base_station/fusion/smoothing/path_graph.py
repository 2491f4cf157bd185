"""Path graph: all paths as one least-squares solution, and the order in which constraints enter.

Constraints that contradict each other or the rest are found before they can act (``consistency``),
and so are encounters of two units on different floors. Live estimates and walls enter last, as they
may have held a person in the wrong room.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.smoothing.chain import WALKED, Chain, WalkNoise
from base_station.fusion.smoothing.consistency import (
    GATE2,
    ConditionalPrediction,
    Prediction,
    consistent_set,
    strongest_conflict,
)
from base_station.fusion.smoothing.graph import Graph
from base_station.fusion.smoothing.heights import Heights, Solved, with_height
from base_station.fusion.smoothing.interface import (
    ON_FLOOR_STD_M,
    EncounterConstraint,
    PositionConstraint,
    SmoothedPath,
    Solution,
    UnitEvidence,
    Verdict,
)
from base_station.fusion.smoothing.landmarks import Landmark
from base_station.fusion.smoothing.live_estimates import choose_shown, shown_floor_m
from base_station.fusion.smoothing.stairs import find_stairs
from base_station.fusion.smoothing.trail import trail_of
from base_station.fusion.smoothing.wall_constraints import WallMessages, WallSegments

Floats = NDArray[np.float64]

ENCOUNTER_TAIL = 3.0  # standard deviations from which a meeting counts less
REJECTION_ROUNDS = 3  # rounds in which meetings that do not fit are let go
SWEEPS = 6  # over what walls say
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
        return _Solver(self, units, encounters).solution()

    def smooth(
        self, units: Mapping[str, UnitEvidence], encounters: Sequence[EncounterConstraint] = ()
    ) -> Solution:
        solving = _Solver(self, units, encounters)
        solving.close_loops()
        return solving.solution()


class _Solver:
    """One problem on its way."""

    def __init__(
        self,
        kind: PathGraph,
        units: Mapping[str, UnitEvidence],
        encounters: Sequence[EncounterConstraint],
    ) -> None:
        self._noise = kind.noise
        self._units = units
        self._encounters = [t for t in encounters if t.unit_id in units and t.other_id in units]
        self._chains = _chains(kind, units)
        self._floor_conflicts: dict[str, Verdict] = {}  # by tie: they were on different floors
        self._begin()
        while self._split_encounters_by_floor():
            self._begin()
        self._add_live_estimates()
        self._add_wall_constraints()

    def _begin(self) -> None:
        """Solve by paths, fixes, encounters and the consistent set of constraints."""
        self._verdicts: dict[str, Verdict] = {}
        self._graph = Graph(self._units, self._chains)
        self._graph.add_landmarks([self._meeting(encounter) for encounter in self._encounters])
        self._graph.relax(self._noise)
        if any(one.places for one in self._units.values()):
            self._choose_places()
            self._graph.relax(self._noise)
            self._reject_outliers()

    def _meeting(self, encounter: EncounterConstraint) -> Landmark:
        visits = [
            self._graph.visit(one, encounter.t_ns)
            for one in (encounter.unit_id, encounter.other_id)
        ]
        return Landmark(visits, encounter.std_m / np.sqrt(2.0), ENCOUNTER_TAIL)

    def _choose_places(self) -> None:
        for unit_id, evidence in self._units.items():
            if not evidence.places:
                continue
            expected = self._graph.expected(unit_id, evidence.places)
            used = consistent_set(expected)
            given = ConditionalPrediction(expected, used)
            for one, place in enumerate(evidence.places):
                if one not in used:
                    self._verdicts[place.name] = _rejection(
                        expected, given, evidence.places, used, one
                    )
            agreed = [evidence.places[one] for one in used]
            self._graph.places[unit_id] = self._consistent_heights(evidence, agreed)

    def _consistent_heights(
        self, evidence: UnitEvidence, places: Sequence[PositionConstraint]
    ) -> list[PositionConstraint]:
        """Constraints without those of a floor that path and other constraints contradict: no one
        is half way between two floors.
        """
        told = with_height(places)
        if not told:
            return list(places)
        heights = Heights.of(evidence)
        expected, used = heights.expected(told), heights.consistent_set(told)
        given = ConditionalPrediction(expected, used)
        for one in sorted(set(range(len(told))) - set(used)):
            below_m, sigmas = heights.off(told[one])
            refused = _rejection(expected, given, told, used, one)
            if refused.against:
                below_m = float(given.of(one)[0][0])
            self._verdicts[told[one].name] = replace(
                refused,
                residual_m=abs(below_m),
                sigmas=max(sigmas, refused.sigmas),
                above_m=-below_m,
            )
        return [place for place in places if place.name not in self._verdicts]

    def _reject_outliers(self) -> None:
        """Reject constraints that do not fit once later steps have estimated scale and drift."""
        for unit_id, used in self._graph.places.items():
            while used:
                apart_m = self._graph.residuals_m(unit_id, used)
                worst = int(np.argmax(apart_m / [place.std_m for place in used]))
                if (apart_m[worst] / used[worst].std_m) ** 2 <= GATE2:
                    break
                place = used.pop(worst)
                sigmas = float(apart_m[worst]) / place.std_m
                self._verdicts[place.name] = Verdict(False, float(apart_m[worst]), sigmas)
                self._graph.relax(self._noise)

    def _add_live_estimates(self) -> None:
        """Add live estimates where only they used the building model or walls."""
        graph, spreads = self._graph, self._graph.spreads()
        for unit_id, chain in graph.chains.items():
            estimate, places = graph.estimates[unit_id], graph.places[unit_id]
            rows = choose_shown(chain, estimate, spreads[unit_id], places)
            if len(rows):
                graph.shown[unit_id] = rows
        del spreads  # they hold the last solution
        if graph.shown:
            graph.relax(self._noise)

    def _add_wall_constraints(self) -> None:
        """Replace live estimates by the plan's walls. Where walls are crossed again and again the
        plan is of another building, and neither is used.
        """
        graph = self._graph
        for unit_id, unit in self._units.items():
            if unit.grid is not None:
                wall_messages = WallMessages(WallSegments.of(graph.chains[unit_id], unit.grid))
                if len(wall_messages.segments):
                    graph.wall_messages[unit_id] = wall_messages
        for sweep in range(SWEEPS if graph.wall_messages else 0):
            spreads = graph.spreads(on_plan=True)
            for unit_id, wall_messages in list(graph.wall_messages.items()):
                wall_messages.update(
                    graph.estimates[unit_id], graph.common.plan_m, spreads[unit_id]
                )
                if sweep > 0 and wall_messages.log_loss > CONTRADICTED:
                    del graph.wall_messages[unit_id]
                graph.shown.pop(unit_id, None)
            del spreads
            graph.step(self._noise)

    def close_loops(self) -> None:
        """Close loops where paths lead over the same stairs or along the same line again; lines
        only where no plan's walls are used, which are better.
        """
        graph = self._graph
        stairs = find_stairs(graph.chains, graph.estimates, graph.own_spreads())
        if stairs:
            graph.add_landmarks(stairs)
            graph.iterate(self._noise)
        for _ in range(0 if graph.wall_messages else LINE_SWEEPS):
            if graph.find_lines():
                graph.iterate(self._noise)

    def solution(self) -> Solution:
        graph = self._graph
        refused = self._reject_encounters()
        for unit_id, agreed in graph.places.items():
            if agreed:
                self._judge_used(unit_id, agreed)
        for encounter, meeting in zip(self._encounters, graph.landmarks, strict=False):
            apart_m = graph.visited.apart_m(meeting)
            sigmas = apart_m / encounter.std_m
            used = encounter.name not in refused and sigmas**2 <= GATE2
            self._verdicts[encounter.name] = Verdict(used, apart_m, sigmas)
        spreads = graph.spreads()
        on_plan = graph.spreads(on_plan=True) if graph.wall_messages else spreads
        encounter_heights = self._encounter_heights()
        paths = {
            one: self._trail(one, spreads[one], on_plan[one], encounter_heights)
            for one in self._units
        }
        return Solution(paths, {**self._verdicts, **self._floor_conflicts})

    def _reject_encounters(self) -> set[str]:
        """Remove encounters of units that were too far apart, which until here had reduced weight.
        Returns the names of those that do not fit.
        """
        graph = self._graph
        refused: set[int] = set()
        for _ in range(REJECTION_ROUNDS):
            misfits = [
                number
                for number, encounter in enumerate(self._encounters)
                if (graph.visited.apart_m(graph.landmarks[number]) / encounter.std_m) ** 2 > GATE2
            ]
            if refused.issuperset(misfits):
                break
            refused.update(misfits)
            graph.reject_landmarks(misfits)
            graph.iterate(self._noise)
        return {self._encounters[number].name for number in refused}

    def _split_encounters_by_floor(self) -> bool:
        """Remove encounters of units on different floors; True if there were any."""
        alone, parted = self._heights_alone(), {}
        for encounter in self._encounters:
            (down_m, std_m), (other_m, other_std_m) = (
                alone[one].at(encounter.t_ns) for one in _units_of(encounter)
            )
            above_m = other_m - down_m
            sigmas = abs(above_m) / math.hypot(std_m, other_std_m, ON_FLOOR_STD_M)
            if sigmas**2 > GATE2:
                parted[encounter.name] = Verdict(False, abs(above_m), sigmas, above_m=above_m)
        self._encounters = [
            encounter for encounter in self._encounters if encounter.name not in parted
        ]
        self._floor_conflicts |= parted
        return bool(parted)

    def _encounter_heights(self) -> dict[str, list[PositionConstraint]]:
        """Height constraints of encounters: each unit is as high as the other one is
        without them.
        """
        alone = self._heights_alone()
        encounter_heights: dict[str, list[PositionConstraint]] = {
            unit_id: [] for unit_id in self._units
        }
        for encounter in self._encounters:
            if self._verdicts[encounter.name].used:
                encounter_heights[encounter.unit_id].append(
                    _height_constraint(encounter, *alone[encounter.other_id].at(encounter.t_ns))
                )
                encounter_heights[encounter.other_id].append(
                    _height_constraint(encounter, *alone[encounter.unit_id].at(encounter.t_ns))
                )
        return encounter_heights

    def _heights_alone(self) -> dict[str, Solved]:
        """Heights of the units with encounters, by all other evidence."""
        who = {one for encounter in self._encounters for one in _units_of(encounter)}
        places = self._graph.places
        return {one: Heights.of(self._units[one]).solve(places[one]) for one in sorted(who)}

    def _judge_used(self, unit_id: str, used: Sequence[PositionConstraint]) -> None:
        apart_m = self._graph.residuals_m(unit_id, used)
        for place, off_m in zip(used, apart_m.tolist(), strict=True):
            self._verdicts[place.name] = Verdict(True, off_m, off_m / place.std_m)

    def _trail(
        self,
        unit_id: str,
        spreads: Floats,
        on_plan: Floats,
        encounter_heights: Mapping[str, Sequence[PositionConstraint]],
    ) -> SmoothedPath:
        """Solved path of one unit; with walls it continues from a place on the plan, as a fuser
        uses the walls as drawn.
        """
        graph = self._graph
        chain, estimate = graph.chains[unit_id], graph.estimates[unit_id]
        least_m = shown_floor_m(chain.path, graph.shown.get(unit_id))
        now, known = estimate.x[-1, :WALKED].copy(), spreads[-1, :WALKED, :WALKED]
        if unit_id in graph.wall_messages:
            now[:2] += graph.common.plan_m
            known = on_plan[-1, :WALKED, :WALKED]
        told = [*graph.places[unit_id], *encounter_heights[unit_id]]
        heights = Heights.of(self._units[unit_id]).solve(told)
        return trail_of(chain, estimate, spreads, least_m, heights, (now, known))


def _chains(kind: PathGraph, units: Mapping[str, UnitEvidence]) -> dict[str, Chain]:
    """With knots as far apart as there may be so many of."""
    coarser, chains = 1.0, dict[str, Chain]()
    while not chains or (sum(map(len, chains.values())) > kind.most_knots and coarser < COARSEST):
        chains = {
            unit_id: Chain.of(one, kind.noise, coarser * kind.knot_m, coarser * kind.knot_s)
            for unit_id, one in units.items()
        }
        coarser *= 1.5
    return chains


def _units_of(encounter: EncounterConstraint) -> tuple[str, str]:
    return encounter.unit_id, encounter.other_id


def _height_constraint(
    encounter: EncounterConstraint, down_m: float, std_m: float
) -> PositionConstraint:
    """Height of a unit by the other unit of an encounter; the place is in the graph already."""
    down_std_m = math.hypot(std_m, ON_FLOOR_STD_M)
    return PositionConstraint(
        encounter.name, encounter.t_ns, 0.0, 0.0, math.inf, down_m, down_std_m
    )


def _rejection(
    expected: Prediction,
    given: ConditionalPrediction,
    places: Sequence[PositionConstraint],
    used: Sequence[int],
    one: int,
) -> Verdict:
    innovation, _ = given.of(one)
    against = strongest_conflict(expected, used, one)
    return Verdict(
        used=False,
        residual_m=float(np.linalg.norm(innovation)),
        sigmas=float(np.sqrt(given.distance2(one))),
        against="" if against is None else places[against].name,
    )
