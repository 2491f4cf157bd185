"""Choice of position constraints: those that contradict each other or the rest are rejected."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from base_station.fusion.smoothing.chain import WalkNoise
from base_station.fusion.smoothing.consistency import (
    GATE2,
    ConditionalPrediction,
    Prediction,
    consistent_set,
    strongest_conflict,
)
from base_station.fusion.smoothing.graph import Graph
from base_station.fusion.smoothing.heights import Heights, with_height
from base_station.fusion.smoothing.interface import PositionConstraint, UnitEvidence, Verdict


def choose_places(
    graph: Graph, unit_id: str, evidence: UnitEvidence
) -> tuple[list[PositionConstraint], dict[str, Verdict]]:
    """Position constraints of a unit that can be true together, and the verdicts on the others."""
    places = evidence.places
    expected = graph.expected(unit_id, places)
    used = consistent_set(expected)
    given = ConditionalPrediction(expected, used)
    rejected = {
        place.name: _rejection(expected, given, places, used, one)
        for one, place in enumerate(places)
        if one not in used
    }
    rejected |= _contradicted_heights(evidence, [places[one] for one in used])
    return [places[one] for one in used if places[one].name not in rejected], rejected


def _contradicted_heights(
    evidence: UnitEvidence, places: Sequence[PositionConstraint]
) -> dict[str, Verdict]:
    """Verdicts on constraints of a floor that path and other constraints contradict: no one is
    half way between two floors.
    """
    given_heights = with_height(places)
    if not given_heights:
        return {}
    heights, rejected = Heights.of(evidence), dict[str, Verdict]()
    expected, used = heights.expected(given_heights), heights.consistent_set(given_heights)
    given = ConditionalPrediction(expected, used)
    for one in sorted(set(range(len(given_heights))) - set(used)):
        below_m, sigmas = heights.off(given_heights[one])
        refused = _rejection(expected, given, given_heights, used, one)
        if refused.against:
            below_m = float(given.of(one)[0][0])
        rejected[given_heights[one].name] = replace(
            refused,
            residual_m=abs(below_m),
            sigmas=max(sigmas, refused.sigmas),
            above_m=-below_m,
        )
    return rejected


def reject_outliers(graph: Graph, unit_id: str, noise: WalkNoise) -> dict[str, Verdict]:
    """Reject constraints that do not fit once later steps have estimated scale and drift."""
    used, rejected = graph.places[unit_id], dict[str, Verdict]()
    while used:
        apart_m = graph.residuals_m(unit_id, used)
        worst = int(np.argmax(apart_m / [place.std_m for place in used]))
        if (apart_m[worst] / used[worst].std_m) ** 2 <= GATE2:
            break
        place = used.pop(worst)
        sigmas = float(apart_m[worst]) / place.std_m
        rejected[place.name] = Verdict(False, float(apart_m[worst]), sigmas)
        graph.relax(noise)
    return rejected


def used_verdicts(graph: Graph, unit_id: str) -> dict[str, Verdict]:
    """Verdicts on the constraints that the solution uses."""
    used = graph.places[unit_id]
    if not used:
        return {}
    apart_m = graph.residuals_m(unit_id, used)
    return {
        place.name: Verdict(True, off_m, off_m / place.std_m)
        for place, off_m in zip(used, apart_m.tolist(), strict=True)
    }


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
