"""Routes on which the documents report their trackers of the trunk, as scenarios.

Li et al. 2014 (waist): a corridor of 174 m with four right angles, 60 m with three, five floors of
4 m up and down.  Chiu 2011 (torso and shank): a court of 28 m by 15 m, a roundabout of 16 m.
Hettiarachchige Don 2016 (hip): a straight 40 m, a round of 124 m along corridors.
"""

from __future__ import annotations

from math import pi

from edge.simulation.legs import Leg, StairsLeg, Stand, Turn, Walk
from edge.simulation.polyline import arc
from edge.simulation.scenario import Scenario

_STOREY_M, _RISERS = 4.0, 24
_CORRIDOR_M, _FLIGHT_M = 20.0, 7.0


def _route(name: str, summary: str, *legs: Leg) -> Scenario:
    return Scenario(name, summary, (Stand(5.0), *legs, Stand(5.0)))


def _floors(storeys: int) -> tuple[Leg, ...]:
    """Along a corridor and up a flight at its end, to the top floor, and down again."""
    legs: list[Leg] = []
    places = [(0.0, 0.0)]
    for storey in range(storeys):
        far_m = _CORRIDOR_M if storey % 2 == 0 else 0.0
        along = (far_m, places[-1][1])
        up = (far_m, _FLIGHT_M if along[1] == 0.0 else 0.0)
        legs += [Walk((along,)), StairsLeg(up, _STOREY_M, _RISERS)]
        places += [along, up]
    for below, above in reversed(list(zip(places[::2], places[1::2], strict=False))):
        legs += [StairsLeg(above, -_STOREY_M, _RISERS), Walk((below,))]
    return tuple(legs)


ROUTES: dict[str, Scenario] = {
    route.name: route
    for route in (
        _route(
            "corridor-174m",
            "174 m along corridors with four right angles",
            Walk(((60.0, 0.0), (60.0, 12.0), (0.0, 12.0), (0.0, 24.0), (30.0, 24.0))),
        ),
        _route(
            "three-turns-60m",
            "60 m with three right angles",
            Walk(((20.0, 0.0), (20.0, 10.0), (0.0, 10.0), (0.0, 0.0))),
        ),
        _route("five-floors", "five floors of 4 m up and down", *_floors(4)),
        _route(
            "court-86m",
            "round a court of 28 m by 15 m",
            Walk(((15.0, 0.0), (15.0, 28.0), (0.0, 28.0), (0.0, 0.0))),
        ),
        _route(
            "roundabout-50m",
            "round a circle of 16 m",
            Walk((*arc((0.0, 8.0), 8.0, -pi / 2.0, 3.0 * pi / 2.0),)),
        ),
        _route("straight-40m", "40 m straight on", Walk(((40.0, 0.0),))),
        _route(
            "corridors-124m",
            "a round of 124 m along corridors",
            Walk(((36.0, 0.0), (36.0, 26.0), (0.0, 26.0), (0.0, 0.0))),
            Turn(0.0),
        ),
    )
}
