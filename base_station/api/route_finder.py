"""Routes to a member, over the picture that consoles have.

The graph of known ways is made in the thread of a request and kept for a moment: several consoles
ask for the same routes repeatedly while people move.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Sequence
from threading import Lock

import msgspec
import numpy as np

from base_station.engine.ports import Trails
from base_station.routing.interface import NO_FLOOR, Route, WalkedTrail, Waypoint
from base_station.routing.plan_lattice import NO_LATTICE, PlanLattice, plan_lattice
from base_station.routing.search import routes_to
from base_station.routing.way_graph import WayGraph
from base_station.site.max_travel import RADII_95
from base_station.site.plan_reader import PlanReader
from base_station.views.wire import PositionView, Snapshot, TrailPoint, UnitView

NEAREST = 3  # rescuers that are named
KEPT_S = 1.0  # a rescuer walks a metre in it

_decode_trail = msgspec.json.Decoder(list[TrailPoint]).decode


class RouteFinder:
    """Finder of routes.  Thread-safe; one request works at a time."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._plans = PlanReader()
        self._lattice: tuple[bytes, PlanLattice] = (b"", NO_LATTICE)
        self._made: tuple[float, Snapshot, WayGraph] | None = None

    def routes(
        self,
        current: Callable[[], tuple[Snapshot, Trails]],
        unit_id: str,
        rescuer_ids: Callable[[Snapshot], Iterable[str]],
    ) -> tuple[Snapshot, dict[str, Route]]:
        """Known routes of the nearest rescuers to a unit, and the picture from which they were
        found.

        ``current`` returns the current picture, ``rescuer_ids`` its units that may be sent.
        """
        with self._lock:
            if not self._has_kept(unit_id):
                snapshot, trails = current()
                graph = WayGraph(_walked(snapshot, trails), self._lattice_of(snapshot))
                self._made = time.monotonic(), snapshot, graph
            assert self._made is not None
            _, snapshot, graph = self._made
            return snapshot, routes_to(graph, unit_id, rescuer_ids(snapshot), NEAREST)

    def _has_kept(self, unit_id: str) -> bool:
        """True if what was made a moment ago can be used again: it is not old, and contains the
        unit.
        """
        if self._made is None or time.monotonic() - self._made[0] > KEPT_S:
            return False
        return any(unit.unit_id == unit_id for unit in self._made[1].units)

    def _lattice_of(self, snapshot: Snapshot) -> PlanLattice:
        if snapshot.plan is None or not snapshot.plan_placed:
            return NO_LATTICE
        geojson = bytes(snapshot.plan)
        if self._lattice[0] != geojson:
            plan = self._plans.plan(geojson)
            self._lattice = geojson, plan_lattice(self._plans.grid(plan))
        return self._lattice[1]


def place_of(position: PositionView) -> Waypoint:
    return Waypoint(position.north_m, position.east_m, position.floor)


def std_m_of(position: PositionView) -> float:
    """Standard deviation in the direction in which it is largest."""
    return position.ellipse_major_m / RADII_95


def _walked(snapshot: Snapshot, trails: Trails) -> list[WalkedTrail]:
    placed = [(unit, unit.position) for unit in snapshot.units if unit.position is not None]
    return [_trail(unit, position, trails) for unit, position in placed]


def _trail(unit: UnitView, position: PositionView, trails: Trails) -> WalkedTrail:
    """Trail until now.  The way to a position after a gap is not known."""
    raw = trails.get(unit.unit_id)
    points: Sequence[TrailPoint] = () if raw is None else _decode_trail(raw)
    now = TrailPoint(position.t_ms, position.north_m, position.east_m, position.floor)
    points = [*points, now]
    places_m = np.array([(point.north_m, point.east_m) for point in points])
    floors = [NO_FLOOR if point.floor is None else point.floor for point in points]
    after_gap = [bool(point.after_gap) for point in points]
    is_finite = math.isfinite(position.ellipse_major_m)
    return WalkedTrail(
        unit.unit_id,
        places_m,
        np.array(floors, dtype=np.int64),
        np.array(after_gap, dtype=np.bool_),
        std_m_of(position) if is_finite else math.inf,
    )
