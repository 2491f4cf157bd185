"""Encounters of two units in the graph, and those that cannot have been."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from base_station.fusion.smoothing.chain import WalkNoise
from base_station.fusion.smoothing.consistency import GATE2
from base_station.fusion.smoothing.graph import Graph
from base_station.fusion.smoothing.heights import Heights, Solved
from base_station.fusion.smoothing.interface import (
    ON_FLOOR_STD_M,
    EncounterConstraint,
    PositionConstraint,
    UnitEvidence,
    Verdict,
)
from base_station.fusion.smoothing.landmarks import Landmark

ENCOUNTER_TAIL = 3.0  # standard deviations from which a meeting counts less
REJECTION_ROUNDS = 3  # rounds in which meetings that do not fit are rejected


class Encounters:
    """Encounters of the units; they are the first landmarks of a graph, in this order."""

    def __init__(
        self, units: Mapping[str, UnitEvidence], encounters: Sequence[EncounterConstraint]
    ) -> None:
        self._units = units
        self._encounters = [t for t in encounters if t.unit_id in units and t.other_id in units]
        self.floor_conflicts: dict[str, Verdict] = {}  # of units on different floors

    def add_to(self, graph: Graph) -> None:
        """Add them as landmarks."""
        graph.add_landmarks([_landmark(graph, encounter) for encounter in self._encounters])

    def split_by_floor(self, graph: Graph) -> bool:
        """Remove encounters of units on different floors; True if there were any."""
        alone, conflicts = self._heights_alone(graph), dict[str, Verdict]()
        for encounter in self._encounters:
            (down_m, std_m), (other_m, other_std_m) = (
                alone[one].at(encounter.t_ns) for one in _units_of(encounter)
            )
            above_m = other_m - down_m
            sigmas = abs(above_m) / math.hypot(std_m, other_std_m, ON_FLOOR_STD_M)
            if sigmas**2 > GATE2:
                conflicts[encounter.name] = Verdict(False, abs(above_m), sigmas, above_m=above_m)
        self._encounters = [
            encounter for encounter in self._encounters if encounter.name not in conflicts
        ]
        self.floor_conflicts |= conflicts
        return bool(conflicts)

    def reject(self, graph: Graph, noise: WalkNoise) -> set[str]:
        """Remove encounters of units that were too far apart, which until here had reduced weight.
        Returns the names of those that do not fit.
        """
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
            graph.iterate(noise)
        return {self._encounters[number].name for number in refused}

    def verdicts(self, graph: Graph, refused: set[str]) -> dict[str, Verdict]:
        """Verdicts on those that are not of units on different floors."""
        verdicts = {}
        for encounter, landmark in zip(self._encounters, graph.landmarks, strict=False):
            apart_m = graph.visited.apart_m(landmark)
            sigmas = apart_m / encounter.std_m
            used = encounter.name not in refused and sigmas**2 <= GATE2
            verdicts[encounter.name] = Verdict(used, apart_m, sigmas)
        return verdicts

    def height_constraints(
        self, graph: Graph, verdicts: Mapping[str, Verdict]
    ) -> dict[str, list[PositionConstraint]]:
        """Height constraints by the encounters in use: each unit is as high as the other one is
        without them.
        """
        alone = self._heights_alone(graph)
        constraints: dict[str, list[PositionConstraint]] = {unit_id: [] for unit_id in self._units}
        for encounter in self._encounters:
            if verdicts[encounter.name].used:
                one, other = _units_of(encounter)
                for unit_id, by in ((one, other), (other, one)):
                    height = alone[by].at(encounter.t_ns)
                    constraints[unit_id].append(_height_constraint(encounter, *height))
        return constraints

    def _heights_alone(self, graph: Graph) -> dict[str, Solved]:
        """Heights of the units with encounters, by all other evidence."""
        unit_ids = {one for encounter in self._encounters for one in _units_of(encounter)}
        return {
            one: Heights.of(self._units[one]).solve(graph.places[one]) for one in sorted(unit_ids)
        }


def _landmark(graph: Graph, encounter: EncounterConstraint) -> Landmark:
    visits = [graph.visit(one, encounter.t_ns) for one in _units_of(encounter)]
    return Landmark(visits, encounter.std_m / np.sqrt(2.0), ENCOUNTER_TAIL)


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
