"""All trails at once, as the least-squares solution of a graph of knots: what hangs on it when.

Places that contradict each other or the rest are found before they can pull (``agreement``), and so
are meetings of two who were on different floors.  Only then are live estimates and walls heeded,
which may have held somebody in the wrong room.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.smoother.agreement import (
    GATE2,
    Expected,
    Given,
    agreeing,
    most_against,
)
from base_station.fusion.smoother.chain import WALKED, Chain, WalkNoise
from base_station.fusion.smoother.graph import Graph
from base_station.fusion.smoother.heights import Heights, Solved, telling
from base_station.fusion.smoother.landmarks import Landmark
from base_station.fusion.smoother.live_estimates import choose_shown, shown_floor_m
from base_station.fusion.smoother.port import (
    ON_FLOOR_STD_M,
    PlaceSeen,
    SmoothedPath,
    Solution,
    Tie,
    UnitEvidence,
    Verdict,
)
from base_station.fusion.smoother.stairs import find_stairs
from base_station.fusion.smoother.trail import trail_of
from base_station.fusion.smoother.walls import Pieces, Words

Floats = NDArray[np.float64]

TIE_TAIL = 3.0  # standard deviations from which a meeting counts less
PARTINGS = 3  # rounds in which meetings that do not fit are let go
SWEEPS = 6  # over what walls say
LINE_SWEEPS = 2  # over which lines legs are of
CONTRADICTED = 0.3  # of log weight lost a piece, on the mean: the plan or the path is wrong


@dataclass(frozen=True)
class PathGraph:
    """Parameters, and the smoother itself."""

    name: str = "path-graph"
    noise: WalkNoise = field(default_factory=WalkNoise)
    knot_m: float = 3.0
    knot_s: float = 15.0

    def solve(self, units: Mapping[str, UnitEvidence], ties: Sequence[Tie] = ()) -> Solution:
        return _Solving(self, units, ties).solution()

    def smooth(self, units: Mapping[str, UnitEvidence], ties: Sequence[Tie] = ()) -> Solution:
        solving = _Solving(self, units, ties)
        solving.close_loops()
        return solving.solution()


class _Solving:
    """One problem on its way."""

    def __init__(
        self, kind: PathGraph, units: Mapping[str, UnitEvidence], ties: Sequence[Tie]
    ) -> None:
        self._noise = kind.noise
        self._units = units
        self._ties = [t for t in ties if t.unit_id in units and t.other_id in units]
        self._chains = {
            unit_id: Chain.of(one, kind.noise, kind.knot_m, kind.knot_s)
            for unit_id, one in units.items()
        }
        self._not_met: dict[str, Verdict] = {}  # by tie: they were on different floors
        self._begin()
        while self._part_floors():
            self._begin()
        self._heed_live_estimates()
        self._heed_walls()

    def _begin(self) -> None:
        """By paths, fixes, meetings and what agrees of the places."""
        self._verdicts: dict[str, Verdict] = {}
        self._graph = Graph(self._units, self._chains)
        self._graph.lead_through([self._meeting(tie) for tie in self._ties])
        self._graph.relax(self._noise)
        if any(one.places for one in self._units.values()):
            self._choose_places()
            self._graph.relax(self._noise)
            self._drop_misfits()

    def _meeting(self, tie: Tie) -> Landmark:
        visits = [self._graph.visit(one, tie.t_ns) for one in (tie.unit_id, tie.other_id)]
        return Landmark(visits, tie.std_m / np.sqrt(2.0), TIE_TAIL)

    def _choose_places(self) -> None:
        for unit_id, evidence in self._units.items():
            if not evidence.places:
                continue
            expected = self._graph.expected(unit_id, evidence.places)
            used = agreeing(expected)
            given = Given(expected, used)
            for one, place in enumerate(evidence.places):
                if one not in used:
                    self._verdicts[place.name] = _refused(
                        expected, given, evidence.places, used, one
                    )
            agreed = [evidence.places[one] for one in used]
            self._graph.places[unit_id] = self._at_their_heights(evidence, agreed)

    def _at_their_heights(
        self, evidence: UnitEvidence, places: Sequence[PlaceSeen]
    ) -> list[PlaceSeen]:
        """Without those of a floor that the path and the others do not lead to: half way between
        two floors nobody is.
        """
        told = telling(places)
        if not told:
            return list(places)
        heights = Heights.of(evidence)
        expected, used = heights.expected(told), heights.agreeing(told)
        given = Given(expected, used)
        for one in sorted(set(range(len(told))) - set(used)):
            below_m, sigmas = heights.off(told[one])
            refused = _refused(expected, given, told, used, one)
            if refused.against:
                below_m = float(given.of(one)[0][0])
            self._verdicts[told[one].name] = replace(
                refused,
                residual_m=abs(below_m),
                sigmas=max(sigmas, refused.sigmas),
                above_m=-below_m,
            )
        return [place for place in places if place.name not in self._verdicts]

    def _drop_misfits(self) -> None:
        """Scale and drift come in with the later steps only: what then does not fit goes too."""
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

    def _heed_live_estimates(self) -> None:
        """What they alone knew: the building as it was learnt, and where walls held people."""
        graph, spreads = self._graph, self._graph.spreads()
        for unit_id, chain in graph.chains.items():
            belief, places = graph.beliefs[unit_id], graph.places[unit_id]
            rows = choose_shown(chain, belief, spreads[unit_id], places)
            if len(rows):
                graph.shown[unit_id] = rows
        if graph.shown:
            graph.relax(self._noise)

    def _heed_walls(self) -> None:
        """A plan's walls take the place of what live estimates had of them.  Where they stand in
        the way again and again the plan is of another building, and neither is heeded.
        """
        graph = self._graph
        for unit_id, unit in self._units.items():
            if unit.grid is not None:
                words = Words(Pieces.of(graph.chains[unit_id], unit.grid))
                if len(words.pieces):
                    graph.words[unit_id] = words
        for sweep in range(SWEEPS if graph.words else 0):
            spreads = graph.spreads(on_plan=True)
            for unit_id, words in list(graph.words.items()):
                words.renew(graph.beliefs[unit_id], graph.common.plan_m, spreads[unit_id])
                if sweep > 0 and words.lost > CONTRADICTED:
                    del graph.words[unit_id]
                graph.shown.pop(unit_id, None)
            graph.step(self._noise)

    def close_loops(self) -> None:
        """Where trails lead over the same stairs again, or along the same line, they are drawn
        together.  Where a plan's walls are heeded they tell more.
        """
        graph = self._graph
        stairs = find_stairs(graph.chains, graph.beliefs, graph.own_spreads())
        if stairs:
            graph.lead_through(stairs)
            graph.settle(self._noise)
        for _ in range(0 if graph.words else LINE_SWEEPS):
            if graph.find_lines():
                graph.settle(self._noise)

    def solution(self) -> Solution:
        graph = self._graph
        refused = self._let_go()
        for unit_id, agreed in graph.places.items():
            if agreed:
                self._judge_used(unit_id, agreed)
        for tie, meeting in zip(self._ties, graph.landmarks, strict=False):
            apart_m = graph.visited.apart_m(meeting)
            sigmas = apart_m / tie.std_m
            used = tie.name not in refused and sigmas**2 <= GATE2
            self._verdicts[tie.name] = Verdict(used, apart_m, sigmas)
        spreads = graph.spreads()
        on_plan = graph.spreads(on_plan=True) if graph.words else spreads
        met = self._met()
        paths = {one: self._trail(one, spreads[one], on_plan[one], met) for one in self._units}
        return Solution(paths, {**self._verdicts, **self._not_met})

    def _let_go(self) -> set[str]:
        """Two who were too far apart have not met either: until here such a meeting counted less,
        now it tells nothing.  Gives the names of those that do not fit.
        """
        graph = self._graph
        refused: set[int] = set()
        for _ in range(PARTINGS):
            misfits = [
                number
                for number, tie in enumerate(self._ties)
                if (graph.visited.apart_m(graph.landmarks[number]) / tie.std_m) ** 2 > GATE2
            ]
            if refused.issuperset(misfits):
                break
            refused.update(misfits)
            graph.let_go(misfits)
            graph.settle(self._noise)
        return {self._ties[number].name for number in refused}

    def _part_floors(self) -> bool:
        """Two who were on different floors have not met: such a meeting tells nothing at all.
        Whether there are any.
        """
        alone, parted = self._heights_alone(), {}
        for tie in self._ties:
            (down_m, std_m), (other_m, other_std_m) = (
                alone[one].at(tie.t_ns) for one in _both(tie)
            )
            above_m = other_m - down_m
            sigmas = abs(above_m) / math.hypot(std_m, other_std_m, ON_FLOOR_STD_M)
            if sigmas**2 > GATE2:
                parted[tie.name] = Verdict(False, abs(above_m), sigmas, above_m=above_m)
        self._ties = [tie for tie in self._ties if tie.name not in parted]
        self._not_met |= parted
        return bool(parted)

    def _met(self) -> dict[str, list[PlaceSeen]]:
        """Who met somebody is as high as the other is by all else that is known of that one."""
        alone = self._heights_alone()
        met: dict[str, list[PlaceSeen]] = {unit_id: [] for unit_id in self._units}
        for tie in self._ties:
            if self._verdicts[tie.name].used:
                met[tie.unit_id].append(_beside(tie, *alone[tie.other_id].at(tie.t_ns)))
                met[tie.other_id].append(_beside(tie, *alone[tie.unit_id].at(tie.t_ns)))
        return met

    def _heights_alone(self) -> dict[str, Solved]:
        """Of those that met somebody, by all but that."""
        who = {one for tie in self._ties for one in _both(tie)}
        places = self._graph.places
        return {one: Heights.of(self._units[one]).solve(places[one]) for one in sorted(who)}

    def _judge_used(self, unit_id: str, used: Sequence[PlaceSeen]) -> None:
        apart_m = self._graph.residuals_m(unit_id, used)
        for place, off_m in zip(used, apart_m.tolist(), strict=True):
            self._verdicts[place.name] = Verdict(True, off_m, off_m / place.std_m)

    def _trail(
        self,
        unit_id: str,
        spreads: Floats,
        on_plan: Floats,
        met: Mapping[str, Sequence[PlaceSeen]],
    ) -> SmoothedPath:
        """A fuser knows walls where the plan has them, so it goes on from a place on the plan."""
        graph = self._graph
        chain, belief = graph.chains[unit_id], graph.beliefs[unit_id]
        least_m = shown_floor_m(chain.path, graph.shown.get(unit_id))
        now, known = belief.x[-1, :WALKED].copy(), spreads[-1, :WALKED, :WALKED]
        if unit_id in graph.words:
            now[:2] += graph.common.plan_m
            known = on_plan[-1, :WALKED, :WALKED]
        told = [*graph.places[unit_id], *met[unit_id]]
        heights = Heights.of(self._units[unit_id]).solve(told)
        return trail_of(chain, belief, spreads, least_m, heights, (now, known))


def _both(tie: Tie) -> tuple[str, str]:
    return tie.unit_id, tie.other_id


def _beside(tie: Tie, down_m: float, std_m: float) -> PlaceSeen:
    """What somebody tells of how high the other was; of where, the graph knows already."""
    down_std_m = math.hypot(std_m, ON_FLOOR_STD_M)
    return PlaceSeen(tie.name, tie.t_ns, 0.0, 0.0, math.inf, down_m, down_std_m)


def _refused(
    expected: Expected, given: Given, places: Sequence[PlaceSeen], used: Sequence[int], one: int
) -> Verdict:
    innovation, _ = given.of(one)
    against = most_against(expected, used, one)
    return Verdict(
        used=False,
        residual_m=float(np.linalg.norm(innovation)),
        sigmas=float(np.sqrt(given.distance2(one))),
        against="" if against is None else places[against].name,
    )
