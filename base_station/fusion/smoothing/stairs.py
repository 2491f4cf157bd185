"""Stairs as landmarks on all paths of an incident.

Wearers change storeys only on stairs, and a building has few. The place of a climb is the middle of
its way (``building_model.stairs``); climbs far likelier on the same stairs than on others are
visits of one landmark.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.building_model.building import SURE_M
from base_station.fusion.building_model.stairs import Climb, ClimbDetector, LearntStairs
from base_station.fusion.odometry.points import BREAK, RESTART
from base_station.fusion.smoothing.chain import Chain, PathEstimate, place_of
from base_station.fusion.smoothing.landmarks import Landmark, Visit

Floats = NDArray[np.float64]

ODDS = 3.0  # likelihood ratio of the same stairs to others that is accepted
STD_M = 0.3  # each axis, of a climb's middle by the stairs'
TAIL = 2.4


@dataclass
class _Known:
    """Stairwell with its visits."""

    stairs: LearntStairs  # by all climbs on it
    visits: list[Visit] = field(default_factory=list)

    def take(self, stairs: LearntStairs, visit: Visit) -> None:
        self.visits.append(visit)
        if len(self.visits) == 1:
            return
        (one, spread), (other, also) = self.stairs.place, stairs.place
        gain = spread @ np.linalg.inv(spread + also + 2.0 * STD_M**2 * np.eye(2))
        (north_m, east_m), left = (one + gain @ (other - one)).tolist(), spread - gain @ spread
        (north, cross), (_, east) = left.tolist()
        self.stairs = msgspec.structs.replace(
            self.stairs, north_m=north_m, east_m=east_m, covariance_m2=(north, cross, east)
        )


def find_stairs(
    chains: Mapping[str, Chain],
    estimates: Mapping[str, PathEstimate],
    spreads: Mapping[str, Floats],
) -> list[Landmark]:
    """``spreads`` (k, n, n) by unit: of the knots, without what all units err by together."""
    climbs = [
        (LearntStairs.at(climb, *_placed(visit, estimates, spreads), 0.0), visit)
        for unit_id, chain in chains.items()
        for climb, visit in _climbs(unit_id, chain)
        if estimates[unit_id].aligned[visit.knot]
    ]
    known: list[_Known] = []
    for seen, visit in sorted(climbs, key=lambda climb: climb[0].variance_m2):
        if seen.variance_m2 > SURE_M**2:
            break
        odds = [seen.odds(one.stairs) for one in known]
        best = max(range(len(known)), key=lambda one: odds[one], default=-1)
        if sum(odds) < 1.0 / ODDS:
            known.append(_Known(seen))
            known[-1].take(seen, visit)
        elif odds[best] > ODDS * (1.0 + sum(odds) - odds[best]):
            known[best].take(seen, visit)
    return [Landmark(one.visits, STD_M, TAIL) for one in known if len(one.visits) > 1]


def _climbs(unit_id: str, chain: Chain) -> list[tuple[Climb, Visit]]:
    path, watch, begin, climbs = chain.path, ClimbDetector(), 0, []
    steps = np.diff(path.own_m, axis=0, prepend=path.own_m[:1])
    for row, (north_m, east_m) in enumerate(steps.tolist()):
        if path.flags[row] & (BREAK | RESTART):
            watch = ClimbDetector()
            continue
        if watch.begin_m is None:
            begin = row
        climb = watch.update(north_m, east_m, float(path.down_m[row]))
        if climb is not None:
            middle_m = path.own_m[row] - (climb.since_north_m, climb.since_east_m)
            climbs.append((climb, _visit(unit_id, chain, (begin, row), middle_m)))
    return climbs


def _visit(unit_id: str, chain: Chain, rows: tuple[int, int], middle_m: Floats) -> Visit:
    """Visit from the knot nearest to the middle, among those between two rows of the path."""
    first, last = np.searchsorted(chain.knots, rows, side="right") - 1
    off_m = middle_m - chain.own_m[first : last + 1]
    near = int(np.argmin((off_m**2).sum(axis=1)))
    return Visit(unit_id, int(first) + near, off_m[near])


def _placed(
    visit: Visit, estimates: Mapping[str, PathEstimate], spreads: Mapping[str, Floats]
) -> tuple[Floats, Floats]:
    x = estimates[visit.unit_id].x[visit.knot]
    place: Floats = place_of(x[None], visit.since_m[None])[0]
    return place, spreads[visit.unit_id][visit.knot, :2, :2]
