"""Routes of rescuers to a member over the graph of known ways."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

import numpy as np

from base_station.routing.interface import NO_FLOOR, Indices, Route, Waypoint
from base_station.routing.line_of_sight import straightened
from base_station.routing.way_graph import WayGraph


def routes_to(
    graph: WayGraph, unit_id: str, rescuer_ids: Iterable[str], most: int | None = None
) -> dict[str, Route]:
    """Return the shortest routes to the unit, at most ``most``, the nearest first, of people that
    have one.
    """
    if unit_id not in graph.nodes:
        return {}
    costs_m, following = graph.ways_to(unit_id)
    known = [one for one in rescuer_ids if one in graph.nodes and one != unit_id]
    known = [one for one in known if math.isfinite(costs_m[graph.nodes[one]])]
    # Unwalked ground costs more than its length: some further ones are measured too.
    nearest = sorted(known, key=lambda one: float(costs_m[graph.nodes[one]]))
    routes = {
        one: _route(graph, one, unit_id, list(_nodes(graph, one, following)))
        for one in (nearest if most is None else nearest[: 2 * most])
    }
    return dict(sorted(routes.items(), key=lambda one: one[1].distance_m)[:most])


def _nodes(graph: WayGraph, rescuer_id: str, following: Indices) -> Iterator[int]:
    at = graph.nodes[rescuer_id]
    while at >= 0:
        yield at
        at = int(following[at])


def _route(graph: WayGraph, rescuer_id: str, unit_id: str, nodes: list[int]) -> Route:
    rescuer, member = graph.trails[rescuer_id], graph.trails[unit_id]
    steps = list(pairwise(nodes))
    places_m = graph.places_m[nodes].copy()
    places_m[0], places_m[-1] = rescuer.places_m[-1], member.places_m[-1]
    if len(nodes) == 1:
        places_m = np.stack([rescuer.places_m[-1], member.places_m[-1]])
        nodes = nodes * 2
    places: list[Waypoint] = []
    distance_m = 0.0
    for begin, end in _storeys(graph, nodes):
        if begin:
            distance_m += graph.length_m(nodes[begin - 1], nodes[begin])
        floor = _floor_of(graph.floors[nodes[begin:end]].tolist())
        corners_m = straightened(places_m[begin:end], floor, graph.lattice.grid)
        distance_m += float(np.hypot(*np.diff(corners_m, axis=0).T).sum())
        places += [Waypoint(north_m, east_m, floor) for north_m, east_m in corners_m.tolist()]
    bridged_m2 = sum(graph.bridge_variance_m2(*step) for step in steps)
    return Route(
        places=tuple(places),
        distance_m=distance_m,
        std_m=math.sqrt(rescuer.std_m**2 + member.std_m**2 + bridged_m2),
        crosses_walls=any(graph.is_through_wall(*step) for step in steps),
    )


def _storeys(graph: WayGraph, nodes: list[int]) -> Iterator[tuple[int, int]]:
    """Begin and end of each part on one floor; of a node without a floor it is the one before's."""
    begin, floor = 0, NO_FLOOR
    for number, node in enumerate(nodes):
        here = int(graph.floors[node])
        if here not in {NO_FLOOR, floor} and floor != NO_FLOOR:
            yield begin, number
            begin = number
        floor = floor if here == NO_FLOOR else here
    yield begin, len(nodes)


def _floor_of(floors: Sequence[int]) -> int | None:
    """Known floor of a part on one floor; None if none of its nodes has one."""
    return next((floor for floor in floors if floor != NO_FLOOR), None)
