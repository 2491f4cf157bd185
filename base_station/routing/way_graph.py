"""Graph of known ways: nodes on the ground that was walked or that a plan shows to be free.

On a floor with a plan the nodes are the points of its lattice: doors are open, walls are not, and
walked ground is preferred.  Elsewhere the trails of all are cut into cells, and
what shares a cell or is beside it is one way.  Trails that do not meet are joined where they come
as near as the doubt of both allows; such a bridge adds its doubt to the route.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import KDTree

from base_station.routing.interface import NO_FLOOR, STOREY_M, Flags, Floats, Indices, WalkedTrail
from base_station.routing.plan_lattice import OPEN_GROUND_M, UNWALKED, PlanLattice
from base_station.routing.walked_cells import Samples, sample_trails
from base_station.site.floor_grid import CELL_M as SQUARE_M
from base_station.site.floor_grid import LATTICE
from base_station.site.max_travel import RADII_95
from base_station.site.wall_crossing import WALL

CELL_M = 1.0  # of trails: as wide as a corridor
JOIN_M = 1.5  # nodes so near are one way: cells that touch
MOST_BRIDGE_M = 10.0  # however uncertain two trails are
WALL_COST_M = 50.0  # of a trail through a wall of the plan: only where there is no other way (ours)
_SPAN = 2**20  # cells from edge to edge: no site is a thousand kilometres wide
_BESIDE = [(row, column) for row in (-1, 0, 1) for column in (-1, 0, 1) if row or column]


class WayGraph:
    """Known ways, as they are now."""

    def __init__(self, trails: Sequence[WalkedTrail], lattice: PlanLattice) -> None:
        self.lattice = lattice
        self.trails = {trail.unit_id: trail for trail in trails if len(trail.floors)}
        samples = sample_trails(tuple(self.trails.values()), CELL_M) if self.trails else None
        self.places_m, self.floors = lattice.places_m, lattice.floors
        self._std_m: Floats = np.zeros(len(self.floors))
        self._edges = [lattice.edges]
        self._costs_m = [lattice.costs_m]
        self._bridges: dict[tuple[int, int], float] = {}  # variance that each adds, m2
        self._through_walls: set[tuple[int, int]] = set()
        self.nodes: Mapping[str, int] = {}  # by unit: where it is now
        if samples is not None:
            self._add(samples)
        count = len(self.floors)
        edges = np.concatenate(self._edges)
        costs_m = np.concatenate(self._costs_m)
        self.matrix = csr_array((costs_m, (edges[:, 0], edges[:, 1])), shape=(count, count))

    def ways_to(self, unit_id: str) -> tuple[Floats, Indices]:
        """Cost of the way from each node to a unit, and the next node on it (``scipy``'s
        predecessors, -9999 where there is none); Dijkstra (1959).
        """
        costs_m, following = dijkstra(
            self.matrix, directed=False, indices=self.nodes[unit_id], return_predecessors=True
        )
        return costs_m, following

    def length_m(self, begin: int, end: int) -> float:
        """Length of the edge between two nodes, stairs as they are walked."""
        level_m = float(np.hypot(*(self.places_m[begin] - self.places_m[end])))
        if self.is_level(begin, end):
            return level_m
        return float(max(self.matrix[begin, end], self.matrix[end, begin]))

    def is_level(self, begin: int, end: int) -> bool:
        """True unless two nodes are on different known floors."""
        floors = {int(self.floors[begin]), int(self.floors[end])} - {NO_FLOOR}
        return len(floors) < 2

    def bridge_variance_m2(self, begin: int, end: int) -> float:
        """Variance that a step adds: 0 but where it joins trails that do not meet."""
        return self._bridges.get(_pair(begin, end), 0.0)

    def is_through_wall(self, begin: int, end: int) -> bool:
        return _pair(begin, end) in self._through_walls

    def _add(self, samples: Samples) -> None:
        nodes = self._nodes_of(samples)
        self.nodes = {unit_id: int(nodes[at]) for unit_id, at in samples.last.items()}
        self._add_walked_edges(nodes, samples.joined)
        self._add_open_ground()
        self._bridge()

    def _nodes_of(self, samples: Samples) -> Indices:
        """Node of each sample: on the lattice where there is one, else in a cell of its own."""
        nodes = np.full(len(samples.floors), -1, dtype=np.int64)
        for floor in self.lattice.nodes:
            on_floor = np.flatnonzero(samples.floors == floor)
            nodes[on_floor] = self._on_lattice(floor, samples.places_m[on_floor])
        others = np.flatnonzero(nodes < 0)
        places_m, floors = samples.places_m[others], samples.floors[others]
        rows, columns = np.floor(places_m / CELL_M).astype(np.int64).T
        keys = ((floors - NO_FLOOR) * _SPAN + rows + _SPAN // 2) * _SPAN + columns + _SPAN // 2
        cells, which = np.unique(keys, return_inverse=True)
        counts = np.bincount(which, minlength=len(cells))[:, None]
        sums = [np.bincount(which, places_m[:, axis], len(cells)) for axis in (0, 1)]
        std_m = np.full(len(cells), np.inf)
        np.minimum.at(std_m, which, samples.std_m[others])
        nodes[others] = len(self.floors) + which
        self.places_m = np.concatenate([self.places_m, np.column_stack(sums) / counts])
        self.floors = np.concatenate([self.floors, cells // _SPAN**2 + NO_FLOOR])
        self._std_m = np.concatenate([self._std_m, std_m])
        return nodes

    def _on_lattice(self, floor: int, places_m: Floats) -> Indices:
        """Nearest free point; beside a wall a neighbour on this side of it."""
        nodes = self.lattice.node_at(floor, places_m)
        grid = self.lattice.grid
        left = np.flatnonzero(nodes < 0)
        if grid is None or not len(left):
            return nodes
        at_m, nearest_m = places_m[left], np.full(len(left), np.inf)
        for row, column in _BESIDE:
            beside = self.lattice.node_at(
                floor, at_m + np.array([row, column]) * LATTICE * SQUARE_M
            )
            to_m = self.lattice.places_m[beside]
            away_m = np.hypot(*(to_m - at_m).T)
            is_better = (beside >= 0) & (away_m < nearest_m)
            is_better[is_better] &= grid.crossings(floor, at_m[is_better], to_m[is_better]) != WALL
            nearest_m[is_better] = away_m[is_better]
            nodes[left[is_better]] = beside[is_better]
        return nodes

    def _add_walked_edges(self, nodes: Indices, joined: Flags) -> None:
        """Edges along trails, and between cells that touch; each once."""
        ends = np.flatnonzero(joined)
        walked = np.column_stack([nodes[ends - 1], nodes[ends]])
        first_cell = len(self.lattice.floors)
        beside = [walked]
        for floor in np.unique(self.floors[first_cell:]).tolist():
            cells = first_cell + np.flatnonzero(self.floors[first_cell:] == floor)
            pairs = KDTree(self.places_m[cells]).query_pairs(JOIN_M, output_type="ndarray")
            beside.append(cells[pairs.reshape(-1, 2)])
        edges = _unique(np.concatenate(beside), len(self.floors))
        on_lattice = (edges < first_cell).all(axis=1)
        self._add_edges(edges[~on_lattice])
        self._add_on_lattice(edges[on_lattice])

    def _add_on_lattice(self, edges: Indices) -> None:
        """Steps from point to point of the lattice, through walls too."""
        grid, floors = self.lattice.grid, self.floors
        if grid is None:
            return
        is_climb = floors[edges[:, 0]] != floors[edges[:, 1]]
        climbs = edges[is_climb]
        is_known = np.isin(_keys(climbs, len(floors)), _keys(_climbs(self.lattice), len(floors)))
        self._add_edges(climbs[~is_known])
        for floor in self.lattice.nodes:
            level = edges[~is_climb & (floors[edges[:, 0]] == floor)]
            begins_m, ends_m = self.places_m[level[:, 0]], self.places_m[level[:, 1]]
            meets_wall = grid.crossings(floor, begins_m, ends_m) == WALL
            is_far = np.hypot(*(ends_m - begins_m).T) > 1.5 * LATTICE * SQUARE_M  # no neighbours
            self._add_edges(level[is_far & ~meets_wall])
            self._add_edges(level[meets_wall], WALL_COST_M)
            self._through_walls |= set(map(_pair, *level[meets_wall].T.tolist()))

    def _add_open_ground(self) -> None:
        """Add straight ways to the edge of the plan from nodes beyond it."""
        for node in set(self.nodes.values()):
            to = self.lattice.edge_node(int(self.floors[node]), self.places_m[node])
            if to < 0:
                continue
            way_m = float(np.hypot(*(self.places_m[node] - self.places_m[to])))
            if way_m < OPEN_GROUND_M:
                self._edges.append(np.array([[node, to]]))
                self._costs_m.append(np.array([UNWALKED * way_m]))

    def _add_edges(self, edges: Indices, more_m: float = 0.0) -> None:
        """Edges (k, 2), with the rise between two floors."""
        begins, ends = edges.T
        level_m = np.hypot(*(self.places_m[begins] - self.places_m[ends]).T)
        floors = self.floors[begins], self.floors[ends]
        is_known = (floors[0] != NO_FLOOR) & (floors[1] != NO_FLOOR)
        rises = np.where(is_known, np.abs(floors[0] - floors[1]), 0)
        # Two nodes of one place, of which the floor of one is not known, would cost nothing.
        self._edges.append(edges)
        self._costs_m.append(np.maximum(level_m + rises * STOREY_M, 1e-3) + more_m)

    def _bridge(self) -> None:
        """Join parts of one floor where they come as near as their doubt allows."""
        count = len(self.floors)
        edges = np.concatenate(self._edges)
        links = csr_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
        _, parts = connected_components(links, directed=False)
        first_cell = len(self.lattice.floors)
        for floor in np.unique(self.floors[first_cell:]).tolist():
            cells = first_cell + np.flatnonzero(self.floors[first_cell:] == floor)
            for part in np.unique(parts[cells]).tolist()[1:]:
                self._bridge_part(cells[parts[cells] == part], cells[parts[cells] != part])

    def _bridge_part(self, cells: Indices, others: Indices) -> None:
        places_m = self.places_m[cells]
        low, high = places_m.min(axis=0) - MOST_BRIDGE_M, places_m.max(axis=0) + MOST_BRIDGE_M
        to_m = self.places_m[others]
        others = others[((to_m > low) & (to_m < high)).all(axis=1)]
        if not len(others):
            return
        apart_m, nearest = KDTree(self.places_m[others]).query(places_m)
        found = others[nearest]
        variance_m2 = self._std_m[cells] ** 2 + self._std_m[found] ** 2
        within = apart_m < np.minimum(RADII_95 * np.sqrt(variance_m2), MOST_BRIDGE_M)
        bridges = np.column_stack([cells[within], found[within]])
        self._edges.append(bridges)
        self._costs_m.append(apart_m[within] + np.sqrt(variance_m2[within]))
        pairs = map(_pair, *bridges.T.tolist())
        self._bridges.update(zip(pairs, variance_m2[within].tolist(), strict=True))


def _climbs(lattice: PlanLattice) -> Indices:
    """Edges of stairs that the plan shows."""
    is_climb: Flags = np.diff(lattice.floors[lattice.edges], axis=1)[:, 0] != 0
    return lattice.edges[is_climb]


def _pair(begin: int, end: int) -> tuple[int, int]:
    return (begin, end) if begin < end else (end, begin)


def _keys(edges: Indices, count: int) -> Indices:
    """One number an edge, the same in both directions."""
    keys: Indices = np.minimum(*edges.T) * count + np.maximum(*edges.T)
    return keys


def _unique(edges: Indices, count: int) -> Indices:
    """Each edge once, without those from a node to itself."""
    keys = np.unique(_keys(edges[edges[:, 0] != edges[:, 1]], count))
    return np.column_stack(np.divmod(keys, count))
