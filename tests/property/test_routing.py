"""Properties of routes over any trails."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from base_station.routing.interface import WalkedTrail
from base_station.routing.legs import legs_of
from base_station.routing.plan_lattice import NO_LATTICE
from base_station.routing.search import routes_to
from base_station.routing.way_graph import CELL_M, WayGraph

PLACES = st.tuples(st.floats(-40.0, 40.0), st.floats(-40.0, 40.0), st.integers(-1, 2))


@st.composite
def trails(draw: st.DrawFn) -> list[WalkedTrail]:
    """Trails of three people who entered at one place."""
    entrance = (0.0, 0.0, 0)
    walks = [[entrance, *draw(st.lists(PLACES, max_size=6))] for _ in range(3)]
    return [
        WalkedTrail(
            f"U{number}",
            np.array([place[:2] for place in walk]),
            np.array([floor for *_, floor in walk]),
            np.zeros(len(walk), dtype=np.bool_),
            0.5,
        )
        for number, walk in enumerate(walks)
    ]


@given(trails())
def test_route_exists_between_all_who_entered_at_one_place(walked: list[WalkedTrail]) -> None:
    """It is no shorter than the straight line, no longer than the way by the entrance, and the same
    in both directions.
    """
    graph = WayGraph(walked, NO_LATTICE)
    routes = routes_to(graph, "U0", ["U1", "U2"])
    assert set(routes) == {"U1", "U2"}
    for unit_id, found in routes.items():
        begin, end = found.places[0], found.places[-1]
        line_m = math.hypot(end.north_m - begin.north_m, end.east_m - begin.east_m)
        assert found.distance_m >= line_m - 1e-6
        back = routes_to(graph, unit_id, ["U0"])["U0"]
        assert abs(back.distance_m - found.distance_m) < 5 * CELL_M
        around_m = sum(map(_length_m, (walked[0], walked[int(unit_id[1])])))
        assert found.distance_m <= around_m * 1.1 + 8 * CELL_M
        assert begin.floor == int(walked[int(unit_id[1])].floors[-1])
        climbed = sum(leg.floors for leg in legs_of(found.places, None))
        assert climbed == (end.floor or 0) - (begin.floor or 0)


def _length_m(trail: WalkedTrail) -> float:
    level_m = np.hypot(*np.diff(trail.places_m, axis=0).T).sum()
    return float(level_m + 3.0 * np.abs(np.diff(trail.floors)).sum())
